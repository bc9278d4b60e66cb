//! Hashes over only the numbers of fits: without names, state between frames, and error texts.
//!
//! The first hash covers the `Debug` text of values, so it also changes when a field is renamed or added. The
//! hashes over numbers change only if an engine gets another number for the same settings, which are all
//! written out here.

use shadowfit::bias::FilterRadius;
use shadowfit::culling::{Sweep, cull};
use shadowfit::diagnostics::DepthStorage;
use shadowfit::fit_scene;
use shadowfit::glam::{DVec2, DVec3, Mat4, Vec2, Vec3};
use shadowfit::selection::DepthRange;
use shadowfit::settings::{BiasSettings, CasterPolicy};
use shadowfit::{Bias, CasterVolume, FitError, FitState, FittedMap, LightProjection, Scratch};

use crate::inputs::{Scene, fit_settings, technique};
use crate::random::Random;

/// Number of frames of a camera's flight.
const FRAMES: u32 = 6;

/// Adds the numbers of this many fits: single maps, and cascades read by view depth.
pub(crate) fn add(random: Random, fits: u32, numbers: &mut ByKind) {
    let storage = vec![DVec2::ZERO; Scratch::required(64, 8)];
    let mut run = Run { random, single_map: &mut numbers.single_map, cascades: &mut numbers.cascades, storage };
    let mut done = 0;
    while done < fits {
        // Refused input gives no number.
        done += run.scene().unwrap_or(0);
    }
}

struct Run<'a> {
    random: Random,
    single_map: &'a mut Numbers,
    cascades: &'a mut Numbers,
    storage: Vec<DVec2>,
}

impl Run<'_> {
    /// Fits to a random scene. Returns the number of fits.
    fn scene(&mut self) -> Result<u32, FitError> {
        let mut scene = Scene::new(&mut self.random)?;
        if !self.random.once_in(8) {
            let settings = fit_settings(&mut self.random, &scene.camera);
            let fit = fit_scene(&scene.input(), &settings, &mut Scratch::new(&mut self.storage))?;
            self.single_map.fit(&fit);
            self.follow(&scene, &fit, settings.map.casters)?;
            return Ok(1);
        }
        let settings = technique(&mut self.random, &scene.camera);
        // The frames to come use this constructor, and held state may depend on its rounding.
        scene.views = vec![scene.camera.frustum()?];
        let mut fitter = FitState::new();
        for _ in 0..FRAMES {
            let maps = fitter.fit(&scene.input(), &settings, &mut Scratch::new(&mut self.storage))?;
            let numbers = if settings.maps.count() > 1 { &mut *self.cascades } else { &mut *self.single_map };
            for map in maps.iter() {
                numbers.map(map);
            }
            scene.advance(&mut self.random)?;
        }
        Ok(FRAMES)
    }

    /// Computes biases and culling for a fit.
    fn follow(&mut self, scene: &Scene, fit: &LightProjection, casters: CasterPolicy) -> Result<(), FitError> {
        let random = &mut self.random;
        let reach = random.pick(&[
            FilterRadius::POINT,
            FilterRadius::HARDWARE_2X2,
            FilterRadius::kernel(3),
            FilterRadius::kernel(5),
        ]);
        let storage = random.pick(&[DepthStorage::Unorm16, DepthStorage::Float16, DepthStorage::Float32]);
        let settings = BiasSettings {
            constant: random.scale(-2, 1),
            slope: random.between(0.0, 3.0),
            normal_offset: random.between(0.0, 2.0),
            receiver_plane: random.between(0.0, 2.0),
            depth_steps: 1.0,
        };
        for bias in [
            Bias::from_texels(&settings, DepthStorage::Float32, fit),
            Bias::automatic(reach, storage, fit)?,
            Bias::automatic_receiver_plane(reach, storage, fit)?,
        ] {
            self.single_map.f32s(&[bias.constant_depth, bias.slope_depth, bias.normal_offset, bias.receiver_plane]);
        }
        let far = scene.camera.far * self.random.between(0.3, 1.0);
        let normal_offset = self.random.between(0.0, 0.1);
        let sweep = Sweep { views: &scene.views, near: f32::MIN, far, filter_radius: reach, normal_offset };
        let swept = CasterVolume::swept(fit, &sweep)?;
        let volumes = [swept, swept.cut_at_near_plane(fit), CasterVolume::of_map(fit, casters), fit.caster_volume()];
        let mut masks = [0; 24];
        cull(&volumes, scene.origin, &scene.casters, &mut masks);
        for volume in volumes {
            self.single_map.place(volume.origin);
            for plane in volume.active_planes() {
                self.single_map.f32s(&plane.to_array());
            }
        }
        for mask in masks {
            self.single_map.bits(u64::from(mask));
        }
        Ok(())
    }
}

/// A hash for each kind of technique.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ByKind {
    pub(crate) single_map: Numbers,
    pub(crate) cascades: Numbers,
    pub(crate) windows: Numbers,
}

impl ByKind {
    pub(crate) fn new() -> Self {
        let new = Numbers::new();
        Self { single_map: new, cascades: new, windows: new }
    }
}

/// FNV-1a over the bits of numbers (G. Fowler, L. C. Noll, K.-P. Vo: "The FNV non-cryptographic hash algorithm").
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Numbers {
    hash: u64,
    are_finite: bool,
}

impl Numbers {
    pub(crate) fn new() -> Self {
        Self { hash: 0xcbf2_9ce4_8422_2325, are_finite: true }
    }

    pub(crate) fn value(self) -> u64 {
        self.hash
    }

    /// Returns whether all numbers were finite.
    pub(crate) fn are_finite(self) -> bool {
        self.are_finite
    }

    /// Adds one of several maps.
    pub(crate) fn map(&mut self, map: &FittedMap) {
        self.fit(&map.projection);
        self.depths(map.depths);
        if let Some(grid_position) = map.grid_position {
            for line in grid_position.first {
                self.bits(line.cast_unsigned());
            }
            self.f64s(&[grid_position.texel.x, grid_position.texel.y, grid_position.depth[0], grid_position.depth[1]]);
        }
    }

    /// Adds view depths in f32, as shaders compare them: `f32::MAX` for no end, and `f32::MIN` for no range.
    fn depths(&mut self, depths: Option<DepthRange>) {
        self.f32s(&depths.map_or([f32::MIN; 3], |DepthRange { near, far, covered_from }| {
            let far = far.map_or(f32::MAX, |far| far as f32);
            [near as f32, far, covered_from.map_or(far, |near| near as f32)]
        }));
    }

    pub(crate) fn bits(&mut self, bits: u64) {
        for byte in bits.to_le_bytes() {
            self.hash = (self.hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    pub(crate) fn f32s(&mut self, numbers: &[f32]) {
        for number in numbers {
            self.are_finite &= number.is_finite();
            self.bits(u64::from(number.to_bits()));
        }
    }

    fn f64s(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.are_finite &= number.is_finite();
            self.bits(number.to_bits());
        }
    }

    pub(crate) fn place(&mut self, place: DVec3) {
        self.f64s(&place.to_array());
    }

    pub(crate) fn matrix(&mut self, matrix: &Mat4) {
        self.f32s(&matrix.to_cols_array());
    }

    fn fit(&mut self, fit: &LightProjection) {
        self.place(fit.origin);
        for matrix in [&fit.light_from_world, &fit.clip_from_light, &fit.clip_from_world, &fit.uv_from_world] {
            self.matrix(matrix);
        }
        let Vec2 { x, y } = fit.texel_size;
        for Vec3 { x, y, z } in [fit.direction, fit.box_min, fit.box_max] {
            self.f32s(&[x, y, z]);
        }
        self.f32s(&[x, y, fit.depth_range]);
        self.bits(u64::from(fit.resolution.x) << 32 | u64::from(fit.resolution.y));
        self.bits(u64::from(fit.is_empty));
    }
}
