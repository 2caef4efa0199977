//! Font and SVG files → Font: the mirror of `write`.
