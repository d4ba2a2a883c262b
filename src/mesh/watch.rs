//! Watches the files of meshes on a thread of its own, and reads changed ones again.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use super::library::{MeshSource, Reread};
use super::resolve::MeshFileStamp;

/// How often the files are checked.
const PERIOD: Duration = Duration::from_secs(1);
/// How soon a changed file is checked again: it is read once it has stopped changing, so that no half-written file is
/// read.
const SETTLING: Duration = Duration::from_millis(250);

enum Order {
    Watch(Vec<MeshSource>),
    ReadAll,
}

/// The handle of the thread, which ends when the handle is dropped.
#[derive(Debug)]
pub struct Watcher {
    orders: Sender<Order>,
    news: Receiver<Reread>,
}

impl Watcher {
    /// Starts the thread; it calls `wake` when there is news. The error is a reason for the user.
    pub fn start(wake: impl Fn() + Send + 'static) -> Result<Self, String> {
        let (orders, received) = channel();
        let (sender, news) = channel();
        let thread = std::thread::Builder::new().name("models on disk".into());
        thread.spawn(move || run(&received, &sender, wake)).map_err(|error| error.to_string())?;
        Ok(Self { orders, news })
    }

    /// Watches exactly these from now on.
    pub fn watch(&self, sources: Vec<MeshSource>) {
        // Cannot fail: the thread lives as long as `self`.
        let _ = self.orders.send(Order::Watch(sources));
    }

    /// Reads everything again, changed or not.
    pub fn read_all(&self) {
        let _ = self.orders.send(Order::ReadAll);
    }

    /// The meshes read again since the last call.
    pub fn news(&self) -> impl Iterator<Item = Reread> {
        self.news.try_iter()
    }
}

/// A watched mesh.
struct Watched {
    source: MeshSource,
    /// The stamps of its files at the last check, if they differ from those at the time of reading.
    changed: Option<Vec<MeshFileStamp>>,
}

fn run(orders: &Receiver<Order>, news: &Sender<Reread>, wake: impl Fn()) {
    let mut watched: Vec<Watched> = Vec::new();
    loop {
        let settling = watched.iter().any(|mesh| mesh.changed.is_some());
        let all = match orders.recv_timeout(if settling { SETTLING } else { PERIOD }) {
            Ok(Order::Watch(sources)) => {
                watched = sources.into_iter().map(|source| Watched { source, changed: None }).collect();
                continue;
            }
            Ok(Order::ReadAll) => true,
            Err(RecvTimeoutError::Timeout) => false,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        for mesh in &mut watched {
            let now = mesh.source.look();
            let is_new = now != mesh.source.files();
            let has_settled = is_new && mesh.changed.as_ref() == Some(&now);
            mesh.changed = (is_new && !has_settled).then_some(now);
            if all || has_settled {
                mesh.changed = None;
                let fresh = mesh.source.clone().read();
                mesh.source = fresh.source().clone();
                if news.send(fresh).is_err() {
                    return;
                }
                wake();
            }
        }
    }
}
