//! The materials of glTF files as materials of the scene: metallic-roughness is a subset of OpenPBR's layers.

use crate::FlatMaterial;
use isolith_mesh::Surface;
use isolith_scene::Material;

/// Index of refraction of a clear coat (extension KHR_materials_clearcoat).
const COAT_IOR: f32 = 1.5;

/// The material of a surface without its textures. What textures change stands in it as the factor of the texture.
pub fn mesh_material(surface: &Surface) -> FlatMaterial {
    let [r, g, b, _] = surface.color;
    let plain = FlatMaterial { base_color: [r, g, b], ..FlatMaterial::new(&Material::default()) };
    if surface.is_unlit {
        return FlatMaterial { base_color: [0.0; 3], emission: [r, g, b], specular_weight: 0.0, ior: 1.0, ..plain };
    }
    FlatMaterial {
        metalness: surface.metalness,
        specular_color: surface.specular_color,
        specular_weight: surface.specular_weight,
        emission: surface.emission,
        coat_weight: surface.coat_weight,
        roughness: surface.roughness,
        ior: surface.ior,
        coat_roughness: surface.coat_roughness,
        coat_ior: COAT_IOR,
        ..plain
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_keep_their_properties() {
        let glossy = Surface { metalness: 0.25, roughness: 0.5, ior: 1.3, coat_weight: 0.75, ..Surface::default() };
        let material = mesh_material(&glossy);
        assert_eq!([material.metalness, material.roughness, material.ior], [0.25, 0.5, 1.3]);
        assert_eq!([material.coat_weight, material.coat_ior, material.phong_weight], [0.75, 1.5, 0.0]);
        let unlit = mesh_material(&Surface { is_unlit: true, color: [0.5, 0.25, 1.0, 1.0], ..glossy });
        assert_eq!((unlit.base_color, unlit.emission), ([0.0; 3], [0.5, 0.25, 1.0]));
        assert_eq!([unlit.specular_weight, unlit.coat_weight], [0.0; 2]);
    }
}
