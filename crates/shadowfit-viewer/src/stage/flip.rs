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

/// Greatest width of the compared pictures, in pixels, so that frames do not stall. Larger ones are drawn at
/// 1/2, 1/3 and so on.
const WIDTH: u32 = 1280;

/// The ꟻLIP error of a judged picture, which a thread calculates.
#[derive(Clone, Debug, Default)]
pub(super) struct Flip(Arc<OnceLock<f32>>);

impl Flip {
    /// Draws the picture of a probe with mapped and with true factors, and starts to compare them; `waits` for the
    /// result.
    ///
    /// # Errors
    ///
    /// If the maps do not match the shadow map, the device was lost, or no thread can be started.
    pub(super) fn measure(
        &self,
        evaluator: &mut Evaluator,
        shot: &mut Shot<'_>,
        (view, maps): (&View, &[FittedMap]),
        (probe, classes): (&Probe, &wgpu::Texture),
        waits: bool,
    ) -> Result<()> {
        let bits = read_texture(shot.gpu, classes, probe.size, 4)?;
        let step = probe.size[0].div_ceil(WIDTH);
        let size = probe.size.map(|side| (side / step).max(1));
        let factors = |pixel: u32| {
            let [x, y] = [pixel % size[0], pixel / size[0]].map(|place| place * step + step / 2);
            let index = (y.min(probe.size[1] - 1) * probe.size[0] + x) as usize;
            factors(GpuPixel::from_bits(bits_of(&bits, index)), probe.pixels[index].as_ref())
        };
        let (mapped, truth): (Vec<f32>, Vec<f32>) = (0..size[0] * size[1]).map(factors).unzip();
        evaluator.judging.size = size;
        let pair = evaluator.picture_pair(shot.gpu, shot.scene, view, maps, [&mapped, &truth])?;
        let slot = Arc::clone(&self.0);
        let compare = move || {
            // Only this closure fills the slot.
            let _ = slot.set(pair.flip() as f32);
        };
        if waits {
            compare();
        } else {
            in_background("flip", compare)?;
        }
        Ok(())
    }

    /// Returns the mean error, 0 to 1. `None` if it is not known yet.
    pub(super) fn mean(&self) -> Option<f32> {
        self.0.get().copied()
    }

    /// Returns whether a thread is calculating it.
    pub(super) fn is_busy(&self) -> bool {
        Arc::strong_count(&self.0) > 1
    }
}

/// Returns the bits of a pixel in the bytes of a texture of classes.
fn bits_of(bytes: &[u8], pixel: usize) -> u32 {
    u32::from_le_bytes(bytes.as_chunks::<4>().0[pixel])
}

/// Returns the factors of a pixel by the maps and in truth. Pixels that are not judged are equal in both pictures.
fn factors(judged: GpuPixel, seen: Option<&ProbePixel>) -> (f32, f32) {
    match seen {
        Some(seen) if judged.class != Class::NotJudged => (seen.factor, f32::from(u8::from(judged.is_lit))),
        _ => (-1.0, -1.0),
    }
}
