//! The engine's own alpha test in the edge pass: its verdict on hits is used, and invalid input is refused.

use shadowfit::Technique;
use shadowfit::glam::{Affine3A, DVec3, Vec3};
use shadowfit_rays::{RayInstance, RayMesh};
use shadowfit_wgpu::exact_edges::{AnyHit, EdgeError, EdgeOutcome, EdgePass, FallbackReason};

use super::pass_gpu::{assert_filtered, look, points};
use super::stage::{Look, Stage, Thing, traced};

/// Height of a square over the ground, from -1 to 1 m along x and z.
const HEIGHT: f32 = 1.5;
/// Custom number of the square's instance.
const SQUARE: u32 = 7;

/// Accepts hits on the square only if they lie farther along x than a bound share.
const FARTHER: &str = "
@group(3) @binding(0) var<storage, read> engine_share: array<f32>;
fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool {
    let along = select(hit.weights.x, hit.weights.x + hit.weights.y, hit.triangle == 0u);
    return hit.custom != 7u || along > engine_share[0];
}
";

const ALL: &str = "fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool { return true; }";

/// Returns the part of the square beyond a share of its side along x.
fn square(share: f32) -> Vec<Vec3> {
    let x = share * 2.0 - 1.0;
    let [a, b, c, d] = [(x, -1.0), (1.0, -1.0), (1.0, 1.0), (x, 1.0)].map(|(x, z)| Vec3::new(x, HEIGHT, z));
    vec![a, b, c, a, c, d]
}

/// Returns maps with a part of the square, as if their passes had discarded the rest, and a pass with this
/// WGSL and a layout of `buffers` storage buffers.
fn stage(share: f32, wgsl: &str, buffers: Option<u32>) -> (Stage, Option<wgpu::BindGroupLayout>) {
    let ground = Thing::solid(Vec3::new(-10.0, -0.5, -10.0), Vec3::new(10.0, 0.0, 10.0));
    let part = Thing { corners: square(share), ..Thing::default() };
    // With wide texels, so that many pixels are unsure.
    let coarse = Technique::preset("stable-4").expect("a preset").with_resolution(256, 256).with_max_distance(60.0);
    let mut stage = Stage::new(&traced(coarse, 1), vec![ground, part]);
    let layout = buffers.map(|buffers| layout(&stage, buffers));
    let any_hit = AnyHit { wgsl: wgsl.to_owned(), layout: layout.clone() };
    stage.pass = EdgePass::with_any_hit(&stage.gpu.device, &stage.gpu.queue, any_hit).expect("valid WGSL");
    (stage, layout)
}

/// Places the whole square for the rays, above the ground.
fn place_square(stage: &mut Stage) {
    let [ground, whole] = [stage.things[0].corners.clone(), square(0.0)].map(|corners| {
        let mesh = RayMesh::from_triangles(corners.as_chunks::<3>().0.iter().copied()).expect("a mesh");
        RayInstance::new(stage.rays.add_mesh(&mesh).expect("room"), Affine3A::IDENTITY)
    });
    let instances = [ground, RayInstance { custom: SQUARE, ..whole }];
    stage.rays.set_instances(DVec3::ZERO, &instances).expect("room");
}

fn layout(stage: &Stage, buffers: u32) -> wgpu::BindGroupLayout {
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let entries: Vec<_> = (0..buffers).map(entry).collect();
    stage.gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

/// Creates a bind group of buffers with one share each.
fn group(stage: &Stage, layout: &wgpu::BindGroupLayout, shares: &[f32]) -> wgpu::BindGroup {
    let buffer = |share: &f32| stage.gpu.buffer(&[*share], wgpu::BufferUsages::STORAGE);
    let buffers: Vec<wgpu::Buffer> = shares.iter().map(buffer).collect();
    stage.gpu.group(layout, buffers.iter().map(wgpu::Buffer::as_entire_binding))
}

/// Returns how far a ground point is inside the shadow of a part of the square, in metres; negative outside.
fn inside(point: Vec3, share: f32, look: &Look) -> f32 {
    let met = point - look.direction * ((HEIGHT - point.y) / -look.direction.y);
    [met.x - (share * 2.0 - 1.0), 1.0 - met.x, met.z + 1.0, 1.0 - met.z].into_iter().fold(f32::MAX, f32::min)
}

#[test]
fn hits_count_where_the_engine_s_own_wgsl_says_so_by_what_it_binds() {
    let look = look();
    for share in [0.5, 0.25] {
        let (mut stage, layout) = stage(share, FARTHER, Some(1));
        let group = group(&stage, &layout.expect("a layout"), &[share]);
        let drawn = stage.draw(&look);
        place_square(&mut stage);
        let (factors, counts) = stage.traced(&look, &drawn, |view| view.any_hit = Some(&group));
        let mut found = [0; 2];
        for (factor, point) in factors.iter().zip(points(&stage, &look, &drawn)) {
            let Some([position, _]) = point.filter(|[position, _]| position.y.abs() < 0.01) else { continue };
            let inside = inside(position.truncate(), share, &look);
            // Farther from the border than the height at which rays start.
            if inside.abs() > 0.005 {
                let is_dark = inside > 0.0;
                assert_eq!(*factor < 0.5, is_dark, "{share}: {factor} at {position}");
                found[usize::from(is_dark)] += usize::from(factor.to_bits() & 1 == 1);
            }
        }
        println!("{share}: {found:?} traced pixels of the ground; {counts:?}");
        assert!(found.iter().all(|count| *count > 10), "{share}: {found:?} traced pixels of the ground");
    }
}

#[test]
fn an_own_test_that_binds_nothing_needs_no_group() {
    let look = look();
    let wgsl = "fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool { return hit.custom != 7u; }";
    let (mut stage, _) = stage(0.0, wgsl, None);
    let drawn = stage.draw(&look);
    let (before, _) = stage.traced(&look, &drawn, |_| ());
    place_square(&mut stage);
    let (after, _) = stage.traced(&look, &drawn, |_| ());
    let is_traced = |factor: f32| factor > 0.0 && factor.to_bits() & 1 == 1;
    let freed = before.iter().zip(&after).filter(|(before, after)| **before < 0.5 && **after > 0.5);
    assert!(freed.clone().all(|(before, after)| is_traced(*before) && is_traced(*after)));
    assert!(freed.count() > 20, "the square blocks rays that it must not");
}

#[test]
fn wgsl_that_is_not_valid_is_an_error_in_the_compiler_s_words_when_the_pass_is_made() {
    let (stage, _) = stage(0.0, ALL, None);
    let cases = [
        ("fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool { return engine_missing; }", "engine_missing"),
        ("fn engine_other() -> bool { return true; }", "shadowfit_rays_counts"),
        // A name that the pass uses.
        (&[ALL, "fn unit() {}"].concat(), "unit"),
    ];
    for (wgsl, word) in cases {
        let any_hit = AnyHit { wgsl: wgsl.to_owned(), layout: None };
        let error = EdgePass::with_any_hit(&stage.gpu.device, &stage.gpu.queue, any_hit).expect_err("not valid");
        assert!(matches!(error, EdgeError::AnyHit(_)) && error.to_string().contains(word), "{error}");
    }
}

#[test]
fn a_layout_that_does_not_suit_is_an_error_and_the_filter_decides() {
    let look = look();
    // Too few buffers for the WGSL, and more storage buffers than the device has in addition to the pass's.
    for (shares, word) in [(&[][..], "Binding is missing"), (&[0.5; 3], "Too many bindings")] {
        let (mut stage, layout) = stage(0.0, FARTHER, Some(shares.len() as u32));
        let drawn = stage.draw(&look);
        let group = group(&stage, &layout.expect("a layout"), shares);
        let error = stage.trace_edges(&look, &drawn, |view| view.any_hit = Some(&group)).expect_err("no pipeline");
        assert!(matches!(error, EdgeError::AnyHit(_)) && error.to_string().contains(word), "{error}");
        assert_filtered(&stage, FallbackReason::Picture);
    }
}

#[test]
fn a_group_without_a_layout_and_a_layout_without_a_group_are_errors() {
    let look = look();
    let (mut with, layout) = stage(0.0, FARTHER, Some(1));
    let group = group(&with, &layout.expect("a layout"), &[0.5]);
    let drawn = with.draw(&look);
    let missing = with.trace_edges(&look, &drawn, |_| ()).expect_err("no group");
    assert_eq!(missing, EdgeError::AnyHitGroup(true));
    assert!(missing.to_string().contains("set EdgeView::any_hit"), "{missing}");
    assert_filtered(&with, FallbackReason::Picture);
    assert_eq!(with.trace_edges(&look, &drawn, |view| view.any_hit = Some(&group)), Ok(EdgeOutcome::Traced));
    let (mut without, _) = stage(0.0, ALL, None);
    let layout = self::layout(&without, 1);
    let group = self::group(&without, &layout, &[0.5]);
    let drawn = without.draw(&look);
    let needless = without.trace_edges(&look, &drawn, |view| view.any_hit = Some(&group)).expect_err("no layout");
    assert_eq!(needless, EdgeError::AnyHitGroup(false));
    assert!(needless.to_string().contains("EdgePass::with_any_hit"), "{needless}");
    assert_filtered(&without, FallbackReason::Picture);
}
