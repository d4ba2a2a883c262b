// Input of the probes: points of one component.

struct Probe {
    count: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

@group(0) @binding(0) var<uniform> probe: Probe;
// xyz: a point relative to the component's origin.
@group(2) @binding(0) var<storage, read> points: array<vec4f>;
