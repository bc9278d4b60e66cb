//! What is remembered of a light from frame to frame: its maps, and what its user has set.

use bevy::ecs::entity::EntityHashMap;
use bevy::light::{CascadeShadowConfig, DirectionalLight};
use bevy::prelude::*;
use shadowfit::ShadowFitter;

use crate::settings::FittedShadows;

/// The fitters of a light, and the values that it has lent us.
#[derive(Component, Clone, Default)]
pub(crate) struct FitMemory {
    /// Chooses the bounds, for all views together.
    pub(crate) bounds: ShadowFitter,
    /// View depth up to which the bounds of still maps are spaced, in metres.
    pub(crate) farthest: Option<f32>,
    /// Fits each cascade of each view.
    pub(crate) views: EntityHashMap<Vec<ShadowFitter>>,
    /// What the user has set, while the light holds our values.
    lent: Option<Lent>,
    /// What was told last about a light that keeps Bevy's cascades.
    pub(crate) told: Option<String>,
}

/// Values of the user that a frame's fit has replaced, each with the one in its place.
#[derive(Clone)]
struct Lent {
    bounds: Replaced<Vec<f32>>,
    biases: Replaced<[f32; 2]>,
}

#[derive(Clone)]
struct Replaced<T> {
    users: T,
    ours: T,
}

impl<T: PartialEq> Replaced<T> {
    /// Gives the user's value back, unless somebody has set another one since.
    fn give_back(self, place: &mut T) {
        if *place == self.ours {
            *place = self.users;
        }
    }
}

impl FitMemory {
    /// Puts a fit's bounds, in metres of view depth, into the config, and its biases (depth in metres, normal in texels)
    /// into the light, for Bevy's renderer. Change detection does not see it: the renderer extracts lights in each
    /// frame, since Bevy makes their cascades anew in each.
    pub(crate) fn lend(
        &mut self,
        bounds: Vec<f32>,
        biases: [f32; 2],
        config: &mut Mut<CascadeShadowConfig>,
        light: &mut Mut<DirectionalLight>,
    ) {
        let config = config.bypass_change_detection();
        let light = light.bypass_change_detection();
        let users = std::mem::replace(&mut config.bounds, bounds);
        let ours = config.bounds.clone();
        let users_biases = [light.shadow_depth_bias, light.shadow_normal_bias];
        [light.shadow_depth_bias, light.shadow_normal_bias] = biases;
        self.lent =
            Some(Lent { bounds: Replaced { users, ours }, biases: Replaced { users: users_biases, ours: biases } });
    }

    /// Gives the user's values back.
    fn give_back(&mut self, config: &mut Mut<CascadeShadowConfig>, light: &mut Mut<DirectionalLight>) {
        let Some(Lent { bounds, biases }) = self.lent.take() else { return };
        bounds.give_back(&mut config.bypass_change_detection().bounds);
        let light = light.bypass_change_detection();
        let mut place = [light.shadow_depth_bias, light.shadow_normal_bias];
        biases.give_back(&mut place);
        [light.shadow_depth_bias, light.shadow_normal_bias] = place;
    }
}

/// Gives all users their values back, for Bevy's own cascades and whoever looks at them.
pub(crate) fn give_back(mut lights: Query<(&mut FitMemory, &mut CascadeShadowConfig, &mut DirectionalLight)>) {
    for (mut memory, mut config, mut light) in &mut lights {
        memory.give_back(&mut config, &mut light);
    }
}

/// Leaves a light to Bevy.
pub(crate) fn forget(
    removed: On<Remove<FittedShadows>>,
    mut lights: Query<(&mut FitMemory, &mut CascadeShadowConfig, &mut DirectionalLight)>,
    mut commands: Commands,
) {
    let light = removed.event_target();
    if let Ok((mut memory, mut config, mut sun)) = lights.get_mut(light) {
        memory.give_back(&mut config, &mut sun);
    }
    if let Ok(mut light) = commands.get_entity(light) {
        light.try_remove::<FitMemory>();
    }
}
