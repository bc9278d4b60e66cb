//! How long the passes that judge a picture take on the GPU: from the beginning of the first one to the end of the last.

/// The two times, in ticks of the device.
pub(super) type Ticks = [u64; 2];

/// Takes the times, on devices that have timestamps.
#[derive(Debug)]
pub(super) struct Stopwatch {
    queries: wgpu::QuerySet,
    ticks: wgpu::Buffer,
}

impl Stopwatch {
    /// `None` on devices without timestamps.
    pub(super) fn new(device: &wgpu::Device) -> Option<Self> {
        if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("judging"),
            ty: wgpu::QueryType::Timestamp,
            count: 2,
        });
        let ticks = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("ticks of judging"),
            size: size_of::<Ticks>() as u64,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Some(Self { queries, ticks })
    }

    /// For the first pass.
    pub(super) fn begin(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        self.writes(Some(0), None)
    }

    /// For the last pass.
    pub(super) fn end(&self) -> wgpu::ComputePassTimestampWrites<'_> {
        self.writes(None, Some(1))
    }

    fn writes(&self, begin: Option<u32>, end: Option<u32>) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: begin,
            end_of_pass_write_index: end,
        }
    }

    /// The buffer of [`Ticks`], once what is recorded so far is done.
    pub(super) fn ticks(&self, encoder: &mut wgpu::CommandEncoder) -> &wgpu::Buffer {
        encoder.resolve_query_set(&self.queries, 0..2, &self.ticks, 0);
        &self.ticks
    }
}

/// Milliseconds between two times, with ticks of `period` nanoseconds; `None` where they were not taken.
pub(super) fn milliseconds([begin, end]: Ticks, period: f32) -> Option<f32> {
    let ticks = end.checked_sub(begin).filter(|ticks| *ticks > 0)?;
    Some((ticks as f64 * f64::from(period) * 1e-6) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_become_milliseconds_where_they_were_taken() {
        assert_eq!(milliseconds([500, 1_000_500], 2.0), Some(2.0));
        assert_eq!(milliseconds([0, 0], 2.0), None);
        assert_eq!(milliseconds([9, 7], 2.0), None);
    }
}
