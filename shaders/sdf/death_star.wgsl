// A sphere minus another above it.
//
// Outside, the nearest point is the one on the sphere or the one in the hollow if that belongs to
// the surface, else one on the circle where both meet; inside, the nearer of both is exact.

#include "generated/params/DeathStarParams.wgsl"

fn sdf_death_star(p: vec3f, q: DeathStarParams) -> f32 {
    let radius = q.radius;
    let distance = q.distance;
    let cut_radius = min(q.cut_radius, radius + distance);
    let at = vec2f(length(p.xz), p.y);
    let from_cut = at - vec2f(0.0, distance);
    let far = length(at);
    let cut_far = length(from_cut);
    let over = far - radius;
    let within = cut_radius - cut_far;
    if over <= 0.0 && within <= 0.0 {
        return max(over, within);
    }
    // Twice the distance times the height of the circle over either center.
    let height = radius * radius + (distance - cut_radius) * (distance + cut_radius);
    let cut_height = (radius - cut_radius) * (radius + cut_radius) - distance * distance;
    let twice = 2.0 * distance;
    if over > 0.0 && twice * radius * at.y <= height * far {
        return over;
    }
    if within > 0.0 && twice * cut_radius * from_cut.y <= cut_height * cut_far {
        return within;
    }
    let circle = clamp(height / max(twice, 1e-30), -radius, radius);
    return length(at - vec2f(sqrt((radius - circle) * (radius + circle)), circle));
}
