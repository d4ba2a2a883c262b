//! The walk along a ray through the copies of an instancer. Counterpart of `shaders/copy/walk.wgsl`.
//!
//! A lattice is walked slab by slab along the axis that the ray crosses fastest, each cell once: the ray visits the
//! cells whose copies may reach it, however far copies leave their cells. Slabs come in the order in which the ray
//! enters them, so the walk ends at the first hit that nothing later can precede.

use std::ops::ControlFlow;

use glam::DVec3;

use super::blocks::{BlockWalk, block_is_empty};
use super::instancer::{FlatInstancer, FlatLattice, PlaceList, Placement};
use super::variation::{Copy, copy_at_rest, copy_moved, copy_of_place};
use crate::ray_limits::RayLimits;
use isolith_geometry::{Aabb, Ray};

/// Most slabs of one walk: beyond them nothing is found.
pub const MAX_SLABS: u32 = 1 << 16;

/// A copy whose bounding sphere a cone meets, with the stretch of the axis where it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyVisit {
    /// The copy.
    pub copy: Copy,
    /// Where the cone enters the sphere.
    pub entry: f64,
    /// Where it leaves.
    pub exit: f64,
}

/// A cone in the space of an instancer: its axis, whose direction need not have unit length, the range of its
/// parameter, and its radius per parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyCone {
    /// The axis.
    pub axis: Ray,
    /// The range.
    pub limits: RayLimits,
    /// Radius at parameter 1.
    pub spread: f64,
}

impl CopyCone {
    /// Where the cone enters and leaves a box: its bounds along each axis alone, so it may leave later.
    pub(super) fn interval(&self, bounds: &Aabb) -> RayLimits {
        let RayLimits { mut near, mut far } = self.limits;
        for axis in 0..3 {
            let (origin, direction) = (self.axis.origin[axis], self.axis.direction[axis]);
            let [low, high] = [bounds.min[axis] - origin, bounds.max[axis] - origin];
            let [ahead, behind] = if direction < 0.0 { [-high, -low] } else { [low, high] };
            let speed = direction.abs();
            near = near.max(ahead / (speed + self.spread).max(1e-12));
            // A cone that is wider than steep never leaves on this axis.
            if speed > self.spread || self.spread <= 0.0 {
                far = far.min(behind / (speed - self.spread).max(1e-12));
            }
        }
        RayLimits { near, far }
    }
}

/// The work of a walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WalkCounts {
    /// Blocks of slabs that were tried.
    pub blocks: u64,
    /// Cells looked at, or nodes of a list.
    pub cells: u64,
    /// Copies that stand there.
    pub copies: u64,
    /// Those of them whose sizes, rotations and motions were computed.
    pub moved: u64,
    /// Copies whose bounding spheres the cone met.
    pub met: u64,
}

/// Visits the copies that a cone may meet. `visit` may move `limits.far` nearer, or break off.
pub fn copies_along(
    instancer: &FlatInstancer,
    cone: CopyCone,
    visit: &mut dyn FnMut(&CopyVisit, &mut RayLimits) -> ControlFlow<()>,
) -> WalkCounts {
    CopyWalk { instancer, cone, skips: true, counts: WalkCounts::default() }.run(visit)
}

/// The same, but looks at every cell within reach, also where masks leave blocks empty: for comparison.
pub fn copies_along_every_cell(
    instancer: &FlatInstancer,
    cone: CopyCone,
    visit: &mut dyn FnMut(&CopyVisit, &mut RayLimits) -> ControlFlow<()>,
) -> WalkCounts {
    CopyWalk { instancer, cone, skips: false, counts: WalkCounts::default() }.run(visit)
}

/// A walk.
struct CopyWalk<'a> {
    instancer: &'a FlatInstancer,
    cone: CopyCone,
    /// Whether it passes empty blocks.
    skips: bool,
    counts: WalkCounts,
}

impl CopyWalk<'_> {
    fn run(mut self, visit: &mut dyn FnMut(&CopyVisit, &mut RayLimits) -> ControlFlow<()>) -> WalkCounts {
        self.cone.limits = self.cone.interval(&self.instancer.bounds());
        if self.cone.limits.near <= self.cone.limits.far {
            let _ = match &self.instancer.placement {
                Placement::Lattice(lattice) => self.along_lattice(lattice, visit),
                Placement::List(list) => self.along_list(list, visit),
            };
        }
        self.counts
    }

    fn along_lattice(
        &mut self,
        lattice: &FlatLattice,
        visit: &mut dyn FnMut(&CopyVisit, &mut RayLimits) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let (instancer, direction) = (self.instancer, self.cone.axis.direction);
        let axis = walk_axis(lattice, direction);
        let range = [self.cone.limits.near, self.cone.limits.far];
        let [first, last] = cells_between(instancer, lattice, &self.cone, axis, range);
        let backward = direction[axis] < 0.0;
        let slabs = (i64::from(last) - i64::from(first) + 1).clamp(0, i64::from(MAX_SLABS)) as i32;
        let mut blocks = BlockWalk::new();
        let mut step = 0;
        while step < slabs {
            let slab_at = |step: i32| if backward { last - step } else { first + step };
            if self.skips
                && !instancer.masks.is_empty()
                && let Some(count) = blocks.next(slabs - step)
            {
                let is_empty = self.is_empty(lattice, axis, [slab_at(step), slab_at(step + count - 1)]);
                blocks.learn(is_empty);
                self.counts.blocks += 1;
                step += if is_empty { count } else { 0 };
                continue;
            }
            let slab = slab_at(step);
            step += 1;
            let [entry, exit] = slab_interval(instancer, lattice, &self.cone, axis, slab);
            if entry > self.cone.limits.far {
                break;
            }
            if entry > exit {
                continue;
            }
            let ranges = self.ranges(lattice, axis, [slab, slab], [entry, exit]);
            for z in ranges[2][0]..=ranges[2][1] {
                for y in ranges[1][0]..=ranges[1][1] {
                    for x in ranges[0][0]..=ranges[0][1] {
                        self.counts.cells += 1;
                        let Some(at_rest) = copy_at_rest(instancer, [x, y, z]) else { continue };
                        self.counts.copies += 1;
                        if !self.skips || self.may_meet(at_rest.place) {
                            self.counts.moved += 1;
                            if let Some(copy) = copy_moved(instancer, at_rest) {
                                self.look(copy, visit)?;
                            }
                        }
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// The cells along each axis that the cone may meet between two parameters, those along `axis` given.
    fn ranges(&self, lattice: &FlatLattice, axis: usize, along: [i32; 2], range: [f64; 2]) -> [[i32; 2]; 3] {
        [0, 1, 2].map(|other| match other {
            _ if other == axis => along,
            _ => cells_between(self.instancer, lattice, &self.cone, other, range),
        })
    }

    /// Whether masks let no copy stand where the cone may meet those of the slabs from the one to the other.
    fn is_empty(&self, lattice: &FlatLattice, axis: usize, [from, to]: [i32; 2]) -> bool {
        let interval = |slab| slab_interval(self.instancer, lattice, &self.cone, axis, slab);
        let [entry, exit] = [interval(from)[0], interval(to)[1]];
        if entry > exit {
            return false;
        }
        let ranges = self.ranges(lattice, axis, [from.min(to), from.max(to)], [entry, exit]);
        if ranges.iter().any(|[low, high]| low > high) {
            return true;
        }
        let corner = |end: usize| {
            let cell = DVec3::from_array(ranges.map(|range| f64::from(range[end])));
            cell * lattice.spacing + lattice.shift
        };
        let off = DVec3::X * lattice.stagger;
        block_is_empty(self.instancer, corner(0) - off, corner(1) + off)
    }

    /// Whether the cone may meet the copy that stands here at rest.
    fn may_meet(&self, place: DVec3) -> bool {
        let CopyCone { axis: Ray { origin, direction }, spread, .. } = self.cone;
        let (away, speed) = (place - origin, direction.length());
        let nearest = away.dot(direction) / (speed * speed);
        let reach = self.instancer.reach_at_rest;
        let wide = reach + spread * (nearest + reach / speed).max(0.0);
        (away - direction * nearest).length_squared() <= wide * wide
    }

    /// Visits a copy if the cone meets it.
    fn look(
        &mut self,
        copy: Copy,
        visit: &mut dyn FnMut(&CopyVisit, &mut RayLimits) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Some(met) = meeting(self.instancer, copy, &self.cone) else { return ControlFlow::Continue(()) };
        self.counts.met += 1;
        visit(&met, &mut self.cone.limits)
    }

    fn along_list(
        &mut self,
        list: &PlaceList,
        visit: &mut dyn FnMut(&CopyVisit, &mut RayLimits) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut open: Vec<usize> = if list.tree.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(index) = open.pop() {
            let node = &list.tree.nodes[index];
            self.counts.cells += 1;
            let RayLimits { near, far } = self.cone.interval(&node.bounds);
            if near > far {
                continue;
            }
            if !node.is_leaf() {
                let [near, far] = if self.cone.axis.direction[node.axis as usize] < 0.0 {
                    [node.link as usize, index + 1]
                } else {
                    [index + 1, node.link as usize]
                };
                open.extend([far, near]);
            } else if let Some(copy) = copy_of_place(self.instancer, node.link as usize) {
                self.counts.copies += 1;
                self.counts.moved += 1;
                self.look(copy, visit)?;
            }
        }
        ControlFlow::Continue(())
    }
}

/// The axis of several cells along which the ray crosses most of them.
pub fn walk_axis(lattice: &FlatLattice, direction: DVec3) -> usize {
    let speed = |axis: usize| {
        if lattice.is_long(axis) { direction[axis].abs() / lattice.spacing[axis] } else { -1.0 }
    };
    let mut best = 0;
    for axis in 1..3 {
        if speed(axis) > speed(best) {
            best = axis;
        }
    }
    best
}

/// How far a copy may be off the place of its cell along an axis, with the shift of rows.
fn reach(instancer: &FlatInstancer, lattice: &FlatLattice, axis: usize) -> f64 {
    instancer.reach[axis] + if axis == 0 { lattice.stagger } else { 0.0 }
}

/// The first and the last cell along an axis whose copies may meet the cone between two parameters.
fn cells_between(
    instancer: &FlatInstancer,
    lattice: &FlatLattice,
    cone: &CopyCone,
    axis: usize,
    range: [f64; 2],
) -> [i32; 2] {
    let [a, b] = range.map(|t| cone.axis.at(t)[axis] - lattice.shift[axis]);
    let reach = reach(instancer, lattice, axis) + cone.spread * range[1];
    let spacing = lattice.spacing[axis];
    let first = ((a.min(b) - reach) / spacing).ceil() as i32;
    let last = ((a.max(b) + reach) / spacing).floor() as i32;
    [first.max(lattice.low[axis]), last.min(lattice.high[axis])]
}

/// Where the cone may meet copies of a slab.
fn slab_interval(
    instancer: &FlatInstancer,
    lattice: &FlatLattice,
    cone: &CopyCone,
    axis: usize,
    slab: i32,
) -> [f64; 2] {
    let middle = f64::from(slab) * lattice.spacing[axis] + lattice.shift[axis] - cone.axis.origin[axis];
    let reach = reach(instancer, lattice, axis);
    let RayLimits { near, far } = cone.limits;
    let speed = cone.axis.direction[axis].abs();
    if speed + cone.spread < 1e-12 {
        return [near, far];
    }
    let ahead = if cone.axis.direction[axis] < 0.0 { -middle } else { middle };
    let entry = (ahead - reach) / (speed + cone.spread);
    // A cone that is wider than steep never leaves the slab.
    let exit = if speed > cone.spread { (ahead + reach) / (speed - cone.spread) } else { far };
    [entry.max(near), exit.min(far)]
}

/// Where the cone meets the bounding sphere of a copy; `None` if it does not.
fn meeting(instancer: &FlatInstancer, copy: Copy, cone: &CopyCone) -> Option<CopyVisit> {
    let (center, radius) = copy_sphere(instancer, &copy);
    if radius <= 0.0 {
        return None;
    }
    let away = center - cone.axis.origin;
    let (speed, along) = (cone.axis.direction.length(), away.dot(cone.axis.direction));
    let nearest = along / (speed * speed);
    let radius = radius + cone.spread * (nearest + radius / speed).clamp(0.0, cone.limits.far);
    let miss = (away - cone.axis.direction * nearest).length_squared();
    if miss > radius * radius {
        return None;
    }
    let half = (radius * radius - miss).sqrt() / speed;
    let (entry, exit) = ((nearest - half).max(cone.limits.near), (nearest + half).min(cone.limits.far));
    (entry <= exit).then_some(CopyVisit { copy, entry, exit })
}

/// Bounding sphere of a copy, in the space of the instancer: center and radius.
pub fn copy_sphere(instancer: &FlatInstancer, copy: &Copy) -> (DVec3, f64) {
    let (center, radius) = instancer.spheres[copy.kind as usize];
    (copy.position + copy.rotation * (copy.scale * center), radius * copy.scale.max_element())
}
