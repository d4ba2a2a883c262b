//! The tables of handles: a parameter gets a handle by one row here or in `shape_rows`.

use glam::DVec3;

use super::measures::Measures;
use super::rows::{BOTH, HandleRow, one, zero};
use super::shape_rows;
use isolith_scene::{Lattice, LightKind, MaskKind, Node, NodeKind, Part};

fn forward(_: &Measures<'_>) -> DVec3 {
    DVec3::NEG_Z
}

fn back(_: &Measures<'_>) -> DVec3 {
    DVec3::Z
}

fn down(_: &Measures<'_>) -> DVec3 {
    DVec3::NEG_Y
}

fn up(_: &Measures<'_>) -> DVec3 {
    DVec3::Y
}

fn right(_: &Measures<'_>) -> DVec3 {
    DVec3::X
}

fn left(_: &Measures<'_>) -> DVec3 {
    DVec3::NEG_X
}

fn outward(m: &Measures<'_>) -> DVec3 {
    m.outward()
}

fn reach(m: &Measures<'_>) -> f64 {
    m.reach
}

/// The space between the middle of a blend and its handle, which keeps a radius of 0 apart from other handles.
fn beside_seam(m: &Measures<'_>) -> DVec3 {
    m.seam + m.outward() * (SEAM_GAP * m.reach)
}

/// The space beside the middle of a blend, in lengths of the reach.
pub const SEAM_GAP: f64 = 0.3;

const RADIUS: HandleRow = HandleRow::along("light.radius", zero, outward);
const RANGE: HandleRow = HandleRow::along("light.falloff.range", zero, forward);

const POINT_LIGHT: &[HandleRow] = &[RADIUS, RANGE];
const SPOT_LIGHT: &[HandleRow] = &[
    RADIUS,
    RANGE,
    HandleRow::angle("light.outer", forward, right, reach, 1.0).at_least(|m| m.number("light.inner")),
    HandleRow::angle("light.inner", forward, left, reach, 1.0).at_most(|m| m.number("light.outer")),
];
const RECTANGLE: &[HandleRow] = &[HandleRow::extent("light.width", 0), HandleRow::extent("light.height", 1)];
const CAMERA: &[HandleRow] = &[HandleRow::angle("fov_y", forward, up, reach, 0.5)];
const LENS: &[HandleRow] = &[CAMERA[0], HandleRow::along("focus_distance", zero, forward)];
const GROUP: &[HandleRow] = &[HandleRow::part_along("blend.radius", beside_seam, outward, |m| m.blend_unit)];

const SPACING: HandleRow = HandleRow::along("lattice.spacing", zero, right);
/// The copies stand around the middle, so that half of them reach to the end of the lattice. 0 is without end: a drag
/// makes an end.
const COUNTS: [HandleRow; 3] = [
    HandleRow::part_along("lattice.counts", zero, left, |m| 0.5 * m.vector("lattice.spacing").x),
    HandleRow::part_along("lattice.counts", zero, down, |m| 0.5 * m.vector("lattice.spacing").y),
    HandleRow::part_along("lattice.counts", zero, forward, |m| 0.5 * m.vector("lattice.spacing").z),
];
const GRID: &[HandleRow] = &[
    SPACING.element(0),
    HandleRow::along("lattice.spacing", zero, back).element(2),
    HandleRow::along("lattice.spacing", zero, up).element(1),
    COUNTS[0].element(0).at_least(one),
    COUNTS[2].element(2).at_least(one),
    COUNTS[1].element(1).at_least(one),
];
const FLAT_GRID: &[HandleRow] = &[GRID[0], GRID[1], GRID[3], GRID[4]];
const HONEYCOMB: &[HandleRow] = &[SPACING, HandleRow::along("lattice.height", zero, up)];
const FLAT_HONEYCOMB: &[HandleRow] = &[SPACING];
const RINGS: &[HandleRow] = &[
    HandleRow::along("lattice.radius", zero, right),
    HandleRow::along("lattice.spacing", |m| DVec3::X * m.number("lattice.radius"), right),
];
const RING: &[HandleRow] = &[RINGS[0]];

/// The rows of a node's kind, with the part of the node that has the parameters.
pub fn rows_of(node: &Node) -> (Part, &'static [HandleRow]) {
    match &node.kind {
        NodeKind::Object(object) => (Part::Shape, shape_rows::rows(object.shape.kind())),
        NodeKind::Group(group) if group.operator.has_radius() => (Part::Operator, GROUP),
        NodeKind::Group(_) => (Part::Operator, &[]),
        NodeKind::Light(light) => (
            Part::Light,
            match light.light {
                LightKind::Sun { .. } => &[],
                LightKind::Point { .. } => POINT_LIGHT,
                LightKind::Spot { .. } => SPOT_LIGHT,
                LightKind::Rectangle { .. } => RECTANGLE,
            },
        ),
        NodeKind::Camera(camera) => (Part::Camera, if camera.aperture > 0.0 { LENS } else { CAMERA }),
        NodeKind::Instancer(instancer) => (Part::Instancer, lattice_rows(&instancer.lattice)),
        NodeKind::Mesh(_) => (Part::Mesh, &[]),
    }
}

/// Directions off the axes, where the handles of lattices are.
fn aside(_: &Measures<'_>) -> DVec3 {
    DVec3::new(0.5 * std::f64::consts::SQRT_2, 0.0, 0.5 * std::f64::consts::SQRT_2)
}

fn across(_: &Measures<'_>) -> DVec3 {
    DVec3::new(0.5 * std::f64::consts::SQRT_2, 0.0, -0.5 * std::f64::consts::SQRT_2)
}

/// Beside the axis along which the spacing is dragged.
fn beside_axis(m: &Measures<'_>) -> DVec3 {
    aside(m) * (SEAM_GAP * m.reach)
}

/// The empty share and the seed of patches have no place in space.
const NOISE_MASK: &[HandleRow] = &[HandleRow::along("size", zero, aside)];
const HEIGHT_MASK: &[HandleRow] = &[HandleRow::along("from", beside_axis, up), HandleRow::along("to", beside_axis, up)];
const SLOPE_MASK: &[HandleRow] = &[
    HandleRow::angle("from", aside, up, reach, 1.0).at_most(|m| m.number("to")),
    HandleRow::angle("to", aside, up, reach, 1.0).at_least(|m| m.number("from")),
];
const RADIUS_MASK: &[HandleRow] = &[
    HandleRow::along("inner", zero, aside).at_most(|m| m.number("outer")),
    HandleRow::along("outer", zero, across).at_least(|m| m.number("inner")),
];

/// The image lies around the middle that its offset gives, which has no handle.
const IMAGE_MASK: &[HandleRow] = &[
    HandleRow::extent("width", 0).shaped(0.5, middle_of_image, BOTH),
    HandleRow::extent("length", 2).shaped(0.5, middle_of_image, BOTH),
];

fn middle_of_image(m: &Measures<'_>) -> DVec3 {
    m.vector("offset") * DVec3::new(1.0, 0.0, 1.0)
}

/// The rows of the masks of an instancer, each with its part of the node.
pub fn mask_rows(node: &Node) -> Vec<(Part, &'static [HandleRow])> {
    let NodeKind::Instancer(instancer) = &node.kind else { return Vec::new() };
    let rows = |kind: MaskKind| match kind {
        MaskKind::Noise => NOISE_MASK,
        MaskKind::Height => HEIGHT_MASK,
        MaskKind::Slope => SLOPE_MASK,
        MaskKind::Radius => RADIUS_MASK,
        MaskKind::Image => IMAGE_MASK,
    };
    instancer.masks.iter().enumerate().map(|(at, slot)| (Part::Mask(at), rows(slot.mask.kind()))).collect()
}

/// The spacing and the count along each axis that has more than one cell; flat lattices are the usual ones.
fn lattice_rows(lattice: &Lattice) -> &'static [HandleRow] {
    match lattice {
        Lattice::Grid { counts: [_, 1, _], .. } => FLAT_GRID,
        Lattice::Grid { .. } => GRID,
        Lattice::Hexagonal { counts: [_, 1, _], .. } => FLAT_HONEYCOMB,
        Lattice::Hexagonal { .. } => HONEYCOMB,
        Lattice::Polar { rings: 1, .. } => RING,
        Lattice::Polar { .. } => RINGS,
        // A surface or a curve says where copies stand.
        Lattice::Scatter { .. } | Lattice::Curve { .. } => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_scene::{CameraNode, Falloff, Group, Instancer, Light, Object, Params, ShapeKind};

    fn of_every_kind() -> Vec<Node> {
        let material = isolith_scene::MaterialId(1);
        let object = |kind: &ShapeKind| NodeKind::Object(Object { shape: kind.default_shape(), material });
        let mut kinds: Vec<NodeKind> = ShapeKind::ALL.iter().map(object).collect();
        let falloff = Falloff::Attenuation { constant: 1.0, linear: 0.0, quadratic: 1.0, range: 5.0 };
        let point = LightKind::Point { power: 1.0, radius: 0.1, falloff };
        let spot = LightKind::Spot { power: 1.0, radius: 0.1, falloff, inner: 10.0, outer: 20.0 };
        kinds.extend([point, spot, LightKind::RECTANGLE].map(|light| NodeKind::Light(Light::new(light))));
        kinds.push(NodeKind::Camera(CameraNode { aperture: 0.1, ..CameraNode::default() }));
        kinds.push(NodeKind::Group(Group::UNION));
        for counts in [[2; 3], [2, 1, 2]] {
            let hexagonal = Lattice::Hexagonal { counts, spacing: 1.0, height: 1.0 };
            let polar = Lattice::Polar { count: 6, rings: counts[1], radius: 2.0, spacing: 1.0 };
            for lattice in [Lattice::Grid { counts, spacing: [1.0; 3] }, hexagonal, polar] {
                let masks = MaskKind::ALL.iter().map(|kind| kind.default_mask().into()).collect();
                kinds.push(NodeKind::Instancer(Box::new(Instancer { lattice, masks, ..Instancer::default() })));
            }
        }
        kinds.into_iter().map(|kind| Node::new("Node", kind)).collect()
    }

    #[test]
    fn every_row_names_a_parameter_that_exists_and_can_be_set() {
        for mut node in of_every_kind() {
            let parts: Vec<_> = mask_rows(&node).into_iter().chain([rows_of(&node)]).collect();
            for (part, row) in parts.into_iter().flat_map(|(part, rows)| rows.iter().map(move |row| (part, row))) {
                let params = part.params_mut(&mut node).unwrap();
                let value = params.get(row.param).unwrap_or_else(|| panic!("no {} in {:?}", row.param, part));
                assert!(params.set(row.param, value), "{}", row.param);
            }
        }
    }

    /// What has no place in space: the length of waves stands for a frequency.
    const WITHOUT: &[&str] = &["light.power", "near", "far", "aperture", "width", "depth"];

    #[test]
    fn every_length_and_angle_has_a_handle() {
        // Ranges and jitter of an instancer have no place in space.
        for node in of_every_kind().into_iter().filter(|node| !matches!(node.kind, NodeKind::Instancer(_))) {
            let (part, rows) = rows_of(&node);
            let params: &dyn Params = part.params(&node).unwrap();
            params.visit("", &mut |prefix, param, value| {
                let name = format!("{prefix}{}", param.name);
                let is_measure = ["m", "°"].contains(&param.limits.unit) && !(param.is_color);
                let is_turn = ["direction", "spread", "phase"].contains(&param.name);
                // A voxel is too small to be seen.
                let is_exempt =
                    name == "voxel_size" || WITHOUT.contains(&&*name) && !matches!(node.kind, NodeKind::Object(_));
                if is_measure && !is_turn && !is_exempt {
                    let found = rows.iter().filter(|row| row.param == name).count();
                    let wanted = match value {
                        isolith_scene::ParamValue::Vector(_) if !name.contains("start") && !name.contains("end") => 3,
                        _ => 1,
                    };
                    assert_eq!(found, wanted, "{name} of {:?}", node.kind);
                }
            });
        }
    }
}
