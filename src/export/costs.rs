//! What a picture takes: time of each pass by the clock of the device, and evaluations by pipelines that count.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use super::error::ExportError;
use super::still::canceled;
use crate::field::mesh_rays::Meshes;
use crate::field::{Component, FlatScene};
use crate::jobs::Task;
use crate::render::driver::loop_iterations;
use crate::render::{AdapterChoice, EvalStrategy, Frame, Gpu, OverlaySettings, Renderer, Slot};
use crate::scene::{NodeId, Scene};
use crate::session::{MeasuredView, NodeCost, PassCost, PreparedScene, SceneCost};

/// Measures a view on a device of its own.
pub fn measure(choice: &AdapterChoice, view: &MeasuredView, task: &Task) -> Result<SceneCost, ExportError> {
    task.set_stage("preparing");
    let preparing = Task::canceled_by(task.name(), task.flag());
    let prepared = PreparedScene::of(&view.scene, view.time, view.folder.clone(), &preparing)?;
    let mut prepared = prepared.ok_or(ExportError::Canceled)?;
    let (meshes, _) = prepared.flat.load_meshes(&mut prepared.library);
    let flat = prepared.flat.shaded(view.shading);
    let gpu = Gpu::open(choice)?;
    loop_iterations(&gpu)?;
    let mut plain = Renderer::new(&gpu)?;
    plain.set_strategy(EvalStrategy::Tape);
    plain.set_cancel(task.flag());
    task.set_stage("measuring time");
    // The first picture compiles and uploads.
    draw(&mut plain, view, &flat, &meshes, task, [0.0, 0.3])?;
    let started = Instant::now();
    draw(&mut plain, view, &flat, &meshes, task, [0.3, 0.5])?;
    let seconds = started.elapsed().as_secs_f64();
    plain.set_timing(true);
    draw(&mut plain, view, &flat, &meshes, task, [0.5, 0.7])?;
    let timed = plain.timings().unwrap_or_default().iter().filter(|pass| pass.runs > 0);
    let passes = timed.map(|pass| PassCost { name: pass.label, seconds: pass.seconds }).collect();
    task.set_stage("counting");
    let mut counting = Renderer::counting(&gpu)?;
    counting.set_cancel(task.flag());
    let frame = draw(&mut counting, view, &flat, &meshes, task, [0.7, 1.0])?;
    let counts = counting.counts(&frame)?;
    let mut nodes: Vec<NodeCost> = Vec::new();
    for (index, component) in flat.components.iter().enumerate() {
        let evaluations = counts.of_components.get(index).copied().unwrap_or(0);
        // Tapes say what they read. Without one, an evaluation reads all of the component.
        let read = counts.entries.get(index).copied().unwrap_or(0);
        let entries = if read > 0 { read } else { evaluations * u64::from(component.count) };
        let (node, others) = holder(&view.scene, &flat, component);
        match nodes.iter_mut().find(|cost| cost.node == node && others == 0 && cost.others == 0) {
            Some(cost) => (cost.evaluations, cost.entries) = (cost.evaluations + evaluations, cost.entries + entries),
            None => nodes.push(NodeCost { node, others, evaluations, entries }),
        }
    }
    nodes.retain(|cost| cost.evaluations > 0);
    nodes.sort_by_key(|cost| std::cmp::Reverse(cost.entries));
    Ok(SceneCost { size: view.size, seconds, nodes, passes, adapter: gpu.info.name.clone() })
}

/// Draws a picture of one sample, which takes the task from one share to the other.
fn draw(
    renderer: &mut Renderer,
    view: &MeasuredView,
    flat: &FlatScene,
    meshes: &Meshes,
    task: &Task,
    [start, end]: [f32; 2],
) -> Result<Frame, ExportError> {
    let overlay = OverlaySettings::default();
    let mut frame = renderer.begin(Slot::Full, flat, meshes, &view.camera, view.size, overlay)?;
    while !frame.is_done() {
        task.set_progress(start + (end - start) * frame.progress());
        if task.is_canceled() {
            return Err(ExportError::Canceled);
        }
        renderer.advance(&mut frame, Duration::ZERO).map_err(canceled)?;
    }
    // All work is queued; reading back waits for it.
    renderer.unfinished_rays(&frame)?;
    Ok(frame)
}

/// The innermost node that holds everything in a component, or the first of several and the number of others.
fn holder(scene: &Scene, flat: &FlatScene, component: &Component) -> (NodeId, usize) {
    let ids = &flat.ids[component.first as usize..(component.first + component.count) as usize];
    let path = |id: NodeId| {
        let mut path: Vec<NodeId> =
            std::iter::successors(Some(id), |id| scene.node(*id).and_then(|node| node.parent)).collect();
        path.reverse();
        path
    };
    let mut shared = path(ids[0]);
    let mut outermost = BTreeSet::new();
    for id in ids {
        let other = path(*id);
        outermost.insert(other[0]);
        let alike = shared.iter().zip(&other).take_while(|(a, b)| a == b).count();
        shared.truncate(alike);
    }
    match shared.last() {
        Some(node) => (*node, 0),
        None => (ids[0], outermost.len() - 1),
    }
}
