//! Picture of a material: a ball on a floor, between the lamps of a studio. For thumbnails.
//!
//! The integral over the studio takes a few samples of each lobe of the material, weighted by the balance heuristic
//! (Veach 1997). Each sample sees the studio blurred by the solid angle that it stands for (filtered importance
//! sampling, Křivánek and Colbert 2008), so that few samples give a smooth picture.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::brdf::{ShadingPoint, brdf_direct};
use super::display::display_encode;
use crate::flat_material::FlatMaterial;
use crate::mixture::SurfaceMaterial;

/// Place of the eye; the ball has radius 1 and stands at the origin.
const EYE: DVec3 = DVec3::new(0.0, 1.05, 6.4);
/// The point in the middle of the picture.
const TARGET: DVec3 = DVec3::new(0.0, -0.06, 0.0);
/// Half of the picture's height at distance 1.
const HALF_HEIGHT: f64 = 0.2;
/// Samples of each lobe.
const SAMPLES: u32 = 10;
/// The blur of a sample covers this many times the solid angle that it stands for.
const WIDENED: f64 = 2.2;
/// A smoother lobe would hold no more than a pixel of the reflection.
const LEAST_ROUGHNESS: f64 = 0.07;

/// A lamp of the studio: a rectangle far away.
struct Lamp {
    /// Unit direction toward it.
    direction: DVec3,
    /// Half of its width and height, in radians.
    half_size: DVec2,
    /// Its radiance.
    radiance: DVec3,
}

/// The studio: three lamps above a floor.
struct Studio {
    lamps: [Lamp; 3],
    /// Of the ball.
    opacity: f64,
}

/// A lobe of a material: where its samples go.
#[derive(Clone, Copy)]
enum Lobe {
    /// By the cosine.
    Diffuse,
    /// By the normals of GGX with this alpha.
    Glossy(f64),
}

/// The picture of a material: `side` rows of as many pixels from the top, red, green, blue and 255.
pub fn material_ball(of: &FlatMaterial, side: usize) -> Vec<[u8; 4]> {
    let mut material = SurfaceMaterial::from(of);
    material.roughness = material.roughness.max(LEAST_ROUGHNESS);
    material.coat_roughness = material.coat_roughness.max(LEAST_ROUGHNESS);
    let is_cut = of.opacity_threshold > 0.0;
    let studio = Studio { opacity: if is_cut { 1.0 } else { f64::from(of.opacity) }, ..Studio::new() };
    let back = (EYE - TARGET).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let world_from_view = DMat3::from_cols(right, back.cross(right), back);
    let pixel = 2.0 * HALF_HEIGHT / side as f64;
    let color = |index: usize| {
        let at = DVec2::new((index % side) as f64 + 0.5, (index / side) as f64 + 0.5) * pixel - HALF_HEIGHT;
        let direction = (world_from_view * DVec3::new(at.x, -at.y, -1.0)).normalize();
        let color = studio.pixel(&material, &world_from_view, direction, pixel);
        let [r, g, b] = (display_encode(shoulder(color)) * 255.0).to_array().map(|v| v.round() as u8);
        [r, g, b, 255]
    };
    (0..side * side).map(color).collect()
}

/// Compresses what is brighter than a screen.
fn shoulder(color: DVec3) -> DVec3 {
    const START: f64 = 0.72;
    let rest = 1.0 - START;
    color.map(|v| if v < START { v } else { START + rest * (1.0 - (-(v - START) / rest).exp()) })
}

impl Studio {
    fn new() -> Self {
        let lamp = |direction: [f64; 3], half_size: [f64; 2], radiance: [f64; 3]| Lamp {
            direction: DVec3::from(direction).normalize(),
            half_size: half_size.into(),
            radiance: radiance.into(),
        };
        Self {
            opacity: 1.0,
            lamps: [
                // The key over the left shoulder, a weak fill from the right, a rim from behind.
                lamp([-0.62, 0.80, 0.72], [0.42, 0.36], [4.6, 4.45, 4.2]),
                lamp([0.95, 0.18, 0.75], [0.30, 0.62], [0.60, 0.68, 0.82]),
                lamp([0.80, 0.42, -0.62], [0.20, 0.65], [4.2, 4.6, 5.4]),
            ],
        }
    }

    /// Color of the pixel that sees along `direction`.
    fn pixel(&self, material: &SurfaceMaterial, world_from_view: &DMat3, direction: DVec3, pixel: f64) -> DVec3 {
        let behind = self.backdrop(direction, material);
        let depth = -EYE.dot(direction);
        let nearest = EYE + direction * depth;
        let outside = nearest.length() - 1.0;
        let coverage = (0.5 - outside / (pixel * depth)).clamp(0.0, 1.0);
        if coverage <= 0.0 {
            return behind;
        }
        let into = (1.0 - nearest.length_squared()).max(0.0).sqrt();
        let normal = (nearest - direction * into).normalize();
        let point = ShadingPoint { material: *material, position: normal - EYE, normal, to_eye: -direction };
        behind.lerp(self.reflected(&point, world_from_view) + material.emission, coverage * self.opacity)
    }

    /// The light of the studio that a point of the ball reflects to the eye.
    fn reflected(&self, point: &ShadingPoint, world_from_view: &DMat3) -> DVec3 {
        let material = &point.material;
        let glossy = |roughness: f64| Lobe::Glossy(roughness * roughness);
        let phong = Lobe::Glossy((2.0 / (material.phong_shininess + 2.0)).sqrt().max(LEAST_ROUGHNESS.powi(2)));
        let specular = if material.phong_weight > 0.5 { phong } else { glossy(material.roughness) };
        let coat = (material.coat_weight > 0.0).then(|| glossy(material.coat_roughness));
        let lobes = [Some(Lobe::Diffuse), Some(specular), coat];
        let count = f64::from(SAMPLES);
        let frame = frame_of(point.normal, world_from_view);
        let mut sum = DVec3::ZERO;
        for lobe in lobes.iter().flatten() {
            for sample in 0..SAMPLES {
                let to_light = frame * lobe.sample(sample, frame.transpose() * point.to_eye);
                if to_light.dot(point.normal) <= 0.0 {
                    continue;
                }
                let density: f64 = lobes.iter().flatten().map(|other| count * other.density(point, to_light)).sum();
                // Wide enough that the samples of this lobe leave no gaps.
                let own = count * lobe.density(point, to_light);
                let blur = (WIDENED * FRAC_1_PI / own.max(1e-9)).sqrt().min(1.0);
                let light = self.light(to_light, blur, material);
                sum += brdf_direct(point, to_light) * FRAC_1_PI * light / density.max(1e-9);
            }
        }
        sum
    }

    /// Radiance from a direction, blurred by an angle.
    fn light(&self, direction: DVec3, blur: f64, material: &SurfaceMaterial) -> DVec3 {
        let above = smooth(direction.y / (0.08 + 0.7 * blur) * 0.5 + 0.5);
        let ceiling = DVec3::new(0.20, 0.21, 0.23) * (0.65 + 0.55 * direction.y.max(0.0));
        let floor = DVec3::new(0.13, 0.125, 0.12) + 0.1 * material.base_color * (-direction.y).max(0.0);
        let lamps: DVec3 = self.lamps.iter().map(|lamp| lamp.radiance * lamp.share(direction, blur)).sum();
        floor.lerp(ceiling, above) + lamps * smooth(direction.y / (0.02 + blur) + 0.5)
    }

    /// The floor and what is behind it, as the eye sees them.
    fn backdrop(&self, direction: DVec3, material: &SurfaceMaterial) -> DVec3 {
        let wall = DVec3::new(0.036, 0.039, 0.046);
        if direction.y > -0.02 {
            return wall;
        }
        let at = EYE + direction * ((-1.0 - EYE.y) / direction.y);
        let way = DVec2::new(at.x, at.z).length_squared();
        // What the ball hides of the sky over the floor, as seen from the floor.
        let open = 1.0 - (way + 1.0).powf(-1.5);
        let key = self.lamps[0].direction;
        let beside = at.reject_from_normalized(key).length();
        let lit = 1.0 - (1.0 - smooth((beside - 0.62) / 0.75)) * 0.8;
        let pool = (-0.1 * way).exp();
        let glow = material.emission * 0.30 / (1.0 + way).powf(1.5);
        let floor = DVec3::new(0.030, 0.032, 0.037) * open + DVec3::new(0.155, 0.15, 0.142) * (pool * lit * open);
        wall.lerp(floor, smooth((9.0 - at.distance(EYE)) / 3.5)) + glow
    }
}

impl Lamp {
    /// The share of its radiance from a direction, blurred by an angle: a box after a blur, along both axes.
    fn share(&self, direction: DVec3, blur: f64) -> f64 {
        let right = DVec3::Y.cross(self.direction).normalize();
        let up = self.direction.cross(right);
        let ahead = direction.dot(self.direction);
        if ahead <= 0.02 {
            return 0.0;
        }
        let width = 0.045 + 0.8 * blur;
        let edge = |at: f64, half: f64| 0.5 * (((half - at) / width).tanh() + ((half + at) / width).tanh());
        let [x, y] = [right, up].map(|axis| direction.dot(axis).atan2(ahead));
        edge(x, self.half_size.x) * edge(y, self.half_size.y)
    }
}

impl Lobe {
    /// Direction of a sample, in a frame with the normal as Z.
    fn sample(self, sample: u32, to_eye: DVec3) -> DVec3 {
        // Points of a spiral: its angles are apart by the golden ratio.
        let u = (f64::from(sample) + 0.5) / f64::from(SAMPLES);
        let (sin, cos) = (f64::from(sample) * 0.618_033_988_749_895 * TAU).sin_cos();
        let around = |height: f64| {
            let radius = (1.0 - height * height).max(0.0).sqrt();
            DVec3::new(cos * radius, sin * radius, height)
        };
        match self {
            Self::Diffuse => around((1.0 - u).sqrt()),
            Self::Glossy(alpha) => {
                let halfway = around(((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)).sqrt());
                halfway * 2.0 * halfway.dot(to_eye) - to_eye
            }
        }
    }

    /// Density of its samples in a direction.
    fn density(self, point: &ShadingPoint, to_light: DVec3) -> f64 {
        match self {
            Self::Diffuse => point.normal.dot(to_light) * FRAC_1_PI,
            Self::Glossy(alpha) => {
                let halfway = (to_light + point.to_eye).normalize_or_zero();
                let cosine = point.normal.dot(halfway).max(0.0);
                let root = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
                let normals = alpha * alpha / (PI * root * root).max(1e-12);
                normals * cosine / (4.0 * point.to_eye.dot(halfway)).max(1e-6)
            }
        }
    }
}

/// A frame with the normal as Z that turns steadily over all that the eye sees of the ball.
fn frame_of(normal: DVec3, world_from_view: &DMat3) -> DMat3 {
    let seen = world_from_view.transpose() * normal;
    // Frisvad 2012, with its singularity at the far side of the ball.
    let a = 1.0 / (1.0 + seen.z.max(-0.99));
    let b = -seen.x * seen.y * a;
    let x = DVec3::new(1.0 - seen.x * seen.x * a, b, -seen.x);
    let y = DVec3::new(b, 1.0 - seen.y * seen.y * a, -seen.y);
    DMat3::from_cols(*world_from_view * x, *world_from_view * y, normal)
}

fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{Material, MaterialId, ReflectionModel};

    const SIDE: usize = 32;

    fn plastic(color: [f64; 3]) -> Material {
        let model = ReflectionModel::BlinnPhong { specular: 0.3, shininess: 60.0 };
        Material { model, ..Material::new(MaterialId(1), "Plastic", color) }
    }

    fn ball(material: &Material) -> Vec<[u8; 4]> {
        material_ball(&FlatMaterial::new(material), SIDE)
    }

    /// Mean of the middle of the ball.
    fn middle(picture: &[[u8; 4]]) -> [f64; 3] {
        let rows = SIDE / 2 - 4..SIDE / 2 + 4;
        let pixels: Vec<_> = rows.clone().flat_map(|y| rows.clone().map(move |x| picture[y * SIDE + x])).collect();
        [0, 1, 2].map(|c| pixels.iter().map(|p| f64::from(p[c])).sum::<f64>() / pixels.len() as f64)
    }

    #[test]
    fn a_ball_has_the_color_of_its_material() {
        let [r, g, b] = middle(&ball(&plastic([0.8, 0.1, 0.1])));
        assert!(r > 120.0 && r > 1.8 * g && r > 1.8 * b, "{r} {g} {b}");
        let [white, gray, black] = [0.8, 0.2, 0.01].map(|v| middle(&ball(&plastic([v; 3])))[1]);
        assert!(white > gray + 40.0 && gray > black + 20.0, "{white} {gray} {black}");
        assert!(white > 150.0, "{white}");
    }

    #[test]
    fn a_white_ball_reflects_no_more_than_the_lamps_give() {
        let material = SurfaceMaterial { base_color: DVec3::ONE, ..SurfaceMaterial::default() };
        let studio = Studio::new();
        for normal in [DVec3::Z, DVec3::new(-0.6, 0.6, 0.5).normalize(), DVec3::new(0.7, -0.4, 0.6).normalize()] {
            let point = ShadingPoint { material, position: normal - EYE, normal, to_eye: (EYE - normal).normalize() };
            let seen = studio.reflected(&point, &DMat3::IDENTITY).y;
            assert!(seen > 0.05 && seen < 1.9, "{normal}: {seen}");
        }
    }

    #[test]
    fn emission_shines_and_lights_the_floor() {
        let dark = plastic([0.02; 3]);
        let lamp = Material { emission_luminance: 1.0, emission_color: [0.1, 0.9, 0.2], ..dark.clone() };
        let [[_, before, _], [red, green, _]] = [middle(&ball(&dark)), middle(&ball(&lamp))];
        assert!(green > before + 100.0 && green > red + 60.0, "{before} {red} {green}");
        let floor = |picture: &[[u8; 4]]| picture[(SIDE - 2) * SIDE + SIDE / 2][1];
        assert!(floor(&ball(&lamp)) > floor(&ball(&dark)), "it lights the floor");
    }

    #[test]
    fn smooth_and_rough_materials_look_different_and_the_same_one_the_same() {
        let of = |shininess| Material {
            model: ReflectionModel::BlinnPhong { specular: 0.6, shininess },
            ..plastic([0.1, 0.2, 0.5])
        };
        let [sharp, wide] = [400.0, 4.0].map(|shininess| ball(&of(shininess)));
        assert_eq!(sharp, ball(&of(400.0)));
        let far = sharp.iter().zip(&wide).filter(|(a, b)| a[1].abs_diff(b[1]) > 8).count();
        assert!(far > SIDE * SIDE / 20, "{far}");
    }
}
