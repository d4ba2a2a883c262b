//! Joins small components of one kind that are near each other into batches.
//!
//! A visible component takes three dispatches, however small it is. In a scene with hundreds of components, neighbors
//! therefore become one component by hard union, which leaves the field unchanged. A batch holds components of one
//! kind only: then few kernels suffice, and none computes features that only some members use.

use std::collections::HashMap;

use glam::DMat3;

use super::arrays::Join;
use super::composition::group_of;
use super::lower_bound::fold_bounds;
use super::operand::{Operand, Value};
use isolith_geometry::Aabb;
use isolith_scene::Blend;

/// Batching leaves at least this many components, since the members of a batch are evaluated together: measured for
/// 32 to 2 000 shapes on lavapipe.
const FEWEST_COMPONENTS: usize = 32;
/// Most shapes in a batch. Sixteen take longer than eight, measured as above.
const MOST_SHAPES: usize = 8;
/// Most shapes in one member of a batch: with more it takes longer.
const MOST_SHAPES_EACH: u32 = 4;
/// A batch is at most this many times as large as its smallest member: its numbers are relative to its center.
const MOST_SPREAD: f64 = 32.0;

/// The components of a scene, with small neighbors of one kind joined, except those whose folds are to stay `alone`.
pub(super) fn batched<'a>(
    components: Vec<Vec<Operand<'a>>>,
    alone: impl Fn(&[Operand<'a>]) -> bool,
) -> Vec<Vec<Operand<'a>>> {
    let shapes = (components.len() / FEWEST_COMPONENTS).min(MOST_SHAPES);
    if shapes < 2 {
        return components;
    }
    let mut kinds: HashMap<Kind, Vec<Member>> = HashMap::new();
    for (at, fold) in components.iter().enumerate() {
        if alone(fold) {
            continue;
        }
        if let (Some(kind), Some(bounds)) = (Kind::of(fold), joinable_bounds(fold)) {
            kinds.entry(kind).or_default().push(Member { at, bounds });
        }
    }
    // The other members of each batch, by its first member.
    let mut others: HashMap<usize, Vec<usize>> = HashMap::new();
    for (kind, mut members) in kinds {
        let most = (shapes / kind.shapes as usize).max(1);
        split(&mut members, 1 << most.ilog2(), &mut |batch| {
            let mut batch: Vec<usize> = batch.iter().map(|member| member.at).collect();
            batch.sort_unstable();
            others.insert(batch[0], batch.split_off(1));
        });
    }
    let mut open: Vec<_> = components.into_iter().map(Some).collect();
    let mut joined = Vec::new();
    for at in 0..open.len() {
        let Some(first) = open[at].take() else { continue };
        let rest = others.get(&at).into_iter().flatten();
        let mut folds = vec![first];
        folds.extend(rest.filter_map(|other| open[*other].take()));
        joined.push(if folds.len() == 1 { folds.remove(0) } else { united(folds) });
    }
    joined
}

/// Whether these folds may form one component.
pub(super) fn may_be_joined(folds: &[Vec<Operand<'_>>]) -> bool {
    let Some(kind) = Kind::of(&folds[0]) else { return false };
    let bounds: Option<Vec<Aabb>> = folds.iter().map(|fold| joinable_bounds(fold)).collect();
    folds.iter().all(|fold| Kind::of(fold).as_ref() == Some(&kind)) && bounds.is_some_and(|all| is_compact(&all))
}

/// The hard union of folds.
pub(super) fn united(folds: Vec<Vec<Operand<'_>>>) -> Vec<Operand<'_>> {
    let operand = |mut fold: Vec<_>| if fold.len() == 1 { fold.remove(0) } else { group_of(fold) };
    let joined = |(at, fold)| {
        let join = if at == 0 { Join::First } else { Join::Union };
        Operand { join, blend: Blend::HARD, detail: [0.0; 2], ..operand(fold) }
    };
    folds.into_iter().enumerate().map(joined).collect()
}

/// The common properties of the members of a batch: shapes, nesting, blends, and all else that selects a kernel.
#[derive(PartialEq, Eq, Hash)]
struct Kind {
    shapes: u32,
    words: Vec<u32>,
}

impl Kind {
    /// `None` if the fold is too large or too slow to be evaluated in a batch.
    fn of(fold: &[Operand<'_>]) -> Option<Self> {
        let mut kind = Self { shapes: 0, words: Vec::new() };
        kind.add(fold).then_some(kind)
    }

    fn add(&mut self, fold: &[Operand<'_>]) -> bool {
        self.words.push(fold.len() as u32);
        fold.iter().all(|operand| {
            let kernel = (operand.blend.radius > 0.0).then_some(operand.blend.kernel as u32);
            self.words.extend([operand.join as u32, kernel.map_or(0, |kernel| kernel + 1)]);
            let fits = match &operand.value {
                Value::Leaf { local_from_world, distance_scale, prepared, .. } => {
                    self.shapes += 1;
                    let [is_moved, is_unscaled] = [local_from_world.matrix3 == DMat3::IDENTITY, *distance_scale == 1.0];
                    self.words.extend([1 + prepared.kind as u32, u32::from(is_moved), u32::from(is_unscaled)]);
                    self.shapes <= MOST_SHAPES_EACH && !prepared.kind.has_data() && !prepared.kind.is_iterated()
                }
                Value::Fold(inner) => {
                    self.words.push(0);
                    self.add(inner)
                }
                Value::Modified { .. } => false,
            };
            fits && !operand.join.is_extended()
        })
    }
}

/// The bounds of a fold that is neither empty nor unbounded.
fn joinable_bounds(fold: &[Operand<'_>]) -> Option<Aabb> {
    let bounds = fold_bounds(fold).bounds;
    (bounds.is_finite() && !bounds.is_empty()).then_some(bounds)
}

fn is_compact(all: &[Aabb]) -> bool {
    let size = |bounds: &Aabb| bounds.half().max_element();
    let whole = all.iter().fold(Aabb::EMPTY, |whole, bounds| whole.union(bounds));
    all.iter().all(|bounds| size(&whole) <= MOST_SPREAD * size(bounds))
}

struct Member {
    at: usize,
    bounds: Aabb,
}

/// Halves the members by position until each part is compact and has at most `most` members, a power of two. The
/// sizes of the parts are powers of two as well, so that a member needs another kernel less often.
fn split(members: &mut [Member], most: usize, out: &mut impl FnMut(&[Member])) {
    let count = members.len();
    let bounds: Vec<Aabb> = members.iter().map(|member| member.bounds).collect();
    if count == 1 || count <= most && count.is_power_of_two() && is_compact(&bounds) {
        return out(members);
    }
    let center = |member: &Member| member.bounds.center();
    let [low, high] = [|a: f64, b| a.min(b), |a: f64, b| a.max(b)];
    let extent = [0, 1, 2].map(|i| {
        let along = || members.iter().map(|member| center(member)[i]);
        along().fold(f64::NEG_INFINITY, high) - along().fold(f64::INFINITY, low)
    });
    let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).unwrap_or_default();
    members.sort_by(|a, b| center(a)[axis].total_cmp(&center(b)[axis]).then(a.at.cmp(&b.at)));
    let first = if count > most {
        // All batches of the first half are full.
        (count / 2).next_multiple_of(most).min((count - 1) / most * most)
    } else if count.is_power_of_two() {
        count / 2
    } else {
        1 << count.ilog2()
    };
    let (a, b) = members.split_at_mut(first);
    split(a, most, out);
    split(b, most, out);
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::{FlatScene, Flattener, eval::field, flatten, flatten_whole};
    use isolith_gallery as gallery;
    use isolith_geometry::Aabb;
    use isolith_scene::{MaterialId, Modifier, Node, NodeKind, Object, Scene, Shape, ShapeKind};

    fn object(kind: ShapeKind) -> Node {
        Node::new("object", NodeKind::Object(Object { shape: kind.default_shape(), material: MaterialId(1) }))
    }

    /// A row of objects, `gap` meters from one to the next.
    fn row(count: usize, gap: f64, node: impl Fn(usize) -> Node) -> Scene {
        let mut scene = Scene::new();
        for i in 0..count {
            scene.insert(None, usize::MAX, node(i).at(DVec3::X * gap * i as f64)).expect("the scene has room");
        }
        scene
    }

    fn counts(flat: &FlatScene) -> Vec<u32> {
        let mut counts: Vec<u32> = flat.components.iter().map(|c| c.count).collect();
        counts.sort_unstable();
        counts
    }

    /// The field of the scene: the minimum over all components.
    fn least(flat: &FlatScene, p: DVec3) -> f64 {
        flat.components.iter().map(|c| field(flat, c, p - c.origin)).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn how_many_are_joined_follows_from_how_many_there_are() {
        let joined = |count| counts(&flatten(&row(count, 2.0, |_| object(ShapeKind::Sphere)), 0.0).unwrap());
        assert_eq!(joined(63), [1; 63]);
        assert_eq!(joined(64), [2; 32]);
        assert_eq!(joined(128 + 3), [[1].as_slice(), &[2], &[4; 32]].concat());
        assert_eq!(joined(600), [8; 75]);
        assert_eq!(joined(607), [[1, 2, 4].as_slice(), &[8; 75]].concat());
    }

    #[test]
    fn what_is_joined_is_alike_and_near() {
        let flat = flatten(&gallery::crowd(1_000, false, 3), 0.0).unwrap();
        assert!(flat.components.len() < 140, "{} components", flat.components.len());
        for component in &flat.components {
            let nodes = &flat.nodes[component.first as usize..][..component.count as usize];
            assert!(nodes.iter().all(|node| node.code & 0xffff == nodes[0].code & 0xffff), "another shape");
            assert!(nodes.len().is_power_of_two() && nodes.len() <= super::MOST_SHAPES);
        }
        // The batches of each of the three shapes fill the crowd about once; batches of shapes from anywhere would
        // fill it once each.
        let volume = |bounds: Aabb| 8.0 * bounds.half().element_product();
        let whole = flat.components.iter().fold(Aabb::EMPTY, |all, c| all.union(&c.bounds.translated(c.origin)));
        let filled = flat.components.iter().map(|c| volume(c.bounds)).sum::<f64>() / volume(whole);
        assert!((1.0..8.0).contains(&filled), "filled {filled} times");
    }

    #[test]
    fn what_is_far_off_large_slow_or_deformed_stays_alone() {
        let alone = |scene: &Scene| flatten(scene, 0.0).unwrap().components.iter().filter(|c| c.count == 1).count();
        // Spheres of 1 m are joined up to 31 m from center to center.
        assert_eq!(alone(&row(64, 30.0, |_| object(ShapeKind::Sphere))), 0);
        assert_eq!(alone(&row(64, 32.0, |_| object(ShapeKind::Sphere))), 64);
        assert_eq!(alone(&row(64, 3.0, |_| object(ShapeKind::Mandelbulb))), 64);
        assert_eq!(alone(&row(64, 3.0, |_| object(ShapeKind::Plane))), 64);
        let twisted = |_: usize| object(ShapeKind::Box).modified(Modifier::Twist { angle: 90.0 });
        assert!(flatten(&row(64, 3.0, twisted), 0.0).unwrap().components.iter().all(|c| c.modifier_domains.len() == 1));
    }

    #[test]
    fn the_field_is_that_of_all_objects() {
        for scene in [gallery::crowd(300, false, 7), gallery::random(200, 7)] {
            let (flat, whole) = (flatten(&scene, 0.0).unwrap(), flatten_whole(&scene, 0.0).unwrap());
            let leaves = |flat: &FlatScene| flat.nodes.iter().filter(|node| node.is_leaf()).count();
            assert_eq!(leaves(&flat), leaves(&whole));
            for i in 0..200 {
                let p = DVec3::new(1.3, 2.9, 4.7).map(|v| 3.0 * (v * f64::from(i)).sin());
                let (ours, all) = (least(&flat, p), least(&whole, p));
                assert!((ours - all).abs() < 1e-5, "{p}: {ours}, {all}");
            }
        }
    }

    #[test]
    fn a_dragged_object_stays_with_its_neighbors_until_it_is_far_off_or_another_shape() {
        let mut scene = gallery::crowd(300, false, 7);
        let mut flattener = Flattener::default();
        let before = flattener.flatten(&scene, 0.0).unwrap();
        let joined = before.components.iter().find(|c| c.count == 8).expect("eight that are joined");
        let dragged = before.ids[joined.first as usize + 3];
        let mut edit = |change: &dyn Fn(&mut Node)| {
            let mut node = Node::clone(scene.node(dragged).unwrap());
            change(&mut node);
            scene.replace(node).unwrap();
            let (flat, fresh) = (flattener.flatten(&scene, 0.0).unwrap(), flatten(&scene, 0.0).unwrap());
            for i in 0..100 {
                let p = DVec3::new(1.3, 2.9, 4.7).map(|v| 3.0 * (v * f64::from(i)).sin());
                assert!((least(&flat, p) - least(&fresh, p)).abs() < 1e-5);
            }
            flat
        };
        // To the opposite side of the crowd.
        let near = edit(&|node| node.transform.translation = -node.transform.translation);
        assert_eq!(near.ids, before.ids, "it stays with its neighbors");
        assert_ne!(near.params, before.params);
        let far = edit(&|node| node.transform.translation.x += 1e4);
        assert_ne!(far.ids, before.ids);
        let alone =
            |flat: &FlatScene| flat.components.iter().any(|c| c.count == 1 && flat.ids[c.first as usize] == dragged);
        assert!(alone(&far));
        let back = edit(&|node| node.transform.translation.x -= 1e4);
        let other = |node: &mut Node| {
            let NodeKind::Object(object) = &mut node.kind else { unreachable!("it is an object") };
            let cylinder = Shape::Cylinder { radius: 0.3, height: 0.4, rounding: 0.0 };
            object.shape = cylinder;
        };
        assert!(alone(&back), "what is alone stays so until all are joined anew");
        assert!(alone(&edit(&other)), "the only one of its kind");
    }
}
