// What an invocation of the pass `shadow` leaves: shares, or its state. Needs `shares`, `states`,
// `unfinished` and `settings`.

// Stores a share as a byte.
fn shadow_store(first: u32, slot: u32, share: f32) {
    let at = first + slot / 4u;
    let shift = 8u * (slot & 3u);
    shares[at] = (shares[at] & ~(0xffu << shift)) | (u32(round(clamp(share, 0.0, 1.0) * 255.0)) << shift);
}

fn shadow_save(own: u32, march: ConeMarch) {
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

// Stores the shares of the cones of occlusion, or the state if they have not ended.
fn shadow_leave_occlusion(own: u32, after: u32, cone: u32, t: f32, ended: bool, low: vec3f, high: vec3f, first: u32) {
    states[own + 3u] = select(0u, 1u, ended);
    if ended {
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
    states[own] = after;
    states[own + 1u] = cone;
    states[own + 2u] = bitcast<u32>(t);
    states[own + 4u] = bitcast<u32>(low.x);
    states[own + 5u] = bitcast<u32>(low.y);
    states[own + 6u] = bitcast<u32>(low.z);
    states[own + 7u] = bitcast<u32>(high.x);
    states[own + 8u] = bitcast<u32>(high.y);
    states[own + 9u] = bitcast<u32>(high.z);
}
