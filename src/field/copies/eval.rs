//! The field of all copies of one type. Counterpart of `shaders/copy/value.wgsl`.
//!
//! The value at a point is the least of max(field, distance to the bounding sphere) over the copies nearby, and never
//! more than the distance from which on copies are not looked at. It is continuous, since it depends on no cell border:
//! a copy that is left out could not be the least.

use glam::{DAffine3, DVec3};

use super::instancer::{FlatInstancer, FlatLattice, Placement};
use super::variation::{Copy, copy_of_cell, copy_of_place};
use super::walk::copy_sphere;
use crate::eval::{SurfacePoint, field, gradient, surface};
use crate::{Component, FlatScene};

/// Shells of cells beyond the reach of copies that are looked at.
const SHELLS: i32 = 1;

/// The nearest copy to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestCopy {
    /// The value of the field of all copies.
    pub value: f64,
    /// The copy that has it; `None` where none is near.
    pub copy: Option<Copy>,
}

/// World from the space of a copy.
pub fn world_from_copy(instancer: &FlatInstancer, copy: &Copy) -> DAffine3 {
    instancer.world_from_local * copy.instancer_from_copy()
}

/// The copy of `component`'s type that is nearest to a point of the world.
pub fn nearest_copy(flat: &FlatScene, component: &Component, point: DVec3) -> NearestCopy {
    let Some(of) = component.instanced else { return NearestCopy { value: f64::INFINITY, copy: None } };
    let instancer = &flat.instancers[of.instancer as usize];
    let local = instancer.world_from_local.inverse().transform_point3(point);
    let mut nearest = NearestCopy { value: f64::INFINITY, copy: None };
    let consider = |copy: Copy, floor: f64, nearest: &mut NearestCopy| {
        if copy.kind != of.kind {
            return;
        }
        let (center, radius) = copy_sphere(instancer, &copy);
        // Outside of its box, the distance to that is a bound as well.
        let sphere = (local.distance(center) - radius).max(if floor > 0.0 { floor } else { f64::NEG_INFINITY });
        if sphere >= nearest.value {
            return;
        }
        let q = copy.instancer_from_copy().inverse().transform_point3(local);
        let own = field(flat, component, q - component.origin) * copy.scale.min_element();
        let value = if sphere > 0.0 { own.max(sphere) } else { own };
        if value < nearest.value {
            *nearest = NearestCopy { value, copy: Some(copy) };
        }
    };
    let beyond = match &instancer.placement {
        Placement::Lattice(lattice) => {
            each_near(instancer, lattice, local, &mut |copy| consider(copy, f64::NEG_INFINITY, &mut nearest))
        }
        Placement::List(list) => {
            let mut open: Vec<usize> = if list.tree.nodes.is_empty() { Vec::new() } else { vec![0] };
            while let Some(index) = open.pop() {
                let node = &list.tree.nodes[index];
                // No value below is less: those of copies are no less than the distance to their boxes.
                let floor = node.bounds.distance(local);
                if floor > 0.0 && floor >= nearest.value {
                    continue;
                }
                if !node.is_leaf() {
                    let [left, right] = [index + 1, node.link as usize];
                    let is_left =
                        list.tree.nodes[left].bounds.distance(local) <= list.tree.nodes[right].bounds.distance(local);
                    open.extend(if is_left { [right, left] } else { [left, right] });
                } else if let Some(copy) = copy_of_place(instancer, node.link as usize) {
                    consider(copy, floor, &mut nearest);
                }
            }
            f64::INFINITY
        }
    };
    let value = nearest.value.min(beyond) * instancer.least_scale();
    NearestCopy { value, copy: nearest.copy.filter(|_| nearest.value <= beyond) }
}

/// Visits the copies of all cells near a point. Returns a lower bound of the distance to all others.
fn each_near(instancer: &FlatInstancer, lattice: &FlatLattice, point: DVec3, visit: &mut dyn FnMut(Copy)) -> f64 {
    let home = lattice.nearest(point);
    let long = |axis: &usize| lattice.is_long(*axis);
    let spacing = (0..3).filter(long).map(|axis| lattice.spacing[axis]).fold(f64::INFINITY, f64::min);
    let reach = (0..3).filter(long).map(|axis| instancer.reach[axis]).fold(0.0, f64::max) + lattice.stagger;
    // Shells from which copies come near at all.
    let shells = if spacing.is_finite() { (reach / spacing + 0.5).ceil() as i32 + SHELLS } else { 0 };
    let range = |axis: usize| {
        let low = home[axis].saturating_sub(shells).max(lattice.low[axis]);
        let high = home[axis].saturating_add(shells).min(lattice.high[axis]);
        low..=high
    };
    for z in range(2) {
        for y in range(1) {
            for x in range(0) {
                copy_of_cell(instancer, [x, y, z]).into_iter().for_each(&mut *visit);
            }
        }
    }
    (f64::from(shells) + 0.5) * spacing - reach
}

/// The field of a component at a point of the world.
pub fn world_field(flat: &FlatScene, component: &Component, point: DVec3) -> f64 {
    match component.instanced {
        None => field(flat, component, point - component.origin),
        Some(_) => nearest_copy(flat, component, point).value,
    }
}

/// The field of a component and its gradient, at a point of the world. Where no copy is near, the gradient is zero.
pub fn world_gradient(flat: &FlatScene, component: &Component, point: DVec3) -> (f64, DVec3) {
    let Some((copy, nearest, local)) = copy_near(flat, component, point) else {
        return match component.instanced {
            None => gradient(flat, component, point - component.origin),
            Some(_) => (nearest_copy(flat, component, point).value, DVec3::ZERO),
        };
    };
    let (_, of_copy) = gradient(flat, component, local.transform_point3(point) - component.origin);
    (nearest, local.matrix3.transpose() * of_copy * copy)
}

/// The surface of a component near a point of the world.
pub fn world_surface(flat: &FlatScene, component: &Component, point: DVec3) -> SurfacePoint {
    let Some((factor, value, local)) = copy_near(flat, component, point) else {
        return surface(flat, component, point - component.origin);
    };
    let found = surface(flat, component, local.transform_point3(point) - component.origin);
    SurfacePoint { distance: value, gradient: local.matrix3.transpose() * found.gradient * factor, ..found }
}

/// The space of the copy that is nearest to a point of the world; `None` for components that are no type of an
/// instancer.
pub fn copy_from_world(flat: &FlatScene, component: &Component, point: DVec3) -> Option<DAffine3> {
    copy_near(flat, component, point).map(|(.., copy_from_world)| copy_from_world)
}

/// The factor on the field of the nearest copy, the value, and copy from world.
fn copy_near(flat: &FlatScene, component: &Component, point: DVec3) -> Option<(f64, f64, DAffine3)> {
    let of = component.instanced?;
    let instancer = &flat.instancers[of.instancer as usize];
    let nearest = nearest_copy(flat, component, point);
    let copy = nearest.copy?;
    let factor = copy.scale.min_element() * instancer.least_scale();
    Some((factor, nearest.value, world_from_copy(instancer, &copy).inverse()))
}
