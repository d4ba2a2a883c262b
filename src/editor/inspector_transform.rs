//! Position, rotation, scale. Rotation is shown in degrees; the stored quaternion changes only when
//! the artist changes an angle.

use egui::{Id, Ui};
use glam::{DQuat, DVec3, EulerRot};

use super::multi_edit::MultiEdit;
use super::numbers::{self, FieldResponse, NumberField};
use super::{inspector_params, keying, widgets};
use isolith_scene::limits::POSITION;
use isolith_scene::{Limits, Node, NodeKind, Part};

const ROTATION_FIELD: NumberField<'_> = NumberField {
    label: "Rotation",
    help: "Degrees: Y turns like a compass, then X tilts, then Z rolls",
    limits: Limits::new([-180.0, 180.0], [-36_000.0, 36_000.0], "°"),
    default: Some(0.0),
};

/// The last typed angles and their quaternion: until it changes, the fields show the angles as typed.
#[derive(Default)]
pub struct EulerMemory {
    rotation: DQuat,
    degrees: DVec3,
    /// Show the position in the world rather than in the group.
    in_world: bool,
}

impl EulerMemory {
    /// The card.
    pub fn show(&mut self, ui: &mut Ui, edit: &mut MultiEdit<'_>) {
        widgets::card(ui, "Transform", |ui| {
            let is_inside = edit.active().parent.is_some();
            if is_inside {
                self.space_row(ui);
            }
            match is_inside && self.in_world {
                true => world_position(ui, edit),
                false => inspector_params::row(ui, edit, Part::Transform, "translation"),
            }
            self.rotation_row(ui, edit);
            if let Some(mut scalable) = edit.only(|n| !matches!(n.kind, NodeKind::Light(_) | NodeKind::Camera(_))) {
                inspector_params::row(ui, &mut scalable, Part::Transform, "scale");
            }
        });
    }

    fn space_row(&mut self, ui: &mut Ui) {
        let help = |in_world| if in_world { "The position in the world" } else { "The position in the group" };
        let label = |in_world| if in_world { "World" } else { "Local" };
        let (_, chosen) = widgets::row(ui, "Coordinates", "Whether the position is that in the group", |ui| {
            widgets::choice(ui, "Coordinates", Some(self.in_world), &[false, true], label, help)
        });
        self.in_world = chosen.unwrap_or(self.in_world);
    }

    fn rotation_row(&mut self, ui: &mut Ui, edit: &mut MultiEdit<'_>) {
        let shown = self.degrees(edit.active().transform.rotation);
        let mixed = [0, 1, 2].map(|axis| edit.common(|n| self.degrees(n.transform.rotation)[axis]).is_none());
        let (top, paths) = (ui.cursor().min, edit.paths(Part::Transform, "rotation"));
        let changed = widgets::row(ui, ROTATION_FIELD.label, ROTATION_FIELD.help, |ui| {
            numbers::vector(ui, &ROTATION_FIELD, shown.to_array(), mixed)
        });
        keying::mark(ui, edit.session(), ROTATION_FIELD.label, &paths, top);
        let Some((axis, FieldResponse { widget, value: Some(value) })) = changed else { return };
        self.turn(edit, widget, axis, value);
    }

    /// Sets one angle in every node and keeps their other angles.
    fn turn(&mut self, edit: &mut MultiEdit<'_>, widget: Id, axis: usize, value: f64) {
        let mut degrees = self.degrees(edit.active().transform.rotation);
        degrees[axis] = value;
        let (active, rotation) = (edit.active().id, to_quaternion(degrees));
        edit.change(widget, |node| {
            node.transform.rotation = if node.id == active {
                rotation
            } else {
                let mut own = to_degrees(node.transform.rotation);
                own[axis] = value;
                to_quaternion(own)
            };
        });
        (self.rotation, self.degrees) = (rotation, degrees);
    }

    fn degrees(&self, rotation: DQuat) -> DVec3 {
        if rotation == self.rotation { self.degrees } else { to_degrees(rotation) }
    }
}

/// The position in the world. A change moves each node along that axis of the world alone.
fn world_position(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    let field = NumberField {
        label: "World position",
        help: "The position in the world: it changes along the axes of the world",
        limits: POSITION,
        default: None,
    };
    let scene = edit.session().document.snapshot();
    let place = |node: &Node| scene.world_from_local(node.id).translation;
    let shown = place(edit.active());
    let mixed = [0, 1, 2].map(|axis| edit.common(|n| place(n)[axis]).is_none());
    let changed = widgets::row(ui, field.label, field.help, |ui| numbers::vector(ui, &field, shown.to_array(), mixed));
    let Some((axis, FieldResponse { widget, value: Some(value) })) = changed else { return };
    edit.change(widget, |node| {
        let mut wanted = place(node);
        wanted[axis] = value;
        let parent_from_world = node.parent.map(|parent| scene.world_from_local(parent).inverse());
        let local = parent_from_world.map_or(wanted, |parent| parent.transform_point3(wanted));
        if local.is_finite() {
            node.transform.translation = local;
        }
    });
}

/// Angles about X, Y and Z in degrees, applied Z first, then X, then Y.
fn to_degrees(rotation: DQuat) -> DVec3 {
    let (y, x, z) = rotation.to_euler(EulerRot::YXZ);
    // Round to a billionth, to hide −0 and 1e-15; adding 0 turns −0 into 0.
    DVec3::new(x, y, z).map(|a| (a.to_degrees() * 1e9).round() / 1e9 + 0.0)
}

fn to_quaternion(degrees: DVec3) -> DQuat {
    let r = degrees.map(f64::to_radians);
    DQuat::from_euler(EulerRot::YXZ, r.y, r.x, r.z).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_survive_the_way_through_the_quaternion() {
        for degrees in [DVec3::new(30.0, -120.0, 45.0), DVec3::new(-80.0, 10.0, 170.0), DVec3::ZERO] {
            assert!((to_degrees(to_quaternion(degrees)) - degrees).length() < 1e-6);
        }
    }

    #[test]
    fn typed_angles_are_shown_as_typed_even_where_they_are_not_unique() {
        let degrees = DVec3::new(90.0, 400.0, 20.0);
        let memory = EulerMemory { rotation: to_quaternion(degrees), degrees, in_world: false };
        assert_eq!(memory.degrees(to_quaternion(degrees)), degrees);
        assert_ne!(memory.degrees(DQuat::IDENTITY), degrees);
    }
}
