//! Places along a span where quadratics may join.

use super::super::{
    Strictness,
    curve::{Curve, Gate, coarse},
};
use super::Effort;
use kurbo::{Point, Vec2};

/// What a join there has to do.
#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    Free,
    /// A quadratic must end there, on the extremum's line.
    Gate(Gate),
    /// A quadratic may end there, on the extremum's line.
    Pass(Gate),
    End,
}

/// A place along the span where quadratics may join.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stage {
    /// Sample.
    pub(super) at: usize,
    pub(super) kind: Kind,
    /// Arc between stages here, units.
    pub(super) spacing: f64,
}

impl Kind {
    /// The extremum there.
    pub(super) const fn gate(self) -> Option<Gate> {
        match self {
            Self::Gate(g) | Self::Pass(g) => Some(g),
            Self::Free | Self::End => None,
        }
    }

    /// Whether no quadratic may go on across it.
    pub(super) const fn blocks(self) -> bool {
        matches!(self, Self::Gate(_) | Self::End)
    }
}

/// Stages between the gates, closer where the curve bends.
pub(super) fn stages(curve: &Curve, effort: Effort) -> Vec<Stage> {
    /// Stages a unit of arc where the curve is straight.
    const STRAIGHT: f64 = 1.0 / 60.0;
    let (first, last) = (curve.first, curve.last);
    let straight = STRAIGHT / coarse(effort.limit);
    let dense = |i: usize| effort.grain * (curve.dots[i].k.abs() / effort.limit).sqrt() + straight;
    let mut out = vec![Stage {
        at: first,
        kind: Kind::Free,
        spacing: 1.0 / dense(first),
    }];
    let kind = match effort.keep {
        Strictness::Extrema | Strictness::Places => Kind::Gate,
        Strictness::Corners => Kind::Pass,
    };
    let gates = curve.gates.iter().map(|&g| (g.at, kind(g)));
    let mut from = first;
    for (to, kind) in gates.chain([(last, Kind::End)]) {
        let total: f64 = (from..to).map(|i| dense(i) * curve.step).sum();
        let parts = total.ceil().max(2.0);
        let (mut sum, mut next) = (0.0, total / parts);
        for i in from..to {
            sum += dense(i) * curve.step;
            if sum >= next && i > from && i + 1 < to {
                out.push(Stage {
                    at: i + 1,
                    kind: Kind::Free,
                    spacing: 1.0 / dense(i),
                });
                next += total / parts;
            }
        }
        out.push(Stage {
            at: to,
            kind,
            spacing: 1.0 / dense(to),
        });
        from = to;
    }
    out
}

pub(in super::super) fn on_gate(g: Gate, p: Point) -> Point {
    if g.horizontal {
        Point::new(p.x, f64::from(g.level))
    } else {
        Point::new(f64::from(g.level), p.y)
    }
}

pub(super) fn gate_direction(g: Gate, t: Vec2) -> Vec2 {
    if g.horizontal {
        Vec2::new(t.x.signum(), 0.0)
    } else {
        Vec2::new(0.0, t.y.signum())
    }
}
