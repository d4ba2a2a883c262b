// Masks of existence. Counterpart of `src/field/copies/masks.rs`.

#include "copy/instancer.wgsl"
#include "copy/noise.wgsl"

// In the order of `MaskKind`.
const MASK_NOISE: u32 = 0u;
const MASK_HEIGHT: u32 = 1u;
const MASK_SLOPE: u32 = 2u;
const MASK_RADIUS: u32 = 3u;

// In the order of `MaskJoin`.
const MASK_ADD: u32 = 1u;
const MASK_SUBTRACT: u32 = 2u;
const MASK_MINIMUM: u32 = 3u;
const MASK_MAXIMUM: u32 = 4u;

// How an image lies: `whole.y` of its mask.
const MASK_TILED: i32 = 1;
const MASK_MISSING: i32 = 2;

// Intervals of a sampled curve.
const MASK_INTERVALS: f32 = 60.0;
// Upper bound of the slope of noise along an axis, per lattice point.
const MASK_NOISE_SLOPE: f32 = 1.875;

// Of the share so far with that of the next mask.
fn copy_mask_joined(join: u32, share: f32, next: f32) -> f32 {
    var joined = share * next;
    joined = select(joined, min(share + next, 1.0), join == MASK_ADD);
    joined = select(joined, max(share - next, 0.0), join == MASK_SUBTRACT);
    joined = select(joined, min(share, next), join == MASK_MINIMUM);
    return select(joined, max(share, next), join == MASK_MAXIMUM);
}

// The height of the curve of a mask at a share.
fn copy_mask_curve(mask: CopyMask, share: f32) -> f32 {
    let at = share * MASK_INTERVALS;
    let left = min(u32(at), u32(MASK_INTERVALS) - 1u);
    let row = u32(mask.curve.w);
    let low = places[row + left / 4u][left % 4u];
    let high = places[row + (left + 1u) / 4u][(left + 1u) % 4u];
    return low + (high - low) * (at - f32(left));
}

// What becomes of the share of a mask.
fn copy_mask_response(mask: CopyMask, share: f32) -> f32 {
    let turned = select(share, 1.0 - share, mask.inverted == 1u);
    return select(turned, copy_mask_curve(mask, turned), mask.curve.x >= 0.0);
}

// The brightness of a pixel of an image, whose coordinates are whole.
fn copy_mask_pixel(mask: CopyMask, at: vec2f) -> f32 {
    let size = mask.params.zw;
    let around = at - size * floor(at / size);
    let pixel = vec2u(select(clamp(at, vec2f(0.0), size - 1.0), around, mask.whole.y == MASK_TILED));
    let index = pixel.y * u32(size.x) + pixel.x;
    return places[u32(mask.whole.x) + index / 4u][index % 4u];
}

// The brightness of an image at a position, between four pixels; 0 beside it, 1 without an image.
fn copy_mask_image(mask: CopyMask, position: vec3f) -> f32 {
    let size = max(mask.params.zw, vec2f(1.0));
    var place = mask.fraction + position.xz * mask.params.xy;
    let is_beside = any(place < vec2f(0.0)) || any(place > size);
    place -= select(vec2f(0.0), size * floor(place / size), mask.whole.y == MASK_TILED);
    // Pixels have their values in their middles.
    let corner = floor(place - 0.5);
    let part = place - 0.5 - corner;
    let upper = mix(copy_mask_pixel(mask, corner), copy_mask_pixel(mask, corner + vec2f(1.0, 0.0)), part.x);
    let lower = mix(
        copy_mask_pixel(mask, corner + vec2f(0.0, 1.0)),
        copy_mask_pixel(mask, corner + vec2f(1.0, 1.0)),
        part.x,
    );
    let share = select(mix(upper, lower, part.y), 0.0, is_beside && mask.whole.y != MASK_TILED);
    return select(share, 1.0, mask.whole.y == MASK_MISSING);
}

// The share of mask `i` at a position, from 0 to 1. There is no ground, so nothing is steep.
fn copy_mask(i: u32, position: vec3f) -> f32 {
    let mask = instancer.masks[i];
    var share = 1.0;
    if mask.kind == MASK_NOISE {
        let s = noise_moved(NoiseCoordinate(mask.whole.x, mask.fraction.x), position.x * mask.params.z);
        let t = noise_moved(NoiseCoordinate(mask.whole.y, mask.fraction.y), position.z * mask.params.z);
        share = (copy_noise_2(mask.key, s, t) - mask.params.x) / mask.params.y + 0.5;
    } else if mask.kind <= MASK_RADIUS {
        let at = position + instancer.anchor_place;
        if mask.kind == MASK_HEIGHT {
            share = min((at.y - mask.params.x) / mask.params.z, 1.0);
            share = max(share, 0.0) * clamp((mask.params.y - at.y) / mask.params.z, 0.0, 1.0);
        } else if mask.kind == MASK_RADIUS {
            share = (mask.params.y - length(at.xz)) / (mask.params.y - mask.params.x);
        }
    } else {
        share = copy_mask_image(mask, position);
    }
    return copy_mask_response(mask, clamp(share, 0.0, 1.0));
}

// The share of all masks together, of which there are so many.
fn copy_masks(position: vec3f, count: u32) -> f32 {
    var share = 1.0;
    for (var i = 0u; i < count; i += 1u) {
        let next = copy_mask(i, position);
        share = select(copy_mask_joined(instancer.masks[i].join, share, next), next, i == 0u);
    }
    return share;
}

// The least and the most that the share of a mask may be in a box, before it is inverted.
fn copy_mask_range(mask: CopyMask, center: vec3f, half: vec3f) -> vec2f {
    var range = vec2f(0.0, 1.0);
    if mask.kind == MASK_NOISE {
        let s = noise_moved(NoiseCoordinate(mask.whole.x, mask.fraction.x), center.x * mask.params.z);
        let t = noise_moved(NoiseCoordinate(mask.whole.y, mask.fraction.y), center.z * mask.params.z);
        let off = MASK_NOISE_SLOPE * mask.params.z * (half.x + half.z);
        let noise = copy_noise_2(mask.key, s, t) + vec2f(-off, off);
        range = (noise - mask.params.x) / mask.params.y + 0.5;
    } else if mask.kind == MASK_HEIGHT {
        let y = center.y + instancer.anchor_place.y + vec2f(-half.y, half.y);
        let above = clamp((y - mask.params.x) / mask.params.z, vec2f(0.0), vec2f(1.0));
        range = above * clamp((mask.params.y - y.yx) / mask.params.z, vec2f(0.0), vec2f(1.0));
    } else if mask.kind == MASK_RADIUS {
        let away = abs(center.xz + instancer.anchor_place.xz);
        let distance = vec2f(length(away + half.xz), length(max(away - half.xz, vec2f(0.0))));
        range = (mask.params.y - distance) / (mask.params.y - mask.params.x);
    } else if mask.kind > MASK_RADIUS {
        let place = mask.fraction + center.xz * mask.params.xy;
        let off = half.xz * mask.params.xy;
        let is_beside = any(place + off < vec2f(0.0)) || any(place - off > mask.params.zw);
        range = select(range, vec2f(0.0), is_beside && mask.whole.y == 0);
    }
    return clamp(range, vec2f(0.0), vec2f(1.0));
}

// The same of mask `i` as it counts.
fn copy_mask_response_range(i: u32, center: vec3f, half: vec3f) -> vec2f {
    let mask = instancer.masks[i];
    let range = copy_mask_range(mask, center, half);
    let turned = select(range, 1.0 - range.yx, mask.inverted == 1u);
    let off = mask.curve.x * 0.5 * (turned.y - turned.x);
    let curved = copy_mask_curve(mask, 0.5 * (turned.x + turned.y)) + vec2f(-off, off);
    let is_empty = turned.y <= mask.curve.y || turned.x >= mask.curve.z;
    let bounded = select(clamp(curved, vec2f(0.0), vec2f(1.0)), vec2f(0.0), is_empty);
    return select(turned, bounded, mask.curve.x >= 0.0);
}

// The most that all masks together may be in a box, relative to the anchor's place.
fn copy_masks_most(center: vec3f, half: vec3f, count: u32) -> f32 {
    var all = vec2f(1.0);
    for (var i = 0u; i < count; i += 1u) {
        let range = copy_mask_response_range(i, center, half);
        let join = instancer.masks[i].join;
        // What is taken away is least where most is left.
        let next = select(range, range.yx, join == MASK_SUBTRACT);
        let joined = vec2f(copy_mask_joined(join, all.x, next.x), copy_mask_joined(join, all.y, next.y));
        all = select(joined, range, i == 0u);
    }
    return all.y;
}
