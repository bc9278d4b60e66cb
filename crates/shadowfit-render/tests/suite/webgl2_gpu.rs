//! OpenGL ES 3.0, which corresponds to WebGL2, draws the same pictures as Vulkan. Run it with
//! `MESA_GL_VERSION_OVERRIDE=3.2 MESA_GLES_VERSION_OVERRIDE=3.0 cargo test -p shadowfit-render --features
//! gles webgl2`.

use glam::{DVec3, Vec3, Vec4};
use shadowfit::settings::{FilterKind, MapFormat};
use shadowfit::{DepthConvention, Technique};
use shadowfit_render::{Frame, Inset, Line, Overlay, PixelQuery, RenderTarget, TexelBlock};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::devices::{test_gpu, webgl2_gpu};
use super::pictures::{Pictures, SIZE, Stage, camera};
use super::sheets::sheets;

const EYE: DVec3 = DVec3::new(1.0, 4.0, 6.0);

/// Returns a technique with two maps, because software drivers take seconds to compile the look-up into more.
fn technique() -> Technique {
    Technique::default().with_count(2).with_resolution(1024, 1024)
}

/// Returns the sheets on Vulkan and on OpenGL.
fn both(technique: &Technique, samples: u32) -> [Stage; 2] {
    let vulkan = test_gpu(wgpu::Features::empty(), wgpu::Limits::default());
    [vulkan, webgl2_gpu()].map(|gpu| Stage::on(gpu, technique, samples, &sheets(), camera(EYE, DVec3::Y)))
}

fn assert_alike([a, b]: &[Vec<[u8; 3]>; 2], name: &str) {
    let differs = |(a, b): &(&[u8; 3], &[u8; 3])| a.iter().zip(b.iter()).any(|(a, b)| a.abs_diff(*b) > 3);
    let count = a.iter().zip(b).filter(differs).count();
    assert!(count < a.len() / 200, "{name}: {count} pixels differ");
    assert!(a.iter().any(|pixel| *pixel != a[0]), "{name}: nothing was drawn");
}

fn assert_drawn_alike(stages: &mut [Stage; 2], name: &str, change: impl Fn(&mut Frame<'_>)) {
    assert_alike(&stages.each_mut().map(|stage| stage.picture(&change)), name);
}

#[test]
fn every_view_is_drawn() {
    for samples in [1, 4] {
        let mut stages = both(&technique(), samples);
        for overlay in [Overlay::None].into_iter().chain(Overlay::ALL) {
            assert_drawn_alike(&mut stages, &format!("{overlay:?}"), |frame| frame.overlay = overlay);
        }
    }
}

#[test]
fn every_filter_is_drawn_and_every_format_that_the_adapter_can_draw_to() {
    let techniques = FilterKind::ALL.map(|filter| {
        let format = if filter == FilterKind::Pcss { MapFormat::Rgba8Packed } else { MapFormat::Depth32Float };
        technique().with_count(1).with_filter(filter).with_format(format)
    });
    let formats = [MapFormat::Depth16Unorm, MapFormat::R8Grey];
    let formats = formats.map(|format| technique().with_count(1).with_format(format));
    for technique in techniques.iter().chain(&formats) {
        assert_drawn_alike(&mut both(technique, 1), &format!("{:?} {:?}", technique.filter, technique.format), |_| ());
    }
}

static LINES: [Line; 1] =
    [Line { ends: [DVec3::ZERO, DVec3::new(2.0, 2.0, 0.0)], color: Vec4::new(1.0, 0.2, 0.0, 1.0) }];
static INSETS: [Inset; 2] = [inset(0), inset(1)];

const fn inset(map: u32) -> Inset {
    let left = 8.0 + 50.0 * map as f32;
    Inset { rectangle: [left, 8.0, 40.0, 40.0], depth_range: [0.0, 1.0], map, border: Vec3::X }
}

#[test]
fn maps_of_any_number_are_drawn() {
    // wgpu's OpenGL backend makes no array texture of one layer or of six, and two sets of three maps have
    // six.
    for (count, cross_fades) in [(1, false), (6, false), (3, true)] {
        let mut stages = both(&technique().with_count(count), 1);
        for Stage { pictures, .. } in &mut stages {
            let descriptor = ShadowMapDescriptor { cross_fades, ..*pictures.renderer.shadow_map().descriptor() };
            pictures.renderer.set_shadow_map(&pictures.gpu, &descriptor).expect("a shadow map");
        }
        assert_drawn_alike(&mut stages, &format!("{count} maps"), |_| ());
    }
}

#[test]
fn lines_insets_and_parts_are_drawn() {
    let mut stages = both(&technique(), 4);
    assert_drawn_alike(&mut stages, "lines", |frame| frame.lines = &LINES);
    assert_drawn_alike(&mut stages, "insets", |frame| frame.insets = &INSETS);
    assert_drawn_alike(&mut stages, "part", |frame| frame.scissor = Some([20, 10, 60, 50]));
}

#[test]
fn marks_stick_to_surfaces() {
    for (samples, step) in [(1, DVec3::ZERO), (1, DVec3::new(0.2, 0.1, 0.0)), (4, DVec3::ZERO)] {
        let drawn = both(&technique(), samples).map(|mut stage| stage.judged(Overlay::Error, step));
        assert_alike(&drawn, &format!("{samples} samples, {step}"));
    }
}

#[test]
fn probes_are_those_of_vulkan() {
    let [vulkan, opengl] = both(&technique(), 1).map(|mut stage| stage.probe());
    let seen = |probe: &shadowfit_render::Probe, pixel: usize| {
        probe.pixels[pixel].map(|pixel| (pixel.triangle, (pixel.factor * 50.0).round()))
    };
    let count = (0..vulkan.pixels.len()).filter(|pixel| seen(&vulkan, *pixel) != seen(&opengl, *pixel)).count();
    assert!(count < vulkan.pixels.len() / 200, "{count} pixels differ");
}

#[test]
fn a_pixel_has_the_facts_that_vulkan_finds_and_the_depths_around_a_texel() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        let mut technique = technique();
        technique.fit.depth = depth;
        let query = PixelQuery {
            size: SIZE,
            pixel: [70, 50],
            texels: Some(TexelBlock { map: 0, texel: [500, 500], radius: 31 }),
        };
        let [vulkan, opengl] = both(&technique, 1).map(|mut stage| {
            stage.picture(|_| ());
            stage.pixel(&query)
        });
        assert_eq!(vulkan.seen.map(|pixel| pixel.triangle), opengl.seen.map(|pixel| pixel.triangle));
        assert_eq!(vulkan.depths.len(), 63 * 63);
        let differs = |(a, b): &(&f32, &f32)| (**a - **b).abs() > 1e-5;
        let count = vulkan.depths.iter().zip(&opengl.depths).filter(differs).count();
        assert!(count < 40, "{depth:?}: {count} depths differ");
        assert!(vulkan.depths.iter().any(|depth| *depth != vulkan.depths[0]), "{depth:?}: nothing in the map");
    }
}

#[test]
fn maps_that_are_kept_are_mended_where_casters_move() {
    let mut stage = Stage::on(webgl2_gpu(), &technique(), 1, &sheets(), camera(EYE, DVec3::Y));
    let mut scene = sheets();
    let mut drawn = |scene: &shadowfit_scene::Scene, caching| {
        let Pictures { gpu, renderer, scene: gpu_scene, .. } = &mut stage.pictures;
        renderer.sun_mut().set_caching(caching);
        gpu_scene.set_pose(gpu, scene, &scene.pose(None, 0.0));
        stage.picture(|_| ())
    };
    let before = drawn(&scene, true);
    scene.nodes[1].morph_weights = vec![-1.0];
    scene.nodes[7].rest.translation.y += 0.8;
    let kept = drawn(&scene, true);
    let anew = drawn(&scene, false);
    assert_ne!(before, kept, "nothing moved");
    assert_alike(&[kept, anew], "kept");
}

#[test]
fn display_values_can_be_drawn_and_copied() {
    let gpu = webgl2_gpu();
    for samples in [1, 4] {
        let [below, above] = [(); 2].map(|()| RenderTarget::new(&gpu.device, SIZE, samples));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        drop(below.begin_encoded(&mut encoder, "below", [0.2, 0.4, 0.6]));
        drop(above.begin_encoded(&mut encoder, "above", [0.6, 0.4, 0.2]));
        gpu.submit([encoder.finish()]);
        below.copy_part(&gpu, &above, [80, 0, 80, 90]);
        let pixels = below.read(&gpu).expect("pixels");
        let row = &pixels.as_chunks::<4>().0[..SIZE[0] as usize];
        assert!(row[..80].iter().all(|pixel| *pixel == [51, 102, 153, 255]), "{:?}", row[0]);
        assert!(row[80..].iter().all(|pixel| *pixel == [153, 102, 51, 255]), "{:?}", row[80]);
    }
}
