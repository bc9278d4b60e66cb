//! Sharper, calmer and complete sun shadows for Bevy: shadowfit's fits replace Bevy's cascades.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_shadowfit::prelude::*;
//!
//! fn main() {
//!     App::new().add_plugins((DefaultPlugins, ShadowfitPlugin)).add_systems(Startup, spawn).run();
//! }
//!
//! fn spawn(mut commands: Commands) {
//!     let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
//!     commands.spawn((sun, FittedShadows::default(), Transform::default().looking_to(Vec3::new(0.3, -0.8, 0.2), Vec3::Y)));
//! }
//! ```
//!
//! Bevy's renderer stays the same, with its passes, maps, filters and culling. The plugin replaces the
//! position of a light's cascades, in a system that runs after Bevy's cascade system and before their first
//! use ([`ShadowfitSystems::Fit`]). [`Fit::Windows`], the default, also extends two functions of Bevy's
//! shader library. The other fits do not change it.

use bevy::asset::AssetEventSystems;
use bevy::camera::visibility::VisibilitySystems;
use bevy::light::SimulationLightSystems;
use bevy::prelude::*;

use clusters::MeshClusters;
use windows_shader::WindowsShader;

mod bias;
mod cascade;
mod clusters;
mod fit;
mod histogram;
mod memory;
mod problem;
mod settings;
mod view;
mod windows_shader;

pub use bias::{WINDOWS_MAX_TANGENT, WINDOWS_SLOPE_BIAS};
pub use clusters::WholeBox;
pub use settings::{Fit, FitBias, FitSplits, FittedShadows};

/// Items for users of the plugin.
pub mod prelude {
    pub use crate::{Fit, FitBias, FitSplits, FittedShadows, ShadowfitPlugin, ShadowfitSystems, WholeBox};
}

/// Plugin that fits the cascades of lights with [`FittedShadows`]. Add it after `DefaultPlugins`.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadowfitPlugin;

/// Sets of the plugin's systems, to order other systems before or after them.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShadowfitSystems {
    /// In `First`: restores the bounds and biases that the user set.
    GiveBack,
    /// In `PostUpdate`, after [`SimulationLightSystems::UpdateDirectionalLightCascades`] and
    /// [`VisibilitySystems::CheckVisibility`], before [`SimulationLightSystems::UpdateLightFrusta`]: sets the
    /// cascades, bounds and biases of this frame's fit.
    Fit,
}

impl Plugin for ShadowfitPlugin {
    fn build(&self, app: &mut App) {
        histogram::add(app);
        app.register_type::<FittedShadows>()
            .register_type::<WholeBox>()
            .init_resource::<MeshClusters>()
            .init_resource::<WindowsShader>()
            .add_observer(fit::forget)
            .add_systems(First, memory::give_back.in_set(ShadowfitSystems::GiveBack))
            .add_systems(
                PostUpdate,
                (clusters::update_clusters.after(AssetEventSystems), windows_shader::extend, fit::fit_cascades)
                    .chain()
                    .in_set(ShadowfitSystems::Fit),
            )
            .configure_sets(
                PostUpdate,
                ShadowfitSystems::Fit
                    .after(SimulationLightSystems::UpdateDirectionalLightCascades)
                    .after(VisibilitySystems::CheckVisibility)
                    .before(SimulationLightSystems::UpdateLightFrusta),
            );
    }
}

/// Runs the example of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
