//! Lets the task on whose thread a scene is read know how far it is, and stops the reading where it was canceled: asked once
//! for each entry of the file, because the JSON reader has no place for a task of its own.

use std::cell::RefCell;

use serde::de::Error;

use isolith_jobs::Task;

/// Progress of a task when the bytes are there, and when the scene is. What its session makes of it comes after that.
pub(super) const BYTES_READ: f32 = 0.1;
pub(super) const PARSED: f32 = 0.5;

struct Watched {
    task: Task,
    /// Nodes in the file, and those read so far.
    nodes: usize,
    read: usize,
}

thread_local! {
    static WATCHED: RefCell<Option<Watched>> = const { RefCell::new(None) };
}

/// Reads with the task watching; `nodes` is how many there are.
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

/// An entry of a list was read; an error where there is no reason to go on.
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
