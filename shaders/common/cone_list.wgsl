// The list of subtiles that a cone pass writes.

#include "common/dispatch.wgsl"
#include "common/subtiles.wgsl"

@group(2) @binding(0) var hiz_target: texture_2d<f32>;
@group(2) @binding(1) var<storage, read_write> subtiles: array<Subtile>;
// SUBTILE_COUNTS words per list.
@group(2) @binding(2) var<storage, read_write> subtile_counts: array<atomic<u32>>;

// Start of a subtile that needs no rays.
const CONE_PASSED: f32 = 3e38;

// Lists the subtiles of a tile that need rays, each with its start and the descent of the field
// there.
fn cone_list(place: vec2u, start: ptr<function, array<f32, 4>>, descents: ptr<function, array<f32, 4>>) {
    var count = 0u;
    for (var i = 0u; i < 4u; i += 1u) {
        count += select(0u, 1u, (*start)[i] < CONE_PASSED);
    }
    if count > 0u {
        let list = dispatch.list * SUBTILE_COUNTS;
        var slot = atomicAdd(&subtile_counts[list + 4u], count);
        atomicMax(&subtile_counts[list], (slot + count + 3u) / 4u);
        for (var i = 0u; i < 4u; i += 1u) {
            if (*start)[i] < CONE_PASSED {
                let subtile = Subtile(subtile_pack(cone_subtile(place, i)), (*start)[i], (*descents)[i]);
                subtiles[dispatch.first_subtile + slot] = subtile;
                slot += 1u;
            }
        }
    }
}

// Column and row of a quarter of the tile among all subtiles.
fn cone_subtile(place: vec2u, quarter: u32) -> vec2u {
    return place * 2u + vec2u(quarter & 1u, quarter >> 1u);
}

// The farthest depth of a subtile; 0 outside the picture.
fn cone_hiz(place: vec2u, quarter: u32) -> f32 {
    let subtile = cone_subtile(place, quarter);
    return select(0.0, textureLoad(hiz_target, subtile, 0).x, view_contains(subtile * SUBTILE));
}

// The farthest depth of a tile.
fn cone_hiz_of_tile(place: vec2u) -> f32 {
    return max(
        max(cone_hiz(place, 0u), cone_hiz(place, 1u)),
        max(cone_hiz(place, 2u), cone_hiz(place, 3u)),
    );
}
