//! A moving sun: held maps, and the fade from one set of maps to the next.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::MapFormat;
use shadowfit::{Aabb, DepthConvention, Technique, ViewFrustum};
use shadowfit_wgpu::{Casters, LightSteps, SunFrame, SunShadows, WgslOptions, receiver_wgsl};

use super::ground::{BOXES, EYE, Painter, Picture, Quiet, camera, frame_of};
use super::technique;
use crate::engine::{ClearedDepth, Engine, cleared};

/// Steps for maps of 256 texels with an error of 3 texels at the edges: the sun steps after 0.0234 rad. Less
/// than 0.035 rad is no jump.
const STEPS: LightSteps = LightSteps { texels: 3.0, fade: FADE };
const FADE: u32 = 6;
const STEP: f32 = 0.03;
const LESS: f32 = 0.02;
const MAPS: usize = 4;
const SIDE: u32 = 256;

/// Returns the direction of travel of the light of a sun that has turned by an angle, in radians.
fn sun_at(angle: f32) -> Vec3 {
    let (sin, cos) = (0.45 + angle).sin_cos();
    Vec3::new(sin, -cos, 0.1)
}

/// A sun with its device, its pipelines and some views.
struct Day {
    device: Engine,
    sun: SunShadows,
    painter: Painter,
    views: Vec<ViewFrustum>,
}

impl Day {
    fn new(device: Engine, technique: &Technique, steps: Option<LightSteps>) -> Self {
        device.require_map(&technique.into());
        let mut sun = SunShadows::new(&device.device, &device.queue, &(*technique).into()).expect("maps");
        sun.set_light_steps(steps).expect("steps");
        let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
        Self { sun, painter, views: vec![camera(EYE).frustum().expect("a camera")], device }
    }

    /// Returns a sun with these steps, whose windows have settled.
    fn settled(technique: &Technique, steps: LightSteps) -> Self {
        let mut day = Self::new(Engine::shared(), technique, Some(steps));
        // For 60 frames after a window is replaced, the next replacement needs a larger gain.
        for _ in 0..120 {
            day.go_on(0.0);
        }
        day
    }

    fn frame(&self, angle: f32) -> SunFrame<'_> {
        frame_of(&self.views, sun_at(angle), &BOXES)
    }

    /// Draws a frame of a sun that has turned by an angle, and asserts that every map that is read is
    /// complete.
    fn draw(&mut self, angle: f32) -> Picture {
        self.draw_boxes(angle, &BOXES, &[])
    }

    /// Draws a frame with other boxes, some of which move.
    fn draw_boxes(&mut self, angle: f32, boxes: &[Aabb], moves: &[bool]) -> Picture {
        self.update(angle, boxes, moves);
        self.painter.draw(&self.device, &[(&self.sun, boxes)])
    }

    /// Advances by a frame without drawing an image.
    fn go_on(&mut self, angle: f32) {
        self.update(angle, &BOXES, &[]);
        let mut encoder = self.device.encoder();
        self.painter.draw_one(&self.device, &mut encoder, &[(&self.sun, &BOXES)], 0);
        self.device.submit(encoder);
    }

    fn update(&mut self, angle: f32, boxes: &[Aabb], moves: &[bool]) {
        let frame = frame_of(&self.views, sun_at(angle), boxes);
        let frame = SunFrame { casters: Casters { moves, ..frame.casters }, ..frame };
        self.sun.update(&self.device.queue, &frame).expect("a good frame");
        let proof = self.sun.prove(&frame).expect("a good frame");
        assert!(proof.is_proven(), "{proof:?}");
        let numbers: Vec<usize> =
            self.sun.passes().flat_map(|pass| pass.regions()).map(|region| region.number).collect();
        assert_eq!(numbers, (0..numbers.len()).collect::<Vec<_>>(), "regions of both sets have different numbers");
        assert_eq!(self.sun.culling_regions().count(), numbers.len());
    }

    /// Records the visible demand of a wall that fills the view at this distance.
    fn see_wall(&mut self, metres: f32) {
        self.device.require_depth_loads();
        let (camera, convention) = (camera(EYE), DepthConvention::Reversed);
        let clip_from_world = camera.clip_from_world(convention);
        let depth = self.device.depth_texture();
        let mut encoder = self.device.encoder();
        let value = clip_from_world.project_point3(camera.forward * metres).z;
        drop(cleared(&mut encoder, &[], Some(ClearedDepth { view: &depth, value })));
        assert_eq!(self.sun.record_demand(&mut encoder, &depth, clip_from_world, convention), Ok(true));
        self.device.submit(encoder);
        self.sun.wait_for_demand().expect("a device");
    }

    /// Returns the number of texels that the last frame drew.
    fn drawn(&self) -> u32 {
        let regions = self.sun.passes().flat_map(|pass| pass.regions());
        regions.map(|region| region.scissor[2] * region.scissor[3]).sum()
    }

    /// Returns whether the maps that are read were fitted to the sun at an angle.
    fn is_held_at(&self, angle: f32) -> bool {
        let held = self.sun.maps()[0].projection.direction;
        (held - sun_at(angle).normalize()).length() < 1e-6
    }

    /// Returns the image of a sun without steps, with the same maps, drawn from scratch for an angle.
    fn plain(&self, technique: &Technique, angle: f32) -> (Picture, SunShadows) {
        let mut sun = SunShadows::new(&self.device.device, &self.device.queue, &(*technique).into()).expect("maps");
        sun.prepare(&self.device.queue, &self.frame(angle), self.sun.fitted()).expect("a good frame");
        let painter = Painter::new(&self.device, &[(&sun, "shadowfit")]);
        (painter.draw(&self.device, &[(&sun, &BOXES)]), sun)
    }

    /// Returns the depths of the layers of one set of maps.
    fn layers(&self, sun: &SunShadows, first: usize) -> Vec<Vec<f32>> {
        let depths: Vec<f32> = self.device.texels(sun.map().view().texture());
        depths.chunks((SIDE * SIDE) as usize).skip(first).take(MAPS).map(<[f32]>::to_vec).collect()
    }
}

#[test]
fn gpu_between_steps_no_texel_is_drawn_and_no_pixel_changes() {
    for fade in [0, FADE] {
        let mut day = Day::settled(&technique(), STEPS.with_fade(fade));
        let still = day.draw(0.0);
        for frame in 0..20_u8 {
            let picture = day.draw(LESS * f32::from(frame) / 20.0);
            assert_eq!((day.drawn(), day.sun.passes().len(), &picture), (0, 0, &still), "frame {frame}, fade {fade}");
        }
        assert!(day.is_held_at(0.0));
    }
}

#[test]
fn gpu_a_step_without_a_fade_draws_all_maps_in_one_frame() {
    let mut day = Day::settled(&technique(), STEPS.with_fade(0));
    let picture = day.draw(STEP);
    assert_eq!(day.drawn(), MAPS as u32 * SIDE * SIDE);
    assert!(day.is_held_at(STEP));
    assert_eq!(picture, day.plain(&technique(), STEP).0);
    // There is a single set of maps, with the look-up of a sun without steps.
    let plain = SunShadows::new(&day.device.device, &day.device.queue, &technique().into()).expect("maps");
    let wgsl = |sun: &SunShadows| receiver_wgsl(sun.map().descriptor(), &WgslOptions::group(1));
    assert_eq!(wgsl(&day.sun), wgsl(&plain));
    assert_eq!(day.sun.map().receiver_layout_entries(), plain.map().receiver_layout_entries());
    assert_eq!(day.sun.map().view().texture().depth_or_array_layers(), MAPS as u32);
}

#[test]
fn gpu_a_fade_draws_a_map_in_a_frame_then_goes_from_the_old_shadow_to_the_new_one_and_ends_there() {
    let mut day = Day::settled(&technique(), STEPS);
    let old = day.draw(0.0);
    for map in 0..MAPS {
        assert_eq!(day.draw(STEP), old, "the old maps are read");
        assert_eq!(day.drawn(), SIDE * SIDE, "{map}");
        assert!(day.is_held_at(0.0));
    }
    let mut pictures = vec![old];
    for _ in 0..FADE {
        pictures.push(day.draw(STEP));
        assert_eq!(day.drawn(), 0);
        assert!(day.is_held_at(STEP));
    }
    let (plain, other) = day.plain(&technique(), STEP);
    let [old, new] = [&pictures[0], &pictures[FADE as usize]];
    assert!(old.difference(new) > 20, "the shadow has moved by {} of 255", old.difference(new));
    assert_eq!(*new, plain);
    assert_eq!(day.layers(&day.sun, MAPS), day.layers(&other, 0), "texel by texel");
    for pair in pictures.windows(2) {
        assert!(pair[0].difference(&pair[1]) <= old.difference(new) / FADE as u8 + 2, "even steps");
    }
    let is_between = |before: u8, now: u8, end: u8| {
        (before.min(end).saturating_sub(1)..=before.max(end).saturating_add(1)).contains(&now)
    };
    for pair in pictures.windows(2) {
        let mut values = pair[0].values().zip(pair[1].values()).zip(new.values());
        assert!(values.all(|((before, now), end)| is_between(before, now, end)), "a factor reverses its change");
    }
    assert_eq!(day.draw(STEP), plain, "the image stays the same");
    assert_eq!(day.drawn(), 0);
}

#[test]
fn gpu_windows_follow_what_is_seen_in_the_maps_that_are_not_read_yet_and_fade_in_with_them() {
    const LONG: u32 = 30;
    let mut day = Day::settled(&technique(), STEPS.with_fade(LONG));
    let places = |day: &Day| day.sun.maps().iter().map(|map| map.grid_position).collect::<Vec<_>>();
    for _ in 0..150 {
        day.go_on(0.0);
        day.see_wall(40.0);
    }
    let (mut pictures, before) = (vec![day.draw(0.0)], places(&day));
    // From the first frame of the step on, a nearer wall is visible.
    for frame in 0..MAPS as u32 + LONG {
        pictures.push(day.draw(STEP));
        if frame < MAPS as u32 {
            assert_eq!(places(&day), before, "frame {frame}");
        } else {
            assert_eq!(day.drawn(), 0, "frame {frame}");
            let seen = day.sun.fitter().visible_demand().expect("visible demand").demand().space.direction;
            assert!((seen - sun_at(STEP).normalize()).length() < 1e-6, "frame {frame}");
        }
        day.see_wall(20.0);
    }
    let changes: Vec<u8> = pictures.windows(2).map(|pair| pair[0].difference(&pair[1])).collect();
    assert!(changes.iter().all(|change| *change <= 255 / LONG as u8 + 2), "{changes:?}");
}

#[test]
fn gpu_every_kind_of_map_steps_in_every_format_and_is_that_of_the_new_direction_after_it() {
    let color = technique().with_format(MapFormat::R32Float);
    let mut reversed = technique();
    reversed.fit.depth = DepthConvention::Reversed;
    let of_preset = |name: &str| Technique::preset(name).expect("a preset").with_max_distance(40.0);
    let presets = ["stable-4", "calm-4", "focused-4"].map(|name| of_preset(name).with_resolution(SIDE, SIDE));
    let few = presets.into_iter().chain([color, reversed, technique().with_format(MapFormat::Depth16Unorm)]);
    for technique in few {
        let mut day = Day::settled(&technique, STEPS);
        let frames = MAPS + FADE as usize;
        let mut draws = 0;
        let last = (0..frames)
            .map(|_| {
                let picture = day.draw(STEP);
                draws += usize::from(day.drawn() > 0);
                picture
            })
            .last();
        assert!(day.is_held_at(STEP), "{technique:?}");
        assert_eq!(last.as_ref(), Some(&day.plain(&technique, STEP).0), "{technique:?}");
        assert!(draws >= MAPS);
    }
}

/// Ground points in the post's shadow, before and after it moves.
const BESIDE_POST: [f32; 2] = [-4.6, -3.5];
const BESIDE_MOVED: [f32; 2] = [-4.6, 2.5];

#[test]
fn gpu_what_moves_has_its_shadow_where_it_is_in_every_frame_of_a_step() {
    let moves = [false, false, true];
    let mut moved = BOXES;
    moved[2].min.z += 6.0;
    moved[2].max.z += 6.0;
    for frames in 0..MAPS + FADE as usize {
        let mut day = Day::settled(&technique(), STEPS);
        for _ in 0..frames {
            day.draw_boxes(STEP, &BOXES, &moves);
        }
        let at = |picture: &Picture| [BESIDE_POST, BESIDE_MOVED].map(|place| picture.at(place)[0]);
        assert_eq!(at(&day.draw_boxes(STEP, &BOXES, &moves)), [0, 255], "after {frames} frames of a step");
        assert_eq!(at(&day.draw_boxes(STEP, &moved, &moves)), [255, 0], "after {frames} frames of a step");
    }
}

#[test]
fn gpu_a_sun_that_is_set_elsewhere_is_there_in_the_same_frame_whatever_is_under_way() {
    for frames in [0, 2, MAPS + 3] {
        let mut day = Day::settled(&technique(), STEPS);
        for _ in 0..frames {
            day.draw(STEP);
        }
        let picture = day.draw(0.6);
        assert!(day.is_held_at(0.6));
        assert_eq!(day.drawn(), MAPS as u32 * SIDE * SIDE, "all maps at once");
        assert_eq!(picture, day.plain(&technique(), 0.6).0, "after {frames} frames of a step");
    }
}

#[test]
fn gpu_a_cut_ends_a_step_with_right_maps_and_a_reset_forgets_the_sun() {
    for frames in [2, MAPS + 3] {
        let mut day = Day::settled(&technique(), STEPS);
        for _ in 0..frames {
            day.draw(STEP);
        }
        day.views = vec![camera(EYE + DVec3::X * 3.0).frustum().expect("a camera")];
        day.sun.cut();
        let picture = day.draw(STEP + LESS);
        assert!(day.is_held_at(STEP), "the direction of the step is held after {frames} frames of it");
        let mut new = SunShadows::new(&day.device.device, &day.device.queue, &technique().into()).expect("maps");
        new.update(&day.device.queue, &day.frame(STEP)).expect("a good frame");
        let expected = Painter::new(&day.device, &[(&new, "shadowfit")]).draw(&day.device, &[(&new, &BOXES)]);
        assert!(picture.difference(&expected) <= 1, "{}", picture.difference(&expected));
        day.draw(STEP + LESS);
        assert_eq!(day.drawn(), 0, "no texel is drawn again");
        day.sun.reset();
        day.draw(STEP + LESS);
        assert!(day.is_held_at(STEP + LESS));
        assert_eq!(day.drawn(), MAPS as u32 * SIDE * SIDE);
    }
}

#[test]
fn gpu_a_sun_that_is_turned_off_in_a_fade_is_dark_and_comes_back_with_right_maps() {
    let mut day = Day::settled(&technique(), STEPS);
    for _ in 0..MAPS + 3 {
        day.draw(STEP);
    }
    day.sun.turn_off(&day.device.queue);
    assert_eq!(day.sun.passes().len(), 0);
    let dark = day.painter.draw(&day.device, &[(&day.sun, &BOXES)]);
    assert!(dark.of(0).all(|factor| factor == 0));
    let picture = day.draw(STEP + STEP);
    assert!(day.is_held_at(STEP + STEP), "the movement while the sun was off is not faded");
    assert_eq!(picture, day.plain(&technique(), STEP + STEP).0);
}

#[test]
fn gpu_views_that_walk_are_covered_in_every_frame_of_a_day_and_few_maps_are_drawn() {
    let mut day = Day::settled(&technique(), STEPS);
    let (mut whole, mut most) = (0, 0);
    for frame in 0..120_u8 {
        let way = DVec3::new(0.02, 0.0, -0.01) * f64::from(frame);
        let eyes = [EYE + way, EYE + way + DVec3::X * 0.5];
        day.views = eyes.map(|eye| camera(eye).frustum().expect("a camera")).to_vec();
        day.go_on(f32::from(frame) * 0.002);
        let cleared = day.sun.passes().filter(shadowfit_wgpu::ShadowPass::is_cleared).count();
        whole += cleared;
        most = most.max(cleared);
    }
    // 0.24 rad are 10 steps with fades. A window is replaced now and then.
    assert!(whole <= 12 * MAPS && most <= 2, "{whole} whole maps, {most} in a frame");
}

#[test]
fn gpu_a_sun_that_fades_stands_beside_another_in_one_shader_and_runs_on_a_device_of_webgl2_limits() {
    let device = Engine::with_webgl2_limits();
    let quiet = Quiet::new(&device);
    let suns = || SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let (mut sun, mut moon) = (suns(), suns());
    assert_eq!(sun.set_light_steps(Some(STEPS)), Ok(true), "pipelines and look-up have changed");
    assert_eq!(sun.set_light_steps(Some(STEPS.with_fade(3))), Ok(false));
    assert_eq!(sun.light_steps(), Some(STEPS.with_fade(3)));
    assert!(sun.set_light_steps(Some(STEPS.with_texels(-1.0))).is_err());
    assert_eq!(sun.map().view().texture().depth_or_array_layers(), 2 * MAPS as u32);
    assert_eq!(sun.set_technique(&technique().with_max_distance(39.0)), Ok(false), "the second set stays");
    let painter = Painter::new(&device, &[(&sun, "sun"), (&moon, "moon")]);
    let views = [camera(EYE).frustum().expect("a camera")];
    let mut pictures = Vec::new();
    for frame in 0..60_u8 {
        let angle = if frame < 40 { 0.0 } else { STEP };
        sun.update(&device.queue, &frame_of(&views, sun_at(angle), &BOXES)).expect("a good frame");
        moon.update(&device.queue, &frame_of(&views, sun_at(-0.9), &BOXES)).expect("a good frame");
        pictures.push(painter.draw(&device, &[(&sun, &BOXES), (&moon, &BOXES)]));
    }
    let factors = |frame: usize, sun: usize| pictures[frame].of(sun).collect::<Vec<u8>>();
    assert_ne!(factors(39, 0), factors(59, 0));
    assert_eq!(factors(39, 1), factors(45, 1), "the moon's shadows do not change while the sun's fade");
    assert_eq!(sun.set_light_steps(None), Ok(true));
    assert_eq!(sun.map().view().texture().depth_or_array_layers(), MAPS as u32);
    quiet.assert("two suns");
}
