//! A boundary and a code → its vertices and their curve.

use super::band::Begin;
use super::piece::curve;
use super::places::extent;
use super::search::Search;
use super::{Bounds, Closing, Code, CodeError, Coded, Kind, distortion, ring};
use kurbo::Point;

/// The vertices of least bits whose curve stays within the bounds of a closed boundary (whole px, the
/// first point not repeated).
///
/// # Errors
/// The boundary is too short, the bounds are out of order, or no vertices meet them.
pub fn encode(
    boundary: &[Point],
    kind: Kind,
    bounds: Bounds,
    code: Code,
) -> Result<Coded, CodeError> {
    check(boundary, bounds)?;
    let search = Search {
        boundary,
        kind,
        bounds,
        steps: code.steps,
    };
    let found = match code.closing {
        Closing::Corner => search.cheapest(Begin::Corner, code.width),
        Closing::Ring => ring::cheapest(&search, code.width),
    };
    let (vertices, bits) = found.ok_or(CodeError::Unreachable)?;
    let curve = curve(kind, &vertices, code.closing);
    let (d_max, d_ms) = distortion(boundary, &curve);
    Ok(Coded {
        vertices,
        bits,
        curve,
        d_max,
        d_ms,
    })
}

fn check(boundary: &[Point], bounds: Bounds) -> Result<(), CodeError> {
    /// Fewer points enclose nothing worth a curve.
    const FEW: usize = 8;
    /// Larger shapes take too long, and their tubes too much memory, px.
    const LARGE: f64 = 1024.0;
    if boundary.len() < FEW {
        return Err(CodeError::Short(boundary.len()));
    }
    if !(bounds.t_min > 0.0 && bounds.t_min <= bounds.t_max && bounds.t_max.is_finite()) {
        return Err(CodeError::Bounds(bounds.t_max, bounds.t_min));
    }
    let size = extent(boundary).size();
    if size.max_side() > LARGE || !boundary.iter().all(|p| p.is_finite()) {
        return Err(CodeError::Large(size.width, size.height));
    }
    Ok(())
}
