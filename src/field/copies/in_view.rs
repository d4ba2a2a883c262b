//! The copies that a camera shows: how many there are, and which are the nearest.

use glam::DVec3;

use super::instancer::{FlatInstancer, FlatLattice, PlaceList, Placement};
use super::variation::{Copy, copy_of_cell, copy_of_place};
use super::walk::copy_sphere;
use isolith_geometry::{Aabb, Camera};

/// Limits of a search for the copies in view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ViewLimits {
    /// Most copies.
    pub copies: usize,
    /// Most cells that are looked at.
    pub cells: u64,
}

/// The copies in view, as far as the limits allow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CopiesInView {
    /// The copies, the nearest first.
    pub all: Vec<Copy>,
    /// The depth beyond which others are left out; none if all are there.
    pub cut: Option<f64>,
}

/// Limits of [`copies_in_view`] for a number that is shown while the view moves: some milliseconds.
pub const COUNT_LIMITS: ViewLimits = ViewLimits { copies: 1 << 15, cells: 1 << 16 };

/// How much deeper each slab of the view is than the one before, as a share of its distance.
const SLAB_GROWTH: f64 = 0.1;

/// The copies whose bounding spheres a round cone around the picture meets. `margin`: how far copies of a list may
/// reach beyond their boxes.
pub fn copies_in_view(
    instancer: &FlatInstancer,
    margin: f64,
    camera: &Camera,
    aspect: f64,
    limits: ViewLimits,
) -> CopiesInView {
    let view = InView { instancer, margin, cone: ViewCone::new(instancer, camera, aspect), limits };
    let (mut found, mut cut) = (Vec::new(), None);
    match &instancer.placement {
        Placement::List(list) => view.look_through_list(list, &mut found),
        Placement::Lattice(lattice) => cut = view.look_through_lattice(lattice, &mut found),
    }
    found.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    if let Some((depth, _)) = found.get(limits.copies) {
        cut = Some(cut.map_or(*depth, |cut: f64| cut.min(*depth)));
        found.truncate(limits.copies);
    }
    // Of the last slab only a part may have been looked at.
    found.retain(|(depth, _)| cut.is_none_or(|cut| *depth <= cut));
    let cut = cut.map(|depth| depth.max(0.0) * instancer.least_scale());
    CopiesInView { all: found.into_iter().map(|(_, copy)| copy).collect(), cut }
}

/// A search.
struct InView<'a> {
    instancer: &'a FlatInstancer,
    margin: f64,
    cone: ViewCone,
    limits: ViewLimits,
}

/// Copies with their depths.
type Found = Vec<(f64, Copy)>;

impl InView<'_> {
    fn look(&self, copy: Copy, found: &mut Found) {
        let (center, radius) = copy_sphere(self.instancer, &copy);
        if self.cone.meets(center, radius) {
            found.push((self.cone.depth(copy.position), copy));
        }
    }

    fn look_through_list(&self, list: &PlaceList, found: &mut Found) {
        let mut open: Vec<usize> = if list.tree.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(index) = open.pop() {
            let node = &list.tree.nodes[index];
            if !self.cone.meets(node.bounds.center(), node.bounds.half().length() + self.margin) {
                continue;
            }
            if node.is_leaf() {
                copy_of_place(self.instancer, node.link as usize).into_iter().for_each(|copy| self.look(copy, found));
            } else {
                open.extend([node.link as usize, index + 1]);
            }
        }
    }

    /// Slab by slab across the view. Returns the depth beyond which none were looked at, if that is not the end.
    fn look_through_lattice(&self, lattice: &FlatLattice, found: &mut Found) -> Option<f64> {
        let reach = self.instancer.reach.length();
        let spacing = [0, 1, 2].map(|i| if lattice.is_long(i) { lattice.spacing[i] } else { f64::INFINITY });
        let thinnest = 4.0 * spacing.into_iter().fold(1e6, f64::min);
        let (mut near, mut end) = (-reach, self.cone.far + reach);
        let bounds = self.instancer.bounds();
        if bounds.is_finite() {
            let depths = bounds.corners().map(|corner| self.cone.depth(corner));
            near = depths.into_iter().fold(f64::INFINITY, f64::min).max(near);
            end = depths.into_iter().fold(f64::NEG_INFINITY, f64::max).min(end);
        }
        let mut cells = 0;
        while near <= end {
            let far = near + thinnest.max(SLAB_GROWTH * near);
            if !self.look_at(lattice, [near, far], &mut cells, found) {
                return Some(near);
            }
            near = far;
            if found.len() > self.limits.copies {
                return Some(far);
            }
        }
        None
    }

    /// Those between two depths; false if that is too much to look at.
    fn look_at(&self, lattice: &FlatLattice, [near, far]: [f64; 2], cells: &mut u64, found: &mut Found) -> bool {
        let reach = self.instancer.reach.length();
        let seen = self.cone.slab([near, far]).expanded(reach);
        let ranges = [0, 1, 2].map(|axis| {
            // Rows are shifted to either side.
            let slack = if axis == 0 { lattice.stagger } else { 0.0 };
            let [low, high] = [seen.min[axis] - slack, seen.max[axis] + slack]
                .map(|at| (at - lattice.shift[axis]) / lattice.spacing[axis]);
            [(low.ceil() as i32).max(lattice.low[axis]), (high.floor() as i32).min(lattice.high[axis])]
        });
        let count = |[low, high]: [i32; 2]| (i64::from(high) - i64::from(low) + 1).max(0) as u64;
        let all = ranges.into_iter().fold(1_u64, |all, range| all.saturating_mul(count(range)));
        *cells = cells.saturating_add(all);
        if *cells > self.limits.cells {
            return false;
        }
        for z in ranges[2][0]..=ranges[2][1] {
            for y in ranges[1][0]..=ranges[1][1] {
                for x in ranges[0][0]..=ranges[0][1] {
                    let place = lattice.place([x, y, z]);
                    let depth = self.cone.depth(place);
                    if depth >= near && depth < far && self.cone.meets(place, reach) {
                        let copy = copy_of_cell(self.instancer, [x, y, z]);
                        copy.into_iter().for_each(|copy| self.look(copy, found));
                    }
                }
            }
        }
        true
    }
}

/// A round cone around everything that a camera shows, in the space of an instancer.
struct ViewCone {
    eye: DVec3,
    /// Of unit length.
    forward: DVec3,
    /// Sine and cosine of its half angle.
    half: [f64; 2],
    /// The greatest depth.
    far: f64,
}

/// Half the height and width of the picture are widened by this factor, for the place within a pixel.
const PIXEL_SLACK: f64 = 1.01;

impl ViewCone {
    fn new(instancer: &FlatInstancer, camera: &Camera, aspect: f64) -> Self {
        let local_from_world = instancer.world_from_local.inverse();
        let up = PIXEL_SLACK * camera.tan_half_fov();
        let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y): (f64, f64)| {
            let corner = camera.rotation * DVec3::new(x * aspect * up, y * up, -1.0);
            local_from_world.transform_vector3(corner).normalize()
        });
        let forward = corners.iter().sum::<DVec3>().normalize();
        let cosine = corners.iter().map(|corner| corner.dot(forward)).fold(1.0, f64::min);
        Self {
            eye: local_from_world.transform_point3(camera.position),
            forward,
            half: [(1.0 - cosine * cosine).max(0.0).sqrt(), cosine],
            far: camera.far / instancer.least_scale(),
        }
    }

    fn depth(&self, point: DVec3) -> f64 {
        (point - self.eye).dot(self.forward)
    }

    /// Whether it may meet a sphere.
    fn meets(&self, center: DVec3, radius: f64) -> bool {
        let off = center - self.eye;
        let along = off.dot(self.forward);
        let aside = (off.length_squared() - along * along).max(0.0).sqrt();
        let [sine, cosine] = self.half;
        aside * cosine - along * sine <= radius && along >= -radius && along - radius <= self.far
    }

    /// The box around what it shows between two depths.
    fn slab(&self, [near, far]: [f64; 2]) -> Aabb {
        let [sine, cosine] = self.half;
        let radius = far.max(0.0) * sine / cosine.max(1e-3);
        let [a, b] = [near, far].map(|depth| self.eye + self.forward * depth);
        // A disc reaches less along its axis.
        let half = (DVec3::ONE - self.forward * self.forward).max(DVec3::ZERO) * radius * radius;
        let half = DVec3::from_array(half.to_array().map(f64::sqrt));
        Aabb { min: a.min(b) - half, max: a.max(b) + half }
    }
}
