// The surface of a component that a pixel shows. Included by `surface.wgsl`.

fn surface_seen(component: Component, pixel: vec2u, t: f32, seen: bool) -> SeenSurface {
    let surface = surface_entered(ray_through(component, pixel), t, seen);
    return SeenSurface(surface, surface.gradient, length(surface.gradient));
}
