// Elongate: cuts the content at the origin and moves the parts 2 a.xyz apart.

fn mod_elongate_point(p: vec3f, k: u32, a: vec4f) -> vec3f {
    return p - clamp(p, -a.xyz, a.xyz);
}
