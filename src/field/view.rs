//! The default view of a scene.

use glam::DVec3;

use super::FlatScene;
use super::copies::mesh_copies_bounds;
use super::mesh_rays::Meshes;
use isolith_geometry::{Aabb, Camera};

/// Direction from the scene to the eye, for scenes without cameras: a three-quarter view from above.
pub const THREE_QUARTER: DVec3 = DVec3::new(0.62, 0.46, 1.0);

impl FlatScene {
    /// The scene's first camera; without cameras, one that frames all bounded content. `meshes` is parallel to
    /// [`FlatScene::meshes`].
    pub fn default_camera(&self, meshes: &Meshes, aspect: f64) -> Camera {
        match self.cameras.first() {
            Some(first) => first.camera,
            None => Camera::framing(&self.content(meshes), THREE_QUARTER, Camera::DEFAULT_FOV_Y, aspect),
        }
    }

    /// A world box around all bounded content; a box around the origin if there is none.
    pub fn content(&self, meshes: &Meshes) -> Aabb {
        let mut all = Aabb::EMPTY;
        for component in &self.components {
            let bounds = match component.instanced {
                None => component.bounds.translated(component.origin),
                Some(of) => of.bounds,
            };
            all = if bounds.is_finite() { all.union(&bounds) } else { all };
        }
        for (mesh, triangles) in self.meshes.iter().zip(meshes) {
            if let Some(triangles) = triangles {
                let bounds = mesh_copies_bounds(self, mesh, &triangles.bounds);
                all = if bounds.is_finite() { all.union(&bounds) } else { all };
            }
        }
        if all.is_finite() { all } else { Aabb::from_center_half(DVec3::ZERO, DVec3::ONE) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flatten;
    use isolith_scene::{MaterialId, Node, NodeKind, Object, Scene, ShapeKind};

    fn scene(kinds: &[(ShapeKind, DVec3)]) -> FlatScene {
        let mut scene = Scene::new();
        for (kind, at) in kinds {
            let object = Object { shape: kind.default_shape(), material: MaterialId(1) };
            scene.insert(None, usize::MAX, Node::new("part", NodeKind::Object(object)).at(*at)).unwrap();
        }
        flatten(&scene, 0.0).unwrap()
    }

    #[test]
    fn content_holds_what_has_an_end_and_leaves_out_what_has_none() {
        let flat = scene(&[(ShapeKind::Sphere, DVec3::new(10.0, 0.0, 0.0)), (ShapeKind::Plane, DVec3::ZERO)]);
        let content = flat.content(&[]);
        assert!(content.contains(DVec3::new(10.4, 0.0, 0.0)) && !content.contains(DVec3::ZERO), "{content:?}");
    }

    #[test]
    fn an_empty_scene_and_an_endless_one_still_have_a_view() {
        for flat in [scene(&[]), scene(&[(ShapeKind::Plane, DVec3::ZERO)])] {
            let camera = flat.default_camera(&[], 1.5);
            assert!(camera.position.is_finite() && camera.position.y > 0.0);
        }
    }
}
