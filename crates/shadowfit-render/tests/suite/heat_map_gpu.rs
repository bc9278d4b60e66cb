//! The overlays of pixels per texel and of texels, compared with the core's diagnostics, on a plane and on
//! the built-in scene.

use glam::{UVec2, Vec3};
use shadowfit::settings::FilterKind;
use shadowfit::{DepthConvention, Technique, diagnostics};
use shadowfit_params::figures::pixels_per_texel_color;
use shadowfit_render::{Frame, Overlay};
use shadowfit_scene::Scene;
use shadowfit_testing::subpixel_step;

use super::pictures::{Pictures, SIZE, Seen, Stage, encoded, linear};

/// Levels by which a colour may differ: rounding of the picture, and a step of the scale.
const LEVELS: f32 = 1.5;

/// Relative difference that is allowed for pixels per texel.
const SHARE: f32 = 0.02;

/// Returns a preset with at most two maps and the cheapest filter, which these overlays do not depend on.
fn technique(preset: &str) -> Technique {
    let technique = Technique::preset(preset).expect("a preset").with_filter(FilterKind::Point);
    if technique.maps.count() > 2 { technique.with_count(2) } else { technique }
}

/// Returns the difference of a colour from an expected one that may be darkened by one factor in all
/// channels, in levels.
fn difference(color: [u8; 3], expected: [u8; 3]) -> f32 {
    let [color_light, light] = [color, expected].map(|color| Vec3::from(color.map(linear)));
    let factor = color_light.dot(light) / light.length_squared();
    let darkened = (light * factor).to_array().map(encoded);
    (0..3).map(|i| (darkened[i] - f32::from(color[i])).abs()).fold(0.0, f32::max)
}

/// Returns the core's pixels per texel at each pixel; `None` without a surface or a map.
fn expected(pictures: &mut Pictures, seen: &Seen) -> Vec<Option<f32>> {
    let probe = pictures.probe(&seen.frame());
    let camera = &seen.camera;
    let clip = camera.clip_from_world(DepthConvention::Reversed);
    let at = |(pixel, probed): (usize, &Option<shadowfit_render::ProbePixel>)| {
        let triangle = (*probed)?.triangle;
        let (point, normal) = (pictures.point(camera, pixel, triangle), pictures.normal(triangle));
        let depth = point.dot(camera.forward.as_dvec3());
        let read = seen.fitted.read(&seen.technique, camera.eye + point, depth)?;
        let fit = seen.fitted[read.main()].projection.relative_to(camera.eye);
        let figures = diagnostics::pixels_per_texel(&fit, &clip, UVec2::from(SIZE), point.as_vec3(), normal.as_vec3());
        Some(figures.expect("finite")?.worse_axis)
    };
    probe.pixels.iter().enumerate().map(at).collect()
}

/// Numbers of pixels of a picture.
#[derive(Debug)]
struct Counts {
    same: usize,
    different: usize,
    /// Number of different pixels that are allowed: a border between two maps passes their middles within
    /// half a step of the adapter's corners, so that the picture may read the other map.
    allowed: usize,
}

/// Compares the colours of pixels with their figures.
fn compare(technique: &Technique, scene: Option<Scene>) -> Counts {
    let scene = scene.unwrap_or_else(shadowfit_scene::builtin::default_scene);
    let Stage { mut pictures, seen } = Stage::of(technique, 1, &scene);
    let expected = expected(&mut pictures, &seen);
    let drawn = pictures.picture(&Frame { overlay: Overlay::PixelsPerTexel, ..seen.frame() });
    let step = subpixel_step(&pictures.gpu.adapter.get_info());
    let (mut same, mut different) = (0, 0);
    for (pixel, color) in drawn.into_iter().enumerate() {
        let Some(figure) = expected[pixel] else { continue };
        // The corners of the surface may lie up to a step from their exact positions, and its points too.
        let slope = slope(&expected, pixel).unwrap_or(0.0);
        let allowed = SHARE * figure + step * slope;
        // Colours change in bands, so the colours of the two ends alone may both differ.
        let nearby = (-4_i8..=4).map(|part| figure + allowed * f32::from(part) / 4.0);
        let least = nearby.map(|figure| difference(color, pixels_per_texel_color(figure))).fold(f32::MAX, f32::min);
        *(if least > LEVELS { &mut different } else { &mut same }) += 1;
    }
    let borders = (0..expected.len()).filter(|pixel| is_above_a_border(&expected, *pixel)).count();
    Counts { same, different, allowed: (borders as f32 * step) as usize }
}

/// Returns whether the pixel below reads another map. Its figure is then more than twice or less than half as
/// large, which never happens within one map.
fn is_above_a_border(expected: &[Option<f32>], pixel: usize) -> bool {
    let below = expected.get(pixel + SIZE[0] as usize).copied().flatten();
    expected[pixel].zip(below).is_some_and(|(above, below)| above.min(below) < 0.5 * above.max(below))
}

/// Returns the change of the figure to the pixels above and below, per pixel.
fn slope(expected: &[Option<f32>], pixel: usize) -> Option<f32> {
    let width = SIZE[0] as usize;
    let beside = [pixel.checked_sub(width), Some(pixel + width)];
    let change = |other: usize| Some((expected.get(other).copied()?? - expected[pixel]?).abs());
    beside.into_iter().flatten().filter_map(change).reduce(f32::max)
}

fn floor() -> Scene {
    let corner = |x: f32, z: f32| Vec3::new(x * 60.0, 0.0, z * 60.0);
    let floor = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    Scene::from_objects("floor", &[vec![[floor[0], floor[1], floor[2]], [floor[0], floor[2], floor[3]]]])
}

#[test]
fn pixels_per_texel_of_a_plane_are_those_of_the_diagnostics() {
    let technique = technique("stable-4").with_resolution(512, 512);
    let counts = compare(&technique, Some(floor()));
    assert!(counts.same > 3000 && counts.different <= counts.allowed, "{counts:?}");
}

#[test]
fn pixels_per_texel_of_the_scene_are_those_of_the_diagnostics() {
    for name in ["windows-4", "stable-4", "focused-1"] {
        let technique = technique(name).with_resolution(512, 512);
        let Counts { same, different, .. } = compare(&technique, None);
        println!("{name}: {same} and {different}");
        // Points on the border between two maps may go either way, and normals of slivers are rounded.
        assert!(same > 8000 && different * 200 < same, "{name}: {same} and {different}");
    }
}

/// Returns the greatest difference of each pixel from the next one in its row, in levels.
fn steps(picture: &[[u8; 3]], rows: core::ops::Range<usize>) -> Vec<u8> {
    let width = SIZE[0] as usize;
    let in_rows = (rows.start * width..rows.end * width - 1).filter(|pixel| pixel % width != width - 1);
    let step = |pixel: usize| (0..3).map(|i| picture[pixel][i].abs_diff(picture[pixel + 1][i])).max().unwrap_or(0);
    in_rows.map(step).collect()
}

#[test]
fn texels_show_where_they_are_wide_and_blocks_of_them_where_they_are_not() {
    for (resolution, distance) in [(256, 120.0), (1024, 20.0)] {
        let technique = technique("focused-1").with_max_distance(distance);
        let Stage { mut pictures, seen } = Stage::of(&technique.with_resolution(resolution, resolution), 1, &floor());
        let drawn = pictures.picture(&Frame { overlay: Overlay::TexelGrid, ..seen.frame() });
        // The lowest rows show the floor near the eye.
        let steps = steps(&drawn, 70..90);
        let large = steps.iter().filter(|step| **step > 12).count();
        println!("{resolution}: {large} of {}", steps.len());
        assert!(large * 20 > steps.len(), "{resolution}: there is no grid, {large} of {}", steps.len());
        // The narrowest cells are six pixels wide, with at most two steps and a line of two more steps.
        assert!(large * 3 < steps.len() * 2, "{resolution}: the grid is finer than pixels, {large} of {}", steps.len());
    }
}
