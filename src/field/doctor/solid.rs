//! Loose parts and thin walls of the solid, by distances in f64. What has no bounds, such as a floor, is left out.

use glam::{DVec3, IVec3};

use super::finding::{Checks, Finding, FindingKind, MAX_FINDINGS};
use crate::copies::{world_gradient, world_surface};
use crate::scene_eval::SceneEvaluator;
use crate::{Component, FlatScene};
use isolith_geometry::Aabb;
use isolith_jobs::{Canceled, Task};
use isolith_scene::NodeId;

/// Cells along the longest side of the solid. Parts closer together than a cell count as one.
pub const CELLS: i32 = 96;
/// Rays along each axis, to find walls.
const RAYS: usize = 40;
/// Most steps of a ray.
const MOST_STEPS: usize = 4_096;
/// Distance from the surface from which a wall is measured, relative to its limit.
const START: f64 = 1e-3;

/// The findings.
pub fn findings(flat: &FlatScene, checks: &Checks, task: &Task, told: &dyn Fn(f32)) -> Result<Vec<Finding>, Canceled> {
    let is_bounded = |component: &Component| component.world_bounds().is_finite();
    let mut solid = FlatScene { lights: Vec::new(), ..flat.clone() };
    solid.components.retain(is_bounded);
    // The hierarchy is that of all components.
    solid.lazy_hierarchy = Default::default();
    let bounds = solid.components.iter().fold(Aabb::EMPTY, |all, one| all.union(&one.world_bounds()));
    if solid.components.is_empty() || !bounds.is_finite() {
        return Ok(Vec::new());
    }
    let walls_start = if checks.loose_parts { 0.5 } else { 0.0 };
    let mut found = Vec::new();
    if checks.loose_parts {
        let share = if checks.wall.is_some() { 0.5 } else { 1.0 };
        found.extend(loose_parts(&solid, &bounds, task, &|done| told(share * done))?);
    }
    if let Some(limit) = checks.wall {
        found.extend(thin_walls(&solid, &bounds, limit, task, &|done| told(walls_start + (1.0 - walls_start) * done))?);
    }
    Ok(found)
}

/// A grid of cells, each inside or outside by its center.
struct Grid {
    origin: DVec3,
    cell: f64,
    size: IVec3,
    inside: Vec<bool>,
}

impl Grid {
    fn index(&self, at: IVec3) -> usize {
        ((at.z * self.size.y + at.y) * self.size.x + at.x) as usize
    }

    fn center(&self, at: IVec3) -> DVec3 {
        self.origin + (at.as_dvec3() + 0.5) * self.cell
    }

    /// Fills a block of cells, by one value where it is far from the surface.
    fn fill(&mut self, evaluator: &mut SceneEvaluator<'_>, start: IVec3, size: IVec3) {
        let end = (start + size).min(self.size);
        if (end - start).min_element() <= 0 {
            return;
        }
        let middle = self.origin + (start + end).as_dvec3() * (0.5 * self.cell);
        let reach = (end - start).as_dvec3().length() * (0.5 * self.cell);
        let value = evaluator.distance(middle, reach).value;
        if size.max_element() <= 1 {
            let index = self.index(start);
            self.inside[index] = value < 0.0;
            return;
        }
        if value.abs() > reach {
            for z in start.z..end.z {
                for y in start.y..end.y {
                    let row = self.index(IVec3::new(start.x, y, z));
                    self.inside[row..row + (end.x - start.x) as usize].fill(value < 0.0);
                }
            }
            return;
        }
        let half = (size + 1) / 2;
        for corner in 0..8 {
            let offset = IVec3::new(corner & 1, corner >> 1 & 1, corner >> 2) * half;
            self.fill(evaluator, start + offset, half);
        }
    }

    /// The parts that are joined by faces of cells, largest first: number of cells, and one of them.
    fn parts(&self) -> Vec<(usize, IVec3)> {
        let mut open_cells = self.inside.clone();
        let mut parts = Vec::new();
        for z in 0..self.size.z {
            for y in 0..self.size.y {
                for x in 0..self.size.x {
                    let start = IVec3::new(x, y, z);
                    if !std::mem::take(&mut open_cells[self.index(start)]) {
                        continue;
                    }
                    let (mut open, mut count) = (vec![start], 0);
                    while let Some(at) = open.pop() {
                        count += 1;
                        for step in [IVec3::X, IVec3::Y, IVec3::Z, -IVec3::X, -IVec3::Y, -IVec3::Z] {
                            let next = at + step;
                            let is_in = next.cmpge(IVec3::ZERO).all() && next.cmplt(self.size).all();
                            if is_in && std::mem::take(&mut open_cells[self.index(next)]) {
                                open.push(next);
                            }
                        }
                    }
                    parts.push((count, start));
                }
            }
        }
        parts.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        parts
    }
}

fn loose_parts(solid: &FlatScene, bounds: &Aabb, task: &Task, told: &dyn Fn(f32)) -> Result<Vec<Finding>, Canceled> {
    let cell = 2.0 * bounds.half().max_element() / f64::from(CELLS);
    if cell <= 0.0 {
        return Ok(Vec::new());
    }
    let size = (bounds.half() * 2.0 / cell).ceil().as_ivec3().max(IVec3::ONE) + 2;
    let count = (size.x * size.y * size.z) as usize;
    let mut grid = Grid { origin: bounds.min - cell, cell, size, inside: vec![false; count] };
    let mut evaluator = SceneEvaluator::new(solid);
    const BLOCK: i32 = 16;
    let blocks = (size + BLOCK - 1) / BLOCK;
    for index in 0..blocks.x * blocks.y * blocks.z {
        task.check()?;
        told(index as f32 / (blocks.x * blocks.y * blocks.z) as f32);
        let at = IVec3::new(index % blocks.x, index / blocks.x % blocks.y, index / (blocks.x * blocks.y));
        grid.fill(&mut evaluator, at * BLOCK, IVec3::splat(BLOCK));
    }
    let parts = grid.parts();
    let finding = |(cells, at): &(usize, IVec3)| {
        let place = grid.center(*at);
        let volume = *cells as f64 * cell.powi(3);
        let detail = format!(
            "about {volume:.2e} m³ are not joined to the largest part; parts closer than {cell:.1e} m count as one"
        );
        node_at(solid, &mut evaluator.clone(), place).map(|node| Finding {
            node,
            kind: FindingKind::LoosePart,
            detail,
            place: Some(place),
            repair: None,
        })
    };
    Ok(parts.iter().skip(1).take(MAX_FINDINGS).filter_map(finding).collect())
}

fn thin_walls(
    solid: &FlatScene,
    bounds: &Aabb,
    limit: f64,
    task: &Task,
    told: &dyn Fn(f32),
) -> Result<Vec<Finding>, Canceled> {
    let mut evaluator = SceneEvaluator::new(solid);
    // The thinnest place of each node.
    let mut thinnest: Vec<(NodeId, f64, DVec3)> = Vec::new();
    let size = bounds.half() * 2.0;
    for ray in 0..3 * RAYS * RAYS {
        task.check()?;
        told(ray as f32 / (3 * RAYS * RAYS) as f32);
        let (axis, row, column) = (ray / (RAYS * RAYS), ray / RAYS % RAYS, ray % RAYS);
        let share = |index: usize| (index as f64 + 0.5) / RAYS as f64;
        let mut unit = [0.0; 3];
        (unit[(axis + 1) % 3], unit[(axis + 2) % 3]) = (share(row), share(column));
        let direction = [DVec3::X, DVec3::Y, DVec3::Z][axis];
        let start = bounds.min + DVec3::from(unit) * size - direction * limit;
        let length = size[axis] + 2.0 * limit;
        for entry in entries(&mut evaluator, start, direction, length, limit) {
            let Some(wall) = thickness(solid, &mut evaluator, entry, limit) else { continue };
            let Some(node) = node_at(solid, &mut evaluator, entry) else { continue };
            match thinnest.iter_mut().find(|(other, ..)| *other == node) {
                Some((_, least, place)) if wall < *least => (*least, *place) = (wall, entry),
                Some(_) => {}
                None => thinnest.push((node, wall, entry)),
            }
        }
    }
    thinnest.sort_by(|a, b| a.1.total_cmp(&b.1));
    let finding = |(node, wall, place): (NodeId, f64, DVec3)| Finding {
        node,
        kind: FindingKind::ThinWall,
        detail: format!("a wall of {} where {} are wanted", meters(wall), meters(limit)),
        place: Some(place),
        repair: None,
    };
    Ok(thinnest.into_iter().map(finding).collect())
}

/// Where a ray enters the solid.
fn entries(evaluator: &mut SceneEvaluator<'_>, start: DVec3, direction: DVec3, length: f64, limit: f64) -> Vec<DVec3> {
    let least = limit * START;
    let (mut found, mut t, mut was_inside) = (Vec::new(), 0.0, false);
    for _ in 0..MOST_STEPS {
        if t > length {
            break;
        }
        let value = evaluator.distance(start + direction * t, f64::INFINITY).value;
        let is_inside = value < 0.0;
        if is_inside && !was_inside {
            found.push(start + direction * t);
        }
        was_inside = is_inside;
        t += value.abs().max(least);
    }
    found
}

/// The thickness of the wall below a point just inside of it, if it is less than the limit.
fn thickness(solid: &FlatScene, evaluator: &mut SceneEvaluator<'_>, entry: DVec3, limit: f64) -> Option<f64> {
    let component = evaluator.distance(entry, f64::INFINITY).component?;
    let (_, gradient) = world_gradient(solid, &solid.components[component as usize], entry);
    let inward = -gradient.try_normalize()?;
    let least = limit * START;
    let mut t = 0.0;
    for _ in 0..MOST_STEPS {
        let value = evaluator.distance(entry + inward * (t + least), f64::INFINITY).value;
        if value >= 0.0 {
            return Some(t + least);
        }
        t += (-value).max(least);
        if t > limit {
            return None;
        }
    }
    None
}

/// The node whose surface is nearest.
fn node_at(solid: &FlatScene, evaluator: &mut SceneEvaluator<'_>, p: DVec3) -> Option<NodeId> {
    let component = evaluator.distance(p, f64::INFINITY).component?;
    let leaf = world_surface(solid, &solid.components[component as usize], p).leaf;
    solid.ids.get(leaf as usize).copied()
}

/// A length in a unit in which it is easily read.
fn meters(length: f64) -> String {
    if length < 0.1 { format!("{:.2} mm", length * 1e3) } else { format!("{length:.3} m") }
}
