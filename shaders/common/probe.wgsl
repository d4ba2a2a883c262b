// What the probes are given: points of one component.

struct Probe {
    component: u32,
    count: u32,
    padding: vec2u,
}

@group(0) @binding(0) var<uniform> probe: Probe;
// xyz: a point relative to the component's origin.
@group(2) @binding(0) var<storage, read> points: array<vec4f>;
