//! Chooses the pipeline and the tapes of each component.

use std::sync::Arc;
use std::time::Duration;

use super::error::RenderError;
use super::evaluation::EvaluationCost;
use crate::pipelines::cache::{EvalMode, PipelineCache, PipelineChoice};
use crate::pipelines::key::PipelineKey;
use crate::pipelines::strategy::EvalStrategy;
use isolith_field::{Cancel, CellTree, Component, FlatNode, FlatScene, TapeCache, leaf_payload};
use isolith_geometry::Camera;
use isolith_scene::ShapeKind;
use isolith_wgsl::shape_loops;

/// Result of [`Evaluators::choose`], parallel to the components.
pub struct Chosen {
    pub keys: Vec<Option<PipelineKey>>,
    pub choices: Vec<PipelineChoice>,
    pub evaluations: Vec<EvaluationCost>,
    pub trees: Vec<Option<Arc<CellTree>>>,
}

/// The renderer waits for tapes that are expected within this time: interpretation without them would take longer. A
/// later frame uses the others.
const TAPES_AT_ONCE: Duration = Duration::from_millis(25);

/// The sources of evaluators.
pub struct Evaluators<'a> {
    pub pipelines: &'a mut PipelineCache,
    pub tape_cache: &'a mut TapeCache,
    pub strategy: EvalStrategy,
    /// Words of tapes that the device can hold.
    pub room: usize,
}

impl Evaluators<'_> {
    /// Chooses pipelines and tapes for each component.
    pub fn choose(self, flat: &FlatScene, camera: &Camera, cancel: &Cancel) -> Result<Chosen, RenderError> {
        let Self { pipelines, tape_cache, strategy, mut room } = self;
        let mut keys = pipelines.keys(flat, strategy, &[]);
        // Only components without a specialized pipeline need tapes, and scenes that are queried as a whole.
        let is_queried = flat.environment.shadowing.is_on() && strategy != EvalStrategy::StraightLine;
        let needs = |key: &Option<PipelineKey>| key.is_none() || is_queried;
        let wanted: Vec<bool> = keys.iter().map(|key| needs(key) && strategy != EvalStrategy::Interpreter).collect();
        let mut trees = match strategy {
            EvalStrategy::Auto => tape_cache.ready_trees(flat, &wanted, TAPES_AT_ONCE),
            _ => tape_cache.trees(flat, &wanted),
        };
        check(cancel)?;
        if strategy == EvalStrategy::Auto && trees.iter().any(Option::is_some) {
            // Components with long tapes get straight-line code instead.
            let length = |(tree, key): (&Option<Arc<CellTree>>, &Option<PipelineKey>)| {
                tree.as_ref().filter(|_| key.is_none()).map(|tree| tree.mean_length())
            };
            let lengths: Vec<_> = trees.iter().zip(&keys).map(length).collect();
            keys = pipelines.keys(flat, strategy, &lengths);
        }
        // Components whose tapes do not fit on the device fall back to the interpreter.
        for tree in &mut trees {
            let needed = tree.as_ref().map_or(0, |tree| tree.words.len());
            match room.checked_sub(needed) {
                Some(left) => room = left,
                None => *tree = None,
            }
        }
        let has_tapes: Vec<bool> = trees.iter().map(Option::is_some).collect();
        let choices = pipelines.choose(flat, &keys, strategy, &has_tapes, &largest_first(flat, camera))?;
        let loops = pipelines.loops();
        let evaluation = |i: usize| {
            let loop_trips = loop_trips(flat, &flat.components[i]);
            let straight = || EvaluationCost::of_straight_line(&flat.components[i], loop_trips);
            let mut now = match (choices[i].mode, &trees[i], keys[i]) {
                (EvalMode::StraightLine, _, Some(_)) => straight(),
                (EvalMode::Tape, Some(tree), _) => {
                    EvaluationCost::of_tapes(&flat.components[i], tree, loops, loop_trips)
                }
                _ => EvaluationCost::of_entries(&flat.components[i], loops, loop_trips),
            };
            // A pipeline that becomes ready takes over within the frame.
            now.iterations = now.iterations.max(keys[i].map_or(0, |_| straight().iterations));
            now
        };
        let evaluations = (0..flat.components.len()).map(evaluation).collect();
        check(cancel)?;
        Ok(Chosen { keys, choices, evaluations, trees })
    }
}

/// Fails if the caller asks to stop.
pub fn check(cancel: &Cancel) -> Result<(), RenderError> {
    if cancel.is_canceled() { Err(RenderError::Canceled) } else { Ok(()) }
}

/// Components ordered by their apparent size, largest first.
fn largest_first(flat: &FlatScene, camera: &Camera) -> Vec<usize> {
    let size = |c: &Component| {
        let way = c.bounds.distance(camera.position - c.origin);
        c.bounds.half().max_element() / way.max(camera.near)
    };
    let mut order: Vec<(f64, usize)> = flat.components.iter().map(size).zip(0..).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    order.into_iter().map(|(_, i)| i).collect()
}

/// Upper bound of the loop iterations of the component's leaves together.
pub fn loop_trips(flat: &FlatScene, component: &Component) -> u32 {
    let entries = &flat.nodes[component.first as usize..(component.first + component.count) as usize];
    let of_leaf = |node: &FlatNode| {
        let kind = ShapeKind::ALL[(node.code & 0xffff) as usize];
        let [loops, most] = shape_loops(kind);
        // A shape without a loop reads its payload at a single place.
        most + if loops > 0 { leaf_payload(kind, &flat.params[node.params as usize..]).len() as u32 } else { 0 }
    };
    entries.iter().filter(|node| node.is_leaf()).map(of_leaf).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_field as field;
    use isolith_gallery as gallery;

    /// These trip counts determine the length of dispatches: if they counted an image's rows, a heightmap would take
    /// minutes.
    #[test]
    fn data_count_as_loop_trips_only_where_they_are_looped_over() {
        let shapes = gallery::all().into_iter().find(|(name, _)| *name == "shapes").expect("the sheet of shapes").1;
        let flat = field::flatten(&shapes, 0.0).expect("within the limits");
        let of_kind = |kind: ShapeKind| {
            let is_it = |node: &&FlatNode| node.is_leaf() && node.code & 0xffff == kind as u32;
            let holds = |c: &&Component| flat.nodes[c.first as usize..][..c.count as usize].iter().any(|n| is_it(&n));
            let component = flat.components.iter().find(holds).expect("every shape is in the sheet");
            (loop_trips(&flat, component), component.payload_rows)
        };
        for kind in ShapeKind::ALL.iter().copied().filter(|kind| kind.has_data()) {
            let (loop_trips, data) = of_kind(kind);
            assert!(data > 0, "{kind:?}");
            if shape_loops(kind)[0] > 0 {
                assert!(loop_trips >= data, "{kind:?}: {loop_trips} loop_trips over {data} rows");
            } else {
                assert_eq!(loop_trips, 0, "{kind:?}");
            }
        }
    }
}
