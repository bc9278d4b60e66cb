//! Runs fits, and all functions that engines call for them.

use shadowfit::bias::{FilterRadius, normal_offset, receiver_plane_depth};
use shadowfit::culling::{OrientedBox, Sphere, Sweep, cull};
use shadowfit::demand::{DepthHistogram, needed_texel};
use shadowfit::diagnostics::{DepthStorage, acne_margin, coverage, depth_step_at, pixels_per_texel, share_of_map};
use shadowfit::fit_scene;
use shadowfit::glam::{DVec2, UVec2, Vec2, Vec3};
use shadowfit::light_steps::{LightStepState, LightSteps};
use shadowfit::settings::{BiasSettings, CasterPolicy, FilterKind};
use shadowfit::{Bias, CasterVolume, FitError, FitState, LightProjection, Scratch};

use crate::Outcome;
use crate::hash::Hash;
use crate::inputs::{Scene, fit_settings, technique};
use crate::random::Random;

/// Number of frames of a camera's flight.
const FRAMES: u32 = 4;

pub(crate) fn run(fits: u32) -> Outcome {
    let mut run = Run {
        random: Random::new(1),
        hash: Hash::new(),
        storage: vec![DVec2::ZERO; Scratch::required(64, 8)],
        light: LightStepState::default(),
        fits: 0,
        refused: 0,
    };
    while run.fits < fits {
        if let Err(error) = run.scene() {
            run.hash.add(&error);
            run.refused += 1;
        }
    }
    Outcome { hash: run.hash.value(), fits: run.fits, refused: run.refused }
}

struct Run {
    random: Random,
    hash: Hash,
    storage: Vec<DVec2>,
    light: LightStepState,
    fits: u32,
    refused: u32,
}

impl Run {
    fn scene(&mut self) -> Result<(), FitError> {
        let mut scene = Scene::new(&mut self.random)?;
        self.lights(&scene)?;
        if !self.random.once_in(8) {
            let settings = fit_settings(&mut self.random, &scene.camera);
            let fit = fit_scene(&scene.input(), &settings, &mut Scratch::new(&mut self.storage))?;
            self.fits += 1;
            return self.follow(&scene, &fit, settings.map.casters);
        }
        let settings = technique(&mut self.random, &scene.camera);
        let mut fitter = FitState::new();
        for _ in 0..FRAMES {
            let cascades = fitter.fit(&scene.input(), &settings, &mut Scratch::new(&mut self.storage))?;
            self.hash.add(&cascades);
            self.hash.add(&fitter);
            self.fits += 1;
            scene.advance(&mut self.random)?;
        }
        Ok(())
    }

    /// Calls the functions for cameras and lights that engines call before a fit.
    fn lights(&mut self, scene: &Scene) -> Result<(), FitError> {
        // In f64, which no target computes with SIMD.
        let sun = scene.direction.as_dvec3().normalize().as_vec3();
        let settings = LightSteps::default().with_texels(100.0).with_fade(0.5);
        let step = self.light.update(scene.direction, &settings, self.random.between(0.0, 0.4))?;
        let (right, down) = (self.random.vector(), self.random.vector());
        let texel = needed_texel(right, down, sun);
        let bin = DepthHistogram::bin(0.1, 100.0, 64, 4, self.random.scale(-4, 7), self.random.between(0.0, 4.0));
        let view = (scene.camera.view_from_world(), scene.views[0], scene.views[0].enclosing_sphere()?);
        self.hash.add(&(sun, step, texel, bin, view));
        Ok(())
    }

    /// Calls the functions that an engine calls for a fit.
    fn follow(&mut self, scene: &Scene, fit: &LightProjection, casters: CasterPolicy) -> Result<(), FitError> {
        let random = &mut self.random;
        let moved = fit.relative_to(fit.origin + random.place(100.0));
        self.hash.add(&(fit, moved, fit.world_matrices(), fit.corners(), fit.light_position()));

        let filter = random.pick(&[FilterKind::Point, FilterKind::Hardware2x2]);
        let reach = random.pick(&[
            filter.into(),
            FilterRadius::kernel(5),
            FilterRadius::POINT.over_disc(3.0),
            FilterRadius { disc: Vec2::splat(0.5) / fit.texel_size, ..FilterRadius::POINT },
        ]);
        let storage = random.pick(&[DepthStorage::Unorm16, DepthStorage::Float16, DepthStorage::Float32]);
        let settings =
            BiasSettings { constant: random.scale(-2, 1), slope: random.between(0.0, 3.0), ..Default::default() };
        let bias = Bias::automatic(reach, storage, fit)?;
        let biases = (
            Bias::from_texels(&settings, DepthStorage::Float32, fit),
            bias,
            Bias::automatic_receiver_plane(reach, storage, fit)?,
        );
        let normal = random.vector();
        self.hash.add(&(biases, biases.0.on_plane(fit, normal)?, biases.2.on_plane(fit, normal)?));
        self.hash.add(&(normal_offset(fit, reach, normal)?, receiver_plane_depth(fit, reach, normal)?));

        let corners = scene.views[0].corners;
        let near_view = (corners[0] + corners[6]).as_dvec3() * 0.25;
        let point = scene.views[0].origin + near_view + random.place(f64::from(scene.camera.far) * 0.1);
        let clip_from_world = scene.camera.clip_from_world(fit.depth);
        let density = pixels_per_texel(fit, &clip_from_world, UVec2::new(1280, 720), near_view.as_vec3(), normal);
        self.hash.add(&(
            coverage(fit, reach, point)?,
            acne_margin(fit, &bias, reach, storage, point, normal)?,
            density,
        ));
        self.hash.add(&(share_of_map(fit, &corners)?, depth_step_at(storage, fit.depth_range, 0.3)?));
        self.volumes(scene, fit, reach, bias.normal_offset, casters)
    }

    /// Calls the functions for culling.
    fn volumes(
        &mut self,
        scene: &Scene,
        fit: &LightProjection,
        reach: FilterRadius,
        normal_offset: f32,
        casters: CasterPolicy,
    ) -> Result<(), FitError> {
        let far = scene.camera.far * self.random.between(0.3, 1.0);
        let swept =
            CasterVolume::swept(fit, &Sweep { far, filter_radius: reach, normal_offset, ..Sweep::new(&scene.views) })?;
        let volumes = [swept, swept.cut_at_near_plane(fit), CasterVolume::of_map(fit, casters), fit.caster_volume()];
        let mut masks = [[0; 24]; 3];
        cull(&volumes, scene.origin, &scene.casters, &mut masks[0]);
        let half = |aabb: &shadowfit::Aabb| (aabb.max - aabb.min) * 0.5;
        let spheres: Vec<Sphere> =
            scene.casters.iter().map(|b| Sphere { centre: (b.min + b.max) * 0.5, radius: half(b).x }).collect();
        cull(&volumes, scene.origin, &spheres, &mut masks[1]);
        let turned = |aabb: &shadowfit::Aabb| {
            let (centre, half) = ((aabb.min + aabb.max) * 0.5, half(aabb));
            let axes = [Vec3::new(half.x, half.x, 0.0), Vec3::new(-half.y, half.y, 0.0), Vec3::new(0.0, 0.0, half.z)];
            OrientedBox { centre, half_axes: axes }
        };
        let oriented: Vec<OrientedBox> = scene.casters.iter().map(turned).collect();
        cull(&volumes, scene.origin, &oriented, &mut masks[2]);
        self.hash.add(&(volumes, masks));
        Ok(())
    }
}
