//! Views whose edges cannot be traced: each is refused with its value, and the filter decides. Also tests
//! devices without compute shaders.

use shadowfit::glam::{DVec3, Mat4};
use shadowfit::{Boxes, DepthConvention};
use shadowfit_rays::RayScene;
use shadowfit_wgpu::demand::Unsupported;
use shadowfit_wgpu::exact_edges::{DepthBufferError, EdgeError, EdgeOutcome, EdgePass, EdgeView, FallbackReason};
use shadowfit_wgpu::{Casters, SunFrame, SunShadows};

use super::pass_gpu::{SIZE, assert_filtered, look, stage, technique};
use super::stage::{Drawn, Stage, traced};
use crate::engine::Engine;

const BOUND: wgpu::TextureUsages = wgpu::TextureUsages::TEXTURE_BINDING;
const DRAWN: wgpu::TextureUsages = wgpu::TextureUsages::RENDER_ATTACHMENT;

/// Asserts that a view is refused, and that the filter decides until the next valid view.
fn refused<'a>(stage: &mut Stage, drawn: &'a Drawn, edit: impl FnOnce(&mut EdgeView<'a>), words: &[&str]) -> EdgeError {
    let look = look();
    let good = stage.draw_surfaces(&look);
    assert_eq!(stage.trace_edges(&look, &good, |_| ()), Ok(EdgeOutcome::Traced));
    let error = stage.trace_edges(&look, drawn, edit).expect_err("it is refused");
    for word in words {
        assert!(error.to_string().contains(word), "{error}: {word}");
    }
    assert_filtered(stage, FallbackReason::Picture);
    assert_eq!(stage.trace_edges(&look, &good, |_| ()), Ok(EdgeOutcome::Traced), "after {error}");
    error
}

#[test]
fn textures_that_the_pass_cannot_read_are_refused_with_what_they_are() {
    let mut stage = stage();
    let good = stage.draw(&look());
    let textures = [
        (stage.gpu.texture(SIZE, 1, wgpu::TextureFormat::R32Float, BOUND), vec!["R32Float", "depth format"]),
        (
            stage.gpu.texture(SIZE, 1, wgpu::TextureFormat::Depth32Float, DRAWN),
            vec!["RENDER_ATTACHMENT", "TEXTURE_BINDING"],
        ),
    ];
    for (depth, words) in textures {
        let drawn = Drawn { depth, normals: None };
        let error = refused(&mut stage, &drawn, |view| view.normals = None, &words);
        let texture = drawn.depth.texture();
        let (format, usage) = (texture.format(), texture.usage());
        assert_eq!(error, DepthBufferError::Texture { format, samples: 1, usage, expected_samples: vec![1, 4] }.into());
    }
    let (float, whole) = (wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Rgba8Uint);
    let normals = [
        (stage.gpu.texture([SIZE[0], 64], 1, float, BOUND), vec!["160 × 64", "160 × 90"]),
        (stage.gpu.texture(SIZE, 1, whole, BOUND), vec!["Rgba8Uint", "float format"]),
        (stage.gpu.texture(SIZE, 4, float, BOUND | DRAWN), vec!["one sample"]),
        (stage.gpu.texture(SIZE, 1, float, DRAWN), vec!["TEXTURE_BINDING"]),
    ];
    for (normals, words) in normals {
        let edit = |view: &mut EdgeView<'_>| view.normals = None;
        let drawn = Drawn { depth: good.depth.clone(), normals: Some(normals) };
        let (format, size) = (texture_of(&drawn).format(), [texture_of(&drawn).width(), texture_of(&drawn).height()]);
        let error = refused(&mut stage, &drawn, |_| (), &words);
        assert_eq!(error, EdgeError::Normals { format, size, expected: SIZE });
        assert_eq!(stage.trace_edges(&look(), &drawn, edit), Ok(EdgeOutcome::Traced), "without them");
    }
}

fn texture_of(drawn: &Drawn) -> &wgpu::Texture {
    drawn.normals.as_ref().expect("normals").texture()
}

#[test]
fn rectangles_outside_the_texture_are_refused_with_both_sizes() {
    let mut stage = stage();
    let drawn = stage.draw(&look());
    let [width, height] = SIZE;
    for rectangle @ [x, y, across, down] in [
        [1, 0, width, height],
        [0, 0, width, height + 1],
        [0, 0, 0, height],
        [0, 3, width, 0],
        [u32::MAX, 0, 2, 2],
        [5, 6, u32::MAX, 7],
    ] {
        let words = [format!("{across} × {down}"), format!("({x}, {y})"), "160 × 90".to_owned()];
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let error = refused(&mut stage, &drawn, |view| view.rectangle = Some(rectangle), &words);
        assert_eq!(error, DepthBufferError::Rectangle { rectangle, texture: SIZE }.into());
    }
}

#[test]
fn views_that_make_no_sense_are_refused_with_their_values() {
    let mut stage = stage();
    let drawn = stage.draw(&look());
    for matrix in [Mat4::ZERO, Mat4::NAN, Mat4::from_diagonal(shadowfit::glam::Vec4::new(1.0, 1.0, 0.0, 1.0))] {
        let error = refused(&mut stage, &drawn, |view| view.clip_from_eye = matrix, &["no finite inverse"]);
        assert_eq!(error, EdgeError::DepthBuffer(DepthBufferError::SingularMatrix));
    }
    let (plain, reversed) = (DepthConvention::ZeroToOne, DepthConvention::Reversed);
    let error = refused(&mut stage, &drawn, |view| view.convention = plain, &["ZeroToOne", "drawn with"]);
    assert_eq!(error, EdgeError::DepthBuffer(DepthBufferError::OtherDepth(plain)));
    let other = look().camera.clip_from_world(plain);
    let error = refused(&mut stage, &drawn, |view| view.clip_from_eye = other, &["Reversed", "drawn with"]);
    assert_eq!(error, EdgeError::DepthBuffer(DepthBufferError::OtherDepth(reversed)));
    let opengl = DepthConvention::NegativeOneToOne;
    let error = refused(&mut stage, &drawn, |view| view.convention = opengl, &["NegativeOneToOne", "0..1"]);
    assert_eq!(error, EdgeError::DepthBuffer(DepthBufferError::Depth(opengl)));
    for (offset, word) in [(-0.5, "-0.5"), (f32::NAN, "NaN"), (f32::INFINITY, "inf")] {
        let error = refused(&mut stage, &drawn, |view| view.ray_offset = offset, &[word, "not negative"]);
        assert!(matches!(error, EdgeError::RayOffset(found) if found.to_bits() == offset.to_bits()));
    }
    for (eye, word) in [(DVec3::NAN, "NaN"), (DVec3::new(0.0, f64::INFINITY, 2.0), "inf")] {
        let error = refused(&mut stage, &drawn, |view| view.eye = eye, &[word, "finite world position"]);
        assert!(matches!(error, EdgeError::Eye(_)));
    }
}

#[test]
fn devices_that_lack_something_filter_edges_and_say_what_without_an_error() {
    let webgl2 = wgpu::Limits::downlevel_webgl2_defaults();
    // The number that rays need, without one for the list of pixels.
    let few = wgpu::Limits { max_storage_buffers_per_shader_stage: 5, ..wgpu::Limits::default() };
    for (limits, lack, traces) in [(webgl2, Unsupported::Compute, false), (few, Unsupported::StorageBuffers, true)] {
        let engine = Engine::open(limits);
        // A device that computes may lack loads from depth textures, which is reported first.
        if lack != Unsupported::Compute {
            engine.require_depth_loads();
        }
        let (device, queue) = (&engine.device, &engine.queue);
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let mut sun = SunShadows::new(device, queue, &traced(technique(), 1).into()).expect("maps");
        let rays = RayScene::new(device, queue).ok();
        assert_eq!(rays.is_some(), traces, "{lack:?}");
        let mut pass = EdgePass::new(device, queue).expect("the resources for filtered edges");
        let look = look();
        let views = [look.camera.frustum().expect("a camera")];
        let nothing = Boxes { origin: DVec3::ZERO, boxes: &[] };
        let frame = SunFrame::new(&views, look.direction, nothing, Casters::fixed(nothing));
        sun.update(queue, &frame).expect("a good frame");
        let depth = engine.texture([16; 2], 1, wgpu::TextureFormat::Depth32Float, BOUND | DRAWN);
        let clip_from_eye = look.camera.clip_from_world(look.convention);
        let view = EdgeView::new(&depth, clip_from_eye, look.convention, look.camera.eye);
        let mut encoder = engine.encoder();
        let found = pass.record(&mut encoder, &sun, rays.as_ref(), &view);
        let why = FallbackReason::Device(lack);
        assert_eq!((found, pass.result()), (Ok(EdgeOutcome::Filtered(why)), EdgeOutcome::Filtered(why)));
        assert_eq!((pass.unsupported(), pass.factors().texture().width(), pass.take_counts()), (Some(lack), 1, None));
        engine.submit(encoder);
        let error = pollster::block_on(scope.pop());
        assert!(error.is_none(), "{error:?}");
    }
}
