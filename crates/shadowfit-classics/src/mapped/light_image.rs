//! Generated images that lamps project, which hide the square shape of the light's image.

use shadowfit_render::{Gpu, bindings};

use super::LightImage;

/// Width and height of a picture, in texels.
const SIZE: u32 = 256;
/// Radii at which the round beam's light ends and at which it starts to fall, as shares of the image's half
/// width.
const ROUND: [f32; 2] = [0.96, 0.72];
/// Distance of the two beams' centres from the middle to the left and right, and their half width and half
/// height, in the same unit.
const BEAM_AT: f32 = 0.30;
const BEAM: [f32; 2] = [0.60, 0.74];

impl LightImage {
    /// Returns the transmitted light at a position, -1..=1 from left to right and from bottom to top.
    fn light(self, x: f32, y: f32) -> f32 {
        let beam = |at: f32| {
            let distance = ((x - at) / BEAM[0]).hypot(y / BEAM[1]);
            falling(distance, 0.98, 0.62)
        };
        match self {
            Self::Square => 1.0,
            Self::Round => falling(x.hypot(y), ROUND[0], ROUND[1]),
            // Light adds up where the beams overlap, up to white.
            Self::Headlights => (beam(-BEAM_AT) + beam(BEAM_AT)).min(1.0),
        }
    }

    /// Returns the texels, rows from the top. The outermost are black unless the image is white everywhere,
    /// so that the image ends softly.
    fn texels(self) -> Vec<u8> {
        let at = |index: u32| (index as f32 + 0.5) / SIZE as f32 * 2.0 - 1.0;
        (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (self.light(at(x), -at(y)) * 255.0).round() as u8)).collect()
    }

    /// Creates and uploads the texture.
    pub(super) fn upload(self, gpu: &Gpu) -> wgpu::Texture {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let format = wgpu::TextureFormat::R8Unorm;
        let texture = bindings::plain_texture(&gpu.device, "light image", [SIZE; 2], format, usage);
        gpu.queue.write_texture(
            texture.as_image_copy(),
            &self.texels(),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE), rows_per_image: None },
            texture.size(),
        );
        texture
    }
}

/// Returns 0 from the distance `none` on, 1 up to the distance `full`, and smooth values between.
fn falling(distance: f32, none: f32, full: f32) -> f32 {
    let t = ((none - distance) / (none - full)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shaped_images_end_before_the_square_does_and_are_white_in_the_middle() {
        let border = |image: LightImage| {
            let texels = image.texels();
            let side = SIZE as usize;
            (0..side).all(|i| [i, (side - 1) * side + i, i * side, i * side + side - 1].iter().all(|&t| texels[t] == 0))
        };
        assert!(LightImage::Square.texels().iter().all(|texel| *texel == 255));
        for image in [LightImage::Round, LightImage::Headlights] {
            assert!(border(image), "{image:?}");
            assert_eq!(image.light(0.0, 0.0), 1.0, "{image:?}");
        }
        // Two beams: brighter to the sides than above the middle.
        assert!(LightImage::Headlights.light(0.3, 0.6) > LightImage::Headlights.light(0.0, 0.6));
    }
}
