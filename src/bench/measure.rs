//! Times of a frame on the device.

use std::time::{Duration, Instant};

use crate::flat::FlatScene;
use crate::geometry::Camera;
use crate::render::{Frame, OverlaySettings, RenderError, Renderer, Slot};

/// Time of all threads of the program so far.
pub fn cpu_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// exp
pub fn parts(renderer: &mut Renderer, flat: &FlatScene, camera: &Camera, size: [u32; 2]) -> Result<Vec<(Duration, Duration)>, RenderError> {
    let mut out = vec![];
    for _ in 0..3 {
        let a = (cpu_time(), Instant::now());
        let mut frame: Frame = renderer.begin(Slot::Full, flat, &[], camera, size, OverlaySettings::default())?;
        let b = (cpu_time(), Instant::now());
        renderer.run_until(&mut frame, crate::render::schedule::Stage::Surface)?;
        let c = (cpu_time(), Instant::now());
        renderer.run_until(&mut frame, crate::render::schedule::Stage::Shade)?;
        let d = (cpu_time(), Instant::now());
        renderer.run_until(&mut frame, crate::render::schedule::Stage::Mesh)?;
        let e = (cpu_time(), Instant::now());
        let n = renderer.counts(&frame)?.map(|v| v as f64 / f64::from(size[0] * size[1]));
        if n[0] > 0.0 { eprintln!("march evals/px {:.3} rays/px {:.3} cone evals/px {:.3} tiles/px {:.4}", n[0], n[1], n[2], n[3]); }
        out = vec![(b.0 - a.0, b.1 - a.1), (c.0 - b.0, c.1 - b.1), (d.0 - c.0, d.1 - c.1), (e.0 - d.0, e.1 - d.1)];
    }
    Ok(out)
}
