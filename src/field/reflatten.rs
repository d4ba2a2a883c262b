//! Flattening after a small change, such as a drag or a step in time: rebuilds only the components that contain a
//! change, and puts lights, cameras, meshes, materials and the environment into their places.

use std::sync::Arc;

use super::arrays::{Component, FlatScene};
use super::batch::{may_be_joined, united};
use super::budget::Cancel;
use super::collect::{component_of, is_opened};
use super::copies::instancer::{FlatInstancer, Placement};
use super::copies::moved_scene::{node_dynamics, scene_at};
use super::emit::{MaterialUse, emit};
use super::error::FlattenError;
use super::flat_material::FlatMaterial;
use super::flat_texture::TextureUse;
use super::flatten::flatten_with_cuts;
use super::lower_bound::fold_bounds;
use super::non_field;
use super::operand::Operand;
use crate::light::environment_map::PlacedMap;
use isolith_scene::{Material, Node, NodeKind, Scene};

/// Keeps the arrays of the last scene, and patches them if little has changed. The result is that of
/// [`super::flatten`], except that batches stay as they were.
#[derive(Debug, Default)]
pub struct Flattener {
    last: Option<Last>,
}

#[derive(Debug)]
struct Last {
    nodes: Vec<Arc<Node>>,
    materials: Vec<Arc<Material>>,
    time: f64,
    has_cuts: bool,
    /// Whether a node stays at rest because its tracks contradict each other: a warning tells of it.
    has_faults: bool,
    flat: Arc<FlatScene>,
}

/// With more changed objects than this, looking at each one does not pay.
const MOST_CHANGED: usize = 8;

impl Flattener {
    /// The arrays of `scene` at `time` seconds.
    ///
    /// # Errors
    /// A limit is hit, see [`super::flatten`]; the next call starts from scratch.
    pub fn flatten(&mut self, scene: &Scene, time: f64) -> Result<Arc<FlatScene>, FlattenError> {
        let flat = self.flatten_until(scene, time, &Cancel::default())?;
        Ok(flat.expect("nobody else holds the flag, so nobody cancels"))
    }

    /// The arrays if little has changed since the last call, and so without a wait.
    pub fn update(&mut self, scene: &Scene, time: f64) -> Option<Arc<FlatScene>> {
        let (shown, faults) = scene_at(scene, time);
        if faults.is_empty() { self.update_shown(&shown, time) } else { None }
    }

    fn update_shown(&mut self, shown: &Scene, time: f64) -> Option<Arc<FlatScene>> {
        let mut last = self.last.take()?;
        if last.has_faults || !last.update(shown, time) {
            return None;
        }
        let flat = last.flat.clone();
        self.last = Some(last);
        Some(flat)
    }

    /// The same as [`Flattener::flatten`]; `None` if canceled.
    ///
    /// # Errors
    /// As there.
    pub fn flatten_until(
        &mut self,
        scene: &Scene,
        time: f64,
        cancel: &Cancel,
    ) -> Result<Option<Arc<FlatScene>>, FlattenError> {
        let (shown, faults) = scene_at(scene, time);
        let scene = &*shown;
        if faults.is_empty()
            && let Some(flat) = self.update_shown(scene, time)
        {
            return Ok(Some(flat));
        }
        let Some((flat, has_cuts)) = flatten_with_cuts(scene, &faults, time, cancel)? else { return Ok(None) };
        let flat = Arc::new(flat);
        self.last = Some(Last {
            nodes: scene.nodes().to_vec(),
            materials: scene.materials().to_vec(),
            time,
            has_cuts,
            has_faults: !faults.is_empty(),
            flat: flat.clone(),
        });
        Ok(Some(flat))
    }
}

impl Last {
    /// Updates the arrays; false if they have to be rebuilt.
    fn update(&mut self, scene: &Scene, time: f64) -> bool {
        // A cut affects other components.
        if self.has_cuts || self.nodes.len() != scene.nodes().len() {
            return false;
        }
        let pairs = self.nodes.iter().zip(scene.nodes()).enumerate();
        // The evaluation of tracks makes new nodes, but not always new values.
        let differ = |(_, (a, b)): &(usize, (&Arc<Node>, &Arc<Node>))| !Arc::ptr_eq(a, b) && a != b;
        let changed: Vec<usize> = pairs.filter(differ).map(|(i, _)| i).take(MOST_CHANGED + 1).collect();
        if changed.len() > MOST_CHANGED || !changed.iter().all(|i| is_small(scene, &self.nodes[*i], &scene.nodes()[*i]))
        {
            return false;
        }
        // What copies stand on, and what they are copies of.
        let stands = |instancer: &FlatInstancer| matches!(instancer.placement, Placement::List(_));
        let is_group = |at: &usize| matches!(scene.nodes()[*at].kind, NodeKind::Group(_));
        let has_copies = !self.flat.instancers.is_empty();
        if !changed.is_empty() && self.flat.instancers.iter().any(stands) || has_copies && changed.iter().any(is_group)
        {
            return false;
        }
        if !self.update_materials(scene) {
            return false;
        }
        let mut moves_others = self.time != time;
        for index in changed {
            let node = &scene.nodes()[index];
            moves_others |= !matches!(node.kind, NodeKind::Object(_));
            if node.has_field() && !self.patch(scene, index) {
                return false;
            }
            self.nodes[index] = node.clone();
        }
        self.update_rest(scene, moves_others, time);
        true
    }

    /// Puts changed materials into their places; false if the arrays have to be rebuilt.
    fn update_materials(&mut self, scene: &Scene) -> bool {
        if self.materials.len() != scene.materials().len() {
            return false;
        }
        for (old, new) in self.materials.iter_mut().zip(scene.materials()) {
            if Arc::ptr_eq(old, new) {
                continue;
            }
            // What rays may pass is a part of its own. Images, and tiles that the parameters of textures count, have their places in other arrays.
            if old.id != new.id || old.textures != new.textures || old.is_veiled() != new.is_veiled() {
                return false;
            }
            let flat = Arc::make_mut(&mut self.flat);
            let places = flat.materials.iter_mut().zip(&flat.material_ids).filter(|(_, id)| **id == new.id);
            for (place, _) in places {
                *place = FlatMaterial::new(new);
            }
            *old = Arc::clone(new);
        }
        true
    }

    /// Puts everything but fields and materials into its place.
    fn update_rest(&mut self, scene: &Scene, moves_others: bool, time: f64) {
        if self.time != time && !self.flat.instancers.is_empty() {
            // The motion of copies depends on the time itself.
            for instancer in &mut Arc::make_mut(&mut self.flat).instancers {
                if let Some(node) = scene.node(instancer.id) {
                    instancer.dynamics = node_dynamics(node, time, instancer.seed);
                }
            }
        }
        if moves_others {
            non_field::update(Arc::make_mut(&mut self.flat), scene, time);
        }
        self.time = time;
        if self.flat.environment != scene.environment {
            let flat = Arc::make_mut(&mut self.flat);
            flat.environment = scene.environment.clone();
            flat.environment_map = PlacedMap::of(&scene.environment);
        }
        if self.flat.display != scene.display {
            Arc::make_mut(&mut self.flat).display = scene.display;
        }
    }

    /// Rebuilds the component of the node at `index` in its place.
    fn patch(&mut self, scene: &Scene, index: usize) -> bool {
        let id = scene.nodes()[index].id;
        let Some(entry) = self.flat.ids.iter().position(|i| *i == id) else { return false };
        let at = self.flat.components.partition_point(|c| c.first as usize <= entry) - 1;
        let old = self.flat.components[at].clone();
        if old.instanced.is_some() {
            return false;
        }
        let Some(operands) = self.operands(scene, &old) else { return false };
        let had_warnings = old.is_modified() && !self.flat.warnings.is_empty();
        if fold_bounds(&operands).bounds.is_empty() || had_warnings {
            return false;
        }
        let flat = Arc::make_mut(&mut self.flat);
        // Lent for a moment: their values stand among the rows.
        let materials = std::mem::take(&mut flat.materials);
        let bricks = std::mem::take(&mut flat.bricks);
        let models = bricks.all().len();
        let mut scratch = FlatScene { materials, bricks, ..FlatScene::default() };
        let mut known = true;
        let mut moved = Vec::new();
        let new = emit(&mut scratch, &operands, &mut |scratch, user| {
            let MaterialUse { id, object_from_world, repeated, looks } = user;
            let found = match object_from_world {
                None => (0..flat.material_ids.len())
                    .find(|at| flat.material_ids[*at] == id && !flat.textures.has_looks(*at)),
                Some(object) => {
                    // The leaf that is about to be written keeps its own entry.
                    let leaf = flat.nodes.get(old.first as usize + scratch.nodes.len());
                    let at = leaf.map_or(usize::MAX, |leaf| leaf.material as usize);
                    let space = TextureUse { object_from_world: object, repeated, instancer: None };
                    moved.push((id, at, space, looks.cloned()));
                    flat.material_ids.get(at).filter(|m| **m == id).map(|_| at)
                }
            };
            known &= found.is_some();
            found.unwrap_or(0) as u32
        });
        flat.materials = scratch.materials;
        flat.bricks = scratch.bricks;
        if !known
            || flat.bricks.all().len() != models
            || (new.count, new.param_rows, new.payload_rows, new.stack)
                != (old.count, old.param_rows, old.payload_rows, old.stack)
        {
            return false;
        }
        for node in &mut scratch.nodes {
            node.params += old.params;
        }
        for (id, at, space, looks) in moved {
            if let Some(material) = scene.material(id) {
                flat.textures.replace(material, looks.as_ref(), at, space);
            }
        }
        let range = |first: u32, count: u32| first as usize..(first + count) as usize;
        flat.nodes[range(old.first, old.count)].copy_from_slice(&scratch.nodes);
        flat.ids[range(old.first, old.count)].copy_from_slice(&scratch.ids);
        flat.params[range(old.params, old.param_rows)].copy_from_slice(&scratch.params);
        let Component { first, params, top, march, .. } = old;
        flat.components[at] = Component { first, params, top, march, ..new };
        flat.refit_hierarchy(at);
        true
    }
}

impl Last {
    /// The fold of a component, from the same nodes as before; `None` if they no longer form one component.
    fn operands<'a>(&self, scene: &'a Scene, component: &Component) -> Option<Vec<Operand<'a>>> {
        let top = |entry: usize| outermost(scene, scene.index_of(self.flat.ids[entry])?);
        let (first, end) = (component.first as usize, (component.first + component.count) as usize);
        let only = top(first)?;
        if top(end - 1)? == only {
            return component_of(scene, only);
        }
        let mut tops = Vec::new();
        let mut at = first;
        while at < end {
            let node = &self.flat.nodes[at];
            if node.is_run() {
                at += 1;
            } else {
                tops.push(top(at)?);
                at += node.extent as usize;
            }
        }
        let folds = tops.into_iter().map(|top| component_of(scene, top)).collect::<Option<Vec<_>>>()?;
        may_be_joined(&folds).then(|| united(folds))
    }
}

/// Whether only values differ, so that the arrays keep their structure: those of an object, of a group within a
/// component, of a light, a camera or a mesh.
fn is_small(scene: &Scene, old: &Node, new: &Node) -> bool {
    let form = |n: &Node| (n.id, n.parent, n.visible, n.operation, n.blend_override, n.march, n.apart.clone());
    let modifiers = |n: &Node| n.modifiers.iter().map(|m| (m.enabled, m.modifier.kind())).collect::<Vec<_>>();
    let kinds = match (&old.kind, &new.kind) {
        (NodeKind::Object(a), NodeKind::Object(b)) => a.material == b.material,
        // An opened group holds several components.
        (NodeKind::Group(_), NodeKind::Group(_)) => !is_opened(scene, old) && !is_opened(scene, new),
        (NodeKind::Light(_), NodeKind::Light(_)) | (NodeKind::Camera(_), NodeKind::Camera(_)) => true,
        (NodeKind::Mesh(a), NodeKind::Mesh(b)) => a.material == b.material,
        _ => false,
    };
    kinds && form(old) == form(new) && modifiers(old) == modifiers(new)
}

/// The outermost node of the component that contains the node at `index`.
fn outermost(scene: &Scene, index: usize) -> Option<usize> {
    let mut path = vec![index];
    let mut at = scene.nodes()[index].parent;
    while let Some(id) = at {
        let parent = scene.index_of(id)?;
        path.push(parent);
        at = scene.nodes()[parent].parent;
    }
    path.into_iter().rev().find(|i| !is_opened(scene, &scene.nodes()[*i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flatten;
    use isolith_gallery as gallery;
    use isolith_scene::{ParamValue, Shape};

    #[test]
    fn a_changed_object_gives_the_same_arrays_as_a_fresh_start() {
        // The pedestals of all shapes are batched, see `batch`.
        for (name, mut scene) in gallery::all().into_iter().filter(|(name, _)| *name != "shapes") {
            let mut flattener = Flattener::default();
            flattener.flatten(&scene, 0.0).unwrap();
            for index in (0..scene.nodes().len()).step_by(5) {
                let mut node = Node::clone(&scene.nodes()[index]);
                node.transform.translation.x += 0.01;
                if let NodeKind::Object(object) = &mut node.kind
                    && let Shape::Sphere { radius } = object.shape
                {
                    object.shape.set_value(0, ParamValue::Scalar(radius * 1.1));
                }
                scene.replace(node).unwrap();
                let again = flattener.flatten(&scene, 0.0).unwrap();
                assert_eq!(*again, flatten(&scene, 0.0).unwrap(), "{name}, node {index}");
            }
        }
    }
}
