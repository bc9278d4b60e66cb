//! Pictures of judged frames: as Bevy drew them, and with the wrong pixels marked.

use std::error::Error;
use std::path::Path;

use bevy::asset::RenderAssetUsages;
use bevy::image::Image;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use shadowfit_truth::Class;

use crate::measure::Picture;

/// Colour of wrong pixels, sRGB.
const WRONG: [u8; 3] = [255, 0, 0];
/// Brightness of the marked pictures, so that the marks stand out.
const DIMMED: f32 = 0.5;

/// Writes a picture as `<name>.png`, and with its wrong pixels marked red as `<name>, wrong.png`.
pub(crate) fn write(folder: &Path, name: &str, picture: &Picture) -> Result<(), Box<dyn Error>> {
    // As bright as the brightest surface without shadows would be.
    let brightest = picture.seen.unshadowed().iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    let grey = |red: &f32| srgb(red / brightest);
    let plain = picture.shadowed.iter().map(|red| [grey(red); 3]);
    save(folder, name, picture, plain)?;
    let marked = picture.shadowed.iter().zip(&picture.judged.classes).map(|(red, class)| match class {
        Class::NotJudged | Class::Right => [grey(&(red * DIMMED)); 3],
        Class::FalseShadow | Class::FalseLight | Class::Hole | Class::Edge => WRONG,
    });
    save(folder, &format!("{name}, wrong"), picture, marked)
}

fn save(
    folder: &Path,
    name: &str,
    picture: &Picture,
    pixels: impl Iterator<Item = [u8; 3]>,
) -> Result<(), Box<dyn Error>> {
    let [width, height] = picture.seen.truth.camera.size;
    let data: Vec<u8> = pixels.flat_map(|[red, green, blue]| [red, green, blue, 255]).collect();
    let size = Extent3d { width, height, depth_or_array_layers: 1 };
    let format = TextureFormat::Rgba8UnormSrgb;
    let image = Image::new(size, TextureDimension::D2, data, format, RenderAssetUsages::MAIN_WORLD);
    let file = folder.join(format!("{name}.png"));
    image.try_into_dynamic()?.save(&file).map_err(|error| format!("{}: {error}", file.display()).into())
}

/// The sRGB code of a linear brightness of 0..=1.
fn srgb(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let coded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (coded * 255.0).round() as u8
}
