//! The two halves of the window: a camera, a sun and a line of text for each, and the keys for their shadows.
//!
//! A light lights only views that share one of its layers. The meshes are on the layers of both halves.

use bevy::camera::Viewport;
use bevy::camera::visibility::RenderLayers;
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap};
use bevy::prelude::*;
use bevy_shadowfit::{Fit, FitBias, FitSplits, FittedShadows};

use crate::figures::Measured;
use crate::scene::Shown;

/// Widths of the maps, in texels.
const MAP_SIZES: [usize; 4] = [512, 1024, 2048, 4096];
/// Fits of the right half.
const FITS: [Fit; 4] = [Fit::Stable, Fit::Calm, Fit::Histogram, Fit::Windows];
/// View depth at which shadows end, in metres: Bevy's default. In smaller scenes shadows end earlier.
const MAX_DISTANCE: f32 = 150.0;
/// View depth at which Bevy's first cascade ends, in metres: Bevy's default.
const FIRST_BOUND: f32 = 10.0;
/// Height of the text, in per cent of the width of a half: the longest line fits.
const TEXT_SIZE: f32 = 1.75;

/// A half of the window. Its camera, its sun and its line of figures have this component.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Bevy's own cascades.
    Left,
    /// The plugin's cascades.
    Right,
}

/// Spawns the halves.
pub(crate) fn spawn(shown: Res<Shown>, mut commands: Commands) {
    let extent = shown.0.extent();
    let far = (2.0 * extent).max(2.0 * FIRST_BOUND);
    let keys = [
        "WASD QE fly, Shift faster   arrows, drag look   LK IO sun   T path",
        "F fit   B bias   P splits   M size of the maps of both",
    ];
    for (side, keys) in [Side::Left, Side::Right].into_iter().zip(keys) {
        let layers = RenderLayers::layer(1 + side as usize);
        let lens = PerspectiveProjection { fov: shown.0.fov_y(), far, ..default() };
        let camera = Camera { order: side as isize, ..default() };
        let view = (Camera3d::default(), camera, Projection::Perspective(lens), DepthPrepass);
        let camera = commands.spawn((side, view, Measured::default(), layers.clone())).id();
        let light = DirectionalLight {
            color: Color::srgb(1.0, 0.96, 0.9),
            illuminance: 11_000.0,
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
        let (margin, padding) = (px(8), UiRect::axes(px(6), px(3)));
        let at = Node { position_type: PositionType::Absolute, left: margin, padding, ..default() };
        let font = TextFont::from_font_size(FontSize::Vw(TEXT_SIZE));
        let look = (font, BackgroundColor(Color::srgba(0.0, 0.0, 0.0, 0.65)), UiTargetCamera(camera));
        commands.spawn((side, Text::default(), Node { top: margin, ..at.clone() }, look.clone()));
        commands.spawn((Text::new(keys), Node { bottom: margin, ..at }, look));
    }
}

/// Divides the window between the cameras.
pub(crate) fn divide(window: Single<&Window>, mut cameras: Query<(&Side, &mut Camera)>) {
    let size = window.physical_size();
    let middle = size.x / 2;
    for (side, mut camera) in cameras.iter_mut().filter(|_| size.min_element() >= 2) {
        let [from, to] = if *side == Side::Left { [0, middle] } else { [middle, size.x] };
        let (physical_position, physical_size) = (UVec2::new(from, 0), UVec2::new(to - from, size.y));
        camera.viewport = Some(Viewport { physical_position, physical_size, ..default() });
    }
}

/// Changes the shadow settings by keys.
pub(crate) fn choose(
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

/// Returns the value after `current`, or the first one after the last.
fn next<T: Copy + PartialEq>(all: &[T], current: &T) -> T {
    let at = all.iter().position(|one| one == current);
    all[at.map_or(0, |at| (at + 1) % all.len())]
}

/// Writes the figures.
pub(crate) fn write(
    measured: Query<(&Side, &Measured)>,
    fitted: Single<&FittedShadows>,
    mut lines: Query<(&Side, &mut Text)>,
) {
    let FittedShadows { fit, bias, splits } = **fitted;
    let fit = format!("{fit:?}").to_lowercase();
    let [bias, splits] = [bias == FitBias::Ours, splits == FitSplits::Ours].map(|is| if is { "our" } else { "Bevy's" });
    // Windows have no splits.
    let splits = if fit == "windows" { String::new() } else { format!(", {splits} splits") };
    for (side, mut text) in &mut lines {
        let name = match side {
            Side::Left => "Bevy's cascades".to_owned(),
            Side::Right => format!("{fit}, {bias} bias{splits}"),
        };
        let measured = measured.iter().find(|(of, _)| *of == side).and_then(|(_, measured)| measured.figures);
        let figures = measured.map_or("measuring".to_owned(), |figures| figures.to_string());
        text.set_if_neq(Text(format!("{name}   {figures}")));
    }
}
