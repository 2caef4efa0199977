//! Ink as strokes: a graph of lines, junctions and dots with the pen's half width along them.
//!
//! The thinned picture is cut at its junctions; what the border's roughness sprouted is pruned by the
//! ink's own half width there, and a compact spot of ink is a dot, never a stroke and never lost.

use super::thin::{Field, thin};
use crate::types::{Bitmap, PenDot};
use image::{GrayImage, Luma};
use imageproc::distance_transform::euclidean_squared_distance_transform;
use kurbo::Point;
use std::collections::BTreeMap;

/// Ink whose area is below this multiple of its largest inscribed disc is a dot: a disc has 1, a square
/// 1.27, a triangle 1.65, a dash twice as long as wide 2.27.
const DOT_AREA: f64 = 1.8;

/// How far spurs are cut: the multiple of the half width at its junction that a branch, measured to the
/// border of the ink, must reach to stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pruning {
    /// Half widths, from the junction's centre. A branch of pure roughness reaches 1.
    pub half_widths: f64,
}

impl Default for Pruning {
    fn default() -> Self {
        Self { half_widths: 1.6 }
    }
}

/// A line of ink.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// Centres of the thinned pixels from end to end, px, y down; for a closed one the first is not repeated.
    pub points: Vec<Point>,
    /// The half width of the ink at each point, px.
    pub half_widths: Vec<f64>,
    /// The junctions it starts and ends at, indices into [`Skeleton::junctions`]; `None` at a free end.
    pub joins: [Option<usize>; 2],
    /// Whether it is a ring without a junction.
    pub closed: bool,
}

/// Strokes, the places where they meet, and dots; px, y down.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Skeleton {
    /// Lines in reading order of their first pixel.
    pub strokes: Vec<Stroke>,
    /// Where at least three line ends meet.
    pub junctions: Vec<Point>,
    /// Compact spots.
    pub dots: Vec<PenDot>,
}

impl Skeleton {
    /// The skeleton of the ink.
    #[must_use]
    pub fn new(ink: &Bitmap, pruning: Pruning) -> Self {
        let radii = half_widths(ink);
        let (dots, lines) = split_dots(ink, &radii);
        let mut graph = Graph::new(&thin(&lines), &radii);
        graph.prune(pruning);
        let mut out = graph.strokes();
        out.dots.extend(dots);
        out
    }
}

/// The distance from each ink pixel's centre to the border of the ink, px; 0 on paper. Row-major.
fn half_widths(ink: &Bitmap) -> Vec<f64> {
    // A margin of paper, so that ink touching the picture's edge has a border there.
    let (w, h) = (ink.width() + 2, ink.height() + 2);
    let (Ok(w32), Ok(h32)) = (u32::try_from(w), u32::try_from(h)) else {
        return vec![1.0; ink.bits().len()];
    };
    let paper = GrayImage::from_fn(w32, h32, |x, y| {
        let inside = x > 0 && y > 0 && ink.at(x as usize - 1, y as usize - 1);
        Luma([if inside { 0 } else { 255 }])
    });
    let squared = euclidean_squared_distance_transform(&paper).into_raw();
    let rows = (1..h - 1).flat_map(|y| &squared[y * w + 1..(y + 1) * w - 1]);
    rows.map(|d| (d.sqrt() - 0.5).max(0.0)).collect()
}

/// Labels the 8-connected parts of the ink: row-major part numbers from 0 in reading order, paper `None`,
/// and how many there are.
pub(crate) fn parts(ink: &Bitmap) -> (Vec<Option<usize>>, usize) {
    let field = Field::new(ink);
    let mut label: Vec<Option<usize>> = vec![None; field.ink.len()];
    let mut count = 0;
    for start in 0..field.ink.len() {
        if !field.ink[start] || label[start].is_some() {
            continue;
        }
        label[start] = Some(count);
        let mut stack = vec![start];
        while let Some(i) = stack.pop() {
            for n in field.around(i) {
                if field.ink[n] && label[n].is_none() {
                    label[n] = Some(count);
                    stack.push(n);
                }
            }
        }
        count += 1;
    }
    let rows = (1..=ink.height()).flat_map(|y| {
        let row = y * field.stride + 1;
        label[row..row + ink.width()].iter().copied()
    });
    (rows.collect(), count)
}

/// Takes the compact parts out of the ink.
fn split_dots(ink: &Bitmap, radii: &[f64]) -> (Vec<PenDot>, Bitmap) {
    let (label, count) = parts(ink);
    let mut sums = vec![(0.0, 0.0, 0.0, 0.0_f64); count]; // area, moments, largest radius
    for (i, part) in label.iter().enumerate() {
        if let Some(part) = *part {
            let s = &mut sums[part];
            s.0 += 1.0;
            s.1 += (i % ink.width()) as f64 + 0.5;
            s.2 += (i / ink.width()) as f64 + 0.5;
            s.3 = s.3.max(radii[i]);
        }
    }
    // Half a pixel of border is added back: the disc inscribed in the pixels' squares, not their centres.
    let compact =
        |s: &(f64, f64, f64, f64)| s.0 <= DOT_AREA * std::f64::consts::PI * (s.3 + 0.25).powi(2);
    let dots = sums.iter().filter(|s| compact(s)).map(|s| PenDot {
        centre: Point::new(s.1 / s.0, s.2 / s.0),
        radius: (s.0 / std::f64::consts::PI).sqrt(),
    });
    let dots = dots.collect();
    let bits = label.iter().map(|p| p.is_some_and(|p| !compact(&sums[p])));
    (dots, ink.with_bits(bits))
}

/// A line between two nodes, its inner pixels in order.
#[derive(Debug, Clone)]
struct Edge {
    ends: [usize; 2],
    path: Vec<(Point, f64)>,
}

impl Edge {
    /// Length from node to node, px.
    fn length(&self, nodes: &[(Point, f64)]) -> f64 {
        let inner = self.path.iter().map(|p| p.0);
        let mut way = std::iter::once(nodes[self.ends[0]].0)
            .chain(inner)
            .chain([nodes[self.ends[1]].0]);
        let mut last = way.next().unwrap_or_default();
        way.map(|p| std::mem::replace(&mut last, p).distance(p))
            .sum()
    }

    fn reversed(mut self) -> Self {
        self.ends.reverse();
        self.path.reverse();
        self
    }
}

/// The thinned picture cut at its junctions and ends.
#[derive(Debug, Default)]
struct Graph {
    /// Place and half width of each end or junction.
    nodes: Vec<(Point, f64)>,
    edges: Vec<Edge>,
    rings: Vec<Vec<(Point, f64)>>,
    /// Nodes that no line ends at.
    alone: Vec<(Point, f64)>,
}

impl Graph {
    fn new(thinned: &Bitmap, radii: &[f64]) -> Self {
        Tracer::new(thinned, radii).run()
    }

    fn degree(&self, node: usize) -> usize {
        let ends = self.edges.iter().flat_map(|e| e.ends);
        ends.filter(|&n| n == node).count()
    }

    /// Cuts the shortest spur, joins what it left in two halves, and again until none is left.
    fn prune(&mut self, pruning: Pruning) {
        self.join_throughs();
        while let Some(spur) = self.shortest_spur(pruning) {
            self.edges.remove(spur);
            self.join_throughs();
        }
    }

    /// The shortest branch with one free end that does not reach out of its junction's disc far enough,
    /// px of reach per px of half width.
    fn shortest_spur(&self, pruning: Pruning) -> Option<usize> {
        let reach = |e: &Edge| {
            let free = e.ends.map(|n| self.degree(n) == 1);
            let (tip, foot) = match free {
                [true, false] => (e.ends[0], e.ends[1]),
                [false, true] => (e.ends[1], e.ends[0]),
                _ => return None,
            };
            let length = e.length(&self.nodes) + self.nodes[tip].1;
            Some(length / self.nodes[foot].1.max(0.5))
        };
        let spurs = self.edges.iter().enumerate();
        let spurs = spurs.filter_map(|(i, e)| Some((i, reach(e)?)));
        let short = spurs.filter(|(_, r)| *r < pruning.half_widths);
        short.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    }

    /// A node where only two line ends meet is no junction.
    fn join_throughs(&mut self) {
        for node in 0..self.nodes.len() {
            let touching = |e: &Edge| e.ends.contains(&node);
            let mut at = (0..self.edges.len()).filter(|&i| touching(&self.edges[i]));
            match (at.next(), at.next(), at.next()) {
                (Some(i), Some(j), None) => {
                    let (second, first) = (self.edges.remove(j), self.edges.remove(i));
                    if second.ends[0] == second.ends[1] || first.ends[0] == first.ends[1] {
                        self.edges.extend([first, second]); // a ring with a tail stays
                        continue;
                    }
                    let first = if first.ends[1] == node {
                        first
                    } else {
                        first.reversed()
                    };
                    let second = if second.ends[0] == node {
                        second
                    } else {
                        second.reversed()
                    };
                    let mut path = first.path;
                    path.push(self.nodes[node]);
                    path.extend(second.path);
                    let ends = [first.ends[0], second.ends[1]];
                    self.edges.insert(i, Edge { ends, path });
                }
                (Some(i), None, None) if self.edges[i].ends == [node, node] => {
                    let edge = self.edges.remove(i);
                    let mut ring = vec![self.nodes[node]];
                    ring.extend(edge.path);
                    self.rings.push(ring);
                }
                _ => {}
            }
        }
    }

    fn strokes(self) -> Skeleton {
        let mut number = BTreeMap::new();
        let mut junctions = Vec::new();
        for (node, &(at, _)) in self.nodes.iter().enumerate() {
            if self.degree(node) > 1 {
                number.insert(node, junctions.len());
                junctions.push(at);
            }
        }
        let lines = self.edges.iter().map(|e| {
            let [from, to] = e.ends.map(|n| self.nodes[n]);
            let way = std::iter::once(from).chain(e.path.iter().copied());
            let (points, half_widths) = way.chain([to]).unzip();
            let joins = e.ends.map(|n| number.get(&n).copied());
            Stroke {
                points,
                half_widths,
                joins,
                closed: false,
            }
        });
        let mut strokes: Vec<Stroke> = lines.collect();
        strokes.extend(self.rings.iter().map(|ring| {
            let (points, half_widths) = ring.iter().copied().unzip();
            Stroke {
                points,
                half_widths,
                joins: [None; 2],
                closed: true,
            }
        }));
        let dot = |&(centre, radius): &(Point, f64)| PenDot { centre, radius };
        let dots = self.alone.iter().map(dot).collect();
        Skeleton {
            strokes,
            junctions,
            dots,
        }
    }
}

/// Walks the thinned pixels from node to node.
struct Tracer<'a> {
    field: Field,
    radii: &'a [f64],
    /// The node that a pixel belongs to.
    node_of: Vec<Option<usize>>,
    seen: Vec<bool>,
    graph: Graph,
}

impl<'a> Tracer<'a> {
    fn new(thinned: &Bitmap, radii: &'a [f64]) -> Self {
        let field = Field::new(thinned);
        let n = field.ink.len();
        let graph = Graph::default();
        Self {
            field,
            radii,
            node_of: vec![None; n],
            seen: vec![false; n],
            graph,
        }
    }

    fn run(mut self) -> Graph {
        self.find_nodes();
        for i in 0..self.field.ink.len() {
            if let Some(node) = self.node_of[i] {
                for n in self.field.around(i) {
                    if self.field.ink[n] && !self.seen[n] && self.node_of[n].is_none() {
                        self.walk(node, i, n);
                    }
                }
            }
        }
        for i in 0..self.field.ink.len() {
            if self.field.ink[i] && !self.seen[i] && self.node_of[i].is_none() {
                self.ring(i);
            }
        }
        let alone = |&n: &usize| self.graph.degree(n) == 0;
        let nodes = (0..self.graph.nodes.len()).filter(alone);
        self.graph.alone = nodes.map(|n| self.graph.nodes[n]).collect();
        self.graph
    }

    /// Place and half width of a pixel of the field.
    fn spot(&self, i: usize) -> (Point, f64) {
        let (x, y) = (i % self.field.stride - 1, i / self.field.stride - 1);
        let radius = self.radii.get(y * (self.field.stride - 2) + x);
        let at = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        (at, radius.copied().unwrap_or_default())
    }

    fn neighbours(&self, i: usize) -> impl Iterator<Item = usize> {
        self.field
            .around(i)
            .into_iter()
            .filter(|&n| self.field.ink[n])
    }

    /// Every pixel that is not inside a line, touching ones together.
    fn find_nodes(&mut self) {
        let inner = |i: usize| self.neighbours(i).count() == 2;
        let pixels = (0..self.field.ink.len()).filter(|&i| self.field.ink[i] && !inner(i));
        let special: Vec<usize> = pixels.collect();
        let mut is_special = vec![false; self.field.ink.len()];
        special.iter().for_each(|&i| is_special[i] = true);
        for &start in &special {
            if self.node_of[start].is_some() {
                continue;
            }
            let id = self.graph.nodes.len();
            self.node_of[start] = Some(id);
            let (mut cluster, mut next) = (vec![start], 0);
            while let Some(&i) = cluster.get(next) {
                next += 1;
                for n in self.field.around(i) {
                    if is_special[n] && self.node_of[n].is_none() {
                        self.node_of[n] = Some(id);
                        cluster.push(n);
                    }
                }
            }
            let spots: Vec<_> = cluster.iter().map(|&i| self.spot(i)).collect();
            let sum = spots.iter().fold(Point::ORIGIN, |s, p| s + p.0.to_vec2());
            let radius = spots.iter().map(|p| p.1).fold(0.0, f64::max);
            let centre = (sum.to_vec2() / spots.len() as f64).to_point();
            self.graph.nodes.push((centre, radius));
        }
    }

    /// Follows a line from `node` (its pixel `from`) by its first inner pixel to the next node.
    fn walk(&mut self, node: usize, from: usize, first: usize) {
        let (mut path, mut before, mut at) = (Vec::new(), from, first);
        let end = loop {
            self.seen[at] = true;
            path.push(self.spot(at));
            let onward = |&n: &usize| n != before && !self.seen[n];
            let Some(next) = self.neighbours(at).find(onward) else {
                break node; // back where it started
            };
            if let Some(end) = self.node_of[next] {
                break end;
            }
            (before, at) = (at, next);
        };
        // Two pixels of one node beside the same pixel are no ring: a ring round paper has three at least.
        if node != end || path.len() >= 3 {
            self.graph.edges.push(Edge {
                ends: [node, end],
                path,
            });
        }
    }

    fn ring(&mut self, start: usize) {
        let (mut ring, mut at) = (Vec::new(), Some(start));
        while let Some(i) = at {
            self.seen[i] = true;
            ring.push(self.spot(i));
            at = self.neighbours(i).find(|&n| !self.seen[n]);
        }
        self.graph.rings.push(ring);
    }
}
