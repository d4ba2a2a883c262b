//! Keeps a node in its place in the world when its parent changes.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use isolith_geometry::Transform;
use isolith_scene::limits::{POSITION, SCALE};
use isolith_scene::{NodeId, Scene};

/// Relative error up to which two transforms count as equal.
const TOLERANCE: f64 = 1e-9;
/// Relative difference below which a component keeps its old digits: it is rounding, not a change.
const ROUNDING: f64 = 1e-13;

/// The transform that keeps a node in place below another parent. Returns the node's own transform, so that the node
/// moves, if the new parent would shear the node, which no translation, rotation and scale can express, or would push a
/// value out of its limits.
pub(super) fn kept_in_place(scene: &Scene, id: NodeId, parent: Option<NodeId>) -> Transform {
    let Some(node) = scene.node(id) else { return Transform::IDENTITY };
    let world_from = |p: Option<NodeId>| p.map_or(DAffine3::IDENTITY, |p| scene.world_from_local(p));
    let (world_from_old, world_from_new) = (world_from(node.parent), world_from(parent));
    if node.parent == parent || world_from_old == world_from_new {
        return node.transform;
    }
    let new_from_old = world_from_new.inverse() * world_from_old;
    recomposed(&new_from_old, &node.transform).unwrap_or(node.transform)
}

/// The transform that equals `map` after `local`, if one exists. A linear map is a rotation after a scale exactly if
/// its columns are orthogonal.
pub fn recomposed(map: &DAffine3, local: &Transform) -> Option<Transform> {
    let wanted = *map * local.to_affine();
    let translation = wanted.translation;
    let (rotation, scale) = if map.matrix3 == DMat3::IDENTITY {
        (local.rotation, local.scale)
    } else {
        let columns = wanted.matrix3;
        // The signs that the artist chose stay; a mirroring map flips all three.
        let mut scale = DVec3::new(columns.x_axis.length(), columns.y_axis.length(), columns.z_axis.length());
        scale *= local.scale.signum();
        if map.matrix3.determinant() < 0.0 {
            scale = -scale;
        }
        let turned = DMat3::from_cols(columns.x_axis / scale.x, columns.y_axis / scale.y, columns.z_axis / scale.z);
        let skew = turned.transpose() * turned - DMat3::IDENTITY;
        let skew = skew.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
        // The maximum ignores NaN, so NaN needs its own check.
        if !turned.is_finite() || skew > TOLERANCE {
            return None;
        }
        (rounded_rotation(DQuat::from_mat3(&turned).normalize(), local.rotation), rounded(scale, local.scale))
    };
    let result = Transform { translation: rounded(translation, local.translation), rotation, scale };
    let fits = translation.to_array().into_iter().all(|v| POSITION.accept(v))
        && scale.to_array().into_iter().all(|v| SCALE.accept(v.abs()))
        && rotation.is_finite();
    fits.then_some(result)
}

/// `new`, or `old` if they differ by rounding only.
fn rounded(new: DVec3, old: DVec3) -> DVec3 {
    if (new - old).abs().max_element() <= ROUNDING * old.abs().max_element() { old } else { new }
}

/// The same for rotations; q and −q are the same rotation.
fn rounded_rotation(new: DQuat, old: DQuat) -> DQuat {
    let new = if new.dot(old) < 0.0 { -new } else { new };
    if (new - old).length() <= ROUNDING { old } else { new }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_recomposed(map: &DAffine3, local: &Transform) {
        let result = recomposed(map, local).expect("has a transform");
        let (wanted, got) = (*map * local.to_affine(), result.to_affine());
        assert!(wanted.abs_diff_eq(got, 1e-9), "{wanted} {got}");
    }

    #[test]
    fn rigid_uniform_mirrored_and_aligned_maps_are_recomposed() {
        let turned = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.0, 2.0);
        let local = Transform {
            translation: DVec3::new(1.0, 2.0, 3.0),
            rotation: DQuat::from_rotation_z(0.4),
            scale: DVec3::new(1.0, -2.0, 0.5),
        };
        let shift = DVec3::new(-4.0, 0.5, 9.0);
        for scale in [1.0, 3.0, 0.01, -2.0] {
            let map = DAffine3::from_scale_rotation_translation(DVec3::splat(scale), turned, shift);
            assert_recomposed(&map, &local);
        }
        let aligned = Transform { rotation: DQuat::IDENTITY, ..local };
        assert_recomposed(&DAffine3::from_scale(DVec3::new(1.0, 2.0, 3.0)), &aligned);
        let moved = recomposed(&DAffine3::from_translation(shift), &local).expect("has a transform");
        assert_eq!((moved.rotation, moved.scale), (local.rotation, local.scale));
    }

    #[test]
    fn shear_is_refused() {
        let local = Transform { rotation: DQuat::from_rotation_z(0.4), ..Transform::IDENTITY };
        assert_eq!(recomposed(&DAffine3::from_scale(DVec3::new(1.0, 2.0, 1.0)), &local), None);
    }
}
