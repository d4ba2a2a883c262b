//! What of a mesh is solid: its pieces, closed where they are open.
//!
//! A piece is all that hangs together by common corners. A point is inside a piece if the winding number there is not 0
//! (Jacobson et al., "Robust inside-outside segmentation using generalized winding numbers", 2013). Open edges are closed
//! before: each loop of them by a cone around its middle, which lies where the winding number of the open piece is 1/2 if
//! the loop is flat. A piece that would be nothing but its own lid is a sheet, and gets a thickness instead; so does a
//! piece that is thinner than a voxel.

use std::collections::HashMap;

use glam::DVec3;
use rayon::prelude::*;

use super::super::TriangleMesh;
use super::columns::{SUBVOXELS, Whole3};
use super::facets::{Facets, NONE};
use isolith_bricks::BrickGrid;

/// A piece is a sheet if its lids have more than this share of its area: those of a half ball have half of it.
const SHEET_LIDS: f64 = 0.6;
/// A piece is thin if its volume is less than its area times this, in voxels: a plate of one voxel.
const THIN: f64 = 0.5;

/// The triangles of a mesh, sorted by what they bound.
#[derive(Debug, Default)]
pub(super) struct Solid {
    /// Those of closed pieces, and what closes them.
    pub closed: Facets,
    /// The same as whole numbers, with all triangles without area.
    pub chain: Vec<[Whole3; 3]>,
    /// Those of sheets and of what is thin.
    pub thin: Facets,
    /// Whether any piece is a sheet.
    pub has_sheets: bool,
}

/// A triangle by its corners in the list of points.
type Corners = [u32; 3];

#[derive(Clone, Copy, Default)]
struct Piece {
    area: f64,
    volume: f64,
    lids: f64,
}

impl Solid {
    /// Sorts the triangles of a mesh.
    pub fn new(mesh: &TriangleMesh, grid: &BrickGrid) -> Self {
        let (points, triangles) = welded(mesh, grid);
        let mut pieces = Groups::new(points.len());
        triangles.iter().for_each(|[a, b, c]| pieces.join(*a, *b, *c));
        let (points, lids) = closed(points, &open_edges(&triangles));
        // The middles of cones belong to the pieces that they close.
        pieces.extend(points.len());
        lids.iter().for_each(|[a, b, c]| pieces.join(*a, *b, *c));
        let at = |p: u32| points[p as usize].map(|v| f64::from(v) / SUBVOXELS as f64);
        let corners = |triangle: Corners| triangle.map(|p| DVec3::from(at(p)));
        let mut sizes: HashMap<u32, Piece> = HashMap::new();
        for (triangle, is_lid) in triangles.iter().map(|t| (*t, false)).chain(lids.iter().map(|t| (*t, true))) {
            let piece = sizes.entry(pieces.of(triangle[0])).or_default();
            let [a, b, c] = corners(triangle);
            let area = 0.5 * (b - a).cross(c - a).length();
            *if is_lid { &mut piece.lids } else { &mut piece.area } += area;
            piece.volume += a.dot(b.cross(c)) / 6.0;
        }
        let is_sheet = |piece: &Piece| piece.lids > SHEET_LIDS * piece.area;
        let is_thin = |piece: &Piece| is_sheet(piece) || piece.volume.abs() < THIN * piece.area;
        let (mut chain, mut solid, mut thin) = (Vec::new(), Vec::new(), Vec::new());
        let sources = (0..triangles.len() as u32).chain(std::iter::repeat_n(NONE, lids.len()));
        for (triangle, source) in triangles.iter().chain(&lids).zip(sources) {
            let piece = &sizes[&pieces.of(triangle[0])];
            let floats = corners(*triangle).map(DVec3::as_vec3);
            if !is_sheet(piece) {
                chain.push(triangle.map(|p| points[p as usize]));
                solid.push((floats, source));
            }
            if is_thin(piece) && source != NONE {
                thin.push((floats, source));
            }
        }
        let has_sheets = sizes.values().any(|piece| piece.area > 0.0 && is_sheet(piece));
        let (closed, thin) = rayon::join(|| Facets::new(solid), || Facets::new(thin));
        Self { closed, chain, thin, has_sheets }
    }

    /// Whether nothing has an area.
    pub fn is_empty(&self) -> bool {
        self.closed.is_empty() && self.thin.is_empty()
    }
}

/// The distinct corners, in whole numbers from the first sample, and the triangles of the mesh by them.
fn welded(mesh: &TriangleMesh, grid: &BrickGrid) -> (Vec<Whole3>, Vec<Corners>) {
    let scale = SUBVOXELS as f64 / grid.voxel;
    let mut points = Vec::new();
    let mut known: HashMap<Whole3, u32> = HashMap::new();
    let mut of_vertex = vec![NONE; mesh.positions.len()];
    let mut triangles = Vec::with_capacity(mesh.triangle_count());
    for part in &mesh.parts {
        let run = &mesh.indices[part.indices.start as usize..part.indices.end as usize];
        let mut point = |vertex: u32| {
            let place = &mut of_vertex[vertex as usize];
            if *place == NONE {
                let at = part.origin + DVec3::from(mesh.positions[vertex as usize].map(f64::from)) - grid.origin;
                let whole = (at * scale).round().to_array().map(|v| v as i32);
                *place = *known.entry(whole).or_insert_with(|| {
                    points.push(whole);
                    points.len() as u32 - 1
                });
            }
            *place
        };
        triangles.extend(run.as_chunks::<3>().0.iter().map(|corners| corners.map(&mut point)));
    }
    (points, triangles)
}

/// Edges that are passed more often in one direction than in the other, in that direction, as often as that; sorted.
fn open_edges(triangles: &[Corners]) -> Vec<[u32; 2]> {
    let edge = |[a, b]: [u32; 2]| (u64::from(a.min(b)) << 32 | u64::from(a.max(b))) << 1 | u64::from(a < b);
    let mut all: Vec<u64> = triangles
        .par_iter()
        .flat_map_iter(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]])
        .filter(|[a, b]| a != b)
        .map(edge)
        .collect();
    all.par_sort_unstable();
    let mut open = Vec::new();
    for same in all.chunk_by(|a, b| a >> 1 == b >> 1) {
        let up = same.iter().filter(|edge| *edge & 1 == 1).count();
        let down = same.len() - up;
        let ends = [(same[0] >> 33) as u32, (same[0] >> 1) as u32];
        let ends = if up > down { ends } else { [ends[1], ends[0]] };
        open.extend(std::iter::repeat_n(ends, up.abs_diff(down)));
    }
    open.sort_unstable();
    open
}

/// Triangles that close loops of open edges, and the points with their middles.
fn closed(mut points: Vec<Whole3>, open: &[[u32; 2]]) -> (Vec<Whole3>, Vec<Corners>) {
    let mut lids = Vec::new();
    let mut is_used = vec![false; open.len()];
    // Of each point the first edge that is not used yet; there are as many to a point as from it, so none ends nowhere.
    let mut next: HashMap<u32, usize> = HashMap::new();
    for (index, [from, _]) in open.iter().enumerate().rev() {
        next.insert(*from, index);
    }
    for start in 0..open.len() {
        if is_used[start] {
            continue;
        }
        let mut loop_points = Vec::new();
        let mut at = open[start][0];
        while let Some(&index) = next.get(&at).filter(|index| open.get(**index).is_some_and(|[from, _]| *from == at)) {
            next.insert(at, index + 1);
            is_used[index] = true;
            loop_points.push(at);
            at = open[index][1];
            if at == loop_points[0] {
                break;
            }
        }
        close(&mut points, &loop_points, &mut lids);
    }
    (points, lids)
}

fn close(points: &mut Vec<Whole3>, loop_points: &[u32], lids: &mut Vec<Corners>) {
    match *loop_points {
        [] | [_] | [_, _] => {}
        [a, b, c] => lids.push([c, b, a]),
        _ => {
            let count = loop_points.len() as i64;
            let sum = |i: usize| loop_points.iter().map(|p| i64::from(points[*p as usize][i])).sum::<i64>();
            let middle = [0, 1, 2].map(|i| (sum(i) / count) as i32);
            points.push(middle);
            let middle = points.len() as u32 - 1;
            for (i, from) in loop_points.iter().enumerate() {
                lids.push([loop_points[(i + 1) % loop_points.len()], *from, middle]);
            }
        }
    }
}

/// Points that hang together.
struct Groups(Vec<u32>);

impl Groups {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn extend(&mut self, count: usize) {
        self.0.extend(self.0.len() as u32..count as u32);
    }

    /// The point that stands for a group. Halves the path on its way.
    fn of(&mut self, mut point: u32) -> u32 {
        while self.0[point as usize] != point {
            let above = self.0[self.0[point as usize] as usize];
            self.0[point as usize] = above;
            point = above;
        }
        point
    }

    fn join(&mut self, a: u32, b: u32, c: u32) {
        let [a, b, c] = [a, b, c].map(|p| self.of(p));
        let least = a.min(b).min(c);
        for group in [a, b, c] {
            self.0[group as usize] = least;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Vec<Corners> {
        vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    }

    #[test]
    fn open_edges_are_closed_whatever_is_missing_or_turned() {
        let points: Vec<Whole3> = vec![[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]];
        let triangles = tetrahedron();
        assert!(open_edges(&triangles).is_empty());
        for missing in 0..16_u32 {
            for turned in 0..16_u32 {
                let kept = triangles.iter().enumerate().filter(|(i, _)| missing >> i & 1 == 0);
                let mut some: Vec<Corners> =
                    kept.map(|(i, [a, b, c])| if turned >> i & 1 == 1 { [*a, *c, *b] } else { [*a, *b, *c] }).collect();
                let (_, lids) = closed(points.clone(), &open_edges(&some));
                some.extend(lids);
                assert!(open_edges(&some).is_empty(), "{missing:b} {turned:b}");
            }
        }
    }

    #[test]
    fn groups_hang_together_by_common_points() {
        let mut groups = Groups::new(9);
        groups.join(0, 1, 2);
        groups.join(3, 4, 5);
        assert_ne!(groups.of(2), groups.of(4));
        groups.join(5, 6, 1);
        assert_eq!(groups.of(2), groups.of(4));
        groups.extend(11);
        assert_eq!([8, 9, 10].map(|p| groups.of(p)), [8, 9, 10]);
    }
}
