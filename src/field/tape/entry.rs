//! A component's entries in f64, ready to evaluate, in contiguous arrays.

use glam::{DAffine3, DMat3, DVec3};

use crate::eval::{BlendParams, Payload, entry_field, shape_distance};
use crate::flat_bricks::FlatBricks;
use crate::{Component, FlatNode, FlatScene, LEAF_ROWS, ParamRow, leaf_payload};
use isolith_geometry::{Aabb, singular_values};
use isolith_scene::{ModifierKind, SHAPE_FLOATS, ShapeKind};

/// A leaf, evaluated exactly as the CPU evaluator evaluates it.
#[derive(Clone)]
pub(super) struct Leaf {
    kind: ShapeKind,
    rows: [(DVec3, f64); 3],
    scale: f64,
    parameters: [f64; SHAPE_FLOATS],
    data: Vec<[f64; 4]>,
    bricks: FlatBricks,
}

impl Payload for Leaf {
    fn row(&self, index: usize) -> [f64; 4] {
        self.data[index]
    }
    fn texel(&self, index: usize) -> [u32; 4] {
        self.bricks.texel(index)
    }
}

impl Leaf {
    /// The leaf of shape code `shape` whose rows `params` begins with; `bricks` are those of the scene.
    pub fn read(shape: u32, params: &[ParamRow], bricks: &FlatBricks) -> Self {
        let kind = ShapeKind::ALL[shape as usize];
        let rows = [1, 2, 3].map(|i| {
            let [x, y, z, shift] = params[i].map(f64::from);
            (DVec3::new(x, y, z), shift)
        });
        let mut parameters = [0.0; SHAPE_FLOATS];
        for row in 0..kind.parameter_rows() {
            parameters[4 * row..4 * row + 4].copy_from_slice(&params[LEAF_ROWS + row].map(f64::from));
        }
        let data = leaf_payload(kind, params).iter().map(|row| row.map(f64::from)).collect();
        let bricks = if kind == ShapeKind::MeshField { bricks.clone() } else { FlatBricks::default() };
        Self { kind, rows, scale: params[0][1].into(), parameters, data, bricks }
    }

    /// Its field at `p`, in meters.
    pub fn distance(&self, p: DVec3) -> f64 {
        let local = self.rows.map(|(row, shift)| row.dot(p) + shift);
        shape_distance(self.kind, local, &self.parameters, self) * self.scale
    }

    /// The magnitude of its coordinates in meters, which rounding in f32 is relative to.
    fn size(&self) -> f64 {
        let greatest = match self.around() {
            Some((center, radius)) => center.abs().max_element() + radius,
            None => self.parameters.iter().fold(0.0_f64, |most, v| most.max(v.abs())),
        };
        (self.rows.iter().fold(greatest, |most, (_, shift)| most.max(shift.abs()))) * self.scale
    }

    /// The bounding sphere of a shape with a payload, in its own space.
    fn around(&self) -> Option<(DVec3, f64)> {
        self.data.first().map(|row| (DVec3::from_slice(row), row[3]))
    }

    fn bounding_sphere(&self) -> BoundingSphere {
        let around = self.around().or_else(|| {
            let bounds = self.kind.unpacked(&self.parameters)?.bounds();
            Some((bounds.center(), bounds.half().length()))
        });
        // A payload begins with its bounding sphere.
        let Some((middle, radius)) = around else { return BoundingSphere::NONE };
        let local_from_component = DAffine3 {
            matrix3: DMat3::from_cols(self.rows[0].0, self.rows[1].0, self.rows[2].0).transpose(),
            translation: self.rows.map(|(_, shift)| shift).into(),
        };
        let center = local_from_component.inverse().transform_point3(middle);
        let (least, _) = singular_values(&local_from_component.matrix3);
        BoundingSphere::new(center, least * self.scale, radius * self.scale)
    }
}

/// A lower bound of an entry's field: at p it is at least `slope` |p − `center`| − `reach`.
#[derive(Clone, Copy)]
pub(super) struct BoundingSphere {
    center: DVec3,
    slope_squared: f64,
    reach: f64,
}

impl BoundingSphere {
    /// The trivial bound.
    const NONE: Self = Self { center: DVec3::ZERO, slope_squared: 0.0, reach: f64::INFINITY };
    /// The slack that keeps rounding from making the bound too large.
    const SLACK: f64 = 1e-6;

    fn new(center: DVec3, slope: f64, reach: f64) -> Self {
        if !(center.is_finite() && slope > 0.0 && slope.is_finite() && reach.is_finite()) {
            return Self::NONE;
        }
        let slope = slope.min(1.0) * (1.0 - Self::SLACK);
        let reach = reach * (1.0 + Self::SLACK) + center.length() * Self::SLACK;
        Self { center, slope_squared: slope * slope, reach }
    }

    /// Whether the field at `p` is at least `value` for certain. Without a square root, since calls are far more
    /// frequent than evaluations of a distance.
    #[inline]
    pub fn is_beyond(&self, p: DVec3, value: f64) -> bool {
        let way = value + self.reach;
        way <= 0.0 || self.slope_squared * p.distance_squared(self.center) >= way * way
    }
}

/// All entries of a component; each array holds a harmless value for entries that it does not apply to.
pub(super) struct Entries<'a> {
    flat: &'a FlatScene,
    component: &'a Component,
    first: usize,
    /// The first row of the component.
    pub params: u32,
    /// The leaves; a plane for other entries.
    pub leaves: Vec<Leaf>,
    /// Modifiers whose field may jump, because they evaluate copies only where these can matter.
    pub jumps: Vec<bool>,
    /// The bounding spheres of leaves, groups and modifiers.
    pub spheres: Vec<BoundingSphere>,
    /// The parameters of the blends.
    pub blend_params: Vec<BlendParams>,
    /// The magnitude of coordinates in the component, in meters, rounded up to a power of two so that edits rarely
    /// change it.
    pub size: f64,
}

impl<'a> Entries<'a> {
    /// The entries of `component`.
    pub fn new(flat: &'a FlatScene, component: &'a Component) -> Self {
        let (first, count) = (component.first as usize, component.count as usize);
        let (parameters, data, bricks) = ([0.0; SHAPE_FLOATS], Vec::new(), FlatBricks::default());
        let none = Leaf { kind: ShapeKind::Plane, rows: [(DVec3::ZERO, 0.0); 3], scale: 0.0, parameters, data, bricks };
        let mut entries = Self {
            flat,
            component,
            first,
            params: component.params,
            leaves: vec![none; count],
            jumps: vec![false; count],
            spheres: vec![BoundingSphere::NONE; count],
            blend_params: vec![BlendParams::blend(0.0); count],
            size: 0.0,
        };
        let mut size = component.bounds.min.abs().max(component.bounds.max.abs()).max_element();
        for (index, node) in flat.nodes[first..][..count].iter().enumerate() {
            let params = &flat.params[node.params as usize..];
            entries.blend_params[index] = BlendParams::read(&params[0]);
            if node.is_leaf() {
                let leaf = Leaf::read(node.code & 0xffff, params, &flat.bricks);
                size = size.max(leaf.size());
                entries.spheres[index] = leaf.bounding_sphere();
                entries.leaves[index] = leaf;
            } else if !node.is_run() {
                entries.spheres[index] = group_sphere(params);
                let repeats = |node: &FlatNode| node.modifier() == Some(ModifierKind::Repeat);
                entries.jumps[index] = node.modifier().is_some()
                    && flat.nodes[first + index..][..node.extent as usize].iter().any(repeats);
            }
        }
        entries.size = size.max(f64::MIN_POSITIVE).log2().ceil().exp2();
        entries
    }

    /// The node of an entry.
    pub fn node(&self, entry: usize) -> &'a FlatNode {
        &self.flat.nodes[self.first + entry]
    }

    /// The field of a leaf or of a modifier at `p`, in meters.
    pub fn distance(&self, entry: usize, p: DVec3) -> f64 {
        match self.node(entry).modifier() {
            Some(_) => entry_field(self.flat, self.component, self.first + entry, p),
            None => self.leaves[entry].distance(p),
        }
    }
}

/// The sphere around the bounds in a group's rows, see [`ParamRow`].
fn group_sphere(params: &[ParamRow]) -> BoundingSphere {
    let slope = f64::from(params[0][1]);
    let [center, half] = [1, 2].map(|row| DVec3::from_slice(&params[row].map(f64::from)));
    let bounds = Aabb::from_center_half(center, half);
    BoundingSphere::new(center, slope, slope * bounds.half().length())
}
