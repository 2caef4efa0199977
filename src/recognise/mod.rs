//! Cell → which letter it is; thinning, stroke graphs, B-spline matching.
