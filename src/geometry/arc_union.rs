//! The union of closed curves made of arcs: the curves around all points that at least one curve winds around. They
//! neither cross nor run inside of the solid.
//!
//! The algorithm cuts pieces where they turn and where they meet, unifies ends that nearly coincide, and counts
//! coinciding pieces together. It then determines the winding numbers on both sides of each piece: the piece bounds
//! the union if exactly one of the two is zero. The remaining pieces are joined to closed curves again.

use std::collections::HashMap;

use glam::DVec3;

use super::{Aabb, ArcPiece};

/// The limit on pairs of pieces with overlapping boxes.
const MAX_PAIRS: usize = 4_000_000;
/// The limit on cuts.
const MAX_CUTS: usize = 200_000;
/// The limit on bands, which find the edges that a ray crosses.
const MAX_BANDS: usize = 1_024;
/// An arc that leaves its chord by less than this fraction of the snapping distance is intersected as a straight
/// piece.
const STRAIGHT: f64 = 0.1;
/// Pieces between the same ends coincide if their middles are nearer to each other than this many snapping distances.
const SAME: f64 = 4.0;

/// The curves cross each other too often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooDense;

/// The union of closed curves in the XY plane, of either orientation. `None` if the curves are already their union,
/// or if rounding prevents a result. Ends nearer to each other than `snap` are unified.
pub fn arc_union(arcs: &[ArcPiece], snap: f64) -> Result<Option<Vec<ArcPiece>>, TooDense> {
    // Rounding to another distance may resolve an ambiguity.
    for factor in [1.0, 7.0, 50.0] {
        let mut plane = Arrangement::new(arcs, snap * factor);
        plane.cut()?;
        let (edges, is_changed) = plane.edges();
        let kept = boundary(&edges, &plane.vertices.at);
        if !is_changed && kept.len() == edges.len() {
            return Ok(None);
        }
        if let Some(closed) = closed(&kept) {
            return Ok(Some(closed));
        }
    }
    Ok(None)
}

/// Points; those nearer to each other than the snapping distance are unified.
struct Vertices {
    snap: f64,
    at: Vec<DVec3>,
    cells: HashMap<(i64, i64), Vec<usize>>,
}

impl Vertices {
    /// The index of a point.
    fn index(&mut self, p: DVec3) -> usize {
        let cell = |v: f64| (v / self.snap).floor() as i64;
        let (x, y) = (cell(p.x), cell(p.y));
        for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
            let there = self.cells.get(&(x.saturating_add(dx), y.saturating_add(dy)));
            let near = there.into_iter().flatten().find(|i| self.at[**i].distance(p) <= self.snap);
            if let Some(found) = near {
                return *found;
            }
        }
        self.at.push(p);
        self.cells.entry((x, y)).or_default().push(self.at.len() - 1);
        self.at.len() - 1
    }
}

/// A piece that is monotonic along both axes, and the positions of its cuts.
struct Cut {
    arc: ArcPiece,
    ends: [usize; 2],
    bounds: Aabb,
    /// λ and vertex of each cut.
    places: Vec<(f64, usize)>,
}

/// A piece between two vertices without others on it, and how often the curves traverse it.
struct Edge {
    ends: [usize; 2],
    arc: ArcPiece,
    times: i32,
}

struct Arrangement {
    vertices: Vertices,
    cuts: Vec<Cut>,
}

impl Arrangement {
    fn new(arcs: &[ArcPiece], snap: f64) -> Self {
        let mut vertices = Vertices { snap, at: Vec::new(), cells: HashMap::new() };
        let mut cuts = Vec::with_capacity(2 * arcs.len());
        for arc in arcs {
            let mut turns: Vec<f64> = (0..2).flat_map(|axis| arc.turns(axis)).collect();
            turns.sort_by(f64::total_cmp);
            let places: Vec<f64> = [-arc.reach].into_iter().chain(turns).chain([arc.reach]).collect();
            for pair in places.windows(2) {
                let piece = if places.len() == 2 { *arc } else { arc.between(pair[0], pair[1]) };
                let ends = [vertices.index(piece.start()), vertices.index(piece.end())];
                if ends[0] != ends[1] {
                    cuts.push(Cut { arc: piece, ends, bounds: piece.bounds().expanded(snap), places: Vec::new() });
                }
            }
        }
        Self { vertices, cuts }
    }

    /// Finds the points where pieces meet.
    fn cut(&mut self) -> Result<(), TooDense> {
        let mut order: Vec<usize> = (0..self.cuts.len()).collect();
        order.sort_by(|a, b| self.cuts[*a].bounds.min.x.total_cmp(&self.cuts[*b].bounds.min.x));
        let (mut pairs, mut places) = (0, 0);
        for (k, &i) in order.iter().enumerate() {
            let right = self.cuts[i].bounds.max.x;
            for &j in &order[k + 1..] {
                if self.cuts[j].bounds.min.x > right {
                    break;
                }
                let (a, b) = (&self.cuts[i].bounds, &self.cuts[j].bounds);
                if a.min.y > b.max.y || b.min.y > a.max.y {
                    continue;
                }
                pairs += 1;
                places += self.meet(i, j);
                if pairs > MAX_PAIRS || places > MAX_CUTS {
                    return Err(TooDense);
                }
            }
        }
        Ok(())
    }

    /// Cuts two pieces where they meet; returns the number of these points.
    fn meet(&mut self, i: usize, j: usize) -> usize {
        let snap = self.vertices.snap;
        let (a, b) = (self.cuts[i].arc, self.cuts[j].arc);
        let mut found = 0;
        // An end of one on the other.
        for (on, of) in [(i, j), (j, i)] {
            for end in self.cuts[of].ends {
                let p = self.vertices.at[end];
                let arc = self.cuts[on].arc;
                let lambda = place_on(&arc, p);
                if lambda.abs() < arc.reach && arc.at(lambda).distance(p) <= snap {
                    found += self.place(on, lambda, end);
                }
            }
        }
        for p in crossings(&a, &b, snap) {
            let places = [place_on(&a, p), place_on(&b, p)];
            if places[0].abs() > a.reach || places[1].abs() > b.reach {
                continue;
            }
            let vertex = self.vertices.index(p);
            found += self.place(i, places[0], vertex) + self.place(j, places[1], vertex);
        }
        found
    }

    /// Cuts a piece, unless its end is there.
    fn place(&mut self, i: usize, lambda: f64, vertex: usize) -> usize {
        let cut = &mut self.cuts[i];
        if cut.ends.contains(&vertex) || cut.places.iter().any(|(_, v)| *v == vertex) {
            return 0;
        }
        cut.places.push((lambda, vertex));
        1
    }

    /// The pieces between neighboring vertices, with coinciding ones merged; and whether that changed anything.
    fn edges(&mut self) -> (Vec<Edge>, bool) {
        let mut edges: Vec<Edge> = Vec::with_capacity(self.cuts.len());
        let mut known: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        let mut is_changed = false;
        let at = &self.vertices.at;
        for cut in &mut self.cuts {
            is_changed |= !cut.places.is_empty();
            cut.places.sort_by(|a, b| a.0.total_cmp(&b.0));
            let whole = cut.places.is_empty() && cut.arc.start() == at[cut.ends[0]] && cut.arc.end() == at[cut.ends[1]];
            let middle = cut.places.iter().map(|(_, vertex)| *vertex);
            let stops: Vec<usize> = [cut.ends[0]].into_iter().chain(middle).chain([cut.ends[1]]).collect();
            for pair in stops.windows(2).filter(|pair| pair[0] != pair[1]) {
                let [from, to] = [pair[0], pair[1]];
                let arc = if whole { cut.arc } else { curved_alike(&cut.arc, at[from], at[to]) };
                let same = known.entry([from.min(to), from.max(to)]).or_default();
                let near = |i: &&usize| edges[**i].arc.middle.distance(arc.middle) <= SAME * self.vertices.snap;
                if let Some(&i) = same.iter().find(near) {
                    edges[i].times += if edges[i].ends == [from, to] { 1 } else { -1 };
                    is_changed = true;
                } else {
                    same.push(edges.len());
                    edges.push(Edge { ends: [from, to], arc, times: 1 });
                }
            }
        }
        edges.retain(|edge| edge.times != 0);
        (edges, is_changed)
    }
}

/// λ of the point of an arc's circle or line that is nearest to `p`.
fn place_on(arc: &ArcPiece, p: DVec3) -> f64 {
    let (d, bend) = (p - arc.middle, arc.bend.length());
    if bend < 1e-9 {
        return 0.5 * d.dot(arc.tangent);
    }
    let (x, y) = (d.dot(arc.tangent), d.dot(arc.bend) / bend);
    (0.5 * (bend * x).atan2(1.0 - bend * y)).tan() / bend
}

/// The arc from one point to another with the curvature of `like`.
fn curved_alike(like: &ArcPiece, from: DVec3, to: DVec3) -> ArcPiece {
    let chord = to - from;
    let left = DVec3::new(-like.tangent.y, like.tangent.x, 0.0);
    let sine = (0.5 * like.bend.dot(left) * chord.length()).clamp(-1.0, 1.0);
    let cosine = (1.0 - sine * sine).sqrt();
    // An arc that bends to the left leaves to the right of the chord.
    let along = chord.normalize_or_zero();
    let direction = along * cosine - DVec3::new(-along.y, along.x, 0.0) * sine;
    ArcPiece::leaving(from, direction, to)
}

/// Whether an arc stays within rounding of its chord.
fn is_straight(arc: &ArcPiece, snap: f64) -> bool {
    let chord = 4.0 * arc.reach;
    arc.bend.length() * chord * chord / 8.0 < STRAIGHT * snap
}

/// The points where the circles or lines of two arcs cross.
fn crossings(a: &ArcPiece, b: &ArcPiece, snap: f64) -> Vec<DVec3> {
    match (is_straight(a, snap), is_straight(b, snap)) {
        (true, true) => {
            let across = a.tangent.perp_dot(b.tangent);
            if across.abs() < 1e-12 {
                return Vec::new();
            }
            vec![a.middle + a.tangent * ((b.middle - a.middle).perp_dot(b.tangent) / across)]
        }
        (true, false) => on_line(a, b),
        (false, true) => on_line(b, a),
        (false, false) => {
            let (p, q) = (center(a), center(b));
            let (r, s) = (1.0 / a.bend.length(), 1.0 / b.bend.length());
            let away = p.distance(q);
            if away < 1e-12 {
                return Vec::new();
            }
            let along = (q - p) / away;
            let foot = 0.5 * (away + (r - s) * (r + s) / away);
            let square = (r - foot) * (r + foot);
            if square < 0.0 {
                return Vec::new();
            }
            let aside = DVec3::new(-along.y, along.x, 0.0) * square.sqrt();
            vec![p + along * foot + aside, p + along * foot - aside]
        }
    }
}

/// The points where a straight piece's line crosses an arc's circle.
fn on_line(line: &ArcPiece, arc: &ArcPiece) -> Vec<DVec3> {
    let (c, r) = (center(arc), 1.0 / arc.bend.length());
    let foot = line.middle + line.tangent * (c - line.middle).dot(line.tangent);
    let away = foot.distance(c);
    let square = (r - away) * (r + away);
    if square < 0.0 {
        return Vec::new();
    }
    vec![foot + line.tangent * square.sqrt(), foot - line.tangent * square.sqrt()]
}

fn center(arc: &ArcPiece) -> DVec3 {
    arc.middle + arc.bend / arc.bend.length_squared()
}

trait PerpDot {
    fn perp_dot(self, other: Self) -> f64;
}

impl PerpDot for DVec3 {
    fn perp_dot(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }
}

/// Edges by their position along an axis.
struct Bands {
    axis: usize,
    low: f64,
    width: f64,
    holds: Vec<Vec<usize>>,
}

impl Bands {
    fn new(axis: usize, edges: &[Edge], at: &[DVec3]) -> Self {
        let spans: Vec<[f64; 2]> = edges
            .iter()
            .map(|edge| {
                let [a, b] = edge.ends.map(|end| at[end][axis]);
                [a.min(b), a.max(b)]
            })
            .collect();
        let [low, high] = spans.iter().fold([f64::MAX, f64::MIN], |all, s| [all[0].min(s[0]), all[1].max(s[1])]);
        let count = (edges.len() / 4).clamp(1, MAX_BANDS);
        let width = ((high - low) / count as f64).max(f64::MIN_POSITIVE);
        let mut out = Self { axis, low, width, holds: vec![Vec::new(); count] };
        for (i, [from, to]) in spans.into_iter().enumerate() {
            for band in out.band(from)..=out.band(to) {
                out.holds[band].push(i);
            }
        }
        out
    }

    fn band(&self, value: f64) -> usize {
        (((value - self.low) / self.width) as usize).min(self.holds.len() - 1)
    }

    /// The winding number just beyond the middle of an edge, along the other axis.
    fn winding(&self, of: usize, edges: &[Edge], at: &[DVec3]) -> i32 {
        let (axis, along) = (self.axis, 1 - self.axis);
        let p = edges[of].arc.middle;
        let mut sum = 0;
        for &i in self.holds[self.band(p[axis])].iter().filter(|i| **i != of) {
            let edge = &edges[i];
            let [a, b] = edge.ends.map(|end| at[end]);
            if (a[axis] <= p[axis]) == (b[axis] <= p[axis]) || a[along].max(b[along]) <= p[along] {
                continue;
            }
            if a[along].min(b[along]) > p[along] || beyond(&edge.arc, axis, p) {
                let grows = b[axis] > a[axis];
                // Viewed along X, curves around a solid rise at its far side; along Y they run back there.
                sum += if grows == (axis == 1) { edge.times } else { -edge.times };
            }
        }
        sum
    }
}

/// Whether an arc passes a point at its height on the far side.
fn beyond(arc: &ArcPiece, axis: usize, p: DVec3) -> bool {
    let along = 1 - axis;
    let nearest_end = || {
        let (start, end) = (arc.start(), arc.end());
        if (start[axis] - p[axis]).abs() < (end[axis] - p[axis]).abs() { start } else { end }
    };
    let there = arc.crossings(axis, p[axis]).first().map_or_else(nearest_end, |lambda| arc.at(*lambda));
    there[along] > p[along]
}

/// The edges that bound the union, with the solid on their left.
fn boundary(edges: &[Edge], at: &[DVec3]) -> Vec<Edge> {
    let bands = [Bands::new(0, edges, at), Bands::new(1, edges, at)];
    let mut kept = Vec::new();
    for (i, edge) in edges.iter().enumerate() {
        let [from, to] = edge.ends.map(|end| at[end]);
        let way = to - from;
        // Choose the ray that crosses the edge more steeply.
        let is_steep = way.y.abs() >= way.x.abs();
        let far = bands[usize::from(is_steep)].winding(i, edges, at);
        let far_is_right = if is_steep { way.y > 0.0 } else { way.x < 0.0 };
        let [left, right] = if far_is_right { [far + edge.times, far] } else { [far, far - edge.times] };
        match (left != 0, right != 0) {
            (true, false) => kept.push(Edge { ends: edge.ends, arc: edge.arc, times: 1 }),
            (false, true) => {
                let [from, to] = edge.ends;
                kept.push(Edge { ends: [to, from], arc: edge.arc.reversed(), times: 1 });
            }
            _ => {}
        }
    }
    kept
}

/// Connects the edges to closed curves; `None` if they do not close.
fn closed(edges: &[Edge]) -> Option<Vec<ArcPiece>> {
    let mut leaving: HashMap<usize, Vec<usize>> = HashMap::new();
    for (i, edge) in edges.iter().enumerate().rev() {
        leaving.entry(edge.ends[0]).or_default().push(i);
    }
    let mut out = Vec::with_capacity(edges.len());
    for first in edges {
        // All edges that leave a vertex are used once the curves through it are complete.
        let start = first.ends[0];
        let Some(mut i) = leaving.get_mut(&start).and_then(Vec::pop) else { continue };
        loop {
            out.push(edges[i].arc);
            if edges[i].ends[1] == start {
                break;
            }
            i = leaving.get_mut(&edges[i].ends[1])?.pop()?;
        }
    }
    (out.len() == edges.len()).then_some(out)
}

#[cfg(test)]
mod tests;
