//! The viewport's own camera: orbit, pan, zoom, frame. Pure mathematics in f64; panning and zooming keep the point
//! under the pointer, to the pixel.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec2, DVec3};

use isolith_geometry::{Aabb, Camera, Ray};

/// A side to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From +Z.
    Front,
    /// From −Z.
    Back,
    /// From +X.
    Right,
    /// From −X.
    Left,
    /// From +Y.
    Top,
    /// From −Y.
    Bottom,
}

impl Side {
    /// The direction from the target to the eye.
    pub fn direction(self) -> DVec3 {
        match self {
            Self::Front => DVec3::Z,
            Self::Back => DVec3::NEG_Z,
            Self::Right => DVec3::X,
            Self::Left => DVec3::NEG_X,
            Self::Top => DVec3::Y,
            Self::Bottom => DVec3::NEG_Y,
        }
    }
}

/// A camera that orbits a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Navigation {
    /// The center of the orbit.
    pub target: DVec3,
    /// Distance from the target to the eye, in meters.
    pub distance: f64,
    /// Rotation from camera space to world space.
    pub rotation: DQuat,
    /// Full vertical angle of view in radians. An orthographic view shows at the target what this angle shows there.
    pub fov_y: f64,
    /// Whether parallel lines stay parallel.
    pub orthographic: bool,
    /// Whether the next orbit ends that, because it came with a view along an axis.
    pub leaves_axis: bool,
}

impl Default for Navigation {
    fn default() -> Self {
        let camera = Camera::looking_at(DVec3::new(3.2, 2.4, 4.0), DVec3::ZERO, Camera::DEFAULT_FOV_Y);
        Self {
            target: DVec3::ZERO,
            distance: camera.position.length(),
            rotation: camera.rotation,
            fov_y: camera.fov_y,
            orthographic: false,
            leaves_axis: false,
        }
    }
}

impl Navigation {
    /// Minimum and maximum distance to the target, in meters.
    pub const DISTANCES: [f64; 2] = [1e-4, 1e7];

    /// An orthographic view is one from this many times as far, through an angle that much smaller: a point as far
    /// behind the target as the picture is high is off by half a thousandth of the picture's height at its border. The
    /// renderer is exact at such angles.
    pub const TELEPHOTO: f64 = 1e3;

    /// The camera for the renderer.
    pub fn camera(&self) -> Camera {
        let (fov_y, near) = if self.orthographic {
            // Most of the way from the eye to the target is seen.
            let half = ((0.5 * self.fov_y).tan() / Self::TELEPHOTO).atan();
            (2.0 * half, self.eye_distance() - self.distance * 0.9 * Self::TELEPHOTO)
        } else {
            (self.fov_y, self.distance * 1e-3)
        };
        let far = self.eye_distance() + self.distance.max(1.0) * 1e4;
        Camera { position: self.eye(), rotation: self.rotation, fov_y, near, far }
    }

    /// The position of the eye.
    pub fn eye(&self) -> DVec3 {
        self.target + self.rotation * DVec3::Z * self.eye_distance()
    }

    /// Distance from the target to the eye, in meters.
    pub fn eye_distance(&self) -> f64 {
        if self.orthographic { self.distance * Self::TELEPHOTO } else { self.distance }
    }

    /// Takes over a camera's placement; the new target is the point in front of it nearest to `focus`.
    pub fn look_through(&mut self, camera: &Camera, focus: DVec3) {
        let forward = camera.rotation * DVec3::NEG_Z;
        let distance = (focus - camera.position).dot(forward);
        self.rotation = camera.rotation;
        self.fov_y = camera.fov_y;
        (self.orthographic, self.leaves_axis) = (false, false);
        self.distance = if distance > 0.0 { self.limited(distance) } else { self.distance };
        self.target = camera.position + forward * self.distance;
    }

    /// Orbits the target: a drag over the whole height turns by half a circle. The horizon stays level;
    /// the orbit stops at straight up and straight down.
    pub fn orbit(&mut self, drag_px: DVec2, height_px: f64) {
        if std::mem::take(&mut self.leaves_axis) {
            self.orthographic = false;
        }
        let angle = drag_px * (PI / height_px.max(1.0));
        let pitch_now = (self.rotation * DVec3::Z).y.clamp(-1.0, 1.0).asin();
        let pitch = (pitch_now + angle.y).clamp(-FRAC_PI_2, FRAC_PI_2) - pitch_now;
        let turned = DQuat::from_rotation_y(-angle.x) * self.rotation * DQuat::from_rotation_x(-pitch);
        self.rotation = turned.normalize();
    }

    /// Turns the view around the eye.
    pub fn look_around(&mut self, drag_px: DVec2, height_px: f64) {
        let eye = self.eye();
        self.orbit(drag_px * (self.fov_y / PI), height_px);
        self.target = eye - self.rotation * DVec3::Z * self.eye_distance();
    }

    /// Moves eye and target along the axes of the view, in meters: right, up, forward.
    pub fn fly(&mut self, by: DVec3) {
        self.target += self.rotation * DVec3::new(by.x, by.y, -by.z);
    }

    /// The axis of the world along which an orthographic view looks; `None` for any other view.
    pub fn axis(&self) -> Option<usize> {
        let forward = (self.rotation * DVec3::Z).abs();
        (0..3).find(|axis| self.orthographic && forward[*axis] > 1.0 - 1e-9)
    }

    /// Moves sideways: points at the depth of the target follow the pointer.
    pub fn pan(&mut self, drag_px: DVec2, height_px: f64) {
        let per_px = self.camera().footprint(height_px) * self.eye_distance();
        self.target += self.rotation * DVec3::new(-drag_px.x, drag_px.y, 0.0) * per_px;
    }

    /// Multiplies the distance by `factor`; the point under `pixel` at the depth of the target stays there.
    pub fn zoom(&mut self, factor: f64, pixel: DVec2, size_px: DVec2) {
        let distance = self.limited(self.distance * factor);
        let factor = distance / self.distance;
        let fixed = self.under_pointer(pixel, size_px);
        self.target = fixed + (self.target - fixed) * factor;
        self.distance = distance;
    }

    /// The point under `pixel` in the plane through the target that faces the eye.
    pub fn under_pointer(&self, pixel: DVec2, size_px: DVec2) -> DVec3 {
        let ray = self.ray(pixel, size_px);
        let forward = self.rotation * DVec3::NEG_Z;
        ray.at(self.eye_distance() / ray.direction.dot(forward))
    }

    /// The ray through a pixel.
    pub fn ray(&self, pixel: DVec2, size_px: DVec2) -> Ray {
        self.camera().ray(pixel, size_px)
    }

    /// Shows all of a finite box from the current direction, with a small margin.
    pub fn frame(&mut self, bounds: &Aabb, aspect: f64) {
        if !bounds.is_finite() || bounds.is_empty() {
            return;
        }
        let direction = self.rotation * DVec3::Z;
        let framing = Camera::framing(bounds, direction, self.fov_y, aspect.max(1e-3));
        self.target = bounds.center();
        self.distance = self.limited((framing.position - self.target).length() * 1.05);
    }

    /// Looks at the target from a side.
    pub fn look_from(&mut self, side: Side) {
        self.rotation = match side {
            Side::Top => DQuat::from_rotation_x(-FRAC_PI_2),
            Side::Bottom => DQuat::from_rotation_x(FRAC_PI_2),
            _ => Camera::looking_at(side.direction(), DVec3::ZERO, self.fov_y).rotation,
        };
    }

    /// Looks at the target along an axis, and in parallel until the next orbit.
    pub fn look_along(&mut self, side: Side) {
        self.look_from(side);
        self.leaves_axis |= !self.orthographic;
        self.orthographic = true;
    }

    /// Switches between perspective and orthographic.
    pub fn toggle_orthographic(&mut self) {
        self.orthographic ^= true;
        self.leaves_axis = false;
    }

    fn limited(&self, distance: f64) -> f64 {
        distance.clamp(Self::DISTANCES[0], Self::DISTANCES[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: DVec2 = DVec2::new(800.0, 500.0);

    fn somewhere() -> Navigation {
        let mut view = Navigation { target: DVec3::new(1.0, -2.0, 3.0), distance: 7.0, ..Navigation::default() };
        view.orbit(DVec2::new(130.0, -40.0), SIZE.y);
        view
    }

    #[test]
    fn orbiting_keeps_the_target_and_the_distance() {
        let mut view = somewhere();
        for i in 0..200 {
            view.orbit(DVec2::new(37.0, if i % 3 == 0 { 90.0 } else { -31.0 }), SIZE.y);
            let (pixel, depth) = view.camera().project(view.target, SIZE).unwrap();
            assert!((pixel - SIZE * 0.5).length() < 1e-6 && (depth - 7.0).abs() < 1e-9);
            let right = view.rotation * DVec3::X;
            assert!(right.y.abs() < 1e-9, "the horizon stays level");
            assert!((view.rotation * DVec3::Y).y > -1e-9, "never upside down");
        }
    }

    #[test]
    fn dragging_right_shows_more_of_the_left_side() {
        let mut view = Navigation::default();
        view.look_from(Side::Front);
        view.orbit(DVec2::new(10.0, 0.0), SIZE.y);
        assert!(view.eye().x < 0.0);
        view.look_from(Side::Front);
        view.orbit(DVec2::new(0.0, 10.0), SIZE.y);
        assert!(view.eye().y > 0.0, "dragging down shows more of the top");
    }

    #[test]
    fn panning_moves_the_point_under_the_pointer_with_it() {
        let mut view = somewhere();
        let start = DVec2::new(200.5, 130.25);
        let point = view.under_pointer(start, SIZE);
        let drag = DVec2::new(57.0, -21.0);
        view.pan(drag, SIZE.y);
        let (pixel, _) = view.camera().project(point, SIZE).unwrap();
        assert!((pixel - (start + drag)).length() < 1e-8, "{pixel}");
    }

    #[test]
    fn zooming_keeps_the_point_under_the_pointer() {
        let mut view = somewhere();
        let pixel = DVec2::new(612.5, 88.0);
        let point = view.under_pointer(pixel, SIZE);
        for factor in [0.5, 0.9, 1.7, 0.25, 3.0] {
            view.zoom(factor, pixel, SIZE);
            let (at, _) = view.camera().project(point, SIZE).unwrap();
            assert!((at - pixel).length() < 1e-7, "{at}");
        }
        view.zoom(1e-30, pixel, SIZE);
        assert_eq!(view.distance, Navigation::DISTANCES[0]);
    }

    #[test]
    fn framing_shows_every_corner() {
        let bounds = Aabb::new(DVec3::new(-3.0, 0.0, 10.0), DVec3::new(1.0, 9.0, 11.0));
        for size in [SIZE, DVec2::new(200.0, 900.0)] {
            let mut view = somewhere();
            view.frame(&bounds, size.x / size.y);
            for corner in bounds.corners() {
                let (p, _) = view.camera().project(corner, size).unwrap();
                assert!(p.cmpge(DVec2::ZERO).all() && p.cmple(size).all(), "{p}");
            }
        }
        let mut view = somewhere();
        view.frame(&Aabb::EVERYTHING, 1.0);
        assert_eq!(view, somewhere(), "nothing to frame, nothing changes");
    }

    #[test]
    fn each_side_looks_along_its_axis() {
        for side in [Side::Front, Side::Back, Side::Right, Side::Left, Side::Top, Side::Bottom] {
            let mut view = somewhere();
            view.look_from(side);
            assert!((view.rotation * DVec3::Z - side.direction()).length() < 1e-12, "{side:?}");
            assert!((view.rotation * DVec3::X).y.abs() < 1e-12, "{side:?}");
        }
    }

    #[test]
    fn an_orthographic_view_shows_the_target_as_large_and_keeps_parallels() {
        let near = somewhere();
        let far = Navigation { orthographic: true, ..near };
        let height = |view: &Navigation, depth: f64| {
            let at = |up: f64| view.target + view.rotation * DVec3::new(0.0, up, -depth);
            let [low, high] = [-0.5, 0.5].map(|up| view.camera().project(at(up), SIZE).unwrap().0.y);
            (low - high).abs()
        };
        assert!((height(&near, 0.0) - height(&far, 0.0)).abs() < 1e-3);
        let picture = 2.0 * near.distance * (0.5 * near.fov_y).tan();
        let (front, back) = (height(&far, -picture), height(&far, picture));
        assert!((front / back - 1.0).abs() < 2e-3, "{front} {back}");
        assert!(height(&near, -picture) / height(&near, picture) > 2.0, "unlike in perspective");
        for depth in [-20.0 * picture, 20.0 * picture] {
            let point = far.target - far.rotation * DVec3::Z * depth;
            let distance = point.distance(far.eye());
            assert!((far.camera().near..far.camera().far).contains(&distance), "{depth}");
        }
        let mut moved = far;
        let start = DVec2::new(200.5, 130.25);
        let point = moved.under_pointer(start, SIZE);
        moved.pan(DVec2::new(57.0, -21.0), SIZE.y);
        let (pixel, _) = moved.camera().project(point, SIZE).unwrap();
        assert!((pixel - start - DVec2::new(57.0, -21.0)).length() < 1e-5, "{pixel}");
    }

    #[test]
    fn looking_around_keeps_the_eye_and_flying_keeps_the_direction() {
        let before = somewhere();
        let mut view = before;
        view.look_around(DVec2::new(90.0, -30.0), SIZE.y);
        assert!((view.eye() - before.eye()).length() < 1e-9);
        let right = before.rotation * DVec3::X;
        assert!((view.rotation * DVec3::NEG_Z).dot(right) > 0.05, "a drag to the right looks to the right");
        let turned = view;
        view.fly(DVec3::new(0.0, 0.0, 2.0));
        let forward = turned.rotation * DVec3::NEG_Z;
        assert!((view.eye() - turned.eye() - forward * 2.0).length() < 1e-9 && view.rotation == turned.rotation);
    }

    #[test]
    fn only_an_orthographic_view_along_an_axis_has_one() {
        let mut view = somewhere();
        view.look_from(Side::Right);
        assert_eq!(view.axis(), None);
        view.orthographic = true;
        assert_eq!(view.axis(), Some(0));
        view.orbit(DVec2::new(3.0, 0.0), SIZE.y);
        assert_eq!(view.axis(), None);
    }

    #[test]
    fn looking_through_a_camera_sees_what_it_sees() {
        let camera = Camera::looking_at(DVec3::new(5.0, 2.0, 1.0), DVec3::new(0.0, 1.0, 0.0), 0.6);
        let mut view = Navigation::default();
        view.look_through(&camera, DVec3::ZERO);
        let (a, b) = (camera.ray(DVec2::new(13.0, 99.0), SIZE), view.ray(DVec2::new(13.0, 99.0), SIZE));
        assert!((a.origin - b.origin).length() < 1e-9 && (a.direction - b.direction).length() < 1e-9);
    }
}
