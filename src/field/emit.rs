//! Writes the fold of one component into the arrays, relative to the component's origin.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::arrays::*;
use super::flat_texture::RepeatedSpace;
use super::lower_bound::{LowerBound, fold_bounds};
use super::modifier_table::modifier_payload_row;
use super::operand::{Operand, Value};
use super::prepare::first_texels;
use super::stack::shallow;
use isolith_bricks::BrickLevels;
use isolith_geometry::Aabb;
use isolith_scene::{BlendKernel, MarchSettings, MaterialId, ModifierKind, NodeId, ShapeKind};

/// A leaf's use of a material.
#[derive(Clone, Copy, Debug)]
pub(super) struct MaterialUse<'a> {
    /// The material.
    pub id: MaterialId,
    /// The space of the object, if textures of the material need it. Within modifiers that stay in the arrays it is
    /// that of the object before they act: the texture covers their result as a whole, and only arrays repeat it.
    pub object_from_world: Option<DAffine3>,
    /// The innermost array around it.
    pub repeated: Option<RepeatedSpace>,
    /// The model whose looks it shows.
    pub looks: Option<&'a Arc<BrickLevels>>,
}

impl MaterialUse<'_> {
    /// A material as it is, wherever the object stands.
    pub fn plain(id: MaterialId) -> Self {
        Self { id, object_from_world: None, repeated: None, looks: None }
    }
}

/// The space that a fold is in.
struct Within {
    /// The point that its numbers are relative to.
    origin: DVec3,
    /// The world, or the local space of the enclosing modifier.
    space_from_world: DAffine3,
    /// The innermost array around it.
    repeated: Option<RepeatedSpace>,
}

/// Appends the component's entries and returns its description.
pub(super) fn emit(
    flat: &mut FlatScene,
    operands: &[Operand<'_>],
    material: &mut dyn FnMut(&mut FlatScene, MaterialUse<'_>) -> u32,
) -> Component {
    let bounds = fold_bounds(operands).bounds;
    let shallow = shallow(operands);
    let operands = shallow.as_deref().unwrap_or(operands);
    let origin = origin_of(&bounds, operands);
    let first = flat.nodes.len();
    let params = flat.params.len().next_multiple_of(ROW_ALIGNMENT);
    flat.params.resize(params, [0.0; 4]);
    let within = Within { origin, space_from_world: DAffine3::IDENTITY, repeated: None };
    let stack = emit_fold(flat, operands, &within, material);
    let data = flat.params.len();
    emit_data(flat, operands, &mut (first..));
    let can_cancel = can_cancel(operands);
    let mut modifier_domains = Vec::new();
    let entries = || (first..).map(|at| (at - first, flat.nodes[at].is_run()));
    collect_domains(operands, 1, &mut entries(), &mut modifier_domains);
    let mut rest = Vec::new();
    if reach(flat, first, &bounds) > LARGE {
        rest.resize(flat.nodes.len() - first, [[0.0; 4]; 3]);
        collect_rest(operands, origin, &mut entries(), &mut rest);
    }
    Component {
        first: first as u32,
        count: (flat.nodes.len() - first) as u32,
        params: params as u32,
        param_rows: (flat.params.len() - params) as u32,
        payload_rows: (flat.params.len() - data) as u32,
        origin,
        bounds: bounds.translated(-origin),
        half_space: half_space(operands, origin),
        flush_extent: if can_cancel { extent(operands, origin, &extent_of_leaf) } else { 0.0 },
        flush_placement: if can_cancel { extent(operands, origin, &placement_of_leaf) } else { 0.0 },
        stack,
        modifier_domains,
        copies: operands.iter().map(copies).max().unwrap_or(1),
        rest,
        top: operands.first().map_or(NodeId(0), |first| first.outermost.id),
        march: MarchSettings::default(),
        instanced: None,
    }
}

/// The size of the numbers of the component whose entries begin at `first`: that of its bounds, or the largest
/// distance from its origin to where its shapes and modifiers stand.
fn reach(flat: &FlatScene, first: usize, bounds: &Aabb) -> f64 {
    let size = if bounds.is_finite() { bounds.half().max_element() } else { 0.0 };
    let farthest = |node: &FlatNode| {
        let placing = &flat.params[node.params as usize + node.placing_row()?..][..3];
        Some(placing.iter().fold(0.0_f64, |most, row| most.max(f64::from(row[3].abs()))))
    };
    flat.nodes[first..].iter().filter_map(farthest).fold(size, f64::max)
}

/// Most evaluations of a leaf of the operand for one point.
fn copies(operand: &Operand<'_>) -> u32 {
    match &operand.value {
        Value::Leaf { .. } => 1,
        Value::Fold(inner) => inner.iter().map(copies).max().unwrap_or(1),
        Value::Modified { content, modified, .. } => {
            content.iter().map(copies).max().unwrap_or(1).saturating_mul(modified.copies)
        }
    }
}

/// The center of the bounds, where f32 is finest. Without bounds, the center of the first bounded operand, or else
/// the position of the first operand.
fn origin_of(bounds: &Aabb, operands: &[Operand<'_>]) -> DVec3 {
    if bounds.is_finite() {
        return bounds.center();
    }
    if let Some(bounded) = operands.iter().find(|o| o.bounds.is_finite()) {
        return bounded.bounds.center();
    }
    match &operands[0].value {
        Value::Leaf { local_from_world, .. } => local_from_world.inverse().translation,
        Value::Modified { local_from_world, .. } => local_from_world.inverse().translation,
        Value::Fold(inner) => origin_of(bounds, inner),
    }
}

/// See [`Component::half_space`]: a plane that later operands only cut stays in its half space.
fn half_space(operands: &[Operand<'_>], origin: DVec3) -> Option<[f64; 4]> {
    let Value::Leaf { local_from_world, prepared, .. } = &operands[0].value else { return None };
    if prepared.kind != ShapeKind::Plane || !operands[1..].iter().all(|o| o.join.only_cuts()) {
        return None;
    }
    // The plane's inside is local y < 0.
    let row = local_from_world.matrix3.row(1);
    let length = row.length();
    let normal = row / length;
    Some([normal.x, normal.y, normal.z, local_from_world.transform_point3(origin).y / length])
}

/// Whether the field of one operand can end where that of another begins: in all joins but unions.
fn can_cancel(operands: &[Operand<'_>]) -> bool {
    operands.iter().any(|operand| {
        let below = match &operand.value {
            Value::Leaf { .. } => false,
            Value::Fold(inner) | Value::Modified { content: inner, .. } => can_cancel(inner),
        };
        below || !matches!(operand.join, Join::First | Join::Union)
    })
}

/// The greatest number of `of_leaf` for all leaves, relative to `origin` or to the local space of the enclosing
/// modifier.
fn extent(operands: &[Operand<'_>], origin: DVec3, of_leaf: &dyn Fn(&Operand<'_>, DVec3) -> f64) -> f64 {
    let of = |operand: &Operand<'_>| match &operand.value {
        Value::Leaf { .. } => of_leaf(operand, origin),
        Value::Fold(inner) => extent(inner, origin, of_leaf),
        // How far a point is from the origin of this space is not known.
        Value::Modified { content, .. } => extent(content, DVec3::ZERO, &extent_of_leaf),
    };
    operands.iter().map(of).fold(0.0, f64::max)
}

/// The largest coordinate of a leaf's bounds; for an unbounded leaf its distance.
fn extent_of_leaf(operand: &Operand<'_>, origin: DVec3) -> f64 {
    if !operand.bounds.is_finite() {
        return distance_of_leaf(operand, origin);
    }
    let bounds = operand.bounds.translated(-origin);
    bounds.min.abs().max(bounds.max.abs()).max_element()
}

/// The distance of shapes that compare a coordinate of the point with their size; for others, which subtract points of
/// their own, their extent.
fn placement_of_leaf(operand: &Operand<'_>, origin: DVec3) -> f64 {
    let Value::Leaf { prepared, .. } = &operand.value else { return 0.0 };
    match prepared.kind {
        ShapeKind::Box | ShapeKind::Sphere | ShapeKind::Cylinder => distance_of_leaf(operand, origin),
        _ => extent_of_leaf(operand, origin),
    }
}

/// The distance of a leaf's own origin; of a plane, the distance to it.
fn distance_of_leaf(operand: &Operand<'_>, origin: DVec3) -> f64 {
    let Value::Leaf { local_from_world, distance_scale, prepared, .. } = &operand.value else { return 0.0 };
    let local = local_from_world.transform_point3(origin);
    let far = if prepared.kind == ShapeKind::Plane { local.y.abs() } else { local.length() };
    far * distance_scale
}

/// Appends the payloads of all leaves and modifiers; `entries` are the entries from here on, in the order of writing.
fn emit_data(flat: &mut FlatScene, operands: &[Operand<'_>], entries: &mut dyn Iterator<Item = usize>) {
    for operand in operands {
        let mut entry = || entries.next().expect("all were written");
        let mut at = entry();
        while flat.nodes[at].is_run() {
            at = entry();
        }
        let (behind, data) = match &operand.value {
            Value::Fold(_) => (None, &[][..]),
            Value::Modified { kind, modified, .. } => {
                (modifier_payload_row(*kind).map(|row| MODIFIER_ROWS + row), &*modified.data)
            }
            Value::Leaf { prepared, .. } => (payload_row(prepared.kind), &*prepared.payload),
        };
        if let Some(behind) = behind {
            let row = flat.nodes[at].params as usize + behind;
            // Exact: there are far fewer rows than f32 can count.
            let [count, offset] = [data.len(), flat.params.len() - row].map(|v| v as f32);
            flat.params[row] = [count, offset, 0.0, 0.0];
            flat.params.extend(data.iter().map(|row| row.map(|v| v as f32)));
            if let Value::Leaf { prepared, .. } = &operand.value
                && let Some(bricks) = &prepared.bricks
            {
                // Exact: there are fewer texels than f32 can count.
                let first = flat.bricks.place(bricks) as f32;
                first_texels(bricks, |at| flat.params[row + offset as usize + at][3] += first);
            }
        }
        if let Value::Fold(inner) | Value::Modified { content: inner, .. } = &operand.value {
            emit_data(flat, inner, entries);
        }
    }
}

/// Appends the domains of modifiers; `entries` are the entries from here on, in the order of writing, and whether
/// each is a run. The operands are evaluated up to `copies` times for one point.
fn collect_domains(
    operands: &[Operand<'_>],
    copies: u32,
    entries: &mut impl Iterator<Item = (usize, bool)>,
    out: &mut Vec<ModifierDomain>,
) {
    for operand in operands {
        let (entry, _) = entries.find(|(_, is_run)| !is_run).expect("all were written");
        match &operand.value {
            Value::Fold(inner) => collect_domains(inner, copies, entries, out),
            Value::Modified { content, modified, .. } => {
                let LowerBound { bounds, cull_box, bound_slope, .. } = fold_bounds(content);
                let copies = copies.saturating_mul(modified.copies);
                out.push(ModifierDomain { entry: entry as u32, bounds, cull_box, bound_slope, copies });
                collect_domains(content, copies, entries, out);
            }
            Value::Leaf { .. } => {}
        }
    }
}

/// Consecutive operands that join alike get runs from this number on.
const LEAST_IN_ROW: usize = 10;
/// A run holds at most about this many operands or runs.
const RUN_LENGTH: usize = 6;

/// Writes a fold, with runs before long rows of bounded operands that join alike. Returns how many accumulators an
/// evaluator has to put aside within it.
fn emit_fold(
    flat: &mut FlatScene,
    operands: &[Operand<'_>],
    within: &Within,
    material: &mut dyn FnMut(&mut FlatScene, MaterialUse<'_>) -> u32,
) -> u32 {
    let alike = |a: &Operand<'_>, b: &Operand<'_>| {
        let skippable = |o: &Operand<'_>| o.bound_slope > 0.0 && o.join.is_skipped_far_off();
        a.join == b.join && skippable(a) && skippable(b)
    };
    let mut stack = 0;
    for row in operands.chunk_by(alike) {
        stack = stack.max(if row.len() >= LEAST_IN_ROW {
            emit_runs(flat, row, within, material)
        } else {
            row.iter().map(|operand| emit_operand(flat, operand, within, material)).max().unwrap_or(0)
        });
    }
    stack
}

/// Writes operands that join alike as runs, with runs of runs if there are many.
fn emit_runs(
    flat: &mut FlatScene,
    row: &[Operand<'_>],
    within: &Within,
    material: &mut dyn FnMut(&mut FlatScene, MaterialUse<'_>) -> u32,
) -> u32 {
    let mut stack = 0;
    for run in row.chunks(row.len().div_ceil(RUN_LENGTH).max(RUN_LENGTH)) {
        let index = flat.nodes.len();
        let params = flat.params.len() as u32;
        let code = FlatNode::RUN | ((run[0].join as u32) << 16);
        flat.ids.push(run[0].node.id);
        flat.nodes.push(FlatNode { code, extent: 0, params, material: 0 });
        let bounds = run.iter().fold(Aabb::EMPTY, |all, o| all.union(&o.cull_box)).translated(-within.origin);
        let bound_slope = run.iter().map(|o| o.bound_slope).fold(f64::INFINITY, f64::min);
        let support = run.iter().map(|o| o.blend.support()).fold(0.0, f64::max);
        flat.params.extend(bounding_rows([support as f32, 0.0, 0.0], bound_slope, &bounds));
        stack = stack.max(if run.len() > RUN_LENGTH {
            emit_runs(flat, run, within, material)
        } else {
            run.iter().map(|operand| emit_operand(flat, operand, within, material)).max().unwrap_or(0)
        });
        flat.nodes[index].extent = (flat.nodes.len() - index) as u32;
    }
    stack
}

/// The rows of a group or run. Rounding to f32 must never shrink the bounds or raise the slope.
fn bounding_rows([support, size, depth]: [f32; 3], bound_slope: f64, bounds: &Aabb) -> [ParamRow; GROUP_ROWS] {
    if bound_slope <= 0.0 {
        return [[support, 0.0, size, depth], [0.0; 4], [0.0; 4]];
    }
    let (center, half) = (bounds.center(), bounds.half());
    let half = (half + (half + center.abs()) * 1e-6).as_vec3();
    let center = center.as_vec3();
    let bound_slope = (bound_slope * (1.0 - 1e-6)) as f32;
    [[support, bound_slope, size, depth], [center.x, center.y, center.z, 0.0], [half.x, half.y, half.z, 0.0]]
}

/// Local-from-component, before rounding.
fn exact_placing(local_from_world: &DAffine3, origin: DVec3) -> [[f64; 4]; 3] {
    let shift = local_from_world.transform_point3(origin);
    [0, 1, 2].map(|row| local_from_world.matrix3.row(row).extend(shift[row]).to_array())
}

/// Local-from-component, rounded to f32.
fn placing_rows(local_from_world: &DAffine3, origin: DVec3) -> [ParamRow; 3] {
    exact_placing(local_from_world, origin).map(|row| row.map(|v| v as f32))
}

/// Collects [`Component::rest`]; `entries` are the entries from here on, in the order of writing, and whether each is
/// a run.
fn collect_rest(
    operands: &[Operand<'_>],
    origin: DVec3,
    entries: &mut impl Iterator<Item = (usize, bool)>,
    out: &mut [[ParamRow; 3]],
) {
    for operand in operands {
        let (entry, _) = entries.find(|(_, is_run)| !is_run).expect("all were written");
        let (local_from_world, inner) = match &operand.value {
            Value::Leaf { local_from_world, .. } => (Some(local_from_world), None),
            Value::Fold(inner) => (None, Some((inner, origin))),
            Value::Modified { local_from_world, content, .. } => (Some(local_from_world), Some((content, DVec3::ZERO))),
        };
        if let Some(local_from_world) = local_from_world {
            let exact = exact_placing(local_from_world, origin);
            out[entry] = exact.map(|row| row.map(|v| (v - f64::from(v as f32)) as f32));
        }
        if let Some((inner, origin)) = inner {
            collect_rest(inner, origin, entries, out);
        }
    }
}

/// Writes an operand. Returns how many accumulators an evaluator has to put aside within it.
fn emit_operand(
    flat: &mut FlatScene,
    operand: &Operand<'_>,
    within: &Within,
    material: &mut dyn FnMut(&mut FlatScene, MaterialUse<'_>) -> u32,
) -> u32 {
    let index = flat.nodes.len();
    let params = flat.params.len() as u32;
    let kernel = BlendKernel::ALL.iter().position(|k| *k == operand.blend.kernel).expect("ALL holds every kernel");
    let code = |what: u32| what | ((operand.join as u32) << 16) | ((kernel as u32) << 24);
    let blend_params = [operand.blend.support(), operand.detail[0], operand.detail[1]].map(|v| v as f32);
    flat.ids.push(operand.node.id);
    match &operand.value {
        Value::Leaf { local_from_world, distance_scale, prepared, material: id, object_from_world } => {
            let object_from_world = object_from_world.as_deref().map(|object| *object * within.space_from_world);
            let looks = prepared.bricks.as_ref().filter(|_| prepared.has_looks);
            let user = MaterialUse { id: *id, object_from_world, repeated: within.repeated, looks };
            let material = material(flat, user);
            flat.nodes.push(FlatNode { code: code(prepared.kind as u32), extent: 1, params, material });
            flat.params.push([blend_params[0], *distance_scale as f32, blend_params[1], blend_params[2]]);
            flat.params.extend(placing_rows(local_from_world, within.origin));
            let packed = prepared.parameters.map(|v| v as f32);
            let rows = prepared.kind.parameter_rows();
            flat.params.extend(packed.chunks_exact(4).take(rows).map(|c| [c[0], c[1], c[2], c[3]]));
            // A placeholder: `emit_data` writes the location of the payload here.
            flat.params.extend(payload_row(prepared.kind).map(|_| [0.0; 4]));
            0
        }
        Value::Fold(inner) => {
            flat.nodes.push(FlatNode { code: code(FlatNode::GROUP), extent: 0, params, material: 0 });
            flat.params.extend(bounding_rows(
                blend_params,
                operand.bound_slope,
                &operand.cull_box.translated(-within.origin),
            ));
            let stack = emit_fold(flat, inner, within, material);
            flat.nodes[index].extent = (flat.nodes.len() - index) as u32;
            stack + 1
        }
        Value::Modified { local_from_world, distance_scale, kind, modified, content } => {
            let marker = FlatNode::MODIFIER + *kind as u32;
            flat.nodes.push(FlatNode { code: code(marker), extent: 0, params, material: 0 });
            let mut bounding =
                bounding_rows(blend_params, operand.bound_slope, &operand.cull_box.translated(-within.origin));
            bounding[1][3] = *distance_scale as f32;
            flat.params.extend(bounding);
            flat.params.extend(placing_rows(local_from_world, within.origin));
            flat.params.extend(modified.rows.iter().map(|row| row.map(|v| v as f32)));
            let space_from_world = *local_from_world * within.space_from_world;
            let repeats = *kind == ModifierKind::Repeat;
            let own = repeats.then(|| RepeatedSpace::new(&modified.rows, &space_from_world)).flatten();
            let inner = Within { origin: DVec3::ZERO, space_from_world, repeated: own.or(within.repeated) };
            let stack = emit_fold(flat, content, &inner, material);
            flat.nodes[index].extent = (flat.nodes.len() - index) as u32;
            stack + 1
        }
    }
}
