//! The parameters of a component relative to another point than its origin.
//!
//! Flattening rounds them relative to the origin, which suits a view from as far off as the component is large. Next
//! to a detail of a component that is a thousand times larger, f32 is too coarse for that: the renderer then gets the
//! same parameters relative to a point near the eye, computed in f64 with the residue of rounding.

use glam::DVec3;

use super::arrays::{Component, FlatNode, FlatScene, MODIFIER_ROWS, ParamRow};
use super::modifier_params::{RepeatParams, params_of, write_params};
use isolith_scene::ModifierKind;

/// Rewrites the rows of `component` in `params`, which are those of `flat`, relative to the point at `shift` from its
/// origin.
pub fn move_params(flat: &FlatScene, component: &Component, shift: DVec3, params: &mut [ParamRow]) {
    let mut at = component.first as usize;
    let end = at + component.count as usize;
    while at < end {
        let node = &flat.nodes[at];
        let rows = &mut params[node.params as usize..];
        if let (Some(first), Some(placing)) = (node.placing_row(), component.placing(flat, at)) {
            let mut local = DVec3::from_array(placing.map(|[x, y, z, w]| x * shift.x + y * shift.y + z * shift.z + w));
            if node.modifier() == Some(ModifierKind::Repeat) {
                local -= move_repeat(local, &mut rows[MODIFIER_ROWS..]);
            }
            for (row, moved) in rows[first..].iter_mut().zip(local.to_array()) {
                row[3] = moved as f32;
            }
        }
        // Groups, runs and modifiers have bounds if they have a slope. These bounds have more margin than rounding
        // moves.
        if !node.is_leaf() && rows[0][1] > 0.0 {
            for (center, moved) in rows[1].iter_mut().zip(shift.to_array()) {
                *center = (f64::from(*center) - moved) as f32;
            }
        }
        // The content of a modifier has a space of its own.
        at += step(node);
    }
}

/// Steps to the next entry in the same space.
fn step(node: &FlatNode) -> usize {
    if node.modifier().is_some() { node.extent as usize } else { 1 }
}

/// Counts the cells of a repetition from one near `local`, a point in its space; `rows` are its own. Returns the
/// position of that cell.
fn move_repeat(local: DVec3, rows: &mut [ParamRow]) -> DVec3 {
    let mut params: RepeatParams = params_of(rows);
    // The turn of a cell follows from its number, so the cells keep their numbers.
    if params.turn != 0.0 {
        return DVec3::ZERO;
    }
    let [spacing, first, last, middle, offset] =
        [params.spacing, params.first, params.last, params.middle, params.offset].map(DVec3::from);
    let mut cell = DVec3::ZERO;
    // The cell along Y shifts rows along X.
    for axis in [1, 2, 0] {
        let beside = if axis == 0 { offset.x * cell.y } else { 0.0 };
        let count = ((local[axis] - beside - middle[axis]) / spacing[axis]).clamp(first[axis], last[axis]);
        // If every other cell is mirrored, only an even cell can replace the first.
        cell[axis] = if params.mirrored >> axis & 1 == 1 { (0.5 * count).round() * 2.0 } else { count.round() };
    }
    let place = cell * spacing + DVec3::new(offset.x * cell.y, offset.y * cell.x, offset.z * cell.x);
    let RepeatParams { first, last, carve_from, carve_to, least, greatest, .. } = &mut params;
    let corners = [first, last, carve_from, carve_to].map(|corner| (corner, cell));
    for (corner, by) in corners.into_iter().chain([least, greatest].map(|corner| (corner, place))) {
        *corner = (DVec3::from(*corner) - by).to_array();
    }
    write_params(&params, rows);
    place
}
