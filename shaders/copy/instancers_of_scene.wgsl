// The bindings of passes that query the whole scene.

@group(3) @binding(4) var<storage, read> instancers: array<Instancer>;
@group(3) @binding(5) var<storage, read> places: array<vec4f>;

// The one in question.
var<private> instancer_at: u32;
