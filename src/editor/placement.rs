//! Where a new node goes: on what is under the pointer, as large as suits the view, and never hidden in another shape.

use egui::Pos2;
use glam::DVec3;

use super::bounds;
use super::picking::{PickedPoint, pick_surface};
use super::projection::Projection;
use super::state::EditorState;
use super::steps::{finest_step, rounded, rounded_point};
use isolith_geometry::Aabb;
use isolith_scene::{NodeKind, Shape, ShapeKind};

/// The part of the view's height that a new shape takes.
const SHARE: f64 = 0.25;
/// Within this factor of it, a shape keeps its own size.
const NEAR_ENOUGH: f64 = 3.0;
/// The ground counts within this many distances to the target.
const FARTHEST: f64 = 8.0;
/// A surface is the ground for what stands on it if it is no steeper than this: cosine of 18 degrees.
const LEVEL: f64 = 0.95;
/// How often a shape is moved out of another one.
const MOST_MOVES: usize = 64;

/// Where a new node goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// A point in the world.
    pub point: DVec3,
    /// The direction away from the surface there; `None` where there is no surface.
    pub normal: Option<DVec3>,
}

/// The place under a position of the picture: a surface, or the ground, or the plane through the view's target. Without
/// a position the view's target, rounded to about a hundredth of the view's width.
pub fn placing(state: &EditorState, at: Option<Pos2>) -> Placing {
    let view = &state.view.navigation;
    let Some(at) = at else {
        let has_nodes = !state.session.document.scene().nodes().is_empty();
        let step = 10.0_f64.powf((view.distance * 0.02).log10().floor());
        let point = if has_nodes { rounded_point(view.target, step) } else { DVec3::ZERO };
        return Placing { point, normal: None };
    };
    let projection = Projection::of(&state.view);
    let ray = projection.ray(at);
    if let Some(PickedPoint { point, normal }) = pick_surface(state, &ray) {
        let step = finest_step(projection.meters_per_point(point));
        let level = normal.y > LEVEL;
        let tidy = DVec3::new(rounded(point.x, step), rounded(point.y, step * 1e-3), rounded(point.z, step));
        return Placing {
            point: if level { tidy } else { point },
            normal: Some(if level { DVec3::Y } else { normal }),
        };
    }
    let t = -ray.origin.y / ray.direction.y;
    if t.is_finite() && t > 0.0 && t < FARTHEST * view.distance {
        let point = ray.at(t) * DVec3::new(1.0, 0.0, 1.0);
        let step = finest_step(projection.meters_per_point(point));
        return Placing { point: rounded_point(point, step), normal: Some(DVec3::Y) };
    }
    let point = view.under_pointer(projection.pixel(at), projection.size_px());
    Placing { point: rounded_point(point, finest_step(projection.meters_per_point(point))), normal: None }
}

/// The shape of this kind that was edited last, or the default.
pub fn remembered(state: &EditorState, kind: ShapeKind) -> Shape {
    let last = state.last_shapes.iter().find(|shape| shape.kind() == kind);
    last.cloned().unwrap_or_else(|| kind.default_shape())
}

/// The shape as large as suits the view at a point: a factor of 1, 2 or 5 times a power of ten.
pub fn sized(state: &EditorState, shape: Shape, point: DVec3) -> Shape {
    let bounds = shape.bounds();
    let view = &state.view.navigation;
    let depth = (point - view.eye()).dot(view.rotation * DVec3::NEG_Z);
    let wanted = SHARE * 2.0 * depth * (0.5 * view.fov_y).tan();
    let factor = wanted / (2.0 * bounds.half().max_element());
    if !bounds.is_finite() || !factor.is_finite() || factor <= 0.0 {
        return shape;
    }
    match factor {
        f if (1.0 / NEAR_ENOUGH..=NEAR_ENOUGH).contains(&f) => shape,
        f => shape.with_lengths_times(round_factor(f)),
    }
}

fn round_factor(factor: f64) -> f64 {
    let power = factor.log10().floor() as i32;
    // A division by a power of ten gives tidy numbers, a multiplication by a tenth does not.
    let ten = 10.0_f64.powi(power.abs());
    let scaled = |v: f64| if power < 0 { v / ten } else { v * ten };
    let nearest = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .min_by(|a: &f64, b| (scaled(*a) / factor).ln().abs().total_cmp(&(scaled(*b) / factor).ln().abs()));
    scaled(nearest.unwrap_or(1.0))
}

/// The position of something with these bounds: on the surface rather than in it, and not inside another shape.
pub fn position(state: &EditorState, bounds: &Aabb, placing: &Placing) -> DVec3 {
    let Placing { point, normal } = *placing;
    if !bounds.is_finite() || bounds.is_empty() {
        return point;
    }
    match normal {
        Some(normal) if normal == DVec3::Y => point - DVec3::Y * bounds.min.y,
        Some(normal) => {
            // As far as the ellipsoid within the bounds reaches: it touches rather than floats.
            let reach = (bounds.half() * normal).length();
            let step = finest_step(Projection::of(&state.view).meters_per_point(point));
            rounded_point(point + normal * reach - bounds.center(), step)
        }
        None => uncovered(state, bounds, point),
    }
}

/// The position, or a higher one on top of what would cover all of it.
fn uncovered(state: &EditorState, bounds: &Aabb, mut position: DVec3) -> DVec3 {
    let scene = state.session.document.scene();
    let solid = |kind: &NodeKind| matches!(kind, NodeKind::Object(_) | NodeKind::Mesh(_));
    let others: Vec<Aabb> = scene
        .nodes()
        .iter()
        .filter(|node| node.visible && node.adds() && solid(&node.kind))
        .filter_map(|node| bounds::of_nodes(scene, state.derived.library(), &[node.id]))
        .collect();
    for _ in 0..MOST_MOVES {
        let own = bounds.translated(position);
        let covering = |other: &&Aabb| {
            let room = other.expanded(1e-3 * other.half().max_element());
            room.contains(own.min) && room.contains(own.max)
        };
        let Some(top) = others.iter().filter(covering).map(|other| other.max.y).max_by(f64::total_cmp) else { break };
        position.y = top - bounds.min.y;
    }
    position
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_round() {
        let found = [0.0021, 0.034, 0.3, 3.0, 7.5, 31.0, 480.0].map(round_factor);
        assert_eq!(found, [0.002, 0.05, 0.2, 2.0, 10.0, 20.0, 500.0].map(|v| v));
    }

    #[test]
    fn a_shape_suits_the_view() {
        let mut state = EditorState::default();
        let size = |state: &EditorState| {
            2.0 * sized(state, ShapeKind::Box.default_shape(), DVec3::ZERO).bounds().half().max_element()
        };
        assert_eq!(size(&state), 1.0);
        state.view.navigation.distance *= 100.0;
        assert_eq!(size(&state), 100.0);
        state.view.navigation.distance /= 10_000.0;
        assert_eq!(size(&state), 0.01);
    }
}
