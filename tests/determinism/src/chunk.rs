//! Any number of random fits in chunks, for comparing builds. `random_fits` runs millions of them.

use shadowfit::glam::UVec2;
use shadowfit::settings::{BiasSettings, MapFormat};
use shadowfit::spot::{SpotBias, SpotLight};
use shadowfit::{DepthConvention, FitError};

use crate::numbers::{self, ByKind, Numbers};
use crate::random::Random;
use crate::windows;

/// Number of fits of a chunk.
pub const FITS: u32 = 1000;

/// Number of these fits that are maps of lamps, in chunks without windows.
const LAMPS: u32 = 50;

/// The kind of a chunk's fits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Single maps, cascades and lamps.
    Cascades,
    /// Windows.
    Windows,
}

/// Returns the hash over the numbers of a chunk's fits, which depend only on the seed and the chunk's index.
///
/// # Errors
///
/// If a number is not finite.
pub fn run(kind: Kind, seed: u64, index: u64) -> Result<u64, String> {
    let mut numbers = ByKind::new();
    let mut random = Random::stream(seed, index);
    match kind {
        Kind::Cascades => {
            for _ in 0..LAMPS {
                // Refused input gives no number.
                let _ = lamp(&mut random, &mut numbers.single_map);
            }
            numbers::add(random, FITS - LAMPS, &mut numbers);
        }
        Kind::Windows => windows::add(random, FITS, |_| true, &mut numbers),
    }
    let all = [numbers.single_map, numbers.cascades, numbers.windows];
    if !all.into_iter().all(Numbers::are_finite) {
        return Err("a number is not finite".to_owned());
    }
    let mut chunk = Numbers::new();
    for numbers in all {
        chunk.bits(numbers.value());
    }
    Ok(chunk.value())
}

/// Combines the hashes of all chunks, in their order.
pub fn of_all(hashes: impl IntoIterator<Item = u64>) -> u64 {
    let mut all = Numbers::new();
    for hash in hashes {
        all.bits(hash);
    }
    all.value()
}

/// Adds a map of a lamp, and its biases.
fn lamp(random: &mut Random, numbers: &mut Numbers) -> Result<(), FitError> {
    let near = random.scale(-7, 0);
    let light = SpotLight {
        position: random.place(1e4),
        direction: random.vector() * random.scale(-2, 2),
        up: random.vector(),
        fov_y: random.between(0.01, 3.1),
        aspect: random.scale(-2, 1),
        near,
        far: near + random.scale(-2, 8),
    };
    let depth = random.pick(&[DepthConvention::ZeroToOne, DepthConvention::Reversed]);
    let fit = light.fit(random.pick(&[UVec2::splat(1024), UVec2::new(333, 64)]), depth)?;
    for matrix in [&fit.light_from_world, &fit.clip_from_light, &fit.clip_from_world, &fit.uv_from_world] {
        numbers.matrix(matrix);
    }
    let moved = fit.relative_to(fit.position + random.place(100.0));
    numbers.matrix(&moved.clip_from_world);
    let bias = SpotBias::from_texels(&BiasSettings::default(), MapFormat::Depth32Float, &fit);
    numbers.f32s(&[fit.texel_size.x, fit.texel_size.y, bias.constant_depth, bias.distance_depth, bias.slope_depth]);
    numbers.f32s(&[bias.normal_offset, bias.constant_offset, bias.receiver_plane]);
    Ok(())
}
