//! The lens of a camera: depth of field by views from many points of its opening.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::{Camera, pixel_jitter};

/// A thin lens. Points at the focus distance are sharp.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lens {
    /// Diameter of the opening, in meters; 0 is a pinhole, which sees everything sharp.
    pub aperture: f64,
    /// Distance of the sharp plane, along the view axis, in meters.
    pub focus_distance: f64,
    /// How long it is open, in seconds, around the moment of the picture; 0 stops all motion.
    pub shutter: f64,
}

/// The view of one sample: its camera, and its place in the pixels of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleView {
    /// The camera; it stands at a point of the lens.
    pub camera: Camera,
    /// Offset from the center of each pixel to the place in the camera's picture that the pixel shows, in pixels.
    pub offset: DVec2,
}

impl From<Camera> for SampleView {
    /// Through the centers of the pixels.
    fn from(camera: Camera) -> Self {
        Self { camera, offset: DVec2::ZERO }
    }
}

impl Lens {
    /// The moment of a sample after that of the first one, in seconds: within half the time that the shutter is open. The
    /// moments of any number of samples cover that time evenly (multiples of the golden ratio).
    pub fn moment(&self, sample: u32) -> f64 {
        self.shutter * ((0.5 + 0.618_033_988_75 * f64::from(sample)).fract() - 0.5)
    }

    /// Whether it blurs what is not in the sharp plane.
    pub fn is_open(&self) -> bool {
        self.aperture > 0.0
    }

    /// The greatest offset of a view besides the jitter within a pixel, in pixels of a picture of this height.
    pub fn greatest_offset(&self, camera: &Camera, height: u32) -> f64 {
        if self.is_open() { 0.5 * self.aperture / self.focus_distance / camera.footprint(height.into()) } else { 0.0 }
    }

    /// The view of one of `samples` samples. The first is that of the pinhole.
    ///
    /// The points of the lens form a spiral (Vogel, *A better way to construct the sunflower head*, 1979), and each view
    /// is moved so that the sharp plane stays in place (Haeberli and Akeley, *The Accumulation Buffer*, 1990).
    pub fn view(&self, camera: &Camera, height: u32, sample: u32, samples: u32) -> SampleView {
        let jitter = pixel_jitter(sample);
        if !self.is_open() || sample == 0 {
            return SampleView { camera: *camera, offset: jitter };
        }
        let radius = 0.5 * self.aperture * (f64::from(sample) / f64::from(samples.max(1))).sqrt();
        let golden_angle = PI * (3.0 - 5.0_f64.sqrt());
        let point = DVec2::from_angle(golden_angle * f64::from(sample)) * radius;
        let position = camera.position + camera.rotation * DVec3::new(point.x, point.y, 0.0);
        let moved = point / self.focus_distance / camera.footprint(height.into());
        SampleView { camera: Camera { position, ..*camera }, offset: jitter + DVec2::new(-moved.x, moved.y) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_focus_stays_in_its_pixel() {
        let camera = Camera::looking_at(DVec3::new(3.0, 2.0, 5.0), DVec3::ZERO, 0.6);
        let lens = Lens { aperture: 0.3, focus_distance: 4.0, shutter: 0.0 };
        let (size, pixel) = (DVec2::new(60.0, 40.0), DVec2::new(13.25, 31.5));
        let seen = camera.ray(pixel, size);
        let forward = camera.rotation * DVec3::NEG_Z;
        let at_depth = |depth: f64| seen.at(depth / seen.direction.dot(forward));
        let place = |view: SampleView, depth: f64| {
            let (place, _) = view.camera.project(at_depth(depth), size).expect("before the eye");
            place - view.offset
        };
        let mut farthest: f64 = 0.0;
        for sample in 0..64 {
            let view = lens.view(&camera, 40, sample, 64);
            let jitter = pixel_jitter(sample);
            assert!((place(view, 4.0) + jitter - pixel).length() < 1e-9, "{sample}");
            // Beyond the sharp plane a point wanders by as much as the lens is wide, seen from there.
            let wandered = (place(view, 8.0) + jitter - pixel).length() * 8.0 * camera.footprint(40.0);
            assert!(wandered <= 0.15 + 1e-9, "{sample}: {wandered}");
            farthest = farthest.max(wandered);
            assert!((view.offset - jitter).length() <= lens.greatest_offset(&camera, 40) + 1e-9);
        }
        assert!(farthest > 0.14, "{farthest}");
        let pinhole = Lens::default().view(&camera, 40, 7, 64);
        assert_eq!((pinhole.camera, pinhole.offset), (camera, pixel_jitter(7)));
    }

    #[test]
    fn moments_cover_the_time_that_the_shutter_is_open() {
        let lens = Lens { shutter: 0.4, ..Lens::default() };
        assert_eq!(lens.moment(0), 0.0);
        for count in [16, 64] {
            let mut moments: Vec<_> = (0..count).map(|sample| lens.moment(sample)).collect();
            moments.sort_by(f64::total_cmp);
            assert!(moments.iter().all(|moment| moment.abs() <= 0.2));
            let widest = moments.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
            assert!(widest < 2.0 * 0.4 / f64::from(count), "{count}: {widest}");
        }
    }
}
