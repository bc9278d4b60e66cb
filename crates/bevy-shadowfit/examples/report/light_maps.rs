//! The cascades of one frame, as the measures take them, and a system that puts those of another frame in their place.
//!
//! Crawl compares the same points of the world in the maps of two frames. Bevy draws the second picture itself: the
//! view of this frame with the cascades, bounds and biases of the frame before.

use bevy::light::cascade::Cascade;
use bevy::light::{CascadeShadowConfig, Cascades, SimulationLightSystems};
use bevy::prelude::*;
use bevy_shadowfit::ShadowfitSystems;
use shadowfit::glam::{DMat4, DVec2, DVec3};
use shadowfit_truth::MeasuredMap;

/// The light whose shadows are measured.
#[derive(Component)]
pub(crate) struct Sun;

/// All that decides which shadows the light casts in the view, apart from the scene and the filter.
#[derive(Clone)]
pub(crate) struct LightMaps {
    cascades: Vec<Cascade>,
    config: CascadeShadowConfig,
    /// Depth bias and normal bias.
    biases: [f32; 2],
}

/// What the light has when the maps are drawn: in place of its own, the maps of another frame if there are some.
#[derive(Resource, Default)]
pub(crate) struct Frozen(pub(crate) Option<LightMaps>);

/// What the light had of its own in the last update.
#[derive(Resource, Default)]
pub(crate) struct Live(pub(crate) Option<LightMaps>);

type SunParts<'a> = (&'a mut Cascades, &'a mut CascadeShadowConfig, &'a mut DirectionalLight);

/// Adds the system that notes the maps of each frame and replaces them on demand.
pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Frozen>().init_resource::<Live>().add_systems(
        PostUpdate,
        replace
            .after(SimulationLightSystems::UpdateDirectionalLightCascades)
            .after(ShadowfitSystems::Fit)
            .before(SimulationLightSystems::UpdateLightFrusta),
    );
}

fn replace(
    frozen: Res<Frozen>,
    mut live: ResMut<Live>,
    camera: Single<Entity, With<Camera3d>>,
    mut sun: Single<SunParts, With<Sun>>,
) {
    let (cascades, config, light) = &mut *sun;
    let Some(own) = cascades.cascades.get(&*camera).filter(|_| light.shadow_maps_enabled) else { return };
    let biases = [light.shadow_depth_bias, light.shadow_normal_bias];
    live.0 = Some(LightMaps { cascades: own.clone(), config: config.clone(), biases });
    let Some(frozen) = &frozen.0 else { return };
    cascades.cascades.insert(*camera, frozen.cascades.clone());
    frozen.put(config, light);
}

impl LightMaps {
    /// Sets the light's bounds and biases.
    pub(crate) fn put(&self, config: &mut CascadeShadowConfig, light: &mut DirectionalLight) {
        *config = self.config.clone();
        [light.shadow_depth_bias, light.shadow_normal_bias] = self.biases;
    }

    /// The maps as Bevy's shader reads them: by view depth, with the last part of each one's depths blended into the
    /// next one. They have `size` texels across and down.
    pub(crate) fn measured(&self, size: u32, to_light: DVec3) -> Vec<MeasuredMap> {
        let CascadeShadowConfig { bounds, overlap_proportion, .. } = &self.config;
        let blend = |index: usize| match index.checked_sub(1) {
            Some(before) => f64::from((1.0 - overlap_proportion) * bounds[before]),
            None => f64::INFINITY,
        };
        let cascades = self.cascades.iter().zip(bounds).enumerate();
        cascades
            .map(|(index, (cascade, bound))| {
                let clip_from_world = DMat4::from_cols_array(&cascade.clip_from_world.to_cols_array().map(f64::from));
                let size = DVec2::splat(f64::from(size));
                MeasuredMap::new(&clip_from_world, size, f64::from(*bound), to_light).with_blend_near(blend(index))
            })
            .collect()
    }

    /// Width of a texel of each map, in metres.
    pub(crate) fn texels(&self) -> Vec<f32> {
        self.cascades.iter().map(|cascade| cascade.texel_size).collect()
    }

    /// View depths at which the maps end, in metres.
    pub(crate) fn bounds(&self) -> &[f32] {
        &self.config.bounds
    }
}
