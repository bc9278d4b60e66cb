//! Agreement between the CPU's and the GPU's judgement of the same pictures.

use shadowfit_truth::gpu::GpuPixel;
use shadowfit_truth::{Class, Judged};

/// Agreement between the classes of the GPU and of the CPU, over any number of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    judged: u64,
    same: u64,
    judged_off_edges: u64,
    same_off_edges: u64,
    same_edge_zone: u64,
}

impl Agreement {
    /// Adds a picture that both have judged.
    pub fn add(&mut self, judged: &Judged, pixels: &[GpuPixel]) {
        for (pixel, found) in pixels.iter().enumerate() {
            let class = judged.classes[pixel];
            if class == Class::NotJudged && found.class == Class::NotJudged {
                continue;
            }
            let same = u64::from(class == found.class);
            self.judged += 1;
            self.same += same;
            self.same_edge_zone += u64::from(judged.edge_zone[pixel] == found.is_in_edge_zone);
            if !judged.edge_zone[pixel] {
                self.judged_off_edges += 1;
                self.same_off_edges += same;
            }
        }
    }

    /// Returns the number of pixels that the CPU or the GPU judged.
    pub fn pixels(&self) -> u64 {
        self.judged
    }

    /// Returns the share of all judged pixels that have the same class, 0..=1; 1 without pixels.
    pub fn all(&self) -> f64 {
        share(self.same, self.judged)
    }

    /// Returns the share for pixels outside the CPU's edge zone.
    pub fn off_edges(&self) -> f64 {
        share(self.same_off_edges, self.judged_off_edges)
    }

    /// Returns the share of all judged pixels on whose edge zone both agree.
    pub fn edge_zone(&self) -> f64 {
        share(self.same_edge_zone, self.judged)
    }
}

fn share(same: u64, judged: u64) -> f64 {
    if judged == 0 { 1.0 } else { same as f64 / judged as f64 }
}
