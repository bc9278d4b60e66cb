//! What is remembered of a light from frame to frame: its maps, and what its user has set.

use bevy::ecs::entity::EntityHashMap;
use bevy::light::{CascadeShadowConfig, DirectionalLight};
use bevy::prelude::*;
use shadowfit::ShadowFitter;

use crate::bias::Biases;

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
    biases: Replaced<Biases>,
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
    /// Sets the bounds of the config, in metres of view depth, and the biases of the light to the values of a fit, for
    /// Bevy's renderer. The user's values are kept. Change detection does not see it: Bevy makes new cascades in each
    /// frame, so the renderer extracts all lights in each frame.
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

    /// Gives the user's values back.
    pub(crate) fn give_back(&mut self, config: &mut Mut<CascadeShadowConfig>, light: &mut Mut<DirectionalLight>) {
        let Some(Lent { bounds, biases }) = self.lent.take() else { return };
        bounds.give_back(&mut config.bypass_change_detection().bounds);
        let light = light.bypass_change_detection();
        let mut place = Biases::of(light);
        biases.give_back(&mut place);
        place.set(light);
    }
}

/// Gives all users their values back, for Bevy's own cascades and whoever looks at them.
pub(crate) fn give_back(mut lights: Query<(&mut FitMemory, &mut CascadeShadowConfig, &mut DirectionalLight)>) {
    for (mut memory, mut config, mut light) in &mut lights {
        memory.give_back(&mut config, &mut light);
    }
}
