//! Sharper, calmer, complete sun shadows for Bevy: shadowfit's fits in place of its cascades.
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
//! Bevy's renderer stays as it is: its passes, its maps, its filters, its culling. Where the cascades of a light lie is
//! replaced, by a system that runs after Bevy has made its own and before anything reads them ([`ShadowfitSystems::Fit`]).
//! [`Fit::Windows`], the default, also adds to two functions of Bevy's shader library; the other fits leave it alone.

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

pub use clusters::WholeBox;
pub use settings::{Fit, FitBias, FitSplits, FittedShadows};

/// What users of the plugin name.
pub mod prelude {
    pub use crate::{Fit, FitBias, FitSplits, FittedShadows, ShadowfitPlugin, ShadowfitSystems, WholeBox};
}

/// Fits the cascades of lights that have [`FittedShadows`]. Add it after `DefaultPlugins`.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadowfitPlugin;

/// When the plugin's systems run.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShadowfitSystems {
    /// In `First`: lights have the bounds and biases of their user again.
    GiveBack,
    /// In `PostUpdate`, after [`SimulationLightSystems::UpdateDirectionalLightCascades`] and
    /// [`VisibilitySystems::CheckVisibility`], before [`SimulationLightSystems::UpdateLightFrusta`]: cascades, bounds and
    /// biases are those of this frame's fit.
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
