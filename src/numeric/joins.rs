//! Joins that a fit leaves undecided: curves that turn back just before their end, corners that hardly turn, and
//! smooth nodes that turn at once.

use super::angles::angle;
use super::chain::{Chain, Join, Kind, Node};
use kurbo::common::solve_quadratic;
use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, Vec2};

/// A corner that turns less after a fit is a smooth join, radians: below, designers mean one.
const SOFT: f64 = 0.44;
/// Directions so near to an axis are on it, radians.
const LEVEL: f64 = 0.02;
/// A curve that leaves its direction within so short a handle, px, and turns more than this there, radians, has a
/// corner.
const AT_ONCE: (f64, f64) = (0.5, 1.0);
/// A direction is parallel to an axis whose other component is less.
const ON_AXIS: f64 = 1e-6;
/// A curve that turns back so near to its corner is meant to end where it is level: chords, and px.
const BESIDE: (f64, f64) = (0.25, 6.0);
/// A node at an extremum is so far from the next at least, px.
const APART_PX: f64 = 2.0;
/// A curve that turns back by no more may yet end level, px.
pub const DEPTH_PX: f64 = 0.3;

/// Parameters inside a cubic where it turns back in y (`Horizontal`) or x (`Vertical`).
pub fn inner_extrema(c: &CubicBez) -> impl Iterator<Item = (f64, Join)> + use<> {
    let d = [
        3.0 * (c.p1 - c.p0),
        3.0 * (c.p2 - c.p1),
        3.0 * (c.p3 - c.p2),
    ];
    let axes = [
        (Join::Horizontal, d.map(|v| v.y)),
        (Join::Vertical, d.map(|v| v.x)),
    ];
    axes.into_iter().flat_map(|(join, [a, b, c])| {
        // a (1−t)² + 2 b t (1−t) + c t²
        let (q2, q1, q0) = (a - 2.0 * b + c, 2.0 * (b - a), a);
        let roots = solve_quadratic(q0, q1, q2);
        let size = a.abs().max(b.abs()).max(c.abs());
        roots.into_iter().filter_map(move |t| {
            let inside = t > 1e-3 && t < 1.0 - 1e-3;
            // It must turn back, not only touch, and not by rounding alone.
            let turns = (2.0 * q2 * t + q1).abs() > 1e-6 * size;
            (inside && turns).then_some((t, join))
        })
    })
}

/// Puts a node on a cubic, which stays as it is; at an extremum the node takes its axis.
pub fn divide(chain: &mut Chain, segment: usize, t: f64, join: Join) {
    let c = chain.cubic(segment);
    let (l, r) = (c.subsegment(0.0..t), c.subsegment(t..1.0));
    let (a, b) = chain.ends(segment);
    chain.nodes[a].ahead = (l.p1 - l.p0).hypot();
    chain.nodes[b].back = (r.p3 - r.p2).hypot();
    let d = c.deriv().eval(t).to_vec2();
    let along = match join {
        Join::Horizontal => Vec2::new(1f64.copysign(d.x), 0.0),
        Join::Vertical => Vec2::new(0.0, 1f64.copysign(d.y)),
        _ => d / d.hypot().max(1e-12),
    };
    let node = Node {
        point: l.p3,
        join,
        arrive: along,
        leave: along,
        back: (l.p3 - l.p2).hypot(),
        ahead: (r.p1 - r.p0).hypot(),
    };
    chain.nodes.insert(segment + 1, node);
    chain.kinds.insert(segment, Kind::Cubic);
}

/// Puts nodes on cubics where they turn back by more than `depth_px`: drawings have nodes there.
pub fn divide_at_extrema(chain: &mut Chain, depth_px: f64) {
    let mut i = 0;
    while i < chain.kinds.len() {
        let c = chain.cubic(i);
        let apart = |(t, join): &(f64, Join)| {
            let at = c.eval(*t);
            [c.p0, c.p3].into_iter().all(|end| {
                let off = end - at;
                let depth = if *join == Join::Horizontal {
                    off.y
                } else {
                    off.x
                };
                off.hypot() > APART_PX && depth.abs() > depth_px
            })
        };
        let cubic = chain.kinds[i] == Kind::Cubic;
        match inner_extrema(&c).filter(|_| cubic).find(apart) {
            // what is left of either half may turn back once more
            Some((t, join)) => divide(chain, i, t, join),
            None => i += 1,
        }
    }
}

/// Turns curves that pass an extremum just before a corner so that they end in it: nothing was measured there.
pub fn level_ends(chain: &mut Chain) {
    for i in 0..chain.kinds.len() {
        if chain.kinds[i] == Kind::Cubic {
            level_end(chain, i);
        }
    }
}

fn level_end(chain: &mut Chain, i: usize) {
    let c = chain.cubic(i);
    let (a, b) = chain.ends(i);
    for (t, join) in inner_extrema(&c) {
        let at = c.eval(t);
        let (node, end) = if t > 0.5 { (b, c.p3) } else { (a, c.p0) };
        let off = end - at;
        let (depth, along) = match join {
            Join::Horizontal => (off.y.abs(), Vec2::new(1.0, 0.0)),
            _ => (off.x.abs(), Vec2::new(0.0, 1.0)),
        };
        let near = (BESIDE.0 * c.p0.distance(c.p3)).min(BESIDE.1);
        let node = &mut chain.nodes[node];
        if node.join != Join::Corner || depth > DEPTH_PX || off.hypot() > near {
            continue;
        }
        if t > 0.5 {
            node.arrive = along * 1f64.copysign(node.arrive.dot(along));
        } else {
            node.leave = along * 1f64.copysign(node.leave.dot(along));
        }
    }
}

/// By how much the handles of a cubic, its first and its last, pass the level of an extremum that it ends in on the
/// other side: it would turn back once more. As parts of the handles.
#[must_use]
pub fn past_levels(chain: &Chain, segment: usize) -> [f64; 2] {
    let (a, b) = chain.ends(segment);
    let (a, b) = (&chain.nodes[a], &chain.nodes[b]);
    let chord = b.point - a.point;
    // the way of a handle across an axis that the other end runs along, by what is there to go
    let past = |handle: Vec2, along: Vec2| {
        let axes = [(along.x, handle.x, chord.x), (along.y, handle.y, chord.y)];
        let over = |(along, handle, whole): (f64, f64, f64)| {
            let over = handle - whole;
            let passes = f64::abs(along) < ON_AXIS && over * whole > 0.0;
            if passes { over / handle } else { 0.0 }
        };
        axes.into_iter().map(over).fold(0.0, f64::max)
    };
    [
        past(a.ahead * a.leave, b.arrive),
        past(b.back * b.arrive, a.leave),
    ]
}

/// Shortens handles that pass the level of an extremum at the other end of their cubic.
pub fn keep_levels(chain: &mut Chain) {
    for i in 0..chain.kinds.len() {
        if chain.kinds[i] == Kind::Cubic {
            let [first, last] = past_levels(chain, i);
            let (a, b) = chain.ends(i);
            chain.nodes[a].ahead *= 1.0 - first;
            chain.nodes[b].back *= 1.0 - last;
        }
    }
}

/// Whether a corner of which one side at least is curved turns too little to be one: the blur hid a smooth join.
#[must_use]
pub fn is_soft(chain: &Chain, i: usize) -> bool {
    let curved = |s| chain.kind(s) == Some(Kind::Cubic);
    let direction = |s: Option<usize>, own: Vec2| match s {
        Some(s) if chain.kinds[s] == Kind::Line => chain.direction(s),
        _ => own,
    };
    let (before, after) = (chain.before(i), chain.after(i));
    let node = &chain.nodes[i];
    let (u, v) = (direction(before, node.arrive), direction(after, node.leave));
    node.join == Join::Corner && (curved(before) || curved(after)) && angle(u, v).abs() < SOFT
}

/// Makes a corner smooth that turns too little to be one; whether it is such.
pub fn soften_if_soft(chain: &mut Chain, i: usize) -> bool {
    let soft = is_soft(chain, i);
    if soft {
        soften(&mut chain.nodes[i]);
    }
    soft
}

/// Makes a corner smooth, level or upright if it is so already but for a little.
pub fn soften(node: &mut Node) {
    let along = node.arrive + node.leave;
    let along = along / along.hypot().max(1e-12);
    node.join = if along.y.abs() < LEVEL {
        Join::Horizontal
    } else if along.x.abs() < LEVEL {
        Join::Vertical
    } else {
        Join::Smooth
    };
    (node.arrive, node.leave) = (along, along);
}

/// Makes a smooth node a corner where a curve beside it turns away at once.
pub fn sharpen(chain: &mut Chain, i: usize) {
    if chain.nodes[i].join.is_smooth() {
        aim(chain, i, AT_ONCE.0);
    }
}

/// Makes a node the corner that it is where a curve beside it turns away within a handle shorter than `hidden_px`, and
/// has that curve leave it as it goes on.
pub fn aim(chain: &mut Chain, i: usize, hidden_px: f64) {
    let curve = |s: Option<usize>| s.filter(|s| chain.kinds[*s] == Kind::Cubic);
    let (before, after) = (curve(chain.before(i)), curve(chain.after(i)));
    let node = chain.nodes[i];
    let turns = |along: Vec2, handle: f64, on: Vec2| {
        let turn = angle(along, on).abs();
        (handle < hidden_px && turn > AT_ONCE.1).then(|| on / on.hypot())
    };
    let (p, third) = (node.point, |c: CubicBez| c.p0.distance(c.p3) / 3.0);
    let leaving = after.map(|s| chain.cubic(s));
    let arriving = before.map(|s| chain.cubic(s));
    let leave = leaving.and_then(|c| Some((turns(node.leave, node.ahead, c.p2 - p)?, third(c))));
    let arrive = arriving.and_then(|c| Some((turns(node.arrive, node.back, p - c.p1)?, third(c))));
    let node = &mut chain.nodes[i];
    if let Some((along, handle)) = leave {
        (node.leave, node.ahead, node.join) = (along, handle, Join::Corner);
    }
    if let Some((along, handle)) = arrive {
        (node.arrive, node.back, node.join) = (along, handle, Join::Corner);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Point;

    #[test]
    fn an_arch_turns_back_at_its_top() {
        let c = CubicBez::new((0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0));
        let found: Vec<(f64, Join)> = inner_extrema(&c).collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].0 - 0.5).abs() < 1e-12 && found[0].1 == Join::Horizontal);
    }

    #[test]
    fn a_wave_gets_nodes_where_it_turns_and_stays_as_it_is() {
        let path = kurbo::BezPath::from_svg("M0 0C30 40 60 -40 90 0L90 -90Z").unwrap();
        let mut chain = Chain::from_path(&path, 0.001).unwrap();
        let before = chain.cubic(0);
        divide_at_extrema(&mut chain, DEPTH_PX);
        assert_eq!(
            chain.kinds[..4],
            [Kind::Cubic, Kind::Cubic, Kind::Cubic, Kind::Line]
        );
        assert_eq!([1, 2].map(|i| chain.nodes[i].join), [Join::Horizontal; 2]);
        for (i, range) in inner_extrema(&before).map(|(t, _)| t).enumerate() {
            assert!(chain.nodes[i + 1].point.distance(before.eval(range)) < 1e-9);
        }
        let once = chain.clone();
        divide_at_extrema(&mut chain, DEPTH_PX);
        assert_eq!(chain, once);
    }

    #[test]
    fn a_curve_ends_level_where_it_all_but_did() {
        let path = kurbo::BezPath::from_svg("M0 0C0 30 20 50.1 50 50L50 0Z").unwrap();
        let mut chain = Chain::from_path(&path, 0.001).unwrap();
        level_ends(&mut chain);
        let end = chain.cubic(0);
        assert!((end.p2.y - end.p3.y).abs() < 1e-12);
        assert_eq!(end.p3, Point::new(50.0, 50.0));
    }

    #[test]
    fn a_handle_ends_at_the_level_of_the_extremum_beyond() {
        let path = kurbo::BezPath::from_svg("M0 0C0 20 -4 40 16 60L90 -10Z").unwrap();
        let mut chain = Chain::from_path(&path, 0.001).unwrap();
        let [first, last] = past_levels(&chain, 0);
        assert!(first <= 0.0 && (last - 0.2).abs() < 1e-9, "{first} {last}");
        keep_levels(&mut chain);
        let c = chain.cubic(0);
        assert!(
            c.p2.x.abs() < 1e-9 && c.p1 == Point::new(0.0, 20.0),
            "{c:?}"
        );
        assert_eq!(inner_extrema(&c).count(), 0);
        let within = chain.clone();
        keep_levels(&mut chain);
        assert_eq!(chain, within);
    }

    #[test]
    fn a_node_that_turns_at_once_is_a_corner() {
        let path = kurbo::BezPath::from_svg("M0 0L0 99.9C0 100 30 100 90 100L90 0Z").unwrap();
        let mut chain = Chain::from_path(&path, 0.001).unwrap();
        assert_eq!(chain.nodes[1].join, Join::Vertical);
        sharpen(&mut chain, 1);
        assert_eq!(chain.nodes[1].join, Join::Corner);
        assert!(chain.nodes[1].leave.y.abs() < 0.01 && chain.nodes[1].ahead > 29.0);
        let round = kurbo::BezPath::from_svg("M0 0L0 90C0 96 4 100 10 100L90 0Z").unwrap();
        let mut chain = Chain::from_path(&round, 0.001).unwrap();
        let before = chain.clone();
        (0..chain.nodes.len()).for_each(|i| sharpen(&mut chain, i));
        assert_eq!(chain, before);
    }

    #[test]
    fn a_corner_with_a_hidden_handle_turns_as_its_curve_goes_on() {
        let path = kurbo::BezPath::from_svg("M0 0L40 0C40.6 0 76 70 80 80L0 90Z").unwrap();
        let mut chain = Chain::from_path(&path, 0.001).unwrap();
        chain.nodes[1].join = Join::Corner;
        assert!(is_soft(&chain, 1));
        aim(&mut chain, 1, 1.0);
        assert!(!is_soft(&chain, 1) && chain.nodes[1].ahead > 25.0);
        let before = chain.clone();
        aim(&mut chain, 1, 1.0);
        assert_eq!(chain, before);
    }
}
