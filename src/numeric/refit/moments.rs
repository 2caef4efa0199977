//! Sums over the samples of a segment, from which its block of the normal equations follows.
//!
//! A distance changes with control point i by Bᵢ(t) n: all rows of a segment are products of four functions of t and
//! the two parts of the normal with numbers that are the same for all its samples. So the products' moments are
//! summed, several samples side by side, and the numbers come in once a segment.

use super::Block;
use crate::numeric::chain::{Chain, Kind};
use crate::numeric::powers::LANES;
use kurbo::Vec2;
use std::array::from_fn;

/// One number for each sample beside another.
type Lanes = [f64; LANES];

/// What of a sample's distance goes into the sums.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Term {
    /// parameter of its foot
    pub(super) t: f64,
    /// unit normal there
    pub(super) normal: Vec2,
    /// distance along it
    pub(super) distance: f64,
    pub(super) weight: f64,
}

/// Sums over the samples of one segment. The functions of t are how it follows its start, both handles and its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moments {
    /// of two functions' products, the lower half row by row, times those of the normal: x², xy, y²
    squares: [[Lanes; 3]; 10],
    /// of each function with the distance, times x and y of the normal
    distances: [[Lanes; 2]; 4],
    kind: Kind,
}

impl Moments {
    pub(super) const fn new(kind: Kind) -> Self {
        Self {
            squares: [[[0.0; LANES]; 3]; 10],
            distances: [[[0.0; LANES]; 2]; 4],
            kind,
        }
    }

    /// Adds some samples; those that are none weigh nothing.
    pub(super) fn add(&mut self, terms: &[Term; LANES]) {
        let t = terms.map(|t| t.t);
        let s = t.map(|t| 1.0 - t);
        let functions = match self.kind {
            Kind::Line => [s, [0.0; LANES], [0.0; LANES], t],
            Kind::Cubic => {
                let b1: Lanes = from_fn(|k| 3.0 * s[k] * s[k] * t[k]);
                let b2: Lanes = from_fn(|k| 3.0 * s[k] * t[k] * t[k]);
                let start = from_fn(|k| s[k] * s[k] * s[k] + b1[k]);
                let end = from_fn(|k| t[k] * t[k] * t[k] + b2[k]);
                [start, b1, b2, end]
            }
        };
        let (x, y) = (terms.map(|t| t.normal.x), terms.map(|t| t.normal.y));
        let weight = terms.map(|t| t.weight);
        let (wx, wy) = (product(&weight, &x), product(&weight, &y));
        let normals = [product(&wx, &x), product(&wx, &y), product(&wy, &y)];
        let distance = terms.map(|t| t.distance);
        let along = [product(&wx, &distance), product(&wy, &distance)];
        let mut squares = self.squares.iter_mut();
        for (i, f) in functions.iter().enumerate() {
            for (g, sums) in functions[..=i].iter().zip(&mut squares) {
                let both = product(f, g);
                let sums = sums.iter_mut().zip(&normals);
                sums.for_each(|(sum, n)| add_product(sum, &both, n));
            }
        }
        for (f, sums) in functions.iter().zip(&mut self.distances) {
            let sums = sums.iter_mut().zip(&along);
            sums.for_each(|(sum, n)| add_product(sum, f, n));
        }
    }

    /// Adds the rows of a segment to its block.
    pub(super) fn write(&self, chain: &Chain, segment: usize, block: &mut Block) {
        let (a, b) = chain.ends(segment);
        let (a, b) = (&chain.nodes[a], &chain.nodes[b]);
        let (x, y) = (Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0));
        // which function each of the eight numbers goes with, and what it is times the normal by
        let numbers = [
            (0, x),
            (0, y),
            (1, a.ahead * a.leave.turn_90()),
            (1, a.leave),
            (2, -b.arrive),
            (2, -b.back * b.arrive.turn_90()),
            (3, x),
            (3, y),
        ];
        let total = |lanes: &Lanes| lanes.iter().sum::<f64>();
        let squares = self.squares.map(|s| s.each_ref().map(total));
        let distances = self.distances.map(|s| s.each_ref().map(total));
        for (k, (f, u)) in numbers.into_iter().enumerate() {
            let [dx, dy] = distances[f];
            block.gradient[k] += u.x * dx + u.y * dy;
            for (h, (g, v)) in block.hessian[k].iter_mut().zip(&numbers[..=k]) {
                let [xx, xy, yy] = squares[f * (f + 1) / 2 + g];
                *h += u.x * (xx * v.x + xy * v.y) + u.y * (xy * v.x + yy * v.y);
            }
        }
    }
}

fn product(a: &Lanes, b: &Lanes) -> Lanes {
    from_fn(|k| a[k] * b[k])
}

fn add_product(sum: &mut Lanes, a: &Lanes, b: &Lanes) {
    for k in 0..LANES {
        sum[k] += a[k] * b[k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::angles;
    use kurbo::{BezPath, ParamCurve as _};

    /// Moves one of the eight numbers of a chain's only segment.
    fn nudged(chain: &Chain, number: usize, by: f64) -> Chain {
        let mut chain = chain.clone();
        let turned = |d: Vec2| angles::direction(angles::heading(d) + by);
        let [a, b] = &mut chain.nodes[..] else {
            panic!("one segment")
        };
        match number {
            0 => a.point.x += by,
            1 => a.point.y += by,
            2 => a.leave = turned(a.leave),
            3 => a.ahead += by,
            4 => b.back += by,
            5 => b.arrive = turned(b.arrive),
            6 => b.point.x += by,
            _ => b.point.y += by,
        }
        chain
    }

    #[test]
    fn blocks_are_sums_of_rows() {
        for svg in ["M3 5C10 30 45 38 70 11", "M3 5L70 11"] {
            let chain = Chain::from_path(&BezPath::from_svg(svg).unwrap(), 0.01).unwrap();
            let terms: [Term; 2 * LANES] = from_fn(|k| {
                let k = k as f64;
                Term {
                    t: 0.1 + 0.11 * k,
                    normal: angles::direction(0.7 * k),
                    distance: 0.3 - 0.1 * k,
                    weight: 1.0 + 0.2 * k,
                }
            });
            let mut moments = Moments::new(chain.kinds[0]);
            terms.as_chunks().0.iter().for_each(|t| moments.add(t));
            let mut block = Block::default();
            moments.write(&chain, 0, &mut block);
            let row = |k: usize, term: &Term| {
                let at = |by: f64| nudged(&chain, k, by).cubic(0).eval(term.t);
                (at(1e-5) - at(-1e-5)).dot(term.normal) / 2e-5
            };
            for k in 0..8 {
                let sum = terms.iter().map(|t| t.weight * t.distance * row(k, t));
                let gradient: f64 = sum.sum();
                assert!((block.gradient[k] - gradient).abs() < 1e-6);
                for l in 0..=k {
                    let sum = terms.iter().map(|t| t.weight * row(k, t) * row(l, t));
                    let hessian: f64 = sum.sum();
                    assert!(
                        (block.hessian[k][l] - hessian).abs() < 1e-5,
                        "{svg} {k} {l}"
                    );
                }
            }
        }
    }
}
