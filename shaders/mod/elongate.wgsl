// Cut open at the origin and drawn apart by 2 a.xyz.

fn mod_elongate_point(p: vec3f, k: u32, a: vec4f) -> vec3f {
    return p - clamp(p, -a.xyz, a.xyz);
}
