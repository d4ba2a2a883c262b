// The surface of a copy that a pixel shows. Included by `surface.wgsl` instead of
// `common/surface_seen.wgsl`.

#include "copy/space.wgsl"
#include "copy/material.wgsl"
#include "copy/copied.wgsl"

@group(2) @binding(7) var<storage, read_write> copied: array<vec4i>;

fn surface_seen(component: Component, pixel: vec2u, t: f32, seen: bool) -> SeenSurface {
    let place = select(0u, copied_place(pixel), seen);
    let copy = copy_at(copied[place].xyz, component.kind);
    let origin = instancer_local_point(vec3f(0.0));
    let direction = instancer_local_direction(view_direction(pixel));
    let along = copy_local_direction(copy, direction);
    let stretch = length(along);
    let local = copy_local_point(copy, origin + direction * t) + component.eye;
    let ray = Ray(local, t * stretch, along / stretch);
    let surface = surface_entered(ray, t * stretch, seen);
    if seen {
        copied[place + 1u] = bitcast<vec4i>(copied_material(copy_material(copy)));
    }
    return SeenSurface(surface, copy_world_gradient(copy, surface.gradient), length(surface.gradient));
}
