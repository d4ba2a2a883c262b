// Pass `cone`: one invocation for each tile. A cone around all the tile's rays is marched through the
// component; what it passes without touching, no ray of the tile needs to look at. Tiles in which it
// touches nothing, or only what is hidden, are dropped; the others are listed with a safe start.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/work.wgsl"
#include "common/tiles.wgsl"
#include "generated/value.wgsl"
#include "common/bounds.wgsl"

@group(2) @binding(0) var farthest_target: texture_2d<f32>;
@group(2) @binding(1) var<storage, read_write> tiles: array<Tile>;
// For each list the arguments of an indirect dispatch: tiles, 1, 1, evaluations made here.
@group(2) @binding(2) var<storage, read_write> tile_counts: array<atomic<u32>>;

// Steps before the cone leaves the rest to the rays.
const CONE_STEPS: u32 = 48u;
// The cone stops where the surface may be nearer to its border than this, in footprints.
const CONE_CLEARANCE: f32 = 0.25;

@compute @workgroup_size(64)
fn cone(@builtin(global_invocation_id) id: vec3u) {
    let columns = (work.end.x - work.origin.x + TILE - 1u) / TILE;
    let rows = (work.end.y - work.origin.y + TILE - 1u) / TILE;
    if id.x >= columns * rows {
        return;
    }
    let place = work.origin / TILE + vec2u(id.x % columns, id.x / columns);
    let component = components[work.component];
    field_begin(component);

    // The axis, and the tangent of the angle to the farthest ray: rays go through pixel centres.
    let first = view_direction(place * TILE);
    let last = view_direction(place * TILE + TILE - 1u);
    let left = view_direction(place * TILE + vec2u(0u, TILE - 1u));
    let right = view_direction(place * TILE + vec2u(TILE - 1u, 0u));
    let axis = normalize(first + last + left + right);
    let least_cosine = min(min(dot(axis, first), dot(axis, last)), min(dot(axis, left), dot(axis, right)));
    let spread = sqrt(max(1.0 - least_cosine * least_cosine, 0.0)) / least_cosine * 1.0001;

    // Where a ray of the cone can be inside: the box, grown by the cone's radius at its far end.
    let far_corner = max(abs(component.low - component.eye), abs(component.high - component.eye));
    let interval = bounds_interval(component, axis, spread * min(length(far_corner), 1e9));
    let entry = min(
        min(bounds_half_space_entry(component, first), bounds_half_space_entry(component, last)),
        min(bounds_half_space_entry(component, left), bounds_half_space_entry(component, right)),
    );
    // Distances along a ray are longer than along the axis, by at most this.
    let farthest = textureLoad(farthest_target, place, 0).x;
    let exit = min(min(interval.y, view.far), farthest);
    var t = max(max(interval.x, view.near), entry) * least_cosine;
    if t > exit {
        return;
    }
    var steps = 0u;
    loop {
        let f = field(component.eye + axis * t);
        steps += 1u;
        let clear = f - spread * t;
        if clear < CONE_CLEARANCE * view.footprint * t || steps >= min(CONE_STEPS, work.max_steps) {
            break;
        }
        t += clear / (1.0 + spread);
        if t > exit {
            break;
        }
    }
    cone_count(steps);
    if t <= exit {
        let slot = atomicAdd(&tile_counts[work.list * 4u], 1u);
        tiles[work.first_tile + slot] = Tile(place.x | (place.y << 16u), t);
    }
}

fn cone_count(steps: u32) {
    if COUNTING {
        atomicAdd(&tile_counts[work.list * 4u + 3u], steps);
    }
}
