// The bindings of passes over one type of an instancer.

@group(1) @binding(6) var<uniform> instancer: Instancer;
@group(1) @binding(7) var<storage, read> places: array<vec4f>;
