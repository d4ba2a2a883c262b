// Lights with a size: how large they appear, how far they are above the horizon, and how their
// highlights look. Counterpart of `src/field/light/area.rs`.

// A light as a point meets it.
struct IncomingLight {
    // Unit direction to its middle.
    to_light: vec3f,
    // Irradiance of a surface that faces it, relative to the light's color times pi.
    share: f32,
    // Square of the sine of the half angle of a sphere that appears as large.
    sine_squared: f32,
}

// The irradiance of a surface, relative to that of one that faces the light: the cosine of the angle
// of incidence, unless the horizon cuts a part of the light off. Exact for spheres (Snyder, "Area
// light sources for real-time graphics", 1996).
fn area_facing(cosine: f32, sine_squared: f32) -> f32 {
    let s = max(sine_squared, 1e-8);
    let x = sqrt(max(1.0 / s - 1.0, 0.0));
    let sine = sqrt(max(1.0 - cosine * cosine, 1e-12));
    let y = clamp(-x * cosine / sine, -1.0, 1.0);
    let q = sine * sqrt(1.0 - y * y);
    let cut = ((cosine * acos(y) - x * q) * s + atan2(q, max(x, 1e-12))) / (3.14159265 * s);
    return select(max(cut, 0.0), max(cosine, 0.0), cosine * cosine >= s);
}

// An edge of a polygon in Lambert's formula for its vector irradiance.
fn area_edge(from_point: vec3f, next: vec3f) -> vec3f {
    let side = cross(from_point, next);
    let sine = length(side);
    return side * (0.5 * atan2(sine, dot(from_point, next)) / max(sine, 1e-20));
}

// A rectangle as a point meets it, by Lambert's formula; from behind it is dark.
fn area_rectangle(light: Light, position: vec3f) -> IncomingLight {
    let middle = light.position - position;
    let a = middle - light.right - light.up;
    let b = middle + light.right - light.up;
    let c = middle + light.right + light.up;
    let d = middle - light.right + light.up;
    var flow = area_edge(a, b) + area_edge(b, c) + area_edge(c, d) + area_edge(d, a);
    flow *= select(1.0, -1.0, dot(flow, light.direction) > 0.0);
    let strength = length(flow);
    let share = select(0.0, strength / 3.14159265, dot(middle, light.direction) < 0.0);
    return IncomingLight(flow / max(strength, 1e-20), share, min(share, 1.0));
}

// What a mirror shows of the light.
struct Mirrored {
    // Unit direction to the nearest part of the light, of which only `part` counts around its middle
    // (Karis, "Real shading in Unreal Engine 4", 2013).
    direction: vec3f,
    // How far the mirrored ray passes the edge of the light, in radians; negative within.
    aside: f32,
}

fn area_mirrored(point: ShadingPoint, light: Light, incoming: IncomingLight, part: f32) -> Mirrored {
    let ray = 2.0 * dot(point.normal, point.to_eye) * point.normal - point.to_eye;
    if light.kind == LIGHT_RECTANGLE {
        let middle = light.position - point.position;
        let along = dot(middle, light.direction) / min(dot(ray, light.direction), -1e-3);
        let hit = ray * along - middle;
        let size = vec2f(length(light.right), length(light.up));
        let at = vec2f(dot(hit, light.right), dot(hit, light.up)) / max(size, vec2f(1e-6));
        let beyond = abs(at) - size;
        let aside = length(max(beyond, vec2f(0.0))) + min(max(beyond.x, beyond.y), 0.0);
        let held = clamp(at, -size * part, size * part) / max(size, vec2f(1e-6));
        return Mirrored(normalize(middle + light.right * held.x + light.up * held.y), aside / max(along, 1e-6));
    }
    let toward = ray * dot(incoming.to_light, ray) - incoming.to_light;
    let distance = length(toward);
    let sine = sqrt(incoming.sine_squared);
    let held = toward * min(part * sine / max(distance, 1e-6), 1.0);
    return Mirrored(normalize(incoming.to_light + held), distance - sine);
}

// Roughness of the highlight, as alpha of GGX.
fn area_alpha(material: FlatMaterial) -> f32 {
    let of_phong = sqrt(2.0 / (material.phong_shininess / max(material.phong_weight, 1e-4) + 2.0));
    return max(mix(material.roughness * material.roughness, of_phong, material.phong_weight), 1e-3);
}

// The light that the surface reflects toward the eye, relative to the light's color. The highlight is
// that of the mirrored direction, as weak as the light is larger than the highlight of a point: a
// lobe of GGX with alpha `a` covers the solid angle 4 pi a^2 cos(view), and a light of the solid angle
// pi sin^2 that covers all of it is reflected whole. Where the lobe covers only a part of the light,
// the nearest part and its share stand for it. The diffuse part is exact for spheres.
fn area_reflected(point: ShadingPoint, light: Light, incoming: IncomingLight) -> vec3f {
    let material = point.material;
    let widened = incoming.sine_squared / (4.0 * max(dot(point.normal, point.to_eye), 1e-3));
    let alpha = area_alpha(material);
    let spread = 1.0 + widened / (alpha * alpha);
    let covered = 1.0 - 1.0 / spread;
    let mirrored = area_mirrored(point, light, incoming, covered);
    let edge = mirrored.aside / (2.0 * alpha);
    let visible = 0.5 - 0.5 * edge / sqrt(1.0 + edge * edge);
    let strength = (1.0 - covered + covered * visible) / spread;
    // The coat has a lobe of its own: with this roughness it is as bright as with its own spread.
    let coat = point.layers.coat_alpha;
    var lit = point;
    lit.layers.coat_alpha = sqrt(min((coat * coat + widened) / spread, 1.0));
    let facing = area_facing(dot(point.normal, incoming.to_light), incoming.sine_squared);
    let diffuse = facing - max(dot(point.normal, mirrored.direction), 0.0) * strength;
    let albedo = material.base_color * (1.0 - material.metalness * (1.0 - material.phong_weight));
    return (brdf_direct(lit, mirrored.direction) * strength + albedo * diffuse) * incoming.share;
}
