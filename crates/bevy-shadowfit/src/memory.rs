//! State of a light between frames: its fitters, and the values that the user set.

use bevy::ecs::entity::EntityHashMap;
use bevy::light::{CascadeShadowConfig, DirectionalLight};
use bevy::prelude::*;
use shadowfit::ShadowFitter;

use crate::bias::Biases;

/// Fitters of a light, and the user's values while the light holds the plugin's values.
#[derive(Component, Clone, Default)]
pub(crate) struct FitMemory {
    /// Fitter that chooses the bounds, for all views together.
    pub(crate) bounds: ShadowFitter,
    /// View depth up to which the bounds of still maps are spaced, in metres.
    pub(crate) farthest: Option<f32>,
    /// Fitters for each cascade of each view.
    pub(crate) views: EntityHashMap<Vec<ShadowFitter>>,
    /// Values that the user set, while the light holds the plugin's values.
    lent: Option<Lent>,
    /// Last logged reason why the light keeps Bevy's cascades.
    pub(crate) told: Option<String>,
}

/// User values that a frame's fit has replaced, each with its replacement.
#[derive(Clone)]
struct Lent {
    bounds: Replaced<Vec<f32>>,
    biases: Replaced<Biases>,
}

#[derive(Clone)]
struct Replaced<T> {
    users: T,
    ours: T,
}

impl<T: PartialEq> Replaced<T> {
    /// Restores the user's value, unless other code has changed the value since.
    fn give_back(self, place: &mut T) {
        if *place == self.ours {
            *place = self.users;
        }
    }
}

impl FitMemory {
    /// Sets the bounds of the config, in metres of view depth, and the biases of the light to the values of a
    /// fit, for Bevy's renderer. The user's values are kept. Change detection is bypassed: Bevy recomputes
    /// cascades in each frame, so the renderer extracts all lights anyway.
    pub(crate) fn lend(
        &mut self,
        bounds: Vec<f32>,
        biases: Biases,
        config: &mut Mut<CascadeShadowConfig>,
        light: &mut Mut<DirectionalLight>,
    ) {
        let config = config.bypass_change_detection();
        let light = light.bypass_change_detection();
        let users = std::mem::replace(&mut config.bounds, bounds);
        let ours = config.bounds.clone();
        let users_biases = Biases::of(light);
        biases.set(light);
        self.lent =
            Some(Lent { bounds: Replaced { users, ours }, biases: Replaced { users: users_biases, ours: biases } });
    }

    /// Restores the user's values.
    pub(crate) fn give_back(&mut self, config: &mut Mut<CascadeShadowConfig>, light: &mut Mut<DirectionalLight>) {
        let Some(Lent { bounds, biases }) = self.lent.take() else { return };
        bounds.give_back(&mut config.bypass_change_detection().bounds);
        let light = light.bypass_change_detection();
        let mut place = Biases::of(light);
        biases.give_back(&mut place);
        place.set(light);
    }
}

/// Restores all users' values, for Bevy's cascade system and other systems.
pub(crate) fn give_back(mut lights: Query<(&mut FitMemory, &mut CascadeShadowConfig, &mut DirectionalLight)>) {
    for (mut memory, mut config, mut light) in &mut lights {
        memory.give_back(&mut config, &mut light);
    }
}
