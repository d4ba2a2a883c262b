// Joins of surfaces, for the interpreter and the tape evaluators. The derivatives of the blend mix
// the gradients, the weight of the joining operand mixes the materials.

#include "field/leaf.wgsl"
#include "field/surface.wgsl"
#include "generated/gradients.wgsl"

// Joins a group that has ended, `so_far`, to the result before it.
fn joined_surface(join: u32, kernel: u32, blend_params: vec4f, before: Surface, so_far: Surface) -> Surface {
    if join == JOIN_FIRST {
        return so_far;
    }
    let joined = op_join(join, before.distance, so_far.distance, blend_params, kernel);
    let w = joined.w;
    return Surface(
        joined.x,
        select(before.leaf, so_far.leaf, w > 0.5),
        before.gradient * joined.y + so_far.gradient * joined.z,
        mixture_joined(before.materials, so_far.materials, w),
    );
}

// Joins the leaf at the entry `at`, whose rows begin at `row`. Computes gradient and material only
// where the surface follows the leaf.
fn joined_surface_leaf(at: u32, shape: u32, join: u32, kernel: u32, row: u32, before: Surface, p: vec3f) -> Surface {
    let blend_params = scene_row(row);
    let distance = leaf_distance(shape, row, blend_params, p);
    var joined = vec4f(distance, 0.0, 1.0, 1.0);
    if join != JOIN_FIRST {
        joined = op_join(join, before.distance, distance, blend_params, kernel);
    }
    let w = joined.w;
    var so_far = before;
    so_far.gradient = before.gradient * joined.y;
    so_far.distance = joined.x;
    so_far.leaf = select(before.leaf, at, w > 0.5);
    if w > 0.0 || joined.z != 0.0 {
        so_far.gradient += joined_surface_gradient(shape, row, blend_params, p) * joined.z;
        let left = Mixture(before.materials.ids, before.materials.weights * (1.0 - w));
        so_far.materials = mixture_add(left, nodes[at].material, w);
    }
    return so_far;
}

// Gradient of a leaf's distance along the component's axes.
fn joined_surface_gradient(shape: u32, row: u32, blend_params: vec4f, p: vec3f) -> vec3f {
    let d = shape_gradient(shape, leaf_place(row, p), row + LEAF_ROWS) * blend_params.y;
    return scene_row(row + 1u).xyz * d.x + scene_row(row + 2u).xyz * d.y + scene_row(row + 3u).xyz * d.z;
}
