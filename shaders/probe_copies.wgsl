// Not a pass: copies of given cells and those along given rays, for the tests that compare them with
// the CPU's.

#include "copy/material.wgsl"
#include "copy/walk.wgsl"

struct CopyQuery {
    // A cell, relative to the anchor, or a place; or the origin of a ray, relative to the eye.
    cell: vec3i,
    kind: u32,
    origin: vec3f,
    spread: f32,
    direction: vec3f,
    far: f32,
}

struct CopyAnswer {
    cell: vec3i,
    kind: u32,
    position: vec3f,
    hue: f32,
    rotation: vec4f,
    scale: vec3f,
    emission: f32,
    // Hue, saturation, value, roughness of the material; then its replacement and its emission.
    color: vec4f,
    replaced: u32,
    glow: f32,
    // Number of copies along the ray, and the sum of their entries.
    visits: u32,
    entries: f32,
}

@group(0) @binding(0) var<storage, read> queries: array<CopyQuery>;
@group(0) @binding(1) var<storage, read_write> answers: array<CopyAnswer>;

fn probe_answer(copy: Copy, visits: u32, entries: f32) -> CopyAnswer {
    let look = copy_material(copy);
    return CopyAnswer(
        copy.cell,
        copy.kind,
        copy.position,
        copy.hue,
        copy.rotation,
        copy.scale,
        copy.emission,
        vec4f(look.hue, look.saturation, look.value, look.roughness),
        look.replaced,
        look.emission,
        visits,
        entries,
    );
}

@compute @workgroup_size(64)
fn probe_cells(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&queries) {
        let query = queries[id.x];
        var copy = copy_none();
        if instancer.tree_count > 0u {
            copy = copy_of_place(u32(query.cell.x), query.kind);
        } else {
            copy = copy_of_cell(query.cell, query.kind);
        }
        answers[id.x] = probe_answer(copy, 0u, 0.0);
    }
}

@compute @workgroup_size(64)
fn probe_walks(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&queries) {
        let query = queries[id.x];
        let origin = instancer_local_point(query.origin);
        let direction = instancer_local_direction(query.direction);
        var walk = copy_walk_begin(query.kind, origin, direction, 0.0, query.far, query.spread, 20000u);
        var found: CopyVisit;
        var visits = 0u;
        var entries = 0.0;
        while copy_walk_next(&walk, query.kind, query.far, &found) {
            visits += 1u;
            entries += found.entry;
        }
        answers[id.x] = probe_answer(copy_none(), select(visits, 0xffffffffu, walk.exhausted), entries);
    }
}
