//! Materials: the names, ranges and defaults of OpenPBR; reflection and mixtures alike on both sides.

mod specification;

use bytemuck::{Zeroable as _, cast_slice};
use glam::DVec3;
use isolith::field::FlatMaterial;
use isolith::field::light::brdf::{EnvironmentShares, ShadingPoint, brdf_direct, brdf_environment};
use isolith::field::mixture::{MIXED, SurfaceMaterial, mixture_decoded, mixture_material};
use isolith::render::brdf_probe::{BrdfAnswer, BrdfQuery, mixed, reflected};
use isolith::scene::{Material, ReflectionModel};

use crate::contract::samples::Random;
use crate::gpu::shared;

/// Number of random materials and directions.
const QUERIES: usize = 4_000;
/// What 32-bit numbers may be off by, as a share of the value or of white.
const TOLERANCE: f64 = 2e-3;

/// A material of which nothing is left at its default.
fn material(random: &mut Random) -> FlatMaterial {
    let mut unit = |corners: f64| if random.chance(corners) { random.index(2) as f64 } else { random.range(0.0, 1.0) };
    let color = |unit: &mut dyn FnMut(f64) -> f64| [unit(0.2), unit(0.2), unit(0.2)];
    let phong = ReflectionModel::BlinnPhong { specular: unit(0.1), shininess: 1.0 + 200.0 * unit(0.1) };
    let model = if unit(0.0) < 0.2 { phong } else { ReflectionModel::OpenPbr {} };
    FlatMaterial::new(&Material {
        base_color: color(&mut unit),
        base_weight: unit(0.3),
        base_metalness: unit(0.6),
        base_diffuse_roughness: unit(0.5),
        specular_weight: unit(0.5),
        specular_color: color(&mut unit),
        specular_roughness: unit(0.2),
        specular_ior: 1.0 + 2.0 * unit(0.1),
        coat_weight: unit(0.5),
        coat_color: color(&mut unit),
        coat_roughness: unit(0.3),
        coat_ior: 1.0 + 2.0 * unit(0.1),
        emission_luminance: unit(0.0),
        emission_color: color(&mut unit),
        coat_darkening: unit(0.5),
        model,
        ..Material::default()
    })
}

/// A surface, seen and lit from above it.
fn query(random: &mut Random) -> BrdfQuery {
    let normal = random.direction();
    let mut above = |least: f64| loop {
        let direction = random.direction();
        if direction.dot(normal) > least {
            return direction;
        }
    };
    let to_eye = above(0.02);
    // Often near the mirrored direction, where highlights are.
    let mirrored = 2.0 * normal.dot(to_eye) * normal - to_eye;
    let near = [0.0, 0.002, 0.05, 10.0, 10.0][random.index(5)];
    let to_light = (mirrored + random.direction() * near).normalize();
    let single = |v: DVec3| v.as_vec3().normalize().to_array();
    BrdfQuery {
        material: material(random),
        normal: single(normal),
        to_eye: single(to_eye),
        to_light: single(to_light),
        ..BrdfQuery::zeroed()
    }
}

/// What the CPU finds, as the probe gives it.
fn expected(query: &BrdfQuery) -> [f64; 12] {
    let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let material = SurfaceMaterial::from(&query.material);
    let (normal, to_eye) = (vector(query.normal), vector(query.to_eye));
    let point = ShadingPoint { material, position: DVec3::ZERO, normal, to_eye };
    let direct = brdf_direct(&point, vector(query.to_light));
    let EnvironmentShares { diffuse, specular, roughness, coat, coat_roughness, .. } = brdf_environment(&point);
    let [[dx, dy, dz], [x, y, z], [sx, sy, sz]] = [direct, diffuse, specular].map(|v| v.to_array());
    [dx, dy, dz, coat, x, y, z, coat_roughness, sx, sy, sz, roughness]
}

/// The greatest difference, as a share of the value or of white.
fn difference(query: &BrdfQuery, found: &BrdfAnswer) -> f64 {
    let found: &[f32] = cast_slice(std::slice::from_ref(found));
    let pairs = expected(query).into_iter().zip(found);
    pairs.map(|(meant, found)| (f64::from(*found) - meant).abs() / meant.abs().max(1.0)).fold(0.0, f64::max)
}

#[test]
fn reflection_is_the_same_on_the_device() {
    let mut random = Random::new(18);
    let queries: Vec<_> = (0..QUERIES).map(|_| query(&mut random)).collect();
    let gpu = &shared().gpu;
    let found = reflected(gpu, &queries, true).unwrap();
    let mut bright = 0;
    for (query, found) in queries.iter().zip(&found) {
        let off = difference(query, found);
        assert!(off < TOLERANCE, "{off}: {found:?}, not {:?}, for {query:?}", expected(query));
        bright += usize::from(found.direct[0] > 1.0);
    }
    assert!(bright > QUERIES / 20, "hardly a highlight was looked at: {bright}");
    // Another material's answer is refused.
    let swapped = (1..QUERIES).filter(|at| difference(&queries[*at], &found[*at - 1]) > TOLERANCE).count();
    assert!(swapped > QUERIES * 9 / 10, "{swapped}");
}

#[test]
fn a_scene_of_blinn_phong_materials_needs_no_layers() {
    let mut random = Random::new(19);
    let mut of_blinn_phong = || loop {
        let query = query(&mut random);
        if query.material.phong_weight == 1.0 {
            return query;
        }
    };
    let queries: Vec<_> = (0..500).map(|_| of_blinn_phong()).collect();
    let gpu = &shared().gpu;
    let [without, with] = [false, true].map(|layers| reflected(gpu, &queries, layers).unwrap());
    for ((query, without), with) in queries.iter().zip(without).zip(with) {
        assert_eq!((without.direct, without.diffuse), (with.direct, with.diffuse), "{query:?}");
    }
}

/// A material whose property `at` is 1 and whose others are 0.
fn only(at: usize) -> FlatMaterial {
    let mut material = FlatMaterial::zeroed();
    bytemuck::cast_slice_mut::<_, f32>(std::slice::from_mut(&mut material))[at] = 1.0;
    material
}

/// The properties of a mixture on the CPU, in the order of the GPU's struct.
fn numbers(material: &SurfaceMaterial) -> Vec<f64> {
    let m = material;
    let colors = [
        (m.base_color, m.metalness),
        (m.specular_color, m.specular_weight),
        (m.emission, m.coat_darkening),
        (m.coat_color, m.coat_weight),
    ];
    let rest = [
        m.roughness,
        m.ior,
        m.coat_roughness,
        m.coat_ior,
        m.diffuse_roughness,
        m.phong_weight,
        m.phong_specular,
        m.phong_shininess,
    ];
    colors.into_iter().flat_map(|(color, w)| [color.x, color.y, color.z, w]).chain(rest).collect()
}

#[test]
fn every_property_is_mixed_by_the_weights() {
    // The opacity decides which rays meet the surface: it is mixed before, see `veils`.
    let properties = std::mem::offset_of!(FlatMaterial, opacity) / 4;
    // Beside a material without anything, each property shows its own weight.
    let materials: Vec<_> = (0..properties).map(only).chain([FlatMaterial::zeroed()]).collect();
    let word = |weight: u32, id: usize| weight << 16 | id as u32;
    let share = 0x5000_u32;
    let mixtures: Vec<[u32; MIXED]> =
        (0..properties).map(|at| [word(0xffff - share, properties), word(share, at), 0, 0]).collect();
    let found = mixed(&shared().gpu, &materials, &mixtures).unwrap();
    let weight = f64::from(share) / 65_535.0;
    let is_mixed = |at: usize, values: &[f64], room: f64| {
        let meant = |other| if other == at { weight } else { 0.0 };
        values.len() == properties && (0..properties).all(|other| (values[other] - meant(other)).abs() < room)
    };
    for (at, (mixture, found)) in mixtures.iter().zip(&found).enumerate() {
        let own = numbers(&mixture_material(&mixture_decoded(*mixture), &materials));
        let device: &[f32] = cast_slice(std::slice::from_ref(found));
        let device: Vec<f64> = device[..properties].iter().map(|value| f64::from(*value)).collect();
        assert!(is_mixed(at, &own, 1e-9), "{at}: {own:?}");
        assert!(is_mixed(at, &device, 1e-6), "{at}: {device:?}");
        // A property taken from the heaviest material alone, or from the other one alone, is found.
        for wrong in [0.0, 1.0] {
            let mut values = device.clone();
            values[at] = wrong;
            assert!(!is_mixed(at, &values, 1e-6), "{at} as {wrong} is not found");
        }
    }
}
