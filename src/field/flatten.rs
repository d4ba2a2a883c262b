//! Flattening: scene → arrays.
//!
//! Three steps. `survey` counts what flattening will take. `collect` turns the visible nodes into folds of operands
//! in world space, split into components at hard unions, and `batch` joins small neighbors again. `emit` writes each
//! component relative to its own origin.
//!
//! Hidden nodes, the empty set, groups of one operand, and groups that come first in their parent never reach the
//! arrays. The fold of a group that comes first is the beginning of the parent's fold.

use std::collections::{HashMap, HashSet};

use glam::DAffine3;

use super::arrays::*;
use super::batch::{batched, united};
use super::budget::{BYTES, Budget, Cancel, FlattenLimits, LEVELS, ROWS, STACK, Usage};
use super::collect::{Components, collect};
use super::composition::size_of_fold;
use super::copies::moved_scene::{scene_at, unseen_dynamics};
use super::emit::{MaterialUse, emit};
use super::error::FlattenError;
use super::flat_material::FlatMaterial;
use super::flat_texture::{TextureUse, TexturedMaterials};
use super::lower_bound::fold_bounds;
use super::marches::Marches;
use super::non_field;
use super::operand::{Operand, Value};
use super::survey::Survey;
use super::types::{Flattening, add_instancer};
use super::usage::usage;
use crate::light::environment_map::PlacedMap;
use isolith_scene::check::Fault;
use isolith_scene::limits::MAX_TEXTURE_BYTES;
use isolith_scene::{MaterialId, Node, NodeId, NodeKind, Scene};

/// See [`MAX_COMPONENT_NODES`].
const TOGETHER: &str = "the number of shapes that are blended or cut together";

/// See [`MAX_COMPONENTS`].
const APART: &str = "the number of parts that meet others by hard union only, copies included";

/// See [`MAX_PLACED_MATERIALS`].
const MATERIALS: &str = "the number of materials, those with textures counted for each object that uses them";

/// See [`MAX_COPIES`].
const COPIES: &str = "the number of copies of copies that are evaluated for one point";

/// The arrays of `scene` at `time` seconds. Takes about 0.1 µs per node, and four times as long if thousands of
/// separate shapes are batched. The costs are counted in advance, see [`MAX_FLAT_NODES`] and the limits beside it.
pub fn flatten(scene: &Scene, time: f64) -> Result<FlatScene, FlattenError> {
    let made = flatten_within(scene, time, FlattenLimits::default(), &Cancel::default())?;
    Ok(made.expect("nobody else holds the flag, so nobody cancels").flat)
}

/// The same with the usage of each limit; `None` if canceled.
pub fn flatten_until(
    scene: &Scene,
    time: f64,
    cancel: &Cancel,
) -> Result<Option<(FlatScene, Vec<Usage>)>, FlattenError> {
    let made = flatten_within(scene, time, FlattenLimits::default(), cancel)?;
    Ok(made.map(|Made { flat, steps, .. }| {
        let usage = usage(&flat, steps);
        (flat, usage)
    }))
}

/// The arrays with all components joined into one, as for a renderer without components: the baseline of the benches.
pub fn flatten_whole(scene: &Scene, time: f64) -> Result<FlatScene, FlattenError> {
    let (shown, _) = scene_at(scene, time);
    let scene = &*shown;
    let mut flat = flatten(scene, time)?;
    flat.nodes.clear();
    flat.params.clear();
    flat.ids.clear();
    flat.components.clear();
    let index = flat.material_ids.iter().enumerate().map(|(i, id)| (*id, i as u32)).collect();
    let limits = FlattenLimits::default();
    let survey = Survey::new(scene, 0..scene.nodes().len(), &limits)?;
    on_a_stack(scene, &survey, || {
        let textured = TexturedMaterials::new(scene.materials());
        let mut materials = Materials { scene, textured, index, instancer: None };
        let budget = Budget::new(limits, &Cancel::default());
        let whole = united(collect(scene, &survey, budget, &mut |_, _| {}).operands);
        if !whole.is_empty() {
            add_component(&mut flat, &mut materials, &Marches::new(scene), &whole, limits.rows)?;
        }
        Ok(flat)
    })
}

/// The arrays of a scene whose tracks are evaluated, and whether negative nodes at the top cut components; `None` if
/// canceled.
pub(super) fn flatten_with_cuts(
    shown: &Scene,
    faults: &[(NodeId, Fault)],
    time: f64,
    cancel: &Cancel,
) -> Result<Option<(FlatScene, bool)>, FlattenError> {
    let made = flatten_shown(shown, faults, time, FlattenLimits::default(), cancel)?;
    Ok(made.map(|Made { flat, has_cuts, .. }| (flat, has_cuts)))
}

/// The arrays, and facts about their making.
struct Made {
    flat: FlatScene,
    has_cuts: bool,
    steps: usize,
}

fn flatten_within(
    scene: &Scene,
    time: f64,
    limits: FlattenLimits,
    cancel: &Cancel,
) -> Result<Option<Made>, FlattenError> {
    let (shown, faults) = scene_at(scene, time);
    flatten_shown(&shown, &faults, time, limits, cancel)
}

fn flatten_shown(
    scene: &Scene,
    faults: &[(NodeId, Fault)],
    time: f64,
    limits: FlattenLimits,
    cancel: &Cancel,
) -> Result<Option<Made>, FlattenError> {
    debug_assert!(time.is_finite(), "time is checked at the border");
    let _span = tracing::debug_span!("flatten", nodes = scene.nodes().len()).entered();
    let survey = Survey::new(scene, 0..scene.nodes().len(), &limits)?;
    let mut made = on_a_stack(scene, &survey, || flatten_surveyed(scene, &survey, time, limits, cancel))?;
    if let Some(made) = &mut made {
        made.flat.warnings.extend(scene.nodes().iter().filter_map(|node| {
            let kind = unseen_dynamics(node)?;
            let reason = format!("has {kind:?}, which changes materials: only copies of an instancer show it");
            Some(Warning { node: node.id, name: node.name.clone(), reason })
        }));
        made.flat.warnings.extend(faults.iter().filter_map(|(id, fault)| at_rest(scene, *id, fault)));
    }
    Ok(made)
}

/// Runs `work` on a stack that is deep enough for it.
fn on_a_stack<T: Send>(
    scene: &Scene,
    survey: &Survey,
    work: impl FnOnce() -> Result<T, FlattenError> + Send,
) -> Result<T, FlattenError> {
    if !survey.is_deep() {
        return work();
    }
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().name("flatten".into()).stack_size(survey.stack_bytes());
        match thread.spawn_scoped(scope, work) {
            Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            // The system has no memory for the stack.
            Err(_) => Err(FlattenError::new(&scene.nodes()[0], LEVELS, survey.levels, 0)),
        }
    })
}

/// The warning about a node that its tracks cannot move.
fn at_rest(scene: &Scene, id: NodeId, Fault { field, reason }: &Fault) -> Option<Warning> {
    let name = scene.node(id)?.name.clone();
    let reason = format!("is shown at rest, because its animation contradicts itself at this moment: {field} {reason}");
    Some(Warning { node: id, name, reason })
}

fn flatten_surveyed(
    scene: &Scene,
    survey: &Survey,
    time: f64,
    limits: FlattenLimits,
    cancel: &Cancel,
) -> Result<Option<Made>, FlattenError> {
    let mut flat = FlatScene {
        nodes: Vec::with_capacity(scene.nodes().len()),
        params: Vec::with_capacity(scene.nodes().len() * 6),
        ids: Vec::with_capacity(scene.nodes().len()),
        environment: scene.environment.clone(),
        display: scene.display,
        environment_map: PlacedMap::of(&scene.environment),
        ..FlatScene::default()
    };
    let textured = TexturedMaterials::new(scene.materials());
    let mut materials = Materials { scene, textured, index: HashMap::new(), instancer: None };
    let mut instancers = Vec::new();
    let components = collect(scene, survey, Budget::new(limits, cancel), &mut |node, world_from_local| {
        if matches!(node.kind, NodeKind::Instancer(_)) {
            instancers.extend(scene.index_of(node.id).map(|index| (index, *world_from_local)));
            return;
        }
        let material = non_field::mesh_material_of(node).map(|id| materials.of_mesh(&mut flat, node, id));
        non_field::add(&mut flat, node, world_from_local, material, time);
    });
    let Components { operands, warnings, has_cuts, mut budget } = components;
    flat.warnings.extend(warnings);
    if let Some(problem) = budget.problem.take() {
        return Err(problem);
    }
    if cancel.is_canceled() {
        return Ok(None);
    }
    let marches = Marches::new(scene);
    flat.warnings.extend(marches.warnings());
    let veils = scene.materials().iter().filter(|material| material.is_veiled()).map(|material| material.id).collect();
    let components = batched(operands, |fold| stays_alone(&marches, &veils, fold));
    if let Some(first) = components.get(MAX_COMPONENTS).and_then(|beyond| beyond.first()) {
        return Err(FlattenError::new(first.outermost, APART, components.len(), MAX_COMPONENTS));
    }
    for operands in &components {
        add_component(&mut flat, &mut materials, &marches, operands, limits.rows)?;
        if cancel.is_canceled() {
            return Ok(None);
        }
    }
    let of = Flattening { scene, survey, time, flatten };
    for placed in instancers {
        let materials = std::cell::RefCell::new(&mut materials);
        let mut palette = |flat: &mut FlatScene, id| materials.borrow_mut().resolve(flat, MaterialUse::plain(id));
        let mut add = |flat: &mut FlatScene, operands: &[Operand<'_>]| {
            let before = flat.components.len();
            let mut materials = materials.borrow_mut();
            // It is the last one.
            materials.instancer = (flat.instancers.len() as u32).checked_sub(1);
            add_component(flat, &mut materials, &marches, operands, limits.rows)?;
            Ok((flat.components.len() > before).then_some(before))
        };
        budget = add_instancer(&mut flat, of, placed, budget, &mut palette, &mut add)?;
    }
    if flat.components.len() > MAX_COMPONENTS {
        let node = &scene.nodes()[0];
        return Err(FlattenError::new(node, APART, flat.components.len(), MAX_COMPONENTS));
    }
    let steps = budget.steps();
    warn_of_small_images(&mut flat, scene);
    Ok(Some(Made { flat, has_cuts, steps }))
}

/// Whether a component must not be joined with others: it has settings of its own, or rays may pass it, and must not lose what
/// is in it.
fn stays_alone(marches: &Marches<'_>, veils: &HashSet<MaterialId>, fold: &[Operand<'_>]) -> bool {
    let is_unusual = fold.first().is_some_and(|first| !marches.of(first.outermost).is_usual());
    is_unusual || !veils.is_empty() && is_veiled(veils, fold)
}

fn is_veiled(veils: &HashSet<MaterialId>, fold: &[Operand<'_>]) -> bool {
    fold.iter().any(|operand| match &operand.value {
        Value::Leaf { material, .. } => veils.contains(material),
        Value::Fold(inner) => is_veiled(veils, inner),
        Value::Modified { content, .. } => is_veiled(veils, content),
    })
}

/// Reduces the images of textures to what devices can hold, with a warning for each.
fn warn_of_small_images(flat: &mut FlatScene, scene: &Scene) {
    let FlatScene { textures, warnings, material_ids, nodes, ids, .. } = flat;
    let set_ids = textures.set_ids.clone();
    for image in textures.fit(MAX_TEXTURE_BYTES) {
        let Some(id) = set_ids[image.set as usize] else { continue };
        let user =
            nodes.iter().zip(&*ids).find(|(node, _)| node.is_leaf() && material_ids[node.material as usize] == id);
        let Some(node) = user.and_then(|(_, id)| scene.node(*id)) else { continue };
        let material = scene.material(id).map_or("", |material| &material.name);
        let reason = format!(
            "shows the image {:?} of its material {material:?} at 1/{} of its size: the images of textures take more \
             than {} MiB",
            image.name,
            image.reduction(),
            MAX_TEXTURE_BYTES >> 20
        );
        warnings.push(Warning { node: node.id, name: node.name.clone(), reason });
    }
}

/// Indices of the materials in use, in the order of first use.
struct Materials<'a> {
    scene: &'a Scene,
    textured: TexturedMaterials<'a>,
    index: HashMap<MaterialId, u32>,
    /// The instancer whose types use them now.
    instancer: Option<u32>,
}

impl Materials<'_> {
    fn resolve(&mut self, flat: &mut FlatScene, user: MaterialUse<'_>) -> u32 {
        let MaterialUse { id, object_from_world, repeated, looks } = user;
        let known = self.index.get(&id).copied();
        if let (Some(known), None) = (known, object_from_world) {
            return known;
        }
        let made = || {
            let material = self.scene.material(id).expect("the scene holds every material that a node names");
            FlatMaterial::new(material)
        };
        let at = flat.materials.len();
        flat.materials.push(known.map_or_else(made, |known| flat.materials[known as usize]));
        flat.material_ids.push(id);
        let object_from_world = object_from_world.unwrap_or(DAffine3::IDENTITY);
        let space = TextureUse { object_from_world, repeated, instancer: self.instancer };
        if let Some(model) = looks {
            // Others that name the material show it as it is.
            let first = flat.bricks.place(model);
            flat.textures.place_looks(model, first, at, space);
            return at as u32;
        }
        self.index.entry(id).or_insert(at as u32);
        if let Some(material) = self.textured.get(id) {
            flat.textures.place(material, at, space);
        }
        at as u32
    }

    /// A mesh's use of a material.
    fn of_mesh(&mut self, flat: &mut FlatScene, node: &Node, id: MaterialId) -> u32 {
        let mut warn = |reason: &str| {
            let reason = format!("has a material with {reason}, which meshes do not show");
            flat.warnings.push(Warning { node: node.id, name: node.name.clone(), reason });
        };
        if self.textured.get(id).is_some() {
            warn("textures");
        }
        if self.scene.material(id).is_some_and(|material| material.geometry_opacity < 1.0) {
            warn("opacity");
        }
        self.resolve(flat, MaterialUse::plain(id))
    }
}

fn add_component(
    flat: &mut FlatScene,
    materials: &mut Materials<'_>,
    marches: &Marches<'_>,
    operands: &[Operand<'_>],
    most_rows: usize,
) -> Result<(), FlattenError> {
    let first = operands.first().expect("a component has an operand");
    // An intersection of disjoint operands: there is nothing to trace.
    if fold_bounds(operands).bounds.is_empty() {
        return Ok(());
    }
    let (entries, depth) = size_of_fold(operands);
    let refuse = |what, value, limit| Err(FlattenError::new(first.outermost, what, value, limit));
    // Checked before writing: groups that share their content in memory do not share it in the arrays.
    if entries > MAX_COMPONENT_NODES {
        return refuse(TOGETHER, entries, MAX_COMPONENT_NODES);
    }
    if depth > MAX_STACK {
        return refuse(STACK, depth as usize, MAX_STACK as usize);
    }
    let start = flat.nodes.len();
    let mut component = emit(flat, operands, &mut |flat, user| materials.resolve(flat, user));
    (component.top, component.march) = (marches.top(first.outermost), marches.of(first.outermost));
    let copies = component.copies as usize;
    flat.components.push(component);
    let limits = [
        (TOGETHER, flat.nodes.len() - start, MAX_COMPONENT_NODES),
        ("the number of shapes and groups", flat.nodes.len(), MAX_FLAT_NODES),
        (ROWS, flat.params.len(), most_rows),
        (BYTES, flat.bytes(), MAX_FLAT_BYTES),
        (COPIES, copies, MAX_COPIES),
        (MATERIALS, flat.materials.len(), MAX_PLACED_MATERIALS),
    ];
    match limits.into_iter().find(|(_, value, limit)| value > limit) {
        Some((what, value, limit)) => refuse(what, value, limit),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{Attachment, Axis, Modifier, Object, ShapeKind};

    fn flatten_in_rows(scene: &Scene, rows: usize) -> Result<Option<Made>, FlattenError> {
        flatten_within(scene, 0.0, FlattenLimits { rows, ..FlattenLimits::default() }, &Cancel::default())
    }

    /// Sixty-four copies of a plate that an image of 900 pixels displaces, and the id of the plate's node.
    fn copies() -> (Scene, NodeId) {
        let image = Attachment::drawn("x.png", [30, 30], |x, y| (x * y % 256) as u8);
        let displaced = Modifier::Displacement { image, height: 0.1, tile: 1.0, axis: Axis::Y };
        let mut scene = Scene::new();
        let object = Object { shape: ShapeKind::Box.default_shape(), material: scene.materials()[0].id };
        let ring = Modifier::Polar { count: 64, radius: 9.0, mirrored: false };
        let plate = Node::new("Plate", NodeKind::Object(object)).modified(displaced).modified(ring);
        let id = scene.insert(None, 0, plate).unwrap();
        (scene, id)
    }

    #[test]
    fn too_many_rows_are_refused_with_the_node_before_they_are_made() {
        let (scene, id) = copies();
        let rows = flatten(&scene, 0.0).unwrap().params.len();
        assert!(rows > 64 * 900);
        assert!(flatten_in_rows(&scene, rows).is_ok());
        let refused = |most| flatten_in_rows(&scene, most).err().expect("too many rows");
        // The last component is one row too long.
        let error = refused(rows - 1);
        assert_eq!((error.node, error.value, error.limit), (id, rows, rows - 1));
        // Payload rows alone exceed the limit: `collect` makes only as many copies as it takes to know.
        let error = refused(5_000);
        assert_eq!((error.node, error.value, error.limit), (id, 5_400, 5_000));
        let told = format!("Plate ({id}): the number of rows of points, letters and images, copies included is 5400");
        assert!(error.to_string().starts_with(&told), "{error}");
        assert_eq!(refused(0).value, 900);
    }

    #[test]
    fn rows_of_shapes_count_as_well() {
        let mut scene = Scene::new();
        let object = Object { shape: ShapeKind::Heightmap.default_shape(), material: scene.materials()[0].id };
        let id = scene.insert(None, 0, Node::new("Alps", NodeKind::Object(object))).unwrap();
        let error = flatten_in_rows(&scene, 500).err().expect("too many rows");
        // 24 times 24 heights, and their bounding sphere.
        assert_eq!((error.node, error.value, error.limit), (id, 577, 500));
    }
}
