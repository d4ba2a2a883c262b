// Pass `lights`: which lights may reach the surfaces that a tile shows, as one bit for each. It runs only
// in scenes with many lights.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/light.wgsl"
#include "light/light_tiles.wgsl"

@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var<storage, read> lights: array<Light>;
@group(2) @binding(2) var<storage, read_write> light_tiles: array<u32>;

// The box around the surfaces of a tile; `low` is above `high` if there are none.
struct TileBox {
    low: vec3f,
    high: vec3f,
}

fn light_tile_box(tile: vec2u) -> TileBox {
    var box = TileBox(vec3f(BACKGROUND), vec3f(-BACKGROUND));
    for (var i = 0u; i < LIGHT_TILE * LIGHT_TILE; i += 1u) {
        let pixel = tile * LIGHT_TILE + vec2u(i % LIGHT_TILE, i / LIGHT_TILE);
        let depth = select(BACKGROUND, textureLoad(depth_target, pixel, 0).x, view_contains(pixel));
        let p = view_direction(pixel) * depth;
        let is_hit = depth < BACKGROUND;
        box.low = select(box.low, min(box.low, p), is_hit);
        box.high = select(box.high, max(box.high, p), is_hit);
    }
    return box;
}

// Whether light may reach a point of the box: whether the range does, and not all of it is outside of a
// spot's cone or behind a rectangle.
fn light_tile_reached(box: TileBox, light: Light) -> bool {
    let away = length(max(max(box.low - light.position, light.position - box.high), vec3f(0.0)));
    let middle = 0.5 * (box.low + box.high) - light.position;
    let half = 0.5 * (box.high - box.low);
    let along = dot(middle, light.direction);
    let before = along + dot(half, abs(light.direction));
    // Distance of the middle from the cone, positive outside.
    let beside = sqrt(max(dot(middle, middle) - along * along, 0.0));
    let outside = light.cos_outer * beside - along * sqrt(max(1.0 - light.cos_outer * light.cos_outer, 0.0));
    let is_spot = light.kind == LIGHT_SPOT && light.cos_outer > 0.0;
    let is_hidden = (light.kind == LIGHT_RECTANGLE && before <= 0.0) || (is_spot && outside > length(half) * 1.001);
    // More than rounding moves it.
    let meets = away <= light.range * 1.001 && !is_hidden;
    return all(box.low <= box.high) && (light.kind == LIGHT_DIRECTIONAL || meets);
}

@compute @workgroup_size(8, 8)
fn lights_of_tiles(@builtin(global_invocation_id) id: vec3u) {
    if !view_contains(id.xy * LIGHT_TILE) {
        return;
    }
    let box = light_tile_box(id.xy);
    let words = light_tile_words(view.light_count);
    // Nobody reads an empty tile. A count that depends on the tile is no constant for lavapipe.
    let count = select(0u, view.light_count, box.low.x <= box.high.x);
    for (var word = 0u; word < light_tile_words(count); word += 1u) {
        var bits = 0u;
        for (var bit = 0u; bit < min(32u, count - 32u * word); bit += 1u) {
            bits |= select(0u, 1u << bit, light_tile_reached(box, lights[32u * word + bit]));
        }
        light_tiles[light_tile_first(id.xy, view.width, words) + word] = bits;
    }
}
