//! Seeds of instancers: other ones for those that are not locked.

use super::edit_session::EditSession;
use super::instancing::{instancer, instancer_mut};
use isolith_document::Edit;
use isolith_scene::limits::SEED;
use isolith_scene::{Node, NodeId, Scene};

/// The instancers among the nodes and below them whose seed is not locked.
pub fn unlocked<'s>(scene: &'s Scene, ids: &[NodeId]) -> impl Iterator<Item = &'s Node> {
    let mut indices: Vec<usize> =
        ids.iter().filter_map(|id| scene.index_of(*id)).flat_map(|index| scene.subtree(index)).collect();
    indices.sort_unstable();
    indices.dedup();
    let nodes = indices.into_iter().map(|index| &*scene.nodes()[index]);
    nodes.filter(|node| instancer(node).is_some_and(|instancer| !instancer.seed_locked))
}

/// Gives them other seeds, in one undo step.
pub fn reroll(session: &mut EditSession, ids: &[NodeId]) {
    let scene = session.document.snapshot();
    session.together(|session| {
        for node in unlocked(&scene, ids) {
            let mut node = Node::clone(node);
            let id = node.id;
            if let Some(instancer) = instancer_mut(&mut node) {
                instancer.seed = next(instancer.seed, id);
            }
            session.apply(Edit::Replace(node));
        }
    });
}

/// Another seed, which follows from the old one and the node: two nodes of the same seed get different ones.
fn next(seed: u32, id: NodeId) -> u32 {
    let count = SEED.hard[1] as u64 + 1;
    // SplitMix64: Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators (2014).
    let mut z = (u64::from(seed) ^ (id.0 << 32)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    let other = ((z ^ (z >> 31)) % count) as u32;
    if other == seed { ((u64::from(seed) + 1) % count) as u32 } else { other }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_change_differ_and_stay_within_the_limit() {
        let mut seen = std::collections::HashSet::new();
        for id in 0..20 {
            let mut seed = 1;
            for _ in 0..20 {
                let other = next(seed, NodeId(id));
                assert_ne!(other, seed);
                assert!(SEED.accept(f64::from(other)));
                seed = other;
                seen.insert(other);
            }
        }
        assert!(seen.len() > 390, "{}", seen.len());
    }
}
