//! Every evaluator that a renderer builds for a scene, without a device: for tools that read the shaders or compile
//! them elsewhere.

use std::collections::{BTreeSet, HashMap};

use crate::pipelines::key::Templates;
use crate::pipelines::strategy::EvalStrategy;
use isolith_field::{FlatScene, has_tape};
use isolith_wgsl::{Evaluator, OpSet};

/// An evaluator and the components that it draws, by index. The interpreter of [`EvalStrategy::Auto`] draws all of them
/// until faster pipelines are ready.
#[derive(Clone, Debug)]
pub struct EvaluatorUse {
    /// The evaluator.
    pub evaluator: Evaluator,
    /// Indices of the components that it draws, ascending.
    pub components: Vec<usize>,
}

/// Every evaluator that a new renderer builds for `flat` with this strategy: first interpreter and tapes, then
/// straight-line code, ordered by the first component of each.
pub fn evaluators_of(flat: &FlatScene, strategy: EvalStrategy) -> Vec<EvaluatorUse> {
    let ops = OpSet::of(flat);
    let keys = Templates::default().keys(flat, strategy, &[]);
    let mut walked: [Vec<usize>; 3] = Default::default();
    let mut straight: Vec<EvaluatorUse> = Vec::new();
    let mut slots: HashMap<u128, usize> = HashMap::new();
    for (index, component) in flat.components.iter().enumerate() {
        if let Some(key) = keys[index] {
            if let Some(slot) = slots.get(&key.bits) {
                straight[*slot].components.push(index);
                continue;
            }
            if let Some(evaluator) = key.evaluator(flat, component, strategy) {
                slots.insert(key.bits, straight.len());
                straight.push(EvaluatorUse { evaluator, components: vec![index] });
                continue;
            }
        }
        let has_tapes = strategy != EvalStrategy::Interpreter && has_tape(flat, component);
        walked[if has_tapes { 1 + usize::from(component.is_modified()) } else { 0 }].push(index);
    }
    if strategy == EvalStrategy::Auto {
        walked[0] = (0..flat.components.len()).collect();
    }
    let [plain, modified] = tape_evaluators(&ops);
    let evaluators = [Evaluator::Interpreter(ops), plain, modified];
    let walking = evaluators.into_iter().zip(walked).filter(|(_, components)| !components.is_empty());
    let walking = walking.map(|(evaluator, components)| EvaluatorUse { evaluator, components });
    walking.chain(straight).collect()
}

/// The tape evaluators for a scene that uses these operations: for components without modifiers, and with modifiers.
pub(super) fn tape_evaluators(ops: &OpSet) -> [Evaluator; 2] {
    let plain = OpSet { modifiers: BTreeSet::new(), ..ops.clone() };
    [plain, ops.clone()].map(Evaluator::Tape)
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_field::flatten;
    use isolith_gallery as gallery;

    #[test]
    fn every_component_of_every_scene_is_drawn_by_each_method() {
        for (name, scene) in gallery::all() {
            let flat = flatten(&scene, 0.0).unwrap_or_else(|e| panic!("{name}: {e}"));
            for strategy in
                [EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine, EvalStrategy::Baked]
            {
                let mut drawn: Vec<_> = evaluators_of(&flat, strategy).into_iter().flat_map(|e| e.components).collect();
                drawn.sort_unstable();
                assert!(drawn.into_iter().eq(0..flat.components.len()), "{name} by {strategy:?}");
            }
            let auto = evaluators_of(&flat, EvalStrategy::Auto);
            assert_eq!(auto[0].components.len(), flat.components.len(), "{name}: the interpreter draws first");
        }
    }

    #[test]
    fn equal_structures_share_an_evaluator() {
        let flat = flatten(&gallery::random(512, 5), 0.0).expect("within the limits");
        let auto = evaluators_of(&flat, EvalStrategy::Auto);
        assert!(auto.len() < 12, "{} evaluators for {} components", auto.len(), flat.components.len());
    }
}
