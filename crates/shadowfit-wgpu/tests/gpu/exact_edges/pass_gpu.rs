//! Properties of the edge pass apart from its verdicts: budgets, pixels that the filter decides, and maps
//! that wait.

use shadowfit::glam::{DMat4, DVec3, Vec3, Vec4};
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Aabb, Boxes, DepthConvention, PerspectiveCamera, Technique};
use shadowfit_wgpu::exact_edges::{EdgeCounts, EdgeOutcome, FallbackReason, NormalEncoding};
use shadowfit_wgpu::{LightSteps, UpdateSchedule};

use super::stage::{Drawn, Look, Stage, Thing, traced};

pub(super) const SIZE: [u32; 2] = [160, 90];
const PIXELS: usize = (SIZE[0] * SIZE[1]) as usize;

/// Returns a ground, a block over its centre, and a post at its side.
fn things() -> Vec<Thing> {
    let solid = |min: [f32; 3], max: [f32; 3]| Thing::solid(min.into(), max.into());
    vec![
        solid([-10.0, -0.5, -10.0], [10.0, 0.0, 10.0]),
        solid([-0.75, 1.5, -0.75], [0.75, 2.5, 0.75]),
        solid([-4.0, 0.0, -2.0], [-3.5, 2.0, -1.5]),
    ]
}

pub(super) fn technique() -> Technique {
    Technique::default().with_resolution(256, 256).with_max_distance(40.0)
}

/// Returns a stage with many posts and wide texels, so that many pixels are unsure.
fn coarse_stage() -> Stage {
    let coarse = Technique::preset("stable-4").expect("a preset").with_resolution(256, 256).with_max_distance(60.0);
    let mut things = things();
    let posts = (0..20_u16).flat_map(|x| (0..20_u16).map(move |z| Vec3::new(f32::from(x), 0.0, f32::from(z)) - 9.5));
    things.extend(posts.map(|at| Thing::solid(at.with_y(0.0), at.with_y(0.4) + Vec3::new(0.3, 0.0, 0.3))));
    Stage::new(&traced(coarse, 1), things)
}

pub(super) fn stage() -> Stage {
    Stage::new(&traced(technique(), 1), things())
}

pub(super) fn look() -> Look {
    let eye = DVec3::new(0.0, 6.0, 9.0);
    let camera = PerspectiveCamera {
        eye,
        forward: (-eye).as_vec3().normalize(),
        up: Vec3::Y,
        fov_y: 1.0,
        aspect: Look::aspect(SIZE),
        near: 0.1,
        far: 60.0,
    };
    let direction = Vec3::new(0.5, -1.0, 0.2).normalize();
    Look {
        camera,
        direction,
        size: SIZE,
        samples: 1,
        convention: DepthConvention::Reversed,
        format: wgpu::TextureFormat::Depth32Float,
        normals: Some(NormalEncoding::Signed),
        number: 0,
    }
}

/// Returns the visible point of each pixel: its position in world space and its normal, or `None` for the
/// sky.
pub(super) fn points(stage: &Stage, look: &Look, drawn: &Drawn) -> Vec<Option<[Vec4; 2]>> {
    let depths = stage.depths(&drawn.depth);
    let normals: Vec<[f32; 4]> = drawn
        .normals
        .as_ref()
        .map_or_else(|| vec![[0.0, 1.0, 0.0, 0.0]; PIXELS], |view| stage.gpu.texels(view.texture()));
    let world: DMat4 = look.camera.clip_from_world(look.convention).as_dmat4().inverse();
    let point = |index: usize| {
        let [x, y] = [index % SIZE[0] as usize, index / SIZE[0] as usize].map(|place| place as f64 + 0.5);
        let [u, v] = [x / f64::from(SIZE[0]) * 2.0 - 1.0, 1.0 - y / f64::from(SIZE[1]) * 2.0];
        let position = world.project_point3(DVec3::new(u, v, f64::from(depths[index]))) + look.camera.eye;
        let normal = Vec4::from(normals[index]).truncate();
        let toward_eye = (look.camera.eye - position).as_vec3();
        let normal = if normal.dot(toward_eye) < 0.0 { -normal } else { normal };
        (depths[index] != look.convention.far()).then(|| [position.as_vec3().extend(1.0), normal.extend(0.0)])
    };
    (0..PIXELS).map(point).collect()
}

/// Returns points for the look-up, with an arbitrary point for the sky.
fn asked(points: &[Option<[Vec4; 2]>]) -> Vec<[Vec4; 2]> {
    points.iter().map(|point| point.unwrap_or([Vec4::W, Vec4::Y])).collect()
}

fn bits(factors: &[f32]) -> Vec<u32> {
    factors.iter().map(|factor| factor.to_bits()).collect()
}

/// Returns the number of pixels whose factors differ by more than the bit of traced pixels.
fn different(a: &[f32], b: &[f32]) -> usize {
    a.iter().zip(b).filter(|(a, b)| (*a - *b).abs() > 1e-6).count()
}

/// Returns the number of pixels with a surface that the filter decides.
fn filtered(factors: &[f32], points: &[Option<[Vec4; 2]>]) -> usize {
    factors.iter().zip(points).filter(|(factor, point)| **factor < 0.0 && point.is_some()).count()
}

#[test]
fn a_budget_traces_as_many_pixels_as_it_has_and_leaves_the_others_to_the_filter() {
    let (mut stage, look) = (coarse_stage(), look());
    let drawn = stage.draw(&look);
    let points = points(&stage, &look, &drawn);
    let (all, counts) = stage.traced(&look, &drawn, |_| ());
    assert!(counts.unsure > 500 && counts.traced == counts.unsure && counts.filtered == 0, "{counts:?}");
    assert_eq!(filtered(&all, &points), 0);
    for budget in [0, 1, counts.unsure / 4, counts.unsure / 2, counts.unsure, u32::MAX] {
        let (some, found) = stage.traced(&look, &drawn, |view| view.budget = Some(budget));
        let EdgeCounts { facing, unsure, traced, filtered: left } = found;
        assert_eq!([facing, unsure, traced + left], [counts.facing, counts.unsure, counts.unsure], "{budget}");
        assert_eq!(filtered(&some, &points), left as usize, "{budget}");
        // Traced pixels have the same factor as without a budget.
        assert!(some.iter().zip(&all).all(|(some, all)| *some == -1.0 || some.to_bits() == all.to_bits()), "{budget}");
        let share = f64::from(traced) / f64::from(budget.clamp(1, counts.unsure));
        let is_right = match budget {
            0 => traced == 0,
            1 => traced < 20,
            _ if budget >= counts.unsure => traced == counts.unsure,
            _ => (share - 1.0).abs() < 0.3,
        };
        assert!(is_right, "{traced} of {} pixels with a budget of {budget}", counts.unsure);
    }
}

#[test]
fn the_same_frame_traces_the_same_pixels_and_frames_take_turns_within_the_budget() {
    let mut stage = coarse_stage();
    let budget = 150;
    let mut selections: Vec<Vec<u32>> = Vec::new();
    let (mut traced, mut turns) = (0, vec![0_u32; PIXELS]);
    let mut unsure = Vec::new();
    for number in 0..24 {
        let look = Look { number, ..look() };
        let drawn = stage.draw(&look);
        let (first, counts) = stage.traced(&look, &drawn, |view| view.budget = Some(budget));
        if number % 8 == 0 {
            let (second, again) = stage.traced(&look, &drawn, |view| view.budget = Some(budget));
            assert_eq!((bits(&first), counts), (bits(&second), again), "frame {number}");
            let (all, _) = stage.traced(&look, &drawn, |_| ());
            let (none, _) = stage.traced(&look, &drawn, |view| view.budget = Some(0));
            unsure = all.iter().zip(&none).map(|(all, none)| all != none).collect();
        }
        first.iter().zip(&mut turns).for_each(|(factor, turns)| *turns += u32::from(*factor >= 0.0));
        traced += counts.traced;
        assert!(!selections.contains(&bits(&first)), "frame {number} traces the pixels of another one");
        selections.push(bits(&first));
    }
    let mean = f64::from(traced) / 24.0;
    assert!((mean / f64::from(budget) - 1.0).abs() < 0.1, "{mean} pixels a frame");
    // The golden ratio selects every pixel within some frames.
    let waits = unsure.iter().zip(&turns).filter(|(unsure, turns)| **unsure && **turns == 0).count();
    let all = unsure.iter().filter(|unsure| **unsure).count();
    assert!(waits * 20 < all, "{waits} of {all} pixels were never traced");
}

#[test]
fn pixels_whose_samples_show_several_surfaces_are_left_to_the_filter_and_no_others() {
    let mut stage = stage();
    for normals in [None, Some(NormalEncoding::Signed)] {
        let look = Look { samples: 4, normals, ..look() };
        let drawn = stage.draw(&look);
        let depths = stage.depths(&drawn.depth);
        let (factors, counts) = stage.traced(&look, &drawn, |_| ());
        let samples = |pixel: usize| [0, 1, 2, 3].map(|sample: usize| depths[sample * PIXELS + pixel]);
        let mut several = 0;
        for (pixel, factor) in factors.iter().enumerate() {
            let [first, rest @ ..] = samples(pixel);
            let farthest = rest.iter().map(|depth| (depth / first - 1.0).abs()).fold(0.0, f32::max);
            // Farther apart than on a plane that is viewed at 3°, and nearer than on any plane.
            let (is_several, is_one) = (farthest > 0.5, farthest < 1e-6);
            if first == 0.0 || is_several {
                assert!(*factor == -1.0 || first != 0.0 && *factor == 0.0 && !is_several, "{pixel}: {factor}");
                several += usize::from(first != 0.0);
            }
            assert!(*factor >= 0.0 || !is_one || first == 0.0, "{pixel}: {:?}", samples(pixel));
        }
        assert!(several > 20 && counts.filtered as usize >= several, "{several}, {counts:?}");
        assert!(counts.filtered * 5 < counts.facing, "{counts:?}");
    }
}

#[test]
fn normals_that_are_zero_follow_from_the_depths_as_if_there_were_no_texture() {
    let mut stage = stage();
    let look = Look { normals: None, ..look() };
    let drawn = stage.draw(&look);
    let (plain, _) = stage.traced(&look, &drawn, |_| ());
    let usage = wgpu::TextureUsages::TEXTURE_BINDING;
    let zeros = stage.gpu.texture(SIZE, 1, wgpu::TextureFormat::Rgba8Unorm, usage);
    for encoding in [NormalEncoding::Signed, NormalEncoding::Unsigned] {
        let (found, _) = stage.traced(&look, &drawn, |view| *view = view.with_normals(&zeros, encoding));
        assert_eq!(bits(&found), bits(&plain), "{encoding:?}");
    }
}

#[test]
fn an_engine_reads_exact_factors_and_the_filter_elsewhere_bit_for_bit() {
    let (mut stage, look) = (stage(), Look { samples: 4, ..look() });
    let drawn = stage.draw(&look);
    let points = points(&stage, &Look { samples: 1, ..look }, &drawn);
    let (factors, _) = stage.traced(&look, &drawn, |view| view.budget = Some(300));
    let read = stage.read(&asked(&points), SIZE[0]);
    for (pixel, ([filter, exact], factor)) in read.iter().zip(&factors).enumerate() {
        let wanted = if *factor >= 0.0 { factor } else { filter };
        assert_eq!(exact.to_bits(), wanted.to_bits(), "pixel {pixel}: {factor}");
    }
    assert!(read.iter().filter(|[filter, exact]| filter != exact).count() > 100, "all factors come from the filter");
}

/// Asserts that edges are filtered for this reason, and that engines read the filter's factors.
pub(super) fn assert_filtered(stage: &Stage, why: FallbackReason) {
    assert_eq!(stage.pass.result(), EdgeOutcome::Filtered(why));
    let factors = stage.pass.factors().texture();
    assert_eq!([factors.width(), factors.height()], [1, 1], "{why:?}: the texture has the view's size");
    let at = |index: usize| Vec3::new((index % 64) as f32 * 0.25 - 8.0, 0.0, (index / 64) as f32 * 0.25 - 8.0);
    let points: Vec<[Vec4; 2]> = (0..64 * 64).map(|index| [at(index).extend(1.0), Vec4::Y]).collect();
    for [filter, exact] in stage.read(&points, 64) {
        assert_eq!(filter.to_bits(), exact.to_bits(), "{why:?}");
    }
}

#[test]
fn edges_are_filtered_before_the_first_picture_and_after_one_that_is_left_out() {
    let (mut stage, look) = (stage(), look());
    assert_filtered(&stage, FallbackReason::Picture);
    assert_eq!(stage.pass.take_counts(), None);
    let drawn = stage.draw(&look);
    assert_eq!(stage.trace_edges(&look, &drawn, |_| ()), Ok(EdgeOutcome::Traced));
    stage.pass.skip();
    assert_filtered(&stage, FallbackReason::Picture);
}

#[test]
fn a_technique_with_filtered_edges_records_nothing_and_makes_no_texture() {
    let (mut stage, look) = (Stage::new(&technique(), things()), look());
    let drawn = stage.draw(&look);
    let found = stage.trace_edges(&look, &drawn, |_| ());
    assert_eq!(found, Ok(EdgeOutcome::Filtered(FallbackReason::Technique)));
    assert_filtered(&stage, FallbackReason::Technique);
    stage.gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device works");
    assert_eq!(stage.pass.take_counts(), None);
}

#[test]
fn edges_are_filtered_without_rays_and_without_maps_with_the_reason() {
    let (mut stage, look) = (stage(), look());
    let drawn = stage.draw_surfaces(&look);
    let no_maps = Ok(EdgeOutcome::Filtered(FallbackReason::NoMaps));
    assert_eq!(stage.trace_edges(&look, &drawn, |_| ()), no_maps, "before the first frame");
    stage.draw(&look);
    assert_eq!(stage.trace_edges(&look, &drawn, |_| ()), Ok(EdgeOutcome::Traced));
    stage.sun.turn_off(&stage.gpu.queue);
    assert_eq!(stage.trace_edges(&look, &drawn, |_| ()), no_maps, "while the sun is off");
    assert_filtered(&stage, FallbackReason::NoMaps);
    stage.draw(&look);
    let view = shadowfit_wgpu::exact_edges::EdgeView::new(
        &drawn.depth,
        look.camera.clip_from_world(look.convention),
        look.convention,
        look.camera.eye,
    );
    let mut encoder = stage.gpu.encoder();
    let found = stage.pass.record(&mut encoder, &stage.sun, None, &view);
    assert_eq!(found, Ok(EdgeOutcome::Filtered(FallbackReason::Rays)));
    assert_filtered(&stage, FallbackReason::Rays);
}

#[test]
fn edges_are_filtered_while_light_steps_fade_and_right_before_and_after() {
    let mut stage = stage();
    stage.sun.set_light_steps(Some(LightSteps { texels: 1.0, fade: 3 })).expect("steps");
    let mut found = Vec::new();
    let mut compared = 0;
    for number in 0..30_u16 {
        let angle = f32::from(number) * 0.002;
        let direction = (Vec3::new(0.5, -1.0, 0.2) + Vec3::X * angle).normalize();
        let look = Look { direction, ..look() };
        let drawn = stage.draw(&look);
        let result = stage.trace_edges(&look, &drawn, |_| ()).expect("a good view");
        found.push(result);
        let held = stage.sun.maps()[0].projection.direction;
        if result == EdgeOutcome::Traced && number % 5 == 4 {
            let factors = stage.factors();
            let mut new = self::stage();
            let look = Look { direction: held, ..look };
            let drawn = new.draw(&look);
            let (expected, _) = new.traced(&look, &drawn, |_| ());
            // Both are exact. Where an edge crosses a pixel's centre, rounding decides.
            assert!(different(&factors, &expected) <= 5, "frame {number}: {}", different(&factors, &expected));
            compared += 1;
        }
    }
    assert!(found.contains(&EdgeOutcome::Filtered(FallbackReason::Fading)) && compared > 0, "{found:?}");
    assert_eq!(found[0], EdgeOutcome::Traced);
}

/// Returns whether a ray from a point toward the light intersects a box.
fn is_under(point: Vec3, look: &Look, aabb: &Aabb, around: f32) -> bool {
    let inverse = 1.0 / -look.direction.as_dvec3();
    let [least, most] = [aabb.min - around, aabb.max + around].map(Vec3::as_dvec3);
    let (a, b) = ((least - point.as_dvec3()) * inverse, (most - point.as_dvec3()) * inverse);
    a.max(b).min_element() >= a.min(b).max_element().max(0.0)
}

#[test]
fn what_the_rays_lack_keeps_the_filter_under_its_box_and_nowhere_else() {
    let (mut whole, look) = (stage(), look());
    let drawn = whole.draw(&look);
    let (exact, _) = whole.traced(&look, &drawn, |_| ());
    let points = points(&whole, &look, &drawn);
    let mut lacking = Stage::new(&traced(technique(), 1), things());
    lacking.things[1].is_lacking = true;
    let drawn = lacking.draw(&look);
    let block = lacking.things[1].bounds();
    let (found, counts) = {
        let eye = look.camera.eye;
        let boxes = [Aabb::new(block.min - eye.as_vec3(), block.max - eye.as_vec3())];
        lacking.traced(&look, &drawn, |view| view.missing_from_rays = Some(Boxes { origin: eye, boxes: &boxes }))
    };
    let map = lacking.sun.map().descriptor();
    let reach = |map_of: &shadowfit::FittedMap| {
        let texels = map.softness.filter_radius(map.filter) + 2.0;
        map_of.projection.texel_size.max_element() * texels + map_of.bias.normal_offset
    };
    let around = lacking.sun.maps().iter().map(reach).fold(0.0, f32::max);
    let mut left = 0;
    for (pixel, point) in points.iter().enumerate() {
        let Some([position, normal]) = point else { continue };
        let position = position.truncate();
        // Surfaces that face away are dark with any casters.
        if normal.truncate().dot(-look.direction) <= 1e-3 {
            continue;
        }
        let is_near = is_under(position, &look, &block, around + 1e-3);
        assert!(is_near || found[pixel].to_bits() == exact[pixel].to_bits(), "{pixel} at {position} is not under it");
        let is_below = is_under(position, &look, &block, around - 1e-3);
        assert!(!is_below || found[pixel] == -1.0, "{pixel} at {position} is under it: {}", found[pixel]);
        left += u32::from(found[pixel] == -1.0);
    }
    assert!(left > 100 && left * 2 < counts.facing && left == counts.filtered, "{left}, {counts:?}");
}

#[test]
fn more_boxes_than_there_is_room_for_lose_none() {
    let (mut stage, look) = (stage(), look());
    let drawn = stage.draw(&look);
    let points = points(&stage, &look, &drawn);
    let aabb = |index: u16| {
        let corner = Vec3::new(f32::from(index % 12) * 1.5 - 9.0, 3.0, f32::from(index / 12) * 1.5 - 9.0);
        Aabb::new(corner, corner + 0.1)
    };
    let mut boxes: Vec<Aabb> = (0..144).map(aabb).collect();
    boxes.insert(3, Aabb::EMPTY);
    let (found, _) =
        stage.traced(&look, &drawn, |view| view.missing_from_rays = Some(Boxes { origin: DVec3::ZERO, boxes: &boxes }));
    let mut under = 0;
    for (factor, point) in found.iter().zip(&points) {
        let Some([position, normal]) = point else { continue };
        let is_facing = normal.truncate().dot(-look.direction) > 1e-3;
        let any = |aabb: &Aabb| !aabb.is_empty() && is_under(position.truncate(), &look, aabb, 0.0);
        if is_facing && boxes.iter().any(any) {
            assert_eq!(*factor, -1.0, "{position}");
            under += 1;
        }
    }
    assert!(under > 50, "{under}");
}

#[test]
fn maps_that_wait_are_not_trusted_where_casters_have_moved_over_them() {
    let things = || {
        let mut things = things();
        things[1].moves = true;
        things[2].moves = true;
        things
    };
    let [mut waits, mut fresh] = [(); 2].map(|()| Stage::new(&traced(technique(), 1), things()));
    waits.sun.set_schedule(UpdateSchedule::Every([6; MAX_MAPS]));
    let (mut late, mut frames) = (0, 0);
    for step in 0..14_u16 {
        for stage in [&mut waits, &mut fresh] {
            stage.things[1].shift = Vec3::new(f32::from(step) * 0.13, 0.0, f32::from(step) * 0.05);
            stage.things[2].shift = Vec3::new(0.0, 0.0, f32::from(step) * -0.11);
        }
        let look = look();
        let [a, b] = [&mut waits, &mut fresh].map(|stage| {
            let drawn = stage.draw(&look);
            let points = asked(&points(stage, &look, &drawn));
            let (factors, _) = stage.traced(&look, &drawn, |_| ());
            let read = stage.read(&points, SIZE[0]);
            (factors, read)
        });
        // Both are exact. Where an edge crosses a pixel's centre, rounding decides.
        assert!(different(&a.0, &b.0) <= 2, "step {step}: {} pixels", different(&a.0, &b.0));
        let behind = a.1.iter().zip(&b.1).filter(|([a, _], [b, _])| (a - b).abs() > 0.5).count();
        late += behind;
        frames += usize::from(behind > 0);
    }
    assert!(late > 200 && frames > 4, "waiting maps are outdated in {late} pixels of {frames} frames");
}

#[test]
fn scenes_without_anything_and_skies_alone_count_nothing() {
    let mut empty = Stage::new(&traced(technique(), 4), Vec::new());
    let mut full = stage();
    let up = PerspectiveCamera { forward: Vec3::new(0.0, 1.0, 0.1).normalize(), up: Vec3::Z, ..look().camera };
    for samples in [1, 4] {
        let look = Look { samples, normals: None, ..look() };
        for (stage, look) in [(&mut empty, look), (&mut full, Look { camera: up, ..look })] {
            let drawn = stage.draw(&look);
            let (factors, counts) = stage.traced(&look, &drawn, |_| ());
            assert_eq!(counts, EdgeCounts::default());
            assert!(factors.iter().all(|factor| *factor == -1.0));
        }
    }
}

#[test]
fn a_part_of_a_texture_is_traced_as_a_picture_of_its_own_and_the_rest_stays() {
    let (mut stage, look) = (stage(), Look { normals: None, ..look() });
    let drawn = stage.draw(&look);
    let (alone, counts) = stage.traced(&look, &drawn, |_| ());
    // The same view at a corner of a larger texture.
    let rectangle = [40, 30, SIZE[0], SIZE[1]];
    let large = [256, 160];
    let larger = stage.draw_part(&look, large, [40, 30]);
    let (found, of_part) = stage.traced(&look, &larger, |view| view.rectangle = Some(rectangle));
    let rows = found.chunks(large[0] as usize).skip(30).take(SIZE[1] as usize);
    let part: Vec<f32> = rows.flat_map(|row| &row[40..40 + SIZE[0] as usize]).copied().collect();
    // Rasterisers may interpolate depths differently at other positions.
    assert!(different(&alone, &part) <= 5, "{} pixels", different(&alone, &part));
    assert!(of_part.facing.abs_diff(counts.facing) <= 5 && of_part.unsure.abs_diff(counts.unsure) <= 5, "{of_part:?}");
}
