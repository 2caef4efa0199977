//! Cell → Contours at half coverage, subpixel.
