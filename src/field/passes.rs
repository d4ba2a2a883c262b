//! The order in which components are traced for an eye, and the passes that it makes.

use glam::DVec3;

use super::FlatScene;
use isolith_scene::NodeId;

/// Components that are traced one after the other and belong to one node at the top of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComponentPass {
    /// The node.
    pub node: NodeId,
    /// Indices into [`FlatScene::components`], in order.
    pub components: Vec<usize>,
}

impl FlatScene {
    /// Components by the order of their settings, and those of one order by their nearest points, so that hidden ones
    /// come last.
    pub fn tracing_order(&self, eye: DVec3) -> Vec<usize> {
        let key = |at: usize| {
            let component = &self.components[at];
            (component.march.order, component.world_bounds().distance(eye), at)
        };
        let mut order: Vec<(u32, f64, usize)> = (0..self.components.len()).map(key).collect();
        order.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        order.into_iter().map(|(_, _, at)| at).collect()
    }

    /// The passes over the components for an eye.
    pub fn component_passes(&self, eye: DVec3) -> Vec<ComponentPass> {
        let mut passes: Vec<ComponentPass> = Vec::new();
        for at in self.tracing_order(eye) {
            let node = self.components[at].top;
            match passes.last_mut() {
                Some(pass) if pass.node == node => pass.components.push(at),
                _ => passes.push(ComponentPass { node, components: vec![at] }),
            }
        }
        passes
    }
}
