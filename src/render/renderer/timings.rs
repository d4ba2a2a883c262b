//! Device time of each pass of the recipe.

use crate::gpu::readback::read_words_at;
use crate::gpu::{Gpu, GpuError};
use crate::recipe::Pass;

/// Limit of passes with timestamps in one submission. With two for each, they take a quarter of a query set.
const MOST_TIMED: usize = 512;

/// Time of a pass of the recipe, over all its runs in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTime {
    /// Label of the pass.
    pub label: &'static str,
    /// Number of times that it began on the device.
    pub runs: u64,
    /// Time on the device, in seconds.
    pub seconds: f64,
}

/// Timings of the passes, see the module.
#[derive(Debug, Default)]
pub struct PassTimings {
    /// `None` if timings are off, or the device has no timestamps.
    queries: Option<Queries>,
    rows: Vec<PassTime>,
}

#[derive(Debug)]
struct Queries {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

impl PassTimings {
    /// Switches timings on, if the device supports them.
    pub fn new(gpu: &Gpu) -> Self {
        let new = || Queries {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("times of passes"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * MOST_TIMED as u32,
            }),
            resolved: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("times of passes"),
                size: 16 * MOST_TIMED as u64,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
        };
        let has_clock = gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let mut timings = Self { queries: has_clock.then(new), rows: Vec::new() };
        timings.begin();
        timings
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        let row = |field_pass: &Pass| PassTime { label: field_pass.label(), runs: 0, seconds: 0.0 };
        self.rows = Pass::ALL.iter().map(row).collect();
    }

    /// Times of the passes of the last frame begun, in the order of the frame; `None` if timings are off.
    pub fn rows(&self) -> Option<&[PassTime]> {
        self.queries.as_ref().map(|_| self.rows.as_slice())
    }

    /// The timestamps that passes write when they begin and end.
    pub fn stamps(&self) -> Option<Stamps<'_>> {
        self.queries.as_ref().map(|queries| Stamps { queries, first: 0 })
    }

    /// Adds the times of these passes, in the order of their timestamps. Waits for the device.
    pub fn add(&mut self, gpu: &Gpu, timed: &[Pass]) -> Result<(), GpuError> {
        let Some(queries) = &self.queries else { return Ok(()) };
        let words = read_words_at(gpu, &queries.resolved, 0, 4 * timed.len())?;
        let period = f64::from(gpu.queue.get_timestamp_period()) * 1e-9;
        for (field_pass, [low, high, later_low, later_high]) in timed.iter().zip(words.as_chunks().0) {
            let at = |low: u32, high: u32| u64::from(high) << 32 | u64::from(low);
            let ticks = at(*later_low, *later_high).saturating_sub(at(*low, *high));
            let row = &mut self.rows[*field_pass as usize];
            row.runs += 1;
            row.seconds += ticks as f64 * period;
        }
        Ok(())
    }
}

/// Two timestamps: when a pass begins, and when it ends.
#[derive(Clone, Copy, Debug)]
pub struct Stamps<'a> {
    queries: &'a Queries,
    first: u32,
}

impl<'a> Stamps<'a> {
    /// Number of passes that can have timestamps.
    pub fn room(self) -> usize {
        MOST_TIMED
    }

    /// The timestamps of the pass with this index.
    pub fn at(self, index: usize) -> Option<Self> {
        (index < self.room()).then_some(Self { first: 2 * index as u32, ..self })
    }

    /// Timestamps of a compute pass.
    pub fn of_compute(self) -> wgpu::ComputePassTimestampWrites<'a> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries.set,
            beginning_of_pass_write_index: Some(self.first),
            end_of_pass_write_index: Some(self.first + 1),
        }
    }

    /// Timestamps of a render pass.
    pub fn of_drawing(self) -> wgpu::RenderPassTimestampWrites<'a> {
        wgpu::RenderPassTimestampWrites {
            query_set: &self.queries.set,
            beginning_of_pass_write_index: Some(self.first),
            end_of_pass_write_index: Some(self.first + 1),
        }
    }

    /// Timestamps of the first and of the last of several render passes.
    pub fn of_several(self) -> [wgpu::RenderPassTimestampWrites<'a>; 2] {
        [
            wgpu::RenderPassTimestampWrites { end_of_pass_write_index: None, ..self.of_drawing() },
            wgpu::RenderPassTimestampWrites { beginning_of_pass_write_index: None, ..self.of_drawing() },
        ]
    }

    /// Resolves the timestamps of the first `count` passes.
    pub fn resolve(self, encoder: &mut wgpu::CommandEncoder, count: usize) {
        if count > 0 {
            encoder.resolve_query_set(&self.queries.set, 0..2 * count as u32, &self.queries.resolved, 0);
        }
    }
}
