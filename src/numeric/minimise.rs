//! Minimisation by the secant method: BFGS of limited memory with a line search.
//!
//! Own code, 100 lines, and no library: the objective carries a state (the foot points of a curve) that
//! must start every trial step from the last accepted one, and value and gradient come from one pass
//! over the data; the libraries looked at ask for the two apart, through a shared reference.

use std::collections::VecDeque;

/// What is minimised.
pub trait Objective {
    /// The value at `x`; writes the gradient there. Not finite means: not here.
    fn value(&mut self, x: &[f64], gradient: &mut [f64]) -> f64;
    /// The point valued last becomes the one that further trials start from.
    fn accept(&mut self);
}

/// Where to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Steps at most.
    pub steps: usize,
    /// Two steps in a row that lower the value by less than this part of it end the search.
    pub progress: f64,
}

/// Evaluations of one line search at most: each halves or doubles the step.
const TRIALS: usize = 20;
/// Part of the slope's promise that a step must keep (Armijo).
const KEPT: f64 = 1e-4;
/// Steps that are remembered: as good as all of them up to some hundred variables, linear beyond.
const MEMORY: usize = 60;
/// Part of the slope that may be left after a step (Wolfe).
const LEFT: f64 = 0.9;

/// Lowers the objective from `x` on, which becomes the best point found: its value at the start and after every
/// step, which never rises. `width` is the size of the inverse second derivative to begin with.
pub fn bfgs(f: &mut impl Objective, x: &mut Vec<f64>, width: f64, limits: Limits) -> Vec<f64> {
    let n = x.len();
    let mut gradient = vec![0.0; n];
    let mut value = f.value(x, &mut gradient);
    f.accept();
    let mut inverse = Inverse::new(width);
    let mut values = vec![value];
    let mut slow = 0;
    for _ in 0..limits.steps {
        let Some(step) = line_search(f, x, (value, &gradient), &inverse.direction(&gradient))
        else {
            break;
        };
        f.accept();
        inverse.learn(x, &step.x, &gradient, &step.gradient);
        let small = value - step.value <= limits.progress * value.abs();
        slow = if small { slow + 1 } else { 0 };
        (value, *x, gradient) = (step.value, step.x, step.gradient);
        values.push(value);
        if slow >= 2 {
            break;
        }
    }
    values
}

struct Step {
    x: Vec<f64>,
    gradient: Vec<f64>,
    value: f64,
}

/// A step down along `direction` that keeps the weak Wolfe conditions where halving and doubling find one,
/// else the last that lowers the value; `None` when none does. The step returned was valued last.
fn line_search(
    f: &mut impl Objective,
    x: &[f64],
    (value, gradient): (f64, &[f64]),
    direction: &[f64],
) -> Option<Step> {
    let slope = dot(gradient, direction);
    if slope >= 0.0 || !slope.is_finite() {
        return None;
    }
    let (mut low, mut high) = (0.0, f64::INFINITY);
    let mut length = 1.0;
    let mut best: Option<(f64, Step)> = None;
    let mut valued = f64::NAN;
    for _ in 0..TRIALS {
        let step = at(f, x, direction, length);
        valued = length;
        if step.value <= value + KEPT * length * slope && step.value < value {
            let flat = dot(&step.gradient, direction) >= LEFT * slope;
            best = Some((length, step));
            if flat {
                break;
            }
            low = length;
        } else {
            high = length;
            if best.is_some() && high - low < 1e-3 * high {
                break;
            }
        }
        length = if high.is_finite() {
            low.midpoint(high)
        } else {
            2.0 * low
        };
    }
    let (length, step) = best?;
    if (length - valued).abs() > 0.0 {
        return Some(at(f, x, direction, length));
    }
    Some(step)
}

fn at(f: &mut impl Objective, x: &[f64], direction: &[f64], length: f64) -> Step {
    let x: Vec<f64> = x
        .iter()
        .zip(direction)
        .map(|(a, d)| a + length * d)
        .collect();
    let mut gradient = vec![0.0; x.len()];
    let value = f.value(&x, &mut gradient);
    let finite = value.is_finite() && gradient.iter().all(|g| g.is_finite());
    Step {
        value: if finite { value } else { f64::INFINITY },
        x,
        gradient,
    }
}

/// The inverse of the second derivative as far as the last steps tell: their changes of x and of the
/// gradient, newest last, over a multiple of the identity (limited memory, two-loop recursion).
struct Inverse {
    width: f64,
    pairs: VecDeque<Pair>,
}

struct Pair {
    s: Vec<f64>,
    y: Vec<f64>,
    sy: f64,
}

impl Inverse {
    const fn new(width: f64) -> Self {
        Self {
            width,
            pairs: VecDeque::new(),
        }
    }

    fn direction(&self, gradient: &[f64]) -> Vec<f64> {
        let mut d: Vec<f64> = gradient.iter().map(|g| -g).collect();
        let mut parts = Vec::with_capacity(self.pairs.len());
        for pair in self.pairs.iter().rev() {
            let part = dot(&pair.s, &d) / pair.sy;
            add(&mut d, -part, &pair.y);
            parts.push(part);
        }
        d.iter_mut().for_each(|v| *v *= self.width);
        for (pair, part) in self.pairs.iter().zip(parts.iter().rev()) {
            let rest = part - dot(&pair.y, &d) / pair.sy;
            add(&mut d, rest, &pair.s);
        }
        d
    }

    /// A step of x and of the gradient; left out where the curvature is not positive.
    fn learn(&mut self, x0: &[f64], x1: &[f64], g0: &[f64], g1: &[f64]) {
        let s: Vec<f64> = x1.iter().zip(x0).map(|(a, b)| a - b).collect();
        let y: Vec<f64> = g1.iter().zip(g0).map(|(a, b)| a - b).collect();
        let sy = dot(&s, &y);
        if sy <= 1e-14 * (dot(&s, &s) * dot(&y, &y)).sqrt() {
            return;
        }
        if self.pairs.len() == MEMORY {
            self.pairs.pop_front();
        }
        self.pairs.push_back(Pair { s, y, sy });
    }
}

/// Adds `factor` times `b` to `a`.
fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += factor * b);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley in pairs of variables.
    struct Valley;

    impl Objective for Valley {
        fn value(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
            let mut sum = 0.0;
            for (p, g) in x.chunks(2).zip(gradient.chunks_mut(2)) {
                let (a, b) = (1.0 - p[0], p[1] - p[0] * p[0]);
                g[0] = -2.0 * a - 400.0 * p[0] * b;
                g[1] = 200.0 * b;
                sum += a * a + 100.0 * b * b;
            }
            sum
        }
        fn accept(&mut self) {}
    }

    #[test]
    fn the_valley_is_followed_to_its_end() {
        let mut x = vec![-1.2, 1.0, 0.0, 0.0, -3.0, 2.0];
        let limits = Limits {
            steps: 300,
            progress: 1e-12,
        };
        let values = bfgs(&mut Valley, &mut x, 1.0, limits);
        assert!(values.len() < limits.steps);
        assert!(x.iter().all(|v| (v - 1.0).abs() < 1e-6), "{x:?}");
        assert!(values.windows(2).all(|w| w[1] < w[0]), "never up");
        let few = Limits { steps: 3, ..limits };
        let values = bfgs(&mut Valley, &mut vec![-1.2, 1.0], 1.0, few);
        assert_eq!(values.len(), 4);
    }
}
