//! How different a judged picture looks from the same picture with true shadows. It is measured once the view
//! rests, since both pictures are drawn once more.

use std::sync::{Arc, OnceLock};

use anyhow::Result;
use shadowfit::FittedMap;
use shadowfit_render::{Probe, ProbePixel, read_texture};
use shadowfit_study::{Evaluator, View, in_background};
use shadowfit_truth::Class;
use shadowfit_truth::gpu::GpuPixel;

use super::shot::Shot;

/// The ꟻLIP error of a judged picture, which a thread calculates.
#[derive(Clone, Debug, Default)]
pub(super) struct Flip(Arc<OnceLock<f32>>);

impl Flip {
    /// Draws the picture of a probe with the factors of its maps and with true ones, and starts to compare
    /// them; `waits` for the result.
    ///
    /// # Errors
    ///
    /// If the maps do not match the shadow map, the device was lost, or no thread can be started.
    pub(super) fn measure(
        evaluator: &mut Evaluator,
        shot: &mut Shot<'_>,
        (view, maps): (&View, &[FittedMap]),
        (probe, classes): (&Probe, &wgpu::Texture),
        waits: bool,
    ) -> Result<Self> {
        let bits = read_texture(shot.gpu, classes, probe.size, 4)?;
        let bits = bits.as_chunks::<4>().0.iter().map(|bits| u32::from_le_bytes(*bits));
        let factors = |(bits, seen): (u32, &Option<ProbePixel>)| factors(GpuPixel::from_bits(bits), seen.as_ref());
        let (mapped, truth): (Vec<f32>, Vec<f32>) = bits.zip(&probe.pixels).map(factors).unzip();
        evaluator.judging.size = probe.size;
        let pair = evaluator.picture_pair(shot.gpu, shot.scene, view, maps, [&mapped, &truth])?;
        let flip = Self::default();
        let slot = Arc::clone(&flip.0);
        let compare = move || {
            // Only this closure fills the slot.
            let _ = slot.set(pair.flip() as f32);
        };
        if waits {
            compare();
        } else {
            in_background("flip", compare)?;
        }
        Ok(flip)
    }

    /// Returns the mean error, 0 to 1. `None` if it is not known yet.
    pub(super) fn mean(&self) -> Option<f32> {
        self.0.get().copied()
    }
}

/// Returns the factors of a pixel by the maps and in truth. Pixels that are not judged are equal in both pictures.
fn factors(judged: GpuPixel, seen: Option<&ProbePixel>) -> (f32, f32) {
    match seen {
        Some(seen) if judged.class != Class::NotJudged => (seen.factor, f32::from(u8::from(judged.is_lit))),
        _ => (-1.0, -1.0),
    }
}
