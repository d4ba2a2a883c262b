// What an invocation of the pass `shadow` leaves: shares, or its state. Needs `shares`, `states`,
// `unfinished`, `settings` and `dispatch`.

// The place of an invocation in its dispatch: eight that run together see a block of 4 by 2 pixels with shares, not a row, so
// that they do more alike.
fn shadow_invocation(group: vec3u, lane: u32) -> vec2u {
    return 8u * group.xy + vec2u((lane & 3u) | (lane >> 1u & 4u), (lane >> 2u & 1u) | (lane >> 3u & 6u));
}

// Adds the evaluations of an invocation to those of the dispatch.
fn shadow_count() {
    if COUNTING {
        atomicAdd(&unfinished[1], scene_evaluations);
    }
}

// Place of the state of an invocation; `part`: 0 for shadows, 1 for occlusion.
fn shadow_place(id: vec2u, part: u32) -> u32 {
    var words = SHADOW_WORDS;
#if SCENE_COPIES
    words += SHADOW_COPIES_WORDS;
#end
    return (2u * (id.y * (dispatch.end.x - dispatch.origin.x) + id.x) + part) * words;
}

// Stores a share as a byte.
fn shadow_store(first: u32, slot: u32, share: f32) {
    let at = first + slot / 4u;
    let shift = 8u * (slot & 3u);
    shares[at] = (shares[at] & ~(0xffu << shift)) | (u32(round(clamp(share, 0.0, 1.0) * 255.0)) << shift);
}

// Stores the task of a pixel, and its state if that is not the last one.
fn shadow_leave(own: u32, march: ConeMarch, task: u32, tasks: u32) {
    shadow_count();
    states[own] = task;
    if task >= tasks {
        return;
    }
    atomicAdd(&unfinished[0], 1u);
    states[own + 1u] = bitcast<u32>(march.visit.entry);
    states[own + 2u] = bitcast<u32>(march.visit.exit);
    states[own + 3u] = march.visit.component;
    states[own + 4u] = march.after;
    states[own + 5u] = bitcast<u32>(march.t);
    states[own + 6u] = bitcast<u32>(march.last.x);
    states[own + 7u] = bitcast<u32>(march.last.y);
    states[own + 8u] = bitcast<u32>(march.ratio);
    states[own + 9u] = bitcast<u32>(march.share);
    states[own + 10u] = march.state;
}

fn shadow_load(own: u32) -> ConeMarch {
    var march = cone_march_begin();
    march.visit.entry = bitcast<f32>(states[own + 1u]);
    march.visit.exit = bitcast<f32>(states[own + 2u]);
    march.visit.component = states[own + 3u];
    march.after = states[own + 4u];
    march.t = bitcast<f32>(states[own + 5u]);
    march.last.x = bitcast<f32>(states[own + 6u]);
    march.last.y = bitcast<f32>(states[own + 7u]);
    march.ratio = bitcast<f32>(states[own + 8u]);
    march.share = bitcast<f32>(states[own + 9u]);
    march.state = states[own + 10u];
    return march;
}

// Light for all, until a cone tells otherwise.
fn shadow_clear(first: u32) {
    for (var i = 0u; i < (settings.lights + 3u) / 4u; i += 1u) {
        shares[first + i] = 0xffffffffu;
    }
}

// The six cones of occlusion.
struct OcclusionMarch {
    // Their least ratios.
    low: vec3f,
    high: vec3f,
    // The node behind that of the component.
    after: u32,
    // The cone in it; OCCLUSION_CONES for the next component.
    cone: u32,
    t: f32,
    // Whether all components are done.
    ended: bool,
    // The next cone to be compared with the meshes; OCCLUSION_CONES once all are.
    meshes: u32,
}

fn shadow_load_occlusion(own: u32) -> OcclusionMarch {
    let low = bitcast<vec3f>(vec3u(states[own + 4u], states[own + 5u], states[own + 6u]));
    let high = bitcast<vec3f>(vec3u(states[own + 7u], states[own + 8u], states[own + 9u]));
    let t = bitcast<f32>(states[own + 2u]);
    return OcclusionMarch(low, high, states[own], states[own + 1u], t, states[own + 3u] == 1u, states[own + 10u]);
}

fn shadow_occlusion_ended(march: OcclusionMarch) -> bool {
    return march.ended && march.meshes >= OCCLUSION_CONES;
}

// Stores the shares of the cones of occlusion, or the state if they have not ended.
fn shadow_leave_occlusion(own: u32, march: OcclusionMarch, first: u32) {
    shadow_count();
    let low = march.low;
    let high = march.high;
    states[own + 3u] = select(0u, 1u, march.ended);
    states[own + 10u] = march.meshes;
    if shadow_occlusion_ended(march) {
        let slot = (settings.lights + 3u) / 4u * 4u;
        shadow_store(first, slot, cone_share(low.x));
        shadow_store(first, slot + 1u, cone_share(low.y));
        shadow_store(first, slot + 2u, cone_share(low.z));
        shadow_store(first, slot + 3u, cone_share(high.x));
        shadow_store(first, slot + 4u, cone_share(high.y));
        shadow_store(first, slot + 5u, cone_share(high.z));
        return;
    }
    atomicAdd(&unfinished[0], 1u);
    states[own] = march.after;
    states[own + 1u] = march.cone;
    states[own + 2u] = bitcast<u32>(march.t);
    states[own + 4u] = bitcast<u32>(low.x);
    states[own + 5u] = bitcast<u32>(low.y);
    states[own + 6u] = bitcast<u32>(low.z);
    states[own + 7u] = bitcast<u32>(high.x);
    states[own + 8u] = bitcast<u32>(high.y);
    states[own + 9u] = bitcast<u32>(high.z);
}

#if SCENE_COPIES
// Stores where the walk through the copies of an instancer goes on; `is_in`: whether there is one.
fn shadow_save_copies(own: u32, left_at: vec4i, is_in: bool) {
    let at = own + SHADOW_WORDS;
    states[at] = bitcast<u32>(left_at.x);
    states[at + 1u] = bitcast<u32>(left_at.y);
    states[at + 2u] = bitcast<u32>(left_at.z);
    states[at + 3u] = bitcast<u32>(left_at.w);
    states[at + 4u] = select(0u, 1u, is_in);
}

fn shadow_load_copies(own: u32) -> SceneCopies {
    let at = own + SHADOW_WORDS;
    var copies = copies_begin();
    copies.left_at = bitcast<vec4i>(vec4u(states[at], states[at + 1u], states[at + 2u], states[at + 3u]));
    copies.is_in = states[at + 4u] == 1u;
    return copies;
}

#end
