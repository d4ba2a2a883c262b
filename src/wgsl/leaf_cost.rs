//! The cost of evaluating leaves, counted in the source of their shapes. It decides between straight-line code and
//! tapes.
//!
//! Straight-line code evaluates every leaf of a component at every step. Tapes evaluate about six, each with a `switch`
//! over the shapes, of which software drivers execute every arm. So tapes cost about 6 (K + 6), where K is the cost of
//! one leaf of each kind of shape in the scene, and straight-line code costs the sum over all leaves; the unit is the
//! cost of a sphere. Measured with leaves in one blend on lavapipe 22.3.6, both took the same time with 45 spheres (42
//! by this rule), 32 boxes (34), 35 tori (39), 10 ellipsoids (10), 65 of nine kinds (70). Crowded or nested leaves have
//! longer tapes: 80 tori of a shell 21 entries, a hundred nested balls 19. Once tapes are ready, their mean length
//! replaces the six.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use naga::proc::TypeResolution;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{BinaryOperator, Block, Expression, Function, Handle, MathFunction, Module, Statement, TypeInner};

use super::files::library;
use super::gradients::with_rows;
use super::op_set::shape_loops;
use isolith_field::{Component, FlatNode, FlatScene, has_tape, leaf_payload};
use isolith_scene::ShapeKind;

/// Approximate number of tape entries evaluated at a point, before tapes are ready.
const EVALUATED_ENTRIES: f64 = 6.0;
/// Cost of a tape entry besides its shape.
const ENTRY_COST: f64 = 6.0;
/// Instructions of a leaf in straight-line code besides its shape: its placement and its blend.
const LEAF_INSTRUCTIONS: f64 = 60.0;
/// Cost of reading a payload row at a place that is not constant.
const ROW_LOAD: f64 = 12.0;
/// Payload rows in a piece of a drawing: the rows that a loop over payload reads in one iteration.
const ROWS_OF_PIECE: f64 = 3.0;

/// Whether tapes draw a component faster than straight-line code in its scene. `entries`: mean length of its tapes,
/// once they are ready.
pub fn tapes_are_cheaper(
    flat: &FlatScene,
    component: &Component,
    kinds: &BTreeSet<ShapeKind>,
    entries: Option<f64>,
) -> bool {
    if component.is_modified() || !has_tape(flat, component) {
        return false;
    }
    let nodes = &flat.nodes[component.first as usize..][..component.count as usize];
    let cost = |node: &FlatNode| {
        let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
        leaf_cost(kind, leaf_payload(kind, &flat.params[node.params as usize..]).len())
    };
    let straight: f64 = nodes.iter().filter(|node| node.is_leaf()).map(cost).sum();
    // Tapes, too, loop over pieces, but only for nearby leaves.
    let of_kinds: f64 = kinds.iter().map(|kind| leaf_cost(*kind, 0)).sum();
    straight > entries.unwrap_or(EVALUATED_ENTRIES) * (of_kinds + ENTRY_COST)
}

/// The cost of a leaf with `data` payload rows, in units of a sphere.
fn leaf_cost(kind: ShapeKind, data: usize) -> f64 {
    static COUNTED: LazyLock<Vec<[f64; 2]>> = LazyLock::new(|| {
        let instructions = |kind: &ShapeKind| Instructions::of(*kind).unwrap_or_default();
        ShapeKind::ALL.iter().map(|kind| instructions(kind).sums()).collect()
    });
    let instructions = |kind: ShapeKind, data: usize| {
        let [once, in_loops] = COUNTED[kind as usize];
        let rounds = (data as f64 / ROWS_OF_PIECE).max(f64::from(shape_loops(kind)[1])).max(1.0);
        LEAF_INSTRUCTIONS + once + in_loops * rounds
    };
    instructions(kind, data) / instructions(ShapeKind::Sphere, 0)
}

/// Instructions that a shape's function executes: outside loops, and in one iteration of each loop.
#[derive(Clone, Copy, Debug, Default)]
struct Instructions {
    once: f64,
    in_loops: f64,
}

impl Instructions {
    fn sums(self) -> [f64; 2] {
        [self.once, self.in_loops]
    }

    /// Counts the function of a shape with all that it calls. `None` if the source does not parse, which the shader
    /// tests reject.
    fn of(kind: ShapeKind) -> Option<Self> {
        let shape = kind.function().trim_start_matches("sdf_");
        let text = with_rows(library(&format!("sdf/{shape}.wgsl")).ok()?);
        let module = naga::front::wgsl::parse_str(&text).ok()?;
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).ok()?;
        let named = |(_, f): &(Handle<Function>, &Function)| f.name.as_deref() == Some(kind.function());
        let (handle, _) = module.functions.iter().find(named)?;
        let mut found = Self::default();
        InstructionCounter { module: &module, info: &info, found: &mut found }.function(handle, false);
        Some(found)
    }
}

struct InstructionCounter<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
    found: &'a mut Instructions,
}

impl InstructionCounter<'_> {
    fn function(&mut self, handle: Handle<Function>, in_loop: bool) {
        let module = self.module;
        self.block(handle, &module.functions[handle].body, in_loop);
    }

    fn block(&mut self, handle: Handle<Function>, block: &Block, in_loop: bool) {
        for statement in block {
            match statement {
                Statement::Emit(range) => range.clone().for_each(|e| self.expression(handle, e, in_loop)),
                Statement::Block(inner) => self.block(handle, inner, in_loop),
                // Software drivers execute both branches.
                Statement::If { accept, reject, .. } => {
                    self.block(handle, accept, in_loop);
                    self.block(handle, reject, in_loop);
                }
                Statement::Switch { cases, .. } => {
                    cases.iter().for_each(|case| self.block(handle, &case.body, in_loop));
                }
                Statement::Loop { body, continuing, .. } => {
                    self.block(handle, body, true);
                    self.block(handle, continuing, true);
                }
                Statement::Call { function, .. } if self.is_row(*function) => self.add(ROW_LOAD, in_loop),
                Statement::Call { function, .. } => self.function(*function, in_loop),
                _ => {}
            }
        }
    }

    fn expression(&mut self, handle: Handle<Function>, at: Handle<Expression>, in_loop: bool) {
        use MathFunction as M;
        let expressions = &self.module.functions[handle].expressions;
        let weight = match &expressions[at] {
            Expression::Binary { op: BinaryOperator::Divide | BinaryOperator::Modulo, .. } => 4.0,
            Expression::Math { fun: M::Sqrt | M::InverseSqrt, .. } => 4.0,
            Expression::Math { fun: M::Length | M::Distance | M::Normalize, arg, .. } => {
                4.0 + 2.0 * self.lanes(handle, *arg)
            }
            Expression::Math { fun: M::Dot, arg, .. } => 2.0 * self.lanes(handle, *arg),
            Expression::Math { fun: M::Pow | M::Exp | M::Exp2 | M::Log | M::Log2, .. } => 20.0,
            Expression::Math { fun: M::Sin | M::Cos | M::Tan | M::Atan | M::Atan2 | M::Acos | M::Asin, .. } => 30.0,
            Expression::Binary { .. }
            | Expression::Unary { .. }
            | Expression::Math { .. }
            | Expression::Select { .. } => 1.0,
            _ => return,
        };
        self.add(weight * self.lanes(handle, at), in_loop);
    }

    fn add(&mut self, weight: f64, in_loop: bool) {
        if in_loop {
            self.found.in_loops += weight;
        } else {
            self.found.once += weight;
        }
    }

    /// Whether a function reads a payload row or a texel of bricks.
    fn is_row(&self, handle: Handle<Function>) -> bool {
        matches!(self.module.functions[handle].name.as_deref(), Some("scene_row" | "bricks_texel"))
    }

    /// Number of scalars in the value of an expression.
    fn lanes(&self, handle: Handle<Function>, at: Handle<Expression>) -> f64 {
        let types = &self.module.types;
        let inner = match &self.info[handle][at].ty {
            TypeResolution::Handle(ty) => &types[*ty].inner,
            TypeResolution::Value(inner) => inner,
        };
        match inner {
            TypeInner::Vector { size, .. } => f64::from(*size as u8),
            TypeInner::Matrix { columns, rows, .. } => f64::from(*columns as u8 * *rows as u8),
            _ => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_field::{CellTree, flatten};
    use isolith_scene::{Blend, Group, MaterialId, Node, NodeKind, Object, Operator, Scene, Shape};

    /// One blend of `count` leaves of each shape.
    fn blend(shapes: &[Shape], count: usize) -> FlatScene {
        let mut scene = Scene::new();
        let blend = Blend { radius: 0.05, ..Blend::HARD };
        let group = Group { operator: Operator::Union, blend, ..Group::UNION };
        let parent = scene.insert(None, 0, Node::new("blend", NodeKind::Group(group))).expect("room");
        for i in 0..count * shapes.len() {
            let object = Object { shape: shapes[i % shapes.len()].clone(), material: MaterialId(1) };
            let turn = 2.4 * i as f64;
            let at = glam::DVec3::new(turn.cos(), 0.07 * i as f64, turn.sin());
            let node = Node::new("shape", NodeKind::Object(object)).at(at).rotated(glam::DQuat::from_rotation_x(turn));
            scene.insert(Some(parent), usize::MAX, node).expect("room");
        }
        flatten(&scene, 0.0).expect("within the limits")
    }

    fn cheaper(shapes: &[Shape], count: usize) -> bool {
        let flat = blend(shapes, count);
        assert_eq!(flat.components.len(), 1);
        tapes_are_cheaper(&flat, &flat.components[0], &shapes.iter().map(Shape::kind).collect(), None)
    }

    #[test]
    fn costs_grow_with_what_a_shape_computes() {
        let all: Vec<String> =
            ShapeKind::ALL.iter().map(|kind| format!("{kind:?} {:.2}", leaf_cost(*kind, 0))).collect();
        let cost = |kind| leaf_cost(kind, 0);
        assert_eq!(cost(ShapeKind::Sphere), 1.0);
        assert!(ShapeKind::ALL.iter().all(|kind| cost(*kind) > 0.8), "{all:?}");
        assert!((1.1..2.0).contains(&cost(ShapeKind::Box)) && (1.05..2.0).contains(&cost(ShapeKind::Torus)), "{all:?}");
        assert!((5.0..12.0).contains(&cost(ShapeKind::Ellipsoid)), "{all:?}");
        assert!(leaf_cost(ShapeKind::Tube, 30) > 2.0 * leaf_cost(ShapeKind::Tube, 3), "{all:?}");
    }

    /// Tests either side of the measured break-even points.
    #[test]
    fn tapes_draw_many_or_dear_leaves() {
        let sphere = Shape::Sphere { radius: 0.3 };
        let ellipsoid = Shape::Ellipsoid { radii: [0.3, 0.2, 0.15] };
        let torus = Shape::Torus { major_radius: 0.3, minor_radius: 0.1 };
        let both = [sphere, torus];
        let [spheres, tori] = [&both[..1], &both[1..]];
        for (shapes, few, many) in [(spheres, 24, 60), (tori, 24, 60), (&[ellipsoid], 6, 20), (&both[..], 15, 40)] {
            assert!(!cheaper(shapes, few), "{few} of {shapes:?}");
            assert!(cheaper(shapes, many), "{many} of {shapes:?}");
        }
    }

    /// With straight-line code the shell and the nest take little more than half the time of tapes, and the tubes nine
    /// times as long.
    #[test]
    fn long_lists_are_left_for_straight_line_code() {
        let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
        for (file, is_listed) in [
            ("scenes/deep-tree.json", false),
            ("tests/cases/numerics/deep_nest_100_alternating.json", false),
            ("tests/cases/numerics/auto_is_slow_60_tube.json", true),
        ] {
            let scene = isolith_scene::file::load(&folder.join(file)).expect("a scene");
            let flat = flatten(&scene, 0.0).expect("within the limits");
            let leaves = flat.nodes.iter().filter(|node| node.is_leaf());
            let kinds = leaves.map(|node| ShapeKind::ALL[(node.code & 0xffff) as usize]).collect();
            let largest = flat.components.iter().max_by_key(|component| component.count).expect("something is there");
            let length = CellTree::build(&flat, largest).mean_length();
            assert!(tapes_are_cheaper(&flat, largest, &kinds, None), "{file}: its lists would never be made");
            assert_eq!(tapes_are_cheaper(&flat, largest, &kinds, Some(length)), is_listed, "{file}: {length} entries");
        }
    }
}
