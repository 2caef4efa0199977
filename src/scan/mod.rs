//! Image bytes → Cells: load, clean, deskew, cut.
