//! A smooth run of quadratics as few cubics, by kurbo's fit of one cubic, in bounded time.
//!
//! That fit measures the length of a cubic that it tries where the given run bends much between two samples, and
//! looks for places along it in steps of 10⁻⁹ units. On a cubic longer than some 10⁷ units such steps are finer than
//! numbers are, and the search never ends. One that long comes so far only where it was near all samples before its
//! length is asked for, and what of it is near them is straight: through one of the run's ends, along one of the
//! tangents there. So a range that bends and whose samples lie on such lines is not asked, but halved.

use kurbo::simplify::SimplifyBezPath;
use kurbo::{BezPath, CubicBez, ParamCurveFit, Point, QuadBez, Vec2, fit_to_cubic};
use std::ops::Range;

/// Inner samples of a range that the library looks at.
const SAMPLES: u8 = 20;
/// Tangent of the angle between two neighbouring samples above which the library measures lengths.
const BEND: f64 = 0.2;
/// Sine of the angle below which both ends point along one line: a long cubic can then come back in between, along a
/// third line.
const PARALLEL: f64 = 1e-3;
/// How near to a line a sample counts as on it, in tolerances: one is what the library allows, the other what a long
/// cubic bends.
const NEAR: f64 = 2.0;
/// Coordinates that no font holds (16 bits), units: the run's own length is then not too long either.
const LARGEST: f64 = 65_536.0;

/// The cubics, within `tolerance` of the run. They are never more than its quadratics, which are the answer
/// themselves where no fewer will do.
pub(super) fn fit(run: &[QuadBez], tolerance: f64) -> Vec<CubicBez> {
    let exact = || run.iter().map(QuadBez::raise).collect();
    let small = |p: Point| p.x.abs().max(p.y.abs()) <= LARGEST;
    if run.len() < 2
        || !run
            .iter()
            .all(|q| [q.p0, q.p1, q.p2].into_iter().all(small))
    {
        return exact();
    }
    let path = BezPath::from_path_segments(run.iter().map(|&q| q.into()));
    let mut cubics = Vec::new();
    halve(
        &SimplifyBezPath::new(&path),
        0.0..1.0,
        tolerance,
        &mut cubics,
    );
    if cubics.len() > run.len() {
        exact()
    } else {
        cubics
    }
}

/// One cubic for the range, or those of its halves, as kurbo's `fit_to_bezpath` does.
fn halve(run: &SimplifyBezPath, range: Range<f64>, tolerance: f64, out: &mut Vec<CubicBez>) {
    if !endless(run, &range, tolerance)
        && let Some((cubic, _)) = fit_to_cubic(run, range.clone(), tolerance)
    {
        out.push(cubic);
        return;
    }
    let middle = 0.5 * (range.start + range.end);
    if middle <= range.start || middle >= range.end {
        let (a, b) = (point(run, range.start), point(run, range.end));
        out.push(CubicBez::new(
            a,
            a.lerp(b, 1.0 / 3.0),
            b.lerp(a, 1.0 / 3.0),
            b,
        ));
        return;
    }
    halve(run, range.start..middle, tolerance, out);
    halve(run, middle..range.end, tolerance, out);
}

fn point(run: &SimplifyBezPath, t: f64) -> Point {
    run.sample_pt_deriv(t).0
}

/// Whether a search along a cubic of this range may not end.
fn endless(run: &SimplifyBezPath, range: &Range<f64>, tolerance: f64) -> bool {
    let step = (range.end - range.start) / f64::from(SAMPLES + 1);
    let at = |t: f64| {
        let sample = run.sample_pt_tangent(t, 1.0);
        (sample.p, sample.tangent)
    };
    let samples = (0..=SAMPLES + 1).map(|i| at(range.start + f64::from(i) * step));
    let samples: Vec<(Point, Vec2)> = samples.collect();
    let bends = |w: &[(Point, Vec2)]| w[1].1.cross(w[0].1).abs() > BEND * w[1].1.dot(w[0].1).abs();
    let (start, end) = (samples[0], at(range.end));
    let short = start.0.distance(end.0) <= tolerance;
    if short || !samples.windows(2).any(bends) {
        return false;
    }
    if start.1.hypot().min(end.1.hypot()) <= 0.0 {
        return true;
    }
    let along = [start.1, end.1].map(|v| v / v.hypot());
    let off = |from: Point, to: Point, d: Vec2| d.cross(to - from);
    let near = |p: Point| {
        let least = |d: &Vec2| off(start.0, p, *d).abs().min(off(end.0, p, *d).abs());
        along.iter().any(|d| least(d) <= NEAR * tolerance)
    };
    let others = samples.iter().filter(|s| !near(s.0));
    let others: Vec<f64> = others.map(|s| off(start.0, s.0, along[0])).collect();
    let least = others.iter().copied().fold(f64::INFINITY, f64::min);
    let most = others.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let parallel = along[0].cross(along[1]).abs() < PARALLEL;
    let one_line = parallel && most - least <= 2.0 * NEAR * tolerance;
    others.is_empty() || one_line
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadratic::merge;
    use crate::types::Outline;
    use kurbo::{Affine, ParamCurve, ParamCurveNearest, PathSeg};
    use std::sync::mpsc;
    use std::thread;
    use std::time::Duration;

    /// Runs on which the library's search does not end, each at the tolerance, units.
    const ENDLESS: [(f64, &str); 3] = [
        // what a clip path left: the control point is the start but for a rounding
        (
            0.5,
            "M596 846Q596.0000000000001 846 592.9236046781629 831.1625949300378Q591.6772333616556 825.1514100465537 \
             589.9259106482115 816.7048704947131Q588.5326051109258 809.985004554125 586.8196960565045 801.7237015548161",
        ),
        (
            1.0,
            "M687.9051210305246 569.5195857070364Q550.9719506389367 577.57667398805 549.1492859549677 576.3082928234836\
             Q549.0373607233942 576.2162415265383 545.7952986329653 578.3659627474326Q396.2954718595614 694.1776548032926 \
             388.83193567386076 694.614495234857Q317.91222303348474 697.9806902037905 317.0150401328063 698.0235634440776",
        ),
        (
            2.0,
            "M625.881594285945 11.380195874719611Q625.7926816343443 11.393519083795644 625.7839099730298 11.372538800113022\
             Q625.2787287962607 9.960145879912027 623.854804982555 9.48844390285676Q623.8383136891385 9.481647780705732 \
             623.8033901502637 9.507784800137863",
        ),
    ];

    /// The farthest that a sample of the first lies from the second.
    fn apart(a: &BezPath, b: &BezPath) -> f64 {
        let pieces: Vec<PathSeg> = b.segments().collect();
        let near = |p: Point| {
            let all = pieces.iter().map(|s| s.nearest(p, 1e-6).distance_sq.sqrt());
            all.fold(f64::INFINITY, f64::min)
        };
        let samples = a
            .segments()
            .flat_map(|s| (0..=16).map(move |i| s.eval(f64::from(i) / 16.0)));
        samples.map(near).fold(0.0, f64::max)
    }

    #[test]
    fn every_run_ends() {
        for (tolerance, svg) in ENDLESS {
            let path = BezPath::from_svg(&format!("{svg}Z")).unwrap();
            let outline = Outline::new(vec![path.clone()]).unwrap();
            let (tx, rx) = mpsc::channel();
            thread::spawn(move || tx.send(merge::merge(&outline, tolerance)));
            let merged = rx.recv_timeout(Duration::from_secs(60));
            let merged = merged.unwrap_or_else(|e| panic!("{e} on {svg}")).to_path();
            let (there, back) = (apart(&path, &merged), apart(&merged, &path));
            assert!(
                there.max(back) <= 1.2 * tolerance,
                "{there} {back} on {svg}"
            );
        }
    }

    #[test]
    fn what_no_fewer_hold_stays_as_it_is() {
        let quad = |a, b, c| QuadBez::new(a, b, c);
        let wave = [
            quad((0.0, 0.0), (10.0, 50.0), (20.0, 0.0)),
            quad((20.0, 0.0), (30.0, -50.0), (40.0, 0.0)),
        ];
        assert_eq!(fit(&wave, 1e-4), wave.map(|q| q.raise()));
        let far = wave.map(|q| Affine::scale(1e6) * q);
        assert_eq!(fit(&far, 1e9), far.map(|q| q.raise()));
    }
}
