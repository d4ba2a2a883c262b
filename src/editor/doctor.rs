//! The field doctor in the editor: jobs that look at the scene and measure it, and repairs. `doctor_view` shows them.

use egui::Context;

use super::edit_session::EditSession;
use super::messages::Message;
use super::selection;
use super::state::EditorState;
use isolith_document::Edit;
use isolith_field::doctor::{Checks, Finding, FindingKind, Repair, examine};
use isolith_jobs::{Canceled, Job, JobEnd, Task};
use isolith_scene::{Node, Scene};
use isolith_session::{MeasuredView, SceneCost, SharedStudio, folder_of};

/// A node is slow if it takes more than this share of what all read, while a pixel of it takes many evaluations.
const SLOW_SHARE: f64 = 0.4;
/// See [`SLOW_SHARE`].
const SLOW_PER_PIXEL: f64 = 60.0;
/// Default limit of walls, in millimeters: what most printers of plastic can make.
const WALL_MM: f64 = 1.0;

/// What the window shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DoctorTab {
    /// Findings.
    #[default]
    Findings,
    /// Costs.
    Cost,
}

/// State of the window, and its jobs.
pub struct Doctor {
    /// Whether the window is open.
    pub is_open: bool,
    /// What it shows.
    pub tab: DoctorTab,
    /// Whether walls are measured, and their limit in millimeters.
    pub walls: (bool, f64),
    /// Whether loose parts are looked for.
    pub loose_parts: bool,
    /// The findings, gravest first; `None` before the first scan.
    pub findings: Option<Vec<Finding>>,
    /// What a picture takes; `None` before it has been measured.
    pub cost: Option<SceneCost>,
    /// Why it could not be measured, or looked at.
    pub problem: Option<String>,
    /// Pictures per second that are aimed at.
    pub aim: u32,
    /// The revision of the document that was looked at.
    seen: Option<u64>,
    scanning: Option<Job<Result<Vec<Finding>, Canceled>>>,
    measuring: Option<Job<Result<SceneCost, String>>>,
}

impl Default for Doctor {
    fn default() -> Self {
        Self {
            is_open: false,
            tab: DoctorTab::default(),
            walls: (false, WALL_MM),
            loose_parts: false,
            findings: None,
            cost: None,
            problem: None,
            aim: 60,
            seen: None,
            scanning: None,
            measuring: None,
        }
    }
}

impl Doctor {
    /// Drops everything about the previous document.
    pub fn forget(&mut self) {
        let Self { is_open, tab, walls, loose_parts, aim, .. } = *self;
        *self = Self { is_open, tab, walls, loose_parts, aim, ..Self::default() };
    }

    /// Whether a job is running.
    pub fn is_busy(&self) -> bool {
        self.scanning.is_some() || self.measuring.is_some()
    }

    /// The task to show.
    pub fn task(&self) -> Option<&Task> {
        self.scanning.as_ref().map(Job::task).or(self.measuring.as_ref().map(Job::task))
    }

    /// Whether the document has changed since it was looked at.
    pub fn is_outdated(&self, state: &EditorState) -> bool {
        self.seen.is_some_and(|seen| seen != state.session.document.revision())
    }

    /// Looks at the scene as it is shown.
    pub fn scan(&mut self, state: &EditorState) {
        let (scene, flat) = (state.session.document.snapshot(), state.flat().clone());
        let checks = Checks { wall: self.walls.0.then_some(self.walls.1 * 1e-3), loose_parts: self.loose_parts };
        self.seen = Some(state.session.document.revision());
        self.problem = None;
        let task = Task::new("Examining the scene");
        self.scanning = Some(state.derived.jobs().start(task, move |task| examine(&scene, &flat, &checks, task)));
    }

    /// Measures a picture of the viewport.
    pub fn measure(&mut self, state: &EditorState, studio: Option<&SharedStudio>) {
        let Some(studio) = studio.cloned() else { return };
        let (document, view) = (&state.session.document, state.wanted_view());
        let view = MeasuredView {
            scene: document.resting().as_ref().clone(),
            folder: document.path().and_then(folder_of),
            time: document.time(),
            camera: view.camera,
            size: view.size_px,
            shading: view.shading,
        };
        self.seen = Some(document.revision());
        let task = Task::new("Measuring the scene");
        self.measuring = Some(state.derived.jobs().start(task, move |task| studio.measure(&view, task)));
    }

    /// Takes over the ends of the jobs. Call once a frame.
    pub fn poll(&mut self, ctx: &Context, scene: &Scene) {
        if let Some(end) = self.scanning.as_ref().and_then(Job::poll) {
            self.scanning = None;
            match end {
                JobEnd::Done(Ok(findings)) => self.findings = Some(findings),
                JobEnd::Failed(reason) => self.problem = Some(reason),
                JobEnd::Done(Err(_)) | JobEnd::Canceled => self.seen = None,
            }
            ctx.request_repaint();
        }
        if let Some(end) = self.measuring.as_ref().and_then(Job::poll) {
            self.measuring = None;
            match end {
                JobEnd::Done(Ok(cost)) => self.cost = Some(cost),
                JobEnd::Done(Err(reason)) | JobEnd::Failed(reason) => self.problem = Some(reason),
                JobEnd::Canceled => {}
            }
            ctx.request_repaint();
        }
        // What is gone needs no doctor.
        if let Some(findings) = &mut self.findings {
            findings.retain(|finding| scene.node(finding.node).is_some());
        }
    }

    /// All findings, with those that follow from the measurement.
    pub fn all_findings(&self) -> Vec<Finding> {
        let mut all = self.findings.clone().unwrap_or_default();
        if let Some(cost) = &self.cost
            && self.findings.is_some()
        {
            let at = all.iter().position(|finding| finding.kind > FindingKind::Slow).unwrap_or(all.len());
            all.splice(at..at, slow(cost));
        }
        all
    }
}

/// The nodes that take a large share of a picture that takes much.
fn slow(cost: &SceneCost) -> Vec<Finding> {
    let is_slow = |share: f64, per_pixel: f64| share > SLOW_SHARE && per_pixel > SLOW_PER_PIXEL;
    let nodes = cost.nodes.iter().filter(|node| is_slow(cost.share(node), cost.per_pixel(node)));
    let finding = |node: &isolith_session::NodeCost| Finding {
        node: node.node,
        kind: FindingKind::Slow,
        detail: format!(
            "{:.0} % of all that is read, {:.0} evaluations per pixel",
            100.0 * cost.share(node),
            cost.per_pixel(node)
        ),
        place: None,
        repair: None,
    };
    nodes.map(finding).collect()
}

/// Carries out repairs as one step of undo.
pub fn repair(session: &mut EditSession, repairs: &[Repair]) {
    session.finish();
    let nodes: Vec<_> = repairs.iter().map(|repair| node_of(*repair)).collect();
    if selection::refuse_locked(session, &nodes, "repaired") {
        return;
    }
    let count = repairs.len();
    session.together(|session| repairs.iter().for_each(|repair| apply(session, *repair)));
    let things = if count == 1 { "One repair".to_owned() } else { format!("{count} repairs") };
    session.messages.push(Message::success(format!("{things} done; Undo takes back all of it.")));
}

fn node_of(repair: Repair) -> isolith_scene::NodeId {
    match repair {
        Repair::Show(node) | Repair::Hide(node) | Repair::ResetScale(node) | Repair::Delete(node) => node,
    }
}

fn apply(session: &mut EditSession, repair: Repair) {
    let Some(node) = session.document.scene().node(node_of(repair)).cloned() else { return };
    let mut node = Node::clone(&node);
    let edit = match repair {
        Repair::Show(_) | Repair::Hide(_) => {
            node.visible = matches!(repair, Repair::Show(_));
            Edit::Replace(node)
        }
        Repair::ResetScale(_) => {
            // A mirror image stays one.
            node.transform.scale = node.transform.scale.signum();
            Edit::Replace(node)
        }
        Repair::Delete(id) => Edit::Remove(vec![id]),
    };
    session.apply(edit);
}
