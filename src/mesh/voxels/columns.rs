//! Inside or outside, for every sample: the winding number of a closed surface is the number of its crossings with a ray,
//! each with its direction as the sign. One sweep over the triangles gives the crossings of all columns of samples.
//!
//! Corners are whole numbers, so the crossings at a common edge agree exactly, and none is lost or counted twice.

/// Units of the whole numbers per voxel.
pub(super) const SUBVOXELS: i64 = 1 << 18;

/// A corner in units of 1 / [`SUBVOXELS`].
pub(super) type Whole3 = [i32; 3];

/// The crossings of a column with the surface, from below.
#[derive(Clone, Copy, Debug, Default)]
struct Crossing {
    /// In voxels.
    height: f32,
    /// 1 if the surface faces up.
    turn: i32,
}

/// Columns of samples along z.
#[derive(Debug)]
pub(super) struct Columns {
    /// Columns along x and y.
    size: [usize; 2],
    /// Where the crossings of each column start, and the end of the last.
    starts: Vec<u32>,
    crossings: Vec<Crossing>,
}

impl Columns {
    /// The crossings with a closed surface.
    pub fn new(size: [usize; 2], triangles: &[[Whole3; 3]]) -> Self {
        let mut starts = vec![0_u32; size[0] * size[1] + 1];
        for triangle in triangles {
            crossings(triangle, size, &mut |column, _| starts[column + 1] += 1);
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut all = vec![Crossing::default(); starts.last().map_or(0, |n| *n as usize)];
        for triangle in triangles {
            crossings(triangle, size, &mut |column, crossing| {
                all[next[column] as usize] = crossing;
                next[column] += 1;
            });
        }
        Self { size, starts, crossings: all }
    }

    /// Whether the winding number at a sample is not 0. There is none outside of the columns.
    pub fn is_inside(&self, [x, y, z]: [i32; 3]) -> bool {
        let height = z as f32;
        let turns = self.column(x, y).iter().filter(|crossing| crossing.height > height).map(|crossing| crossing.turn);
        turns.sum::<i32>() != 0
    }

    /// Whether the column never meets the surface.
    pub fn is_empty(&self, x: i32, y: i32) -> bool {
        self.column(x, y).is_empty()
    }

    fn column(&self, x: i32, y: i32) -> &[Crossing] {
        let [Ok(x), Ok(y)] = [x, y].map(usize::try_from) else { return &[] };
        if x >= self.size[0] || y >= self.size[1] {
            return &[];
        }
        let column = x + self.size[0] * y;
        &self.crossings[self.starts[column] as usize..self.starts[column + 1] as usize]
    }
}

/// Calls `visit` with all columns that cross the triangle.
///
/// Columns stand half a unit beside the samples, so that no corner lies on a line of columns; a column on an edge counts
/// as if it stood a little further to the right.
fn crossings(triangle: &[Whole3; 3], size: [usize; 2], visit: &mut impl FnMut(usize, Crossing)) {
    // In half units, so that columns have whole numbers too.
    let [a, b, c] = triangle.map(|corner| corner.map(|v| 2 * i64::from(v)));
    let step = 2 * SUBVOXELS;
    let (lowest, highest) = (a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
    let first = ceil_divide(lowest - 1, step).max(0);
    let last = (highest - 1).div_euclid(step).min(size[1] as i64 - 1);
    for row in first..=last {
        let y = step * row + 1;
        let (mut from, mut to) = (0, 0);
        for [p, q] in [[a, b], [b, c], [c, a]] {
            if (p[1] < y) == (q[1] < y) {
                continue;
            }
            let x = p[0] + ceil_divide_signed((y - p[1]) * (q[0] - p[0]), q[1] - p[1]);
            let column = ceil_divide(x - 1, step).clamp(0, size[0] as i64);
            // Edges that go up have the triangle on their left, if it faces up.
            *if p[1] < y { &mut to } else { &mut from } = column;
        }
        let (columns, turn) = if from < to { (from..to, 1) } else { (to..from, -1) };
        for column in columns {
            let height = height_at([a, b, c], step * column + 1, y) / step as f64;
            visit(column as usize + size[0] * row as usize, Crossing { height: height as f32, turn });
        }
    }
}

fn height_at([a, b, c]: [[i64; 3]; 3], x: i64, y: i64) -> f64 {
    let minus = |p: [i64; 3], q: [i64; 3]| [0, 1, 2].map(|i| (p[i] - q[i]) as f64);
    let (ab, ac) = (minus(b, a), minus(c, a));
    let up = ab[0] * ac[1] - ab[1] * ac[0];
    let (lowest, highest) = (a[2].min(b[2]).min(c[2]) as f64, a[2].max(b[2]).max(c[2]) as f64);
    let (dx, dy) = ((x - a[0]) as f64, (y - a[1]) as f64);
    let by_x = (ab[2] * ac[1] - ab[1] * ac[2]) / up;
    let by_y = (ab[0] * ac[2] - ab[2] * ac[0]) / up;
    let height = a[2] as f64 + by_x * dx + by_y * dy;
    // A triangle seen from its edge has no height; any within it serves.
    if height.is_finite() { height.clamp(lowest, highest) } else { lowest }
}

fn ceil_divide(a: i64, b: i64) -> i64 {
    -(-a).div_euclid(b)
}

/// The same for a divisor of either sign.
fn ceil_divide_signed(a: i64, b: i64) -> i64 {
    if b > 0 { ceil_divide(a, b) } else { ceil_divide(-a, -b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole(v: [f64; 3]) -> Whole3 {
        v.map(|v| (v * SUBVOXELS as f64).round() as i32)
    }

    /// An octahedron with corners on samples: every column of its edges is a special case.
    fn octahedron(half: f64) -> Vec<[Whole3; 3]> {
        let center = [6.0, 6.0, 6.0];
        let tip = |axis: usize, side: f64| {
            let mut v = center;
            v[axis] += side * half;
            whole(v)
        };
        let mut out = Vec::new();
        for [x, y, z] in [[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [1.0, -1.0, -1.0]] {
            for x in [x, -x] {
                let [a, b, c] = [tip(0, x), tip(1, y), tip(2, z)];
                out.push(if x * y * z > 0.0 { [a, b, c] } else { [a, c, b] });
            }
        }
        out
    }

    #[test]
    fn a_closed_surface_has_each_sample_inside_or_outside() {
        for half in [2.0, 3.7, 4.0, 5.0] {
            let columns = Columns::new([13, 13], &octahedron(half));
            let open = columns.starts.windows(2).filter(|run| {
                let turns = columns.crossings[run[0] as usize..run[1] as usize].iter().map(|crossing| crossing.turn);
                turns.sum::<i32>() != 0
            });
            assert_eq!(open.count(), 0, "no crossing is lost");
            for (x, y, z) in (0..13).flat_map(|x| (0..13).flat_map(move |y| (0..13).map(move |z| (x, y, z)))) {
                let away = f64::from((x - 6_i32).abs() + (y - 6_i32).abs() + (z - 6_i32).abs()) - half;
                if away.abs() > 1e-3 {
                    assert_eq!(columns.is_inside([x, y, z]), away < 0.0, "{x} {y} {z} of {half}");
                }
            }
            assert!(columns.is_empty(0, 0) && columns.is_empty(-1, 4) && columns.is_empty(4, 13));
        }
    }

    #[test]
    fn division_rounds_up() {
        for a in -9..=9 {
            for b in [-4, -1, 1, 3] {
                assert_eq!(ceil_divide_signed(a, b), (a as f64 / b as f64).ceil() as i64, "{a} / {b}");
            }
        }
    }
}
