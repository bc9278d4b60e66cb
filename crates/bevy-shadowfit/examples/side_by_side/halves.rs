//! The two halves of the window: a camera and a sun each, told apart by render layers, and the keys for their shadows.
//!
//! A light lights only views whose layers it shares. The meshes are on the layers of both halves.

use std::sync::Arc;

use bevy::camera::Viewport;
use bevy::camera::visibility::RenderLayers;
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap};
use bevy::prelude::*;
use bevy_shadowfit::{Fit, FitBias, FitSplits, FittedShadows};

use crate::content::Content;
use crate::flight::Flight;

/// Sizes of the maps that can be chosen, in texels a side.
const MAP_SIZES: [usize; 4] = [512, 1024, 2048, 4096];
/// Fits that can be chosen: those whose cascades are read by view depth, as the measured look-up does it.
const FITS: [Fit; 4] = [Fit::Stable, Fit::Calm, Fit::Histogram, Fit::Windows];
/// View depth at which shadows end, in metres: Bevy's default. Scenes that are smaller end earlier.
const MAX_DISTANCE: f32 = 150.0;
/// View depth at which Bevy's first cascade ends, in metres: its default.
const FIRST_BOUND: f32 = 10.0;
/// View depth of the near plane, in metres: Bevy's default.
const NEAR: f32 = 0.1;
/// Light on a surface that faces the sun, in lux.
const ILLUMINANCE: f32 = 11_000.0;

/// A half of the window; on its camera, its light and its labels.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Bevy's own cascades.
    Left,
    /// The plugin's.
    Right,
}

impl Side {
    pub(crate) const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Its number from the left.
    pub(crate) fn index(self) -> usize {
        self as usize
    }

    /// The layer of its camera and of its light.
    pub(crate) fn layer(self) -> usize {
        1 + self.index()
    }

    /// Where it lies in a window of a size in pixels.
    fn viewport(self, window: UVec2) -> Viewport {
        let middle = window.x / 2;
        let (from, to) = match self {
            Self::Left => (0, middle),
            Self::Right => (middle, window.x),
        };
        Viewport { physical_position: UVec2::new(from, 0), physical_size: UVec2::new(to - from, window.y), ..default() }
    }
}

/// Spawns the halves and keeps them.
pub(crate) fn plugin(app: &mut App, content: &Arc<Content>) {
    let content = content.clone();
    let spawn = move |mut commands: Commands| Side::BOTH.iter().for_each(|side| spawn(*side, &content, &mut commands));
    app.add_systems(PreStartup, spawn).add_systems(Update, (divide, choose, follow.after(crate::flight::fly)));
}

fn spawn(side: Side, content: &Content, commands: &mut Commands) {
    let extent = content.extent();
    let layers = RenderLayers::layer(side.layer());
    let lens = PerspectiveProjection {
        fov: content.start_view().fov_y,
        near: NEAR,
        far: (2.0 * extent).max(2.0 * FIRST_BOUND),
        ..default()
    };
    let camera = Camera { order: side.index() as isize, ..default() };
    commands.spawn((side, Camera3d::default(), camera, Projection::Perspective(lens), DepthPrepass, layers.clone()));
    let light = DirectionalLight {
        color: Color::srgb(1.0, 0.96, 0.9),
        illuminance: ILLUMINANCE,
        shadow_maps_enabled: true,
        ..default()
    };
    let config = CascadeShadowConfigBuilder {
        first_cascade_far_bound: FIRST_BOUND,
        maximum_distance: extent.clamp(2.0 * FIRST_BOUND, MAX_DISTANCE),
        ..default()
    };
    let mut sun = commands.spawn((side, light, config.build(), layers));
    if side == Side::Right {
        sun.insert(FittedShadows::default());
    }
}

/// Divides the window between the cameras.
fn divide(window: Single<&Window>, mut cameras: Query<(&Side, &mut Camera)>) {
    let size = window.physical_size();
    if size.min_element() < 2 {
        return;
    }
    for (side, mut camera) in &mut cameras {
        let viewport = side.viewport(size);
        let is_set = camera.viewport.as_ref().is_some_and(|set| {
            set.physical_position == viewport.physical_position && set.physical_size == viewport.physical_size
        });
        if !is_set {
            camera.viewport = Some(viewport);
        }
    }
}

/// Moves cameras and lights to where the flight is.
fn follow(
    flight: Res<Flight>,
    mut cameras: Query<&mut Transform, (With<Camera3d>, Without<DirectionalLight>)>,
    mut lights: Query<&mut Transform, With<DirectionalLight>>,
) {
    for mut camera in &mut cameras {
        camera.set_if_neq(flight.camera());
    }
    for mut light in &mut lights {
        light.set_if_neq(flight.sun());
    }
}

/// Keys for the shadows.
fn choose(
    keys: Res<ButtonInput<KeyCode>>,
    mut maps: ResMut<DirectionalLightShadowMap>,
    mut fitted: Single<&mut FittedShadows>,
) {
    if keys.just_pressed(KeyCode::KeyM) {
        maps.size = next(&MAP_SIZES, &maps.size);
    }
    if keys.just_pressed(KeyCode::KeyF) {
        fitted.fit = next(&FITS, &fitted.fit);
    }
    if keys.just_pressed(KeyCode::KeyB) {
        fitted.bias = next(&[FitBias::Ours, FitBias::Bevys], &fitted.bias);
    }
    if keys.just_pressed(KeyCode::KeyP) {
        fitted.splits = next(&[FitSplits::Ours, FitSplits::Bevys], &fitted.splits);
    }
}

/// The one after `current`, and the first one after the last.
fn next<T: Copy + PartialEq>(all: &[T], current: &T) -> T {
    let at = all.iter().position(|one| one == current);
    all[at.map_or(0, |at| (at + 1) % all.len())]
}
