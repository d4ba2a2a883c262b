//! The arrays. `#[repr(C)]` types are read by the GPU as they stand; `shaders/common/scene.wgsl` is
//! their counterpart, and a test compares the layouts.

use std::sync::OnceLock;

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec3};

use super::hierarchy::Hierarchy;
use isolith_geometry::{Aabb, Camera};
use isolith_scene::{Environment, Light, MaterialId, ModifierKind, NodeId, Operator, ShapeKind};

/// Entry of the subtree-extent array: a group, a leaf (one shape), a modifier, or a run.
///
/// A run stands before operands of the same group that follow each other and join in the same way. It
/// has no value; it says where none of them can matter, so that all are skipped at once.
///
/// Pre-order: a group is followed by its operands, and `index + extent` is the next sibling. The entry
/// also says how its value joins what precedes it in its group, so that an evaluator needs no look back.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct FlatNode {
    /// Bits 0–15: shape code, [`FlatNode::MODIFIER`] and a modifier's code, [`FlatNode::GROUP`] or [`FlatNode::RUN`]. Bits 16–23: a [`Join`]. Bits 24–31: blend kernel.
    pub code: u32,
    /// Entries of this node and everything below it; 1 for a leaf.
    pub extent: u32,
    /// Where its numbers start in [`FlatScene::params`].
    pub params: u32,
    /// Index into [`FlatScene::materials`]; leaves only.
    pub material: u32,
}

impl FlatNode {
    /// The shape code that marks a group.
    pub const GROUP: u32 = 0xffff;
    /// The shape code that marks a run.
    pub const RUN: u32 = 0xfffe;
    /// The first of the shape codes that mark modifiers.
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

    /// Where the three rows of local-from-component stand among its rows; `None` for groups and runs.
    pub fn placing_row(&self) -> Option<usize> {
        if self.is_leaf() { Some(1) } else { self.modifier().map(|_| GROUP_ROWS) }
    }

    /// How it joins what precedes it.
    pub fn join(&self) -> u32 {
        (self.code >> 16) & 0xff
    }

    /// The kernel of its blend, as a number of [`isolith_scene::BlendKernel::ALL`].
    pub fn kernel(&self) -> u32 {
        self.code >> 24
    }
}

/// How an operand joins what precedes it in its group; the number stands in [`FlatNode::code`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum Join {
    /// The first operand: it is the start.
    First,
    /// Union.
    Union,
    /// Intersection.
    Intersection,
    /// Cut away.
    Difference,
    /// What is in one but not in both.
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
    /// Only its material.
    Paint,
    /// What is in the operand and not in what stands so far: a difference whose operands are exchanged, see `stack`.
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

    /// How the later children of a group join.
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

    /// Whether it needs more than a sum of shares: derivatives of any sign, or a material of its own.
    pub fn is_extended(self) -> bool {
        self > Self::Difference
    }

    /// Whether it only takes from what stands so far, or leaves it as it is.
    pub fn only_cuts(self) -> bool {
        matches!(self, Self::Intersection | Self::Difference | Self::Groove | Self::Engrave | Self::Paint)
    }

    /// Whether an operand that is far off changes nothing, so that it can be skipped by its bounds.
    pub fn is_skipped_far_off(self) -> bool {
        matches!(self, Self::Union | Self::Difference)
    }
}

/// Kernels from this one on are the extended ones: bevels, steps and columns.
pub const FIRST_EXTENDED_KERNEL: u32 = 3;

/// Parameters of an entry, four at a time. Both kinds begin with the blend, see [`super::eval::BlendParams`].
///
/// Leaf: `[support, distance_scale, size, depth]`, three rows of local-from-component (a point `p` maps to
/// `dot(row.xyz, p) + row.w`), then the shape's parameters, 4 to a row (0 to 2 rows). A shape with data has one more row
/// behind them, `[count, offset, 0, 0]`: its data are `count` rows, the first `offset` rows behind this one. They stand
/// behind all other rows of the component, so that they are no part of what a specialized kernel reads as uniform.
/// A modifier with data has such a row behind its own.
///
/// Group: `[support, bound_slope, size, depth]`, center of its bounds, half extent of its bounds. The field of the
/// group at `p` is at least `bound_slope` times the distance from `p` to these bounds; unbounded groups have
/// slope 0 and finite dummies. A modifier has the same three, with its distance_scale behind the center,
/// then three rows of local-from-component and those of `shaders/mod/`; what is below it is relative to its local
/// space. A run has the same rows: the largest support of its operands, and bounds
/// and slope that hold for the field of each of them.
pub type ParamRow = [f32; 4];

/// A component's rows begin at a multiple of this, so that they can be bound as a uniform buffer (256 bytes).
pub const ROW_ALIGNMENT: usize = 16;
/// Rows of a leaf before its parameters.
pub const LEAF_ROWS: usize = 4;
/// Rows of a group or a run.
pub const GROUP_ROWS: usize = 3;

/// Where the row that says where a leaf's data are stands among its rows; `None` for a shape without data.
pub fn payload_row(kind: ShapeKind) -> Option<usize> {
    kind.has_data().then(|| LEAF_ROWS + kind.parameter_rows())
}

/// The data of the leaf whose rows `params` begins with; empty for most.
pub fn leaf_payload(kind: ShapeKind, params: &[ParamRow]) -> &[ParamRow] {
    payload_row(kind).map_or(&[], |row| payload_at(params, row))
}

/// The data that the row at `row` says where to find.
pub(super) fn payload_at(params: &[ParamRow], row: usize) -> &[ParamRow] {
    let [count, offset, ..] = params[row].map(|v| v as usize);
    &params[row + offset..][..count]
}

/// Rows of a modifier before its own.
pub const MODIFIER_ROWS: usize = GROUP_ROWS + 3;

/// A material as the GPU reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FlatMaterial {
    /// Linear diffuse reflectance.
    pub albedo: [f32; 3],
    /// Strength of the highlight.
    pub specular: f32,
    /// Linear emitted color.
    pub emission: [f32; 3],
    /// Blinn-Phong exponent.
    pub shininess: f32,
}

/// A light with its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatLight {
    /// Which node.
    pub id: NodeId,
    /// World position.
    pub position: DVec3,
    /// Unit world direction in which it shines.
    pub direction: DVec3,
    /// The light.
    pub light: Light,
}

/// A mesh with its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatMesh {
    /// Which node.
    pub id: NodeId,
    /// The file, as the scene names it.
    pub path: String,
    /// World from the file's space.
    pub world_from_local: DAffine3,
    /// Index into [`FlatScene::materials`] instead of the file's own materials.
    pub material: Option<u32>,
}

/// Strength of the highlight of a mesh that keeps its file's colors.
pub const FILE_SPECULAR: f64 = 0.2;
/// Its Blinn-Phong exponent.
pub const FILE_SHININESS: f64 = 32.0;

/// A camera with its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatCamera {
    /// Which node.
    pub id: NodeId,
    /// Its name.
    pub name: String,
    /// The camera.
    pub camera: Camera,
}

/// A subtree that meets the others only through hard union, and is therefore traced alone; or several small ones together.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its entries in [`FlatScene::nodes`].
    pub first: u32,
    /// How many.
    pub count: u32,
    /// Its first row in [`FlatScene::params`], a multiple of [`ROW_ALIGNMENT`].
    pub params: u32,
    /// How many rows, data included.
    pub param_rows: u32,
    /// How many of the last of them are data of its leaves and modifiers.
    pub payload_rows: u32,
    /// World position of its own origin; all its numbers are relative to this.
    pub origin: DVec3,
    /// Around its surface, relative to `origin`; may be unbounded.
    pub bounds: Aabb,
    /// A half space that holds all of it, relative to `origin`: the points p with n·p + d ≤ 0 for
    /// `[n.x, n.y, n.z, d]`, n of unit length. Known where a plane is cut into shape: a floor is then
    /// met at once instead of being approached in ever shorter steps.
    pub half_space: Option<[f64; 4]>,
    /// The largest coordinate, relative to `origin`, of the leaves as far as they end; 0 where no two of their faces can
    /// cancel each other. Where a cut ends flush with a face, what the two leave is the rounding of numbers of this size.
    pub flush_extent: f64,
    /// Accumulators that an evaluator must be able to put aside.
    pub stack: u32,
    /// What its modifiers hold, in the order of their entries.
    pub modifier_domains: Vec<ModifierDomain>,
    /// How often an entry may be evaluated for one point: 1 without repetition.
    pub copies: u32,
    /// What rounding to f32 took from local-from-component of each entry, zero for groups and runs; nothing for a component
    /// that is not [`LARGE`].
    pub rest: Vec<[ParamRow; 3]>,
}

impl Component {
    /// Local-from-component of the leaf or modifier at `index` of [`FlatScene::nodes`], three rows: where the component is
    /// large, as it was before rounding. `None` for groups and runs.
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

    /// Its bounds, relative to `origin`, grown a little: the arrays are rounded to f32, their bounds are not.
    pub fn grown_bounds(&self) -> Aabb {
        let reach = [self.bounds.min, self.bounds.max].map(|v| v.abs().to_array()).concat();
        self.bounds.expanded(1e-6 * reach.into_iter().filter(|v| v.is_finite()).fold(0.0, f64::max))
    }

    /// Whether it holds modifiers.
    pub fn is_modified(&self) -> bool {
        !self.modifier_domains.is_empty()
    }
}

/// What a modifier holds, in its own space.
#[derive(Clone, Debug, PartialEq)]
pub struct ModifierDomain {
    /// The modifier's entry, counted from the component's first.
    pub entry: u32,
    /// Around the content's surface; may be unbounded.
    pub bounds: Aabb,
    /// Its field is at least `bound_slope` times the distance to this.
    pub cull_box: Aabb,
    /// See `cull_box`; 0 where nothing is known.
    pub bound_slope: f64,
    /// How often it may be evaluated for one point of the component.
    pub copies: u32,
}

/// Something that the artist should know; the scene is still rendered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The node concerned.
    pub node: NodeId,
    /// Its name.
    pub name: String,
    /// What is the matter.
    pub reason: String,
}

/// The scene at one moment, as arrays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatScene {
    /// The subtree-extent arrays of all components, one after the other.
    pub nodes: Vec<FlatNode>,
    /// Parameters of the nodes.
    pub params: Vec<ParamRow>,
    /// Which node each entry of `nodes` came from; stays on the CPU.
    pub ids: Vec<NodeId>,
    /// Materials in use, then those of the scene that nothing uses are left out.
    pub materials: Vec<FlatMaterial>,
    /// Where each of `materials` came from.
    pub material_ids: Vec<MaterialId>,
    /// What is traced.
    pub components: Vec<Component>,
    /// Visible lights.
    pub lights: Vec<FlatLight>,
    /// Visible meshes.
    pub meshes: Vec<FlatMesh>,
    /// All cameras.
    pub cameras: Vec<FlatCamera>,
    /// Surroundings.
    pub environment: Environment,
    /// What the artist should know.
    pub warnings: Vec<Warning>,
    /// See [`FlatScene::hierarchy`].
    pub(super) lazy_hierarchy: LazyHierarchy,
}

impl FlatScene {
    /// The hierarchy over the bounds of the components, in the world. Built when first asked for; a scene that nobody asks
    /// has none.
    pub fn hierarchy(&self) -> &Hierarchy {
        self.lazy_hierarchy.0.get_or_init(|| {
            let boxes: Vec<Aabb> = self.components.iter().map(world_bounds).collect();
            Hierarchy::build(&boxes)
        })
    }

    /// Whether somebody has asked for the hierarchy.
    pub fn has_hierarchy(&self) -> bool {
        self.lazy_hierarchy.0.get().is_some()
    }

    /// Fits the hierarchy, where there is one, to the component at `index`, which has changed.
    pub(super) fn refit_hierarchy(&mut self, index: usize) {
        let bounds = world_bounds(&self.components[index]);
        if let Some(hierarchy) = self.lazy_hierarchy.0.get_mut()
            && !hierarchy.refit(index as u32, bounds)
        {
            self.lazy_hierarchy = LazyHierarchy::default();
        }
    }
}

/// The grown bounds of a component in the world.
fn world_bounds(component: &Component) -> Aabb {
    component.grown_bounds().translated(component.origin)
}

/// The hierarchy of a scene once somebody needs it. It follows from the components, so it takes no part in comparisons.
#[derive(Clone, Debug, Default)]
pub(super) struct LazyHierarchy(OnceLock<Hierarchy>);

impl PartialEq for LazyHierarchy {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A component whose numbers reach beyond this, in meters, is large: rounding to f32 moves what is in it by more than 2 µm.
pub const LARGE: f64 = 64.0;
/// Largest stack for which an evaluator exists, see [`Component::stack`].
pub const MAX_STACK: u32 = 128;
/// Most entries in one component: an invocation visits them seven times, twice each, for a normal and a
/// material, and lavapipe ends every loop after 65 535 iterations.
pub const MAX_COMPONENT_NODES: usize = 4_200;
/// Most entries in all components together: with so many of them flattening takes a second and half a gigabyte at most.
pub const MAX_FLAT_NODES: usize = 1 << 18;
/// Most rows of numbers in a scene, and of data while it is flattened: 128 MiB, and fewer than a 32-bit float can count.
pub const MAX_FLAT_ROWS: usize = 1 << 23;
/// Most components: each is drawn by itself, and that many take lavapipe half a gigabyte and several seconds.
pub const MAX_COMPONENTS: usize = 1 << 16;
/// Most bytes of the arrays.
pub const MAX_FLAT_BYTES: usize = 160 << 20;
/// Most steps of flattening: visits of nodes, and operands that are moved, copies included. They stand for time, and are
/// the same on every machine.
pub const MAX_FLAT_STEPS: usize = 1 << 23;
/// Deepest nesting of groups and of their modifiers together, each axis of a mirror counted.
pub const MAX_FLAT_LEVELS: usize = 2_048;
/// Most copies of one entry that are evaluated for one point, where repetitions stand within each other.
pub const MAX_COPIES: usize = 1 << 14;
/// Most entries of components that have tapes at once, the largest first: tapes of small components take 12 KB and
/// a tenth of a millisecond for each entry.
pub const MAX_CACHED_ENTRIES: usize = 1 << 15;
