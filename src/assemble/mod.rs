//! Outlines → Font: names, metrics, spacing, joining, features.
