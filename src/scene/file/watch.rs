//! Progress and cancellation of reading a scene. The JSON reader cannot carry a task, so a thread-local holds it; each
//! entry of the file reports to it and asks it for cancellation.

use std::cell::RefCell;

use serde::de::Error;

use isolith_jobs::Task;

/// Progress of a task when the bytes are read, and when the scene is parsed. The rest is the session's.
pub(super) const BYTES_READ: f32 = 0.1;
pub(super) const PARSED: f32 = 0.5;

struct Watched {
    task: Task,
    /// Nodes in the file, and nodes read so far.
    nodes: usize,
    read: usize,
}

thread_local! {
    static WATCHED: RefCell<Option<Watched>> = const { RefCell::new(None) };
}

/// Runs `read` with this task watching; `nodes` is the number of nodes in the file.
pub(super) fn within<T>(task: &Task, nodes: usize, read: impl FnOnce() -> T) -> T {
    struct Ended;
    impl Drop for Ended {
        fn drop(&mut self) {
            WATCHED.set(None);
        }
    }
    WATCHED.set(Some(Watched { task: task.clone(), nodes, read: 0 }));
    let _ended = Ended;
    read()
}

/// Reports that an entry of a list was read. Fails if the task is canceled.
pub(super) fn entry<E: Error>(is_node: bool) -> Result<(), E> {
    WATCHED.with_borrow_mut(|watched| {
        let Some(Watched { task, nodes, read }) = watched else { return Ok(()) };
        *read += usize::from(is_node);
        if is_node {
            task.set_progress(BYTES_READ + (PARSED - BYTES_READ) * *read as f32 / (*nodes).max(*read) as f32);
        }
        task.check().map_err(E::custom)
    })
}
