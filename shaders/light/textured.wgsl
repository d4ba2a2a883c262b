// The textures of an entry of a mixture, applied to its material. See `light/texture.wgsl`.

#include "light/texture.wgsl"
#if LOOKS
#include "light/model_look.wgsl"
#end
#if SCENE_COPIES
#include "copy/textured.wgsl"
#end

// Most looks along the longer side of a footprint.
const TEXTURE_LOOKS: f32 = 4.0;

// An image over a footprint with these edges: as many looks along the longer side as it is longer, each in the levels
// of the shorter side (after Heckbert, "Survey of Texture Mapping", 1986).
fn textured_image(index: u32, at: vec2f, across: vec2f, along: vec2f, wrap: u32) -> vec3f {
    let image = index * 20u;
    let finest = vec2i(i32(texture_word(image)), i32(texture_word(image + 1u)));
    let levels = texture_word(image + 2u);
    let form = texture_word(image + 3u);
    let a = across * vec2f(finest);
    let b = along * vec2f(finest);
    let is_across = dot(a, a) > dot(b, b);
    let longer = select(length(b), length(a), is_across);
    let shorter = abs(a.x * b.y - a.y * b.x) / max(longer, 1e-9);
    let looks = clamp(ceil(longer / max(shorter, 1.0)), 1.0, TEXTURE_LOOKS);
    let detail = clamp(log2(max(max(shorter, longer / looks), 1.0)), 0.0, f32(levels - 1u));
    let fine = u32(detail);
    let share = detail - f32(fine);
    let way = select(along, across, is_across);
    var start = at;
    if wrap != 2u {
        start -= 2.0 * floor(at * 0.5);
    }
    var sum = vec3f(0.0);
    for (var look = 0u; look < 2u * u32(looks); look += 1u) {
        // The finer level, then the coarser one.
        let weight = select(1.0 - share, share, (look & 1u) == 1u);
        if weight > 0.0 {
            let place = start + way * ((f32(look >> 1u) + 0.5) / looks - 0.5);
            sum += weight * texture_level(image, fine + (look & 1u), form, finest, place, wrap);
        }
    }
    return sum / looks;
}

// What a texture shows: a color or a value, or for normal maps slopes along the axes of the texture.
fn textured_value(texture: FlatTexture, sample: TextureSample, is_slope: bool) -> vec3f {
    if texture.kind >= TEXTURE_NOISE {
        return mix(texture.first, texture.second, texture_solid(texture, sample));
    }
    var sum = vec3f(0.0);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        let weight = sample.weights[axis];
        if weight == 0.0 {
            continue;
        }
        // To the right and downward, as one looks at the side of a cube.
        let side = select(1.0, -1.0, sample.normal[axis] < 0.0);
        let right = select(select(vec3f(side, 0.0, 0.0), vec3f(1.0, 0.0, 0.0), axis == 1u), vec3f(0.0, 0.0, -side), axis == 0u);
        let down = select(vec3f(0.0, -1.0, 0.0), vec3f(0.0, 0.0, side), axis == 1u);
        let at = vec2f(dot(right, sample.at), dot(down, sample.at)) * texture.scale;
        let across = vec2f(dot(right, sample.across), dot(down, sample.across)) * texture.scale;
        let along = vec2f(dot(right, sample.along), dot(down, sample.along)) * texture.scale;
        let width = sqrt(across * across + along * along);
        var shown = vec3f(0.0);
        if texture.kind == TEXTURE_IMAGE {
            shown = textured_image(texture.image, at + 0.5, across, along, texture.wrap);
        } else if texture.kind == TEXTURE_CHECKER {
            shown = mix(texture.first, texture.second, texture_checker(at, width));
        } else {
            shown = mix(texture.first, texture.second, texture_bricks(at * vec2f(1.0, -1.0), width, texture.a, texture.b));
        }
        if is_slope {
            let slope = 2.0 * shown - 1.0;
            shown = (right * slope.x - down * slope.y) / max(slope.z, 0.1);
        }
        sum += weight * shown;
    }
    return sum;
}

// A point of the surface, relative to the eye, with the edges of the pixel's footprint on its tangent plane.
struct TexturedPoint {
    position: vec3f,
    normal: vec3f,
    across: vec3f,
    along: vec3f,
}

// The point that a pixel of this width shows; `direction` is that of the ray.
fn textured_point(direction: vec3f, depth: f32, normal: vec3f, footprint: f32) -> TexturedPoint {
    let width = footprint * depth;
    let facing = max(abs(dot(normal, direction)), 0.0625);
    let side = cross(normal, direction);
    let size = length(side);
    let other = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(normal.y) < 0.9);
    let across = select(normalize(cross(normal, other)), side / max(size, 1e-9), size > 1e-4);
    return TexturedPoint(direction * depth, normal, across * width, cross(across, normal) * (width / facing));
}

// A material with its textures, and by how much they bend the normal.
struct TexturedMaterial {
    material: FlatMaterial,
    bend: vec3f,
}

// The material of the entry at `index` with its textures.
fn textured_material(material: FlatMaterial, index: u32, point: TexturedPoint) -> TexturedMaterial {
    let placed = placed_textures[index];
    if placed.textures == TEXTURE_NONE {
        return TexturedMaterial(material, vec3f(0.0));
    }
#if SCENE_COPIES
    if placed.copied_by > 0u {
        let copy = textured_copy(placed.copied_by - 1u);
        let there = textured_copied(copy, point);
        var found = textured_placed(material, placed, there);
        found.bend = textured_world_bend(copy, found.bend, there.normal);
        return found;
    }
#end
    return textured_placed(material, placed, point);
}

// The same at a point of the space from which the textures are placed.
fn textured_placed(material: FlatMaterial, placed: GpuPlacedTextures, point: TexturedPoint) -> TexturedMaterial {
    var found = TexturedMaterial(material, vec3f(0.0));
    let rows = mat3x3f(placed.rows[0].xyz, placed.rows[1].xyz, placed.rows[2].xyz);
    let axes = mat3x3f(normalize(rows[0]), normalize(rows[1]), normalize(rows[2]));
    let shift = vec3f(placed.rows[0].w, placed.rows[1].w, placed.rows[2].w);
    // A vector times a matrix: its products with the columns, which are rows here.
    let normal = normalize(point.normal * axes);
    let sharpness = texture_sets[placed.textures].sharpness;
    let at = point.position * rows + shift - texture_repeated(placed, point.position);
    var sample = TextureSample(at, point.across * rows, point.along * rows, normal, vec3f(0.0));
#if LOOKS
    if texture_sets[placed.textures].slots[0].kind == TEXTURE_MODEL {
        let model = texture_sets[placed.textures].slots[0];
        let width = sqrt(length(sample.across) * length(sample.along));
        let look = model_look(model.image, model.wrap, texture_wrapped(at), width);
        let rest = 1.0 - look.share;
        found.material.base_color = material.base_color * rest + look.color;
        found.material.metalness = material.metalness * rest + look.metalness;
        found.material.roughness = material.roughness * rest + look.roughness;
        found.material.emission = material.emission * rest + look.emission;
        found.bend = axes * look.bend;
        return found;
    }
#end
    sample.weights = texture_weights(normal, sharpness);
    // For the slope of heights: steps that rounding does not hide.
    let width = max(length(sample.across), length(sample.along));
    let stride = max(1.0, (1.0 / 1024.0) / width);
    var heights = vec3f(0.0);
    // Base color, roughness, normal, and the height at three places: in one loop, since compilers repeat the code of
    // every call.
    for (var look = 0u; look < 6u; look += 1u) {
        let slot = min(look, 3u);
        let texture = texture_sets[placed.textures].slots[slot];
        if texture.kind == 0u {
            continue;
        }
        var there = sample;
        there.at += stride * (select(vec3f(0.0), sample.across, look == 4u) + select(vec3f(0.0), sample.along, look == 5u));
        there.at = texture_wrapped(there.at);
        let value = textured_value(texture, there, slot == 2u);
        if slot == 0u {
            found.material.base_color = value * texture_sets[placed.textures].base_weight;
        } else if slot == 1u {
            found.material.roughness = clamp(value.x, 0.0, 1.0);
        } else if slot == 2u {
            found.bend += axes * value * texture_sets[placed.textures].strength;
        } else {
            heights[look - 3u] = value.x;
        }
    }
    let across = point.across * ((heights.y - heights.x) / (stride * dot(point.across, point.across)));
    let along = point.along * ((heights.z - heights.x) / (stride * dot(point.along, point.along)));
    found.bend -= placed.bump * (across + along);
    return found;
}

// The normal, bent by this much.
fn textured_normal(normal: vec3f, bend: vec3f) -> vec3f {
    return normalize(normal + bend * min(1.0, 4.0 / max(length(bend), 1e-9)));
}
