//! Places of copies that follow no rule: on rings, along a curve, on a surface.

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::ground::{Ground, GroundPoint, aligned};
use super::hash::{Channel, copy_hash, copy_randoms};
use super::instancer::{FlatLattice, Place};
use isolith_geometry::{Aabb, ArcPiece};
use isolith_scene::{Instancer, Lattice, NodeKind, Scene, Shape, Snap, tube_curve};

/// Why there are no places.
#[derive(Clone, Debug, PartialEq)]
pub enum PlaceRefusal {
    /// The reason, for a warning.
    Cannot(String),
    /// There would be at least so many.
    TooMany(usize),
}

/// The curve that copies follow, in the instancer's space.
pub type Curve = Vec<ArcPiece>;

/// The places of an instancer's lattice, at most `most`.
pub fn places(
    instancer: &Instancer,
    ground: Option<&Ground<'_>>,
    curve: Option<&Curve>,
    most: usize,
) -> Result<Vec<Place>, PlaceRefusal> {
    let places = match instancer.lattice {
        Lattice::Polar { count, rings, radius, spacing } => polar_places(count, rings, radius, spacing, most)?,
        Lattice::Curve { spacing } => {
            let curve = curve.ok_or_else(|| cannot("follows no curve: its target is not a tube"))?;
            curve_places(curve, spacing, most)?
        }
        Lattice::Scatter { density, minimum_distance } => {
            let ground = ground.ok_or_else(|| cannot("stands on no surface: it has no target"))?;
            let places = scattered(instancer, ground, density.sqrt().recip(), most)?;
            return Ok(pruned(instancer.seed, places, minimum_distance));
        }
        Lattice::Grid { .. } | Lattice::Hexagonal { .. } => {
            let ground = ground.ok_or_else(|| cannot("falls on no surface: it has no target"))?;
            lattice_places(instancer, ground, most)?
        }
    };
    let Some(ground) = ground.filter(|_| instancer.snap != Snap::Off) else { return Ok(places) };
    let snapped = |place: &Place| {
        let point = snap(instancer, ground, place.position, f64::INFINITY)?;
        let turned = aligned(point.normal, instancer.align) * place.rotation;
        Some(Place { position: point.position, rotation: turned, up: point.normal.y, ..*place })
    };
    Ok(places.iter().filter_map(snapped).collect())
}

fn cannot(reason: &str) -> PlaceRefusal {
    PlaceRefusal::Cannot(reason.into())
}

fn snap(instancer: &Instancer, ground: &Ground<'_>, from: DVec3, most: f64) -> Option<GroundPoint> {
    match instancer.snap {
        Snap::Down => ground.below(from.x, from.z),
        Snap::Nearest | Snap::Off => ground.nearest(from, most),
    }
}

/// The curve of a tube, in the space of an instancer; `None` if the node is none.
pub fn curve_of(scene: &Scene, instancer: &Instancer, world_from_local: &DAffine3) -> Option<Curve> {
    let id = instancer.target?;
    let NodeKind::Object(object) = &scene.node(id)?.kind else { return None };
    let Shape::Tube { points, closed, .. } = &object.shape else { return None };
    let local_from_tube = world_from_local.inverse() * scene.world_from_local(id);
    let moved: Vec<[f64; 4]> = points
        .iter()
        .map(|[x, y, z, r]| {
            let p = local_from_tube.transform_point3(DVec3::new(*x, *y, *z));
            [p.x, p.y, p.z, *r]
        })
        .collect();
    Some(tube_curve(&moved, *closed).into_iter().flatten().collect())
}

/// Places of rings around the Y axis; each faces outward along X.
pub fn polar_places(
    count: u32,
    rings: u32,
    radius: f64,
    spacing: f64,
    most: usize,
) -> Result<Vec<Place>, PlaceRefusal> {
    let mut places = Vec::new();
    let mut total = 0;
    for ring in 0..rings {
        let far = radius + f64::from(ring) * spacing;
        // The same distance along each ring.
        let around = (f64::from(count) * far / radius).round().max(1.0);
        total += around as usize;
        if total > most {
            return Err(PlaceRefusal::TooMany(total));
        }
        for at in 0..around as u32 {
            let rotation = DQuat::from_rotation_y(-std::f64::consts::TAU * f64::from(at) / around);
            let position = rotation * (DVec3::X * far);
            places.push(Place { cell: [at as i32, 0, ring as i32], position, rotation, up: 1.0 });
        }
    }
    Ok(places)
}

/// Places along a curve; each faces along it with X, Y as far up as that allows.
fn curve_places(curve: &Curve, spacing: f64, most: usize) -> Result<Vec<Place>, PlaceRefusal> {
    let whole: f64 = curve.iter().map(ArcPiece::length).sum();
    let count = (whole / spacing).floor() + 1.0;
    if count > most as f64 {
        return Err(PlaceRefusal::TooMany(count as usize));
    }
    let mut places = Vec::new();
    let (mut before, mut arcs) = (0.0, curve.iter());
    let mut arc = arcs.next();
    for at in 0..count as u32 {
        let way = f64::from(at) * spacing;
        while let Some(now) = arc.filter(|arc| before + arc.length() < way) {
            before += now.length();
            arc = arcs.next();
        }
        let Some(arc) = arc.or(curve.last()) else { break };
        let lambda = lambda_of(arc, way - before);
        let along = arc.direction(lambda).try_normalize().unwrap_or(DVec3::X);
        let side = along.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::Z);
        let rotation = DQuat::from_mat3(&DMat3::from_cols(along, side.cross(along), side));
        places.push(Place { cell: [at as i32, 1, 0], position: arc.at(lambda), rotation, up: 1.0 });
    }
    Ok(places)
}

/// The parameter of an arc at a length from its start, by bisection: lengths along it grow.
fn lambda_of(arc: &ArcPiece, way: f64) -> f64 {
    let (mut low, mut high) = (-arc.reach, arc.reach);
    let start = arc.way(low);
    for _ in 0..48 {
        let middle = 0.5 * (low + high);
        if arc.way(middle) - start < way {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Where a copy stands in a cell of this size, from its middle.
fn jitter(instancer: &Instancer, cell: [i32; 3], size: DVec3) -> DVec3 {
    let random = DVec3::from_array(copy_randoms(instancer.seed, cell, Channel::Place as u32));
    (random - 0.5) * instancer.variation.looseness * size
}

/// The cells of a lattice, as far as the ground reaches, on the ground.
fn lattice_places(instancer: &Instancer, ground: &Ground<'_>, most: usize) -> Result<Vec<Place>, PlaceRefusal> {
    let mut lattice = FlatLattice::of(&instancer.lattice).unwrap_or(FlatLattice::ONE);
    for axis in 0..3 {
        if !lattice.is_endless(axis) {
            continue;
        }
        if !ground.bounds.is_finite() {
            return Err(cannot("has no end and falls on a surface without end; give one of them an end"));
        }
        let [low, high] = [ground.bounds.min, ground.bounds.max].map(|v| v[axis] / lattice.spacing[axis]);
        (lattice.low[axis], lattice.high[axis]) = (low.floor() as i32, high.ceil() as i32);
    }
    let count = lattice.count().unwrap_or(u64::MAX);
    if count > most as u64 {
        return Err(PlaceRefusal::TooMany(usize::try_from(count).unwrap_or(usize::MAX)));
    }
    let size = DVec3::from_array([0, 1, 2].map(|i| if lattice.is_long(i) { lattice.spacing[i] } else { 0.0 }));
    let mut places = Vec::new();
    for z in lattice.low[2]..=lattice.high[2] {
        for y in lattice.low[1]..=lattice.high[1] {
            for x in lattice.low[0]..=lattice.high[0] {
                let cell = [x, y, z];
                let position = lattice.place(cell) + jitter(instancer, cell, size);
                places.push(Place { cell, position, rotation: DQuat::IDENTITY, up: 1.0 });
            }
        }
    }
    Ok(places)
}

/// Places on a surface, one per square of this side.
fn scattered(instancer: &Instancer, ground: &Ground<'_>, side: f64, most: usize) -> Result<Vec<Place>, PlaceRefusal> {
    if !ground.bounds.is_finite() {
        return Err(cannot("is scattered over a surface without end; use a grid that falls on it"));
    }
    let is_flat = instancer.snap == Snap::Down;
    let [low, high] = [ground.bounds.min, ground.bounds.max]
        .map(|v| [0, 1, 2].map(|i| if is_flat && i == 1 { 0 } else { (v[i] / side).floor() as i64 }));
    let mut found = Vec::new();
    let mut open = vec![(low, [0, 1, 2].map(|i| high[i] + 1))];
    while let Some((low, high)) = open.pop() {
        let counts = [0, 1, 2].map(|i| high[i] - low[i]);
        if counts.contains(&0) {
            continue;
        }
        let corner = |cell: [i64; 3]| DVec3::from_array(cell.map(|i| i as f64 * side));
        let block = Aabb { min: corner(low), max: corner(high) };
        // No cell of the block is near the surface.
        if !is_flat && ground.distance(block.center()).abs() > block.half().length() + side {
            continue;
        }
        if counts.iter().all(|n| *n == 1) {
            let cell = low.map(|i| i as i32);
            found.extend(on_ground(instancer, ground, cell, block.center(), side));
            if found.len() > most {
                return Err(PlaceRefusal::TooMany(found.len()));
            }
            continue;
        }
        let axis = (0..3).max_by_key(|i| counts[*i]).unwrap_or(0);
        let (mut first, mut second) = ((low, high), (low, high));
        first.1[axis] = low[axis] + counts[axis] / 2;
        second.0[axis] = first.1[axis];
        open.extend([second, first]);
    }
    Ok(found)
}

/// The copy of a cube on the ground, if one stands there: those whose middle is within half a side of the surface make
/// one per square of it.
fn on_ground(instancer: &Instancer, ground: &Ground<'_>, cell: [i32; 3], middle: DVec3, side: f64) -> Option<Place> {
    let from = middle + jitter(instancer, cell, DVec3::splat(side));
    let most = if instancer.snap == Snap::Down { f64::INFINITY } else { 0.5 * side };
    let point = snap(instancer, ground, from, most)?;
    let rotation = aligned(point.normal, instancer.align);
    Some(Place { cell, position: point.position, rotation, up: point.normal.y })
}

/// The places of which no nearer one than `distance` has a greater random number: local, and the same in any order.
fn pruned(seed: u32, places: Vec<Place>, distance: f64) -> Vec<Place> {
    if distance <= 0.0 {
        return places;
    }
    let home = |place: &Place| (place.position / distance).floor().to_array().map(|v| v as i64);
    let rank = |place: &Place| copy_hash(seed, place.cell, Channel::Place as u32);
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (at, place) in places.iter().enumerate() {
        cells.entry(home(place)).or_default().push(at);
    }
    let stays = |place: &&Place| {
        let [x, y, z] = home(place);
        let around = (0..27).map(|i| [x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]);
        let near = around.filter_map(|cell| cells.get(&cell)).flatten().map(|at| &places[*at]);
        let mut nearer = near.filter(|other| other.position.distance(place.position) < distance);
        !nearer.any(|other| rank(other) > rank(place))
    };
    places.iter().filter(stays).copied().collect()
}
