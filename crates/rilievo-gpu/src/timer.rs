//! How long the GPU itself draws, where it can tell.

use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use crate::device::Gpu;
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Features, MapMode, QuerySet, QuerySetDescriptor, QueryType,
    RenderPassTimestampWrites,
};

/// Two timestamps of 64 bits.
const BYTES: u64 = 16;

const IDLE: u8 = 0;
const ASKED: u8 = 1;
const ANSWERED: u8 = 2;

/// Measures one pass at a time: frames that are drawn before the last answer came are not measured.
pub(crate) struct Timer {
    queries: QuerySet,
    resolved: Buffer,
    answer: Buffer,
    state: Arc<AtomicU8>,
    nanoseconds_per_tick: f32,
    last: Mutex<Option<Duration>>,
}

impl Timer {
    /// None if the device has no timestamps.
    pub(crate) fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |usage| {
            gpu.device.create_buffer(&BufferDescriptor { label: None, size: BYTES, usage, mapped_at_creation: false })
        };
        let about = QuerySetDescriptor { label: None, ty: QueryType::Timestamp, count: 2 };
        Some(Self {
            queries: gpu.device.create_query_set(&about),
            resolved: buffer(BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            answer: buffer(BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            state: Arc::default(),
            nanoseconds_per_tick: gpu.queue.get_timestamp_period(),
            last: Mutex::default(),
        })
    }

    /// What a pass writes, if it is to be measured.
    pub(crate) fn writes(&self) -> Option<RenderPassTimestampWrites<'_>> {
        (self.state.load(Ordering::Acquire) == IDLE).then_some(RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        })
    }

    /// After the pass, in the same encoder.
    pub(crate) fn resolve(&self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.answer, 0, BYTES);
    }

    /// After the encoder was submitted.
    pub(crate) fn ask(&self) {
        self.state.store(ASKED, Ordering::Release);
        let state = Arc::clone(&self.state);
        self.answer.slice(..).map_async(MapMode::Read, move |result| {
            state.store(if result.is_ok() { ANSWERED } else { IDLE }, Ordering::Release);
        });
    }

    /// The last time that was measured.
    pub(crate) fn last(&self) -> Option<Duration> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if self.state.load(Ordering::Acquire) == ANSWERED {
            if let Ok(bytes) = self.answer.slice(..).get_mapped_range() {
                let ticks = bytemuck::pod_collect_to_vec::<u8, u64>(&bytes);
                // Clocks of a GPU may start again.
                let elapsed = ticks[1].saturating_sub(ticks[0]) as f64 * f64::from(self.nanoseconds_per_tick);
                *last = Some(Duration::from_nanos(elapsed as u64));
            }
            self.answer.unmap();
            self.state.store(IDLE, Ordering::Release);
        }
        *last
    }
}
