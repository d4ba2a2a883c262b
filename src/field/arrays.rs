//! The arrays of a flattened scene. The GPU reads the `#[repr(C)]` types as they are; `shaders/common/scene.wgsl`
//! declares their counterparts, and a test compares the layouts.

use std::sync::OnceLock;

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec3};

use super::copies::instancer::FlatInstancer;
use super::flat_bricks::FlatBricks;
use super::flat_material::FlatMaterial;
use super::flat_texture::FlatTextures;
use super::hierarchy::Hierarchy;
use crate::light::environment_map::PlacedMap;
use crate::studio::StudioLook;
use isolith_geometry::{Aabb, Camera, Lens};
use isolith_mesh::ModelPose;
use isolith_scene::{
    DisplaySettings, Environment, Light, MarchSettings, MaterialId, ModifierKind, NodeId, Operator, ShapeKind,
};

/// Entry of the subtree-extent array: a group, a leaf (one shape), a modifier, or a run.
///
/// A run precedes consecutive operands of one group that join in the same way. It has no value. Its bounds say where
/// none of these operands can matter, so that an evaluator skips all of them at once.
///
/// Pre-order: a group is followed by its operands, and `index + extent` is the next sibling. The entry also holds how
/// its value joins the result so far of its group, so an evaluator never looks back.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct FlatNode {
    /// Bits 0–15: shape code, [`FlatNode::MODIFIER`] plus a modifier's code, [`FlatNode::GROUP`] or
    /// [`FlatNode::RUN`]. Bits 16–23: a [`Join`]. Bits 24–31: blend kernel.
    pub code: u32,
    /// Entries of this node and everything below it; 1 for a leaf.
    pub extent: u32,
    /// Index of its first row in [`FlatScene::params`].
    pub params: u32,
    /// Index into [`FlatScene::materials`]; leaves only.
    pub material: u32,
}

impl FlatNode {
    /// The shape code that marks a group.
    pub const GROUP: u32 = 0xffff;
    /// The shape code that marks a run.
    pub const RUN: u32 = 0xfffe;
    /// The first of the shape codes of modifiers.
    pub const MODIFIER: u32 = 0xff00;

    /// Whether it is a group.
    pub fn is_group(&self) -> bool {
        self.code & 0xffff == Self::GROUP
    }

    /// Whether it is a run.
    pub fn is_run(&self) -> bool {
        self.code & 0xffff == Self::RUN
    }

    /// Whether it is a leaf.
    pub fn is_leaf(&self) -> bool {
        self.code & 0xffff < Self::MODIFIER
    }

    /// Which modifier it is, if it is one.
    pub fn modifier(&self) -> Option<ModifierKind> {
        let code = (self.code & 0xffff).checked_sub(Self::MODIFIER)?;
        ModifierKind::ALL.get(code as usize).copied()
    }

    /// Index of the first of its three local-from-component rows among its rows; `None` for groups and runs.
    pub fn placing_row(&self) -> Option<usize> {
        if self.is_leaf() { Some(1) } else { self.modifier().map(|_| GROUP_ROWS) }
    }

    /// How it joins the result so far of its group.
    pub fn join(&self) -> u32 {
        (self.code >> 16) & 0xff
    }

    /// The kernel of its blend, as an index into [`isolith_scene::BlendKernel::ALL`].
    pub fn kernel(&self) -> u32 {
        self.code >> 24
    }
}

/// How an operand joins the result so far of its group; [`FlatNode::code`] holds the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum Join {
    /// The first operand: the fold starts with it.
    First,
    /// Union.
    Union,
    /// Intersection.
    Intersection,
    /// Difference: the operand is cut away.
    Difference,
    /// Exclusive or: space inside exactly one of the two.
    Xor,
    /// A tube where both surfaces meet.
    Pipe,
    /// A groove along its surface.
    Groove,
    /// A tongue along its surface.
    Tongue,
    /// A V cut along its surface.
    Engrave,
    /// Between both.
    Morph,
    /// The material of the operand; the surface stays.
    Paint,
    /// The operand minus the result so far: a difference with exchanged operands, see `stack`.
    ReverseDifference,
}

impl Join {
    /// Every join, by its number.
    pub const ALL: [Self; 12] = [
        Self::First,
        Self::Union,
        Self::Intersection,
        Self::Difference,
        Self::Xor,
        Self::Pipe,
        Self::Groove,
        Self::Tongue,
        Self::Engrave,
        Self::Morph,
        Self::Paint,
        Self::ReverseDifference,
    ];

    /// The join of the later children of a group.
    pub fn of(operator: Operator) -> Self {
        match operator {
            Operator::Union => Self::Union,
            Operator::Intersection => Self::Intersection,
            Operator::Difference => Self::Difference,
            Operator::Xor => Self::Xor,
            Operator::Pipe => Self::Pipe,
            Operator::Groove => Self::Groove,
            Operator::Tongue => Self::Tongue,
            Operator::Engrave => Self::Engrave,
            Operator::Morph => Self::Morph,
            Operator::Paint => Self::Paint,
        }
    }

    /// Whether it needs more than a sum of weights: derivatives of any sign, or a material of its own.
    pub fn is_extended(self) -> bool {
        self > Self::Difference
    }

    /// Whether it only removes from the result so far, or leaves it unchanged.
    pub fn only_cuts(self) -> bool {
        matches!(self, Self::Intersection | Self::Difference | Self::Groove | Self::Engrave | Self::Paint)
    }

    /// Whether a distant operand changes nothing, so that evaluators can skip it by its bounds.
    pub fn is_skipped_far_off(self) -> bool {
        matches!(self, Self::Union | Self::Difference)
    }
}

/// Kernels from this one on are the extended ones: bevels, steps and columns.
pub const FIRST_EXTENDED_KERNEL: u32 = 3;

/// Parameters of an entry, four per row. The rows of leaves and groups both begin with the blend, see
/// [`super::eval::BlendParams`].
///
/// Leaf: `[support, distance_scale, size, depth]`, three rows of local-from-component (a point `p` maps to
/// `dot(row.xyz, p) + row.w`), then the parameters of the shape, 4 per row (0 to 2 rows). A shape with a payload has
/// one more row behind them, `[count, offset, 0, 0]`: its payload has `count` rows, the first of them `offset` rows
/// behind this one. Payload rows stand behind all other rows of the component, so that a specialized kernel does not
/// read them as uniform. Such a row is also the last of the own rows of a modifier with a payload.
///
/// Group: `[support, bound_slope, size, depth]`, center of its bounds, half extent of its bounds. The field of the
/// group at `p` is at least `bound_slope` times the distance from `p` to these bounds; unbounded groups have slope 0
/// and finite dummies. A modifier begins with the same three rows, with its distance_scale behind the center. Three
/// rows of local-from-component and its own rows (see `shaders/mod/`) follow; its content is relative to its local
/// space. A run has the three rows of a group: the largest support of its operands, and bounds and a slope that hold
/// for the field of each of them.
pub type ParamRow = [f32; 4];

/// A component's rows begin at a multiple of this, so that they can be bound as a uniform buffer (256 bytes).
pub const ROW_ALIGNMENT: usize = 16;
/// Rows of a leaf before its parameters.
pub const LEAF_ROWS: usize = 4;
/// Rows of a group or a run.
pub const GROUP_ROWS: usize = 3;

/// Index of the row that locates the payload of a leaf, among its rows; `None` for a shape without a payload.
pub fn payload_row(kind: ShapeKind) -> Option<usize> {
    kind.has_data().then(|| LEAF_ROWS + kind.parameter_rows())
}

/// The payload of the leaf whose rows are the first of `params`; empty for most.
pub fn leaf_payload(kind: ShapeKind, params: &[ParamRow]) -> &[ParamRow] {
    payload_row(kind).map_or(&[], |row| payload_at(params, row))
}

/// The payload that the row at `row` locates.
pub(super) fn payload_at(params: &[ParamRow], row: usize) -> &[ParamRow] {
    let [count, offset, ..] = params[row].map(|v| v as usize);
    &params[row + offset..][..count]
}

/// Rows of a modifier before its own.
pub const MODIFIER_ROWS: usize = GROUP_ROWS + 3;

/// A light with its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatLight {
    /// Its node.
    pub id: NodeId,
    /// World position.
    pub position: DVec3,
    /// Unit world direction in which it shines.
    pub direction: DVec3,
    /// World vectors of one meter along the node's X and Y axis.
    pub axes: [DVec3; 2],
    /// Factor on lengths of the node that have no axis.
    pub scale: f64,
    /// The light.
    pub light: Light,
}

/// A mesh with its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatMesh {
    /// Its node.
    pub id: NodeId,
    /// The file, as the scene names it, and the pose at the scene's time.
    pub model: ModelPose,
    /// World from the file's space.
    pub world_from_local: DAffine3,
    /// Index into [`FlatScene::materials`] instead of the file's own materials.
    pub material: Option<u32>,
    /// Set for a type of an instancer: `world_from_local` then leads to the space of a copy.
    pub instanced: Option<InstanceType>,
}

/// A camera with its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatCamera {
    /// Its node.
    pub id: NodeId,
    /// Its name.
    pub name: String,
    /// The camera.
    pub camera: Camera,
    /// Its lens, for stills.
    pub lens: Lens,
}

/// A subtree that meets the others only through hard union, and is therefore traced alone; or a batch of small ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its first entry in [`FlatScene::nodes`].
    pub first: u32,
    /// Number of entries.
    pub count: u32,
    /// Its first row in [`FlatScene::params`], a multiple of [`ROW_ALIGNMENT`].
    pub params: u32,
    /// Number of rows, payload included.
    pub param_rows: u32,
    /// Number of payload rows of its leaves and modifiers; they are its last rows.
    pub payload_rows: u32,
    /// World position of its own origin; all its numbers are relative to this.
    pub origin: DVec3,
    /// Bounds of its surface, relative to `origin`; may be unbounded.
    pub bounds: Aabb,
    /// A half space that contains the component, relative to `origin`: the points p with n·p + d ≤ 0 for
    /// `[n.x, n.y, n.z, d]`, n of unit length. Known for a plane that later operands only cut: a ray then reaches a
    /// floor at once instead of in ever shorter steps.
    pub half_space: Option<[f64; 4]>,
    /// The largest coordinate of its leaves, relative to `origin`; for an unbounded leaf its distance from there. 0
    /// where no two of their faces can cancel each other. Where a cut ends flush with a face, the remainder is the
    /// rounding of numbers of this size.
    pub flush_extent: f64,
    /// The same without the sizes of shapes that are evaluated in numbers no larger than the distances of the point
    /// and of the shape from `origin`: less for a large face, and right where that point is near.
    pub flush_placement: f64,
    /// Stack depth: the accumulators that an evaluator must be able to put aside.
    pub stack: u32,
    /// Domains of its modifiers, in the order of their entries.
    pub modifier_domains: Vec<ModifierDomain>,
    /// Most evaluations of one entry for one point: 1 without repetition.
    pub copies: u32,
    /// Residue of rounding local-from-component of each entry to f32, zero for groups and runs; empty for a component
    /// that is not [`LARGE`].
    pub rest: Vec<[ParamRow; 3]>,
    /// The node at the top of the scene that it is part of; of a batch that of its first member.
    pub top: NodeId,
    /// How rays from the eye march it.
    pub march: MarchSettings,
    /// Set for a type of an instancer: the component then stands in the space of a copy, `origin` included.
    pub instanced: Option<InstanceType>,
}

/// Which copies a component, or a mesh, is the type of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceType {
    /// Index into [`FlatScene::instancers`].
    pub instancer: u32,
    /// Index among the types of the instancer.
    pub kind: u32,
    /// World bounds of all copies of the instancer.
    pub bounds: Aabb,
}

impl Component {
    /// Local-from-component of the leaf or modifier at `index` of [`FlatScene::nodes`], three rows; for a large
    /// component with the residue of rounding. `None` for groups and runs.
    pub fn placing(&self, flat: &FlatScene, index: usize) -> Option<[[f64; 4]; 3]> {
        let node = &flat.nodes[index];
        let rounded = flat.params[node.params as usize + node.placing_row()?..][..3].iter();
        let mut rows = [[0.0; 4]; 3];
        for (row, rounded) in rows.iter_mut().zip(rounded) {
            *row = rounded.map(f64::from);
        }
        if let Some(rest) = self.rest.get(index - self.first as usize) {
            for (row, rest) in rows.iter_mut().zip(rest) {
                *row = [0, 1, 2, 3].map(|i| row[i] + f64::from(rest[i]));
            }
        }
        Some(rows)
    }

    /// Its bounds relative to `origin`, slightly grown: the arrays are rounded to f32, the bounds are not.
    pub fn grown_bounds(&self) -> Aabb {
        let reach = [self.bounds.min, self.bounds.max].map(|v| v.abs().to_array()).concat();
        self.bounds.expanded(1e-6 * reach.into_iter().filter(|v| v.is_finite()).fold(0.0, f64::max))
    }

    /// Bounds in the world, slightly grown; for a type those of all copies.
    pub fn world_bounds(&self) -> Aabb {
        self.instanced.map_or_else(|| self.grown_bounds().translated(self.origin), |of| of.bounds)
    }

    /// Whether its settings limit the steps of a whole ray: the ray then passes it, which is no failure.
    pub fn has_most_steps(&self) -> bool {
        self.march.steps > 0 && self.instanced.is_none()
    }

    /// Whether it has modifiers.
    pub fn is_modified(&self) -> bool {
        !self.modifier_domains.is_empty()
    }
}

/// The content of a modifier, in the modifier's local space.
#[derive(Clone, Debug, PartialEq)]
pub struct ModifierDomain {
    /// Index of the modifier's entry, counted from the component's first entry.
    pub entry: u32,
    /// Bounds of the content's surface; may be unbounded.
    pub bounds: Aabb,
    /// The field of the content is at least `bound_slope` times the distance to this box.
    pub cull_box: Aabb,
    /// See `cull_box`; 0 where unknown.
    pub bound_slope: f64,
    /// Most evaluations of the content for one point of the component.
    pub copies: u32,
}

/// A warning for the artist; the scene still renders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The node concerned.
    pub node: NodeId,
    /// Its name.
    pub name: String,
    /// The problem.
    pub reason: String,
}

/// The scene at one moment, as arrays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatScene {
    /// The entries of all components, one component after the other.
    pub nodes: Vec<FlatNode>,
    /// Parameters of the nodes.
    pub params: Vec<ParamRow>,
    /// The node of each entry of `nodes`; stays on the CPU.
    pub ids: Vec<NodeId>,
    /// Materials in use, in the order of first use.
    pub materials: Vec<FlatMaterial>,
    /// The id in the scene of each of `materials`.
    pub material_ids: Vec<MaterialId>,
    /// Their textures.
    pub textures: FlatTextures,
    /// The bricks of models.
    pub bricks: FlatBricks,
    /// The components.
    pub components: Vec<Component>,
    /// Instancers whose types are among the components.
    pub instancers: Vec<FlatInstancer>,
    /// Visible lights.
    pub lights: Vec<FlatLight>,
    /// Visible meshes.
    pub meshes: Vec<FlatMesh>,
    /// What lights a scene without lights.
    pub studio: StudioLook,
    /// All cameras.
    pub cameras: Vec<FlatCamera>,
    /// The environment.
    pub environment: Environment,
    /// How the light becomes the colors of a screen.
    pub display: DisplaySettings,
    /// Its light, unless it is a gradient.
    pub environment_map: Option<PlacedMap>,
    /// Warnings for the artist.
    pub warnings: Vec<Warning>,
    /// See [`FlatScene::hierarchy`].
    pub(super) lazy_hierarchy: LazyHierarchy,
}

impl FlatScene {
    /// The hierarchy over the world bounds of the components, built on first use.
    pub fn hierarchy(&self) -> &Hierarchy {
        self.lazy_hierarchy.0.get_or_init(|| {
            let boxes: Vec<Aabb> = self.components.iter().map(Component::world_bounds).collect();
            Hierarchy::build(&boxes)
        })
    }

    /// Whether the hierarchy has been built.
    pub fn has_hierarchy(&self) -> bool {
        self.lazy_hierarchy.0.get().is_some()
    }

    /// Refits the hierarchy, if it has been built, to the changed component at `index`.
    pub(super) fn refit_hierarchy(&mut self, index: usize) {
        let bounds = self.components[index].world_bounds();
        if let Some(hierarchy) = self.lazy_hierarchy.0.get_mut()
            && !hierarchy.refit(index as u32, bounds)
        {
            self.lazy_hierarchy = LazyHierarchy::default();
        }
    }
}

/// The hierarchy of a scene, built on first use. It follows from the components, so comparisons ignore it.
#[derive(Clone, Debug, Default)]
pub(super) struct LazyHierarchy(OnceLock<Hierarchy>);

impl PartialEq for LazyHierarchy {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A component with coordinates beyond this, in meters, is large: rounding to f32 moves its content by over 2 µm.
pub const LARGE: f64 = 64.0;
/// Largest stack that evaluators support, see [`Component::stack`].
pub const MAX_STACK: u32 = 128;
/// Most lights of a scene: shading visits them in one loop, and lavapipe ends loops after 65 535 iterations.
pub const MAX_LIGHTS: usize = 1 << 14;
/// Most entries of one component: for a normal and a material an invocation visits them seven times, twice each, and
/// lavapipe ends every loop after 65 535 iterations.
pub const MAX_COMPONENT_NODES: usize = 4_200;
/// Most entries of all components together: with this many, flattening takes at most a second and half a gigabyte.
pub const MAX_FLAT_NODES: usize = 1 << 18;
/// Most rows in a scene, and most payload rows during flattening: 128 MiB, and fewer than a 32-bit float can count.
pub const MAX_FLAT_ROWS: usize = 1 << 23;
/// Most components: the renderer draws each on its own, and lavapipe needs half a gigabyte and several seconds for
/// this many.
pub const MAX_COMPONENTS: usize = 1 << 16;
/// Most entries of materials, where one with textures has an entry for each object that uses it: a mixture holds indices
/// of 16 bits.
pub const MAX_PLACED_MATERIALS: usize = u16::MAX as usize;
/// Most bytes of the arrays.
pub const MAX_FLAT_BYTES: usize = 160 << 20;
/// Most steps of flattening: visits of nodes and moved operands, copies included. Steps stand for time, but are the
/// same on every machine.
pub const MAX_FLAT_STEPS: usize = 1 << 23;
/// Deepest nesting of groups and their modifiers together; each axis of a mirror counts.
pub const MAX_FLAT_LEVELS: usize = 2_048;
/// Most evaluations of one entry for one point under nested repetitions.
pub const MAX_COPIES: usize = 1 << 14;
/// Most entries of components that have tapes at one time, the largest first: tapes of small components take 12 KB
/// and a tenth of a millisecond per entry.
pub const MAX_CACHED_ENTRIES: usize = 1 << 15;
