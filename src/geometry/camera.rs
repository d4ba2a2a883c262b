//! Perspective cameras.

use glam::{DQuat, DVec2, DVec3};

use super::{Aabb, Ray};

/// A perspective camera: looks along its local −Z with +Y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye.
    pub position: DVec3,
    /// World from camera.
    pub rotation: DQuat,
    /// Full vertical angle of view in radians.
    pub fov_y: f64,
    /// The near limit: the least visible distance from the eye, along the ray as depth is, not along the view axis.
    pub near: f64,
    /// The far limit: the greatest visible distance, measured as `near` is.
    pub far: f64,
}

impl Camera {
    /// The angle of view of a new camera, 40°.
    pub const DEFAULT_FOV_Y: f64 = 40.0 * std::f64::consts::PI / 180.0;
    /// The near limit of a new camera.
    pub const DEFAULT_NEAR: f64 = 1e-3;
    /// The far limit of a new camera.
    pub const DEFAULT_FAR: f64 = 1e4;

    /// A camera at `position` that looks at `target` with +Y up (or +Z, when it looks along Y).
    pub fn looking_at(position: DVec3, target: DVec3, fov_y: f64) -> Self {
        let back = (position - target).try_normalize().unwrap_or(DVec3::Z);
        let up = if back.cross(DVec3::Y).length() > 1e-6 { DVec3::Y } else { DVec3::Z };
        let right = up.cross(back).normalize();
        let rotation = DQuat::from_mat3(&glam::DMat3::from_cols(right, back.cross(right), back));
        Self { position, rotation, fov_y, near: Self::DEFAULT_NEAR, far: Self::DEFAULT_FAR }
    }

    /// A camera that shows all of a finite box, from `direction` (which points from the box to the eye).
    pub fn framing(bounds: &Aabb, direction: DVec3, fov_y: f64, aspect: f64) -> Self {
        let radius = bounds.half().length().max(1e-6);
        let half_angle = (fov_y * 0.5).min(((fov_y * 0.5).tan() * aspect).atan());
        let distance = radius / half_angle.sin();
        let mut camera = Self::looking_at(bounds.center() + direction.normalize() * distance, bounds.center(), fov_y);
        camera.near = distance * 1e-4;
        camera.far = (distance + radius) * 1e3;
        camera
    }

    /// Half the height of the image at distance 1 in front of the eye.
    pub fn tan_half_fov(&self) -> f64 {
        (self.fov_y * 0.5).tan()
    }

    /// The cosine of the angle between the view axis and the rays through the corners of an image of `size` pixels:
    /// the least ratio of the depth along the axis to the distance along the ray.
    pub fn corner_cosine(&self, size: [u32; 2]) -> f64 {
        let up = self.tan_half_fov();
        let right = up * f64::from(size[0]) / f64::from(size[1]);
        1.0 / (1.0 + right * right + up * up).sqrt()
    }

    /// The ray through a point of the image; `pixel` in pixels from the upper left corner (pixel centers at .5),
    /// `size` the image's size in pixels.
    pub fn ray(&self, pixel: DVec2, size: DVec2) -> Ray {
        let t = self.tan_half_fov();
        let ndc = DVec2::new(2.0 * pixel.x / size.x - 1.0, 1.0 - 2.0 * pixel.y / size.y);
        let local = DVec3::new(ndc.x * t * size.x / size.y, ndc.y * t, -1.0);
        Ray { origin: self.position, direction: self.rotation * local.normalize() }
    }

    /// Width of a pixel, in world units, at distance 1 from the eye: the footprint of a pixel at
    /// distance `t` is `t` times this.
    pub fn footprint(&self, height_px: f64) -> f64 {
        2.0 * self.tan_half_fov() / height_px
    }

    /// The position of a world point in pixels, with its depth along the view axis; `None` behind the eye.
    pub fn project(&self, p: DVec3, size: DVec2) -> Option<(DVec2, f64)> {
        let local = self.rotation.inverse() * (p - self.position);
        if local.z >= -1e-12 {
            return None;
        }
        let t = self.tan_half_fov();
        let ndc = DVec2::new(local.x / (-local.z * t * size.x / size.y), local.y / (-local.z * t));
        Some((DVec2::new((ndc.x + 1.0) * 0.5 * size.x, (1.0 - ndc.y) * 0.5 * size.y), -local.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn projecting_a_point_of_a_ray_gives_its_pixel() {
        let camera = Camera::looking_at(DVec3::new(3.0, 4.0, 5.0), DVec3::new(0.5, 0.0, -1.0), 0.8);
        let size = DVec2::new(320.0, 200.0);
        for pixel in [DVec2::new(0.5, 0.5), DVec2::new(160.0, 100.0), DVec2::new(300.25, 17.5)] {
            let (back, _) = camera.project(camera.ray(pixel, size).at(7.0), size).unwrap();
            assert!((back - pixel).length() < 1e-9, "{pixel} {back}");
        }
    }

    #[test]
    fn no_ray_is_farther_from_the_view_axis_than_the_corners() {
        let mut camera = Camera::looking_at(DVec3::ZERO, DVec3::new(0.3, -0.2, -1.0), 1.0);
        let forward = camera.rotation * DVec3::NEG_Z;
        for (degrees, size) in [(40.0_f64, [64, 64]), (120.0, [64, 36]), (170.0, [9, 90]), (0.1, [8192, 8])] {
            camera.fov_y = degrees.to_radians();
            let pixels = DVec2::new(size[0].into(), size[1].into());
            let cosine = |x: f64, y: f64| camera.ray(pixels * DVec2::new(x, y), pixels).direction.dot(forward);
            let corner = camera.corner_cosine(size);
            assert!((cosine(0.0, 0.0) - corner).abs() < 1e-12 && (cosine(1.0, 0.0) - corner).abs() < 1e-12);
            assert!(cosine(0.0, 0.5) > corner && cosine(0.3, 1.0) > corner);
        }
    }

    #[test]
    fn framing_sees_every_corner() {
        let bounds = Aabb::new(DVec3::new(-1.0, 0.0, 2.0), DVec3::new(4.0, 1.0, 3.0));
        let size = DVec2::new(200.0, 300.0);
        let camera = Camera::framing(&bounds, DVec3::new(1.0, 0.7, 0.4), 0.7, size.x / size.y);
        for corner in bounds.corners() {
            let (px, _) = camera.project(corner, size).unwrap();
            assert!(px.x >= 0.0 && px.y >= 0.0 && px.x <= size.x && px.y <= size.y, "{px}");
        }
    }
}
