//! What a fitter gives back.

use kurbo::BezPath;

/// How a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Verdict {
    /// The tolerance is met.
    Met,
    /// The best curve found when the iterations or pieces allowed ran out; it misses the tolerance.
    Exhausted,
    /// Too few or degenerate points for the method; the points' own polygon.
    Degenerate,
}

/// Curves through one span, px, y up.
///
/// From an open span: one open path that starts and ends at the span's own ends exactly.
/// From a ring: one closed path. All coordinates are finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Lines and cubics, begun by one move.
    pub path: BezPath,
    /// How the fit ended.
    pub verdict: Verdict,
    /// Numbers that a decoder would need: what the method was free to choose.
    pub parameters: usize,
}
