//! A system that replaces the cascades of a frame by the cascades of another frame.
//!
//! Crawl compares the same world points in the maps of two frames. Bevy draws the second image: the view of
//! this frame with the cascades, bounds and biases of the previous frame.

use bevy::light::{CascadeShadowConfig, Cascades, SimulationLightSystems};
use bevy::prelude::*;
use bevy_shadowfit::ShadowfitSystems;

use crate::sun_maps::SunMaps;

/// The light whose shadows are measured.
#[derive(Component)]
pub(crate) struct Sun;

/// Maps of another frame that replace the light's maps, if set.
#[derive(Resource, Default)]
pub(crate) struct Frozen(pub(crate) Option<SunMaps>);

/// The light's own maps in the last update.
#[derive(Resource, Default)]
pub(crate) struct Live(pub(crate) Option<SunMaps>);

type SunParts<'a> = (&'a mut Cascades, &'a mut CascadeShadowConfig, &'a mut DirectionalLight);

/// Adds the system that copies the maps of each frame and replaces them on demand.
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
    live.0 = Some(SunMaps::new(own, config, light));
    let Some(frozen) = &frozen.0 else { return };
    cascades.cascades.insert(*camera, frozen.cascades.clone());
    put(frozen, config, light);
}

/// Sets the bounds and biases of a light.
pub(crate) fn put(maps: &SunMaps, config: &mut CascadeShadowConfig, light: &mut DirectionalLight) {
    *config = maps.config.clone();
    light.shadow_depth_bias = maps.depth_bias;
    light.shadow_normal_bias = maps.normal_bias;
}
