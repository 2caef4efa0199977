//! Fitted curves and the grey picture → better fitted curves.
