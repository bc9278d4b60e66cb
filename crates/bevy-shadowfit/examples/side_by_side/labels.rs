//! The lines of text: figures over each half, keys below.

use bevy::prelude::*;
use bevy_shadowfit::{FitBias, FitSplits, FittedShadows};

use crate::figures::Measured;
use crate::halves::Side;

/// Height of the text, in per cent of the width of a half: the longest line fits.
const TEXT_SIZE: f32 = 1.75;
/// Distance of text from the borders of a half, in pixels.
const MARGIN: f32 = 8.0;
/// Behind text, so that it can be read before anything.
const BEHIND: Color = Color::srgba(0.0, 0.0, 0.0, 0.65);

/// A line of figures.
#[derive(Component)]
struct FigureLine;

/// Adds the lines.
pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Startup, spawn).add_systems(Update, write);
}

fn spawn(mut commands: Commands, cameras: Query<(Entity, &Side), With<Camera3d>>) {
    for (camera, side) in &cameras {
        let (margin, inner) = (Val::Px(MARGIN), UiRect::axes(Val::Px(6.0), Val::Px(3.0)));
        let at = Node { position_type: PositionType::Absolute, left: margin, padding: inner, ..default() };
        let look =
            || (TextFont::from_font_size(FontSize::Vw(TEXT_SIZE)), BackgroundColor(BEHIND), UiTargetCamera(camera));
        commands.spawn((*side, FigureLine, Text::default(), Node { top: margin, ..at.clone() }, look()));
        commands.spawn((Text::new(keys(*side)), Node { bottom: margin, ..at }, look()));
    }
}

fn keys(side: Side) -> &'static str {
    match side {
        Side::Left => "WASD QE fly, Shift faster   arrows, drag look   LK IO sun   T path",
        Side::Right => "F fit   B bias   P splits   M size of the maps of both",
    }
}

fn write(
    measured: Res<Measured>,
    fitted: Single<&FittedShadows>,
    mut lines: Query<(&Side, &mut Text), With<FigureLine>>,
) {
    for (side, mut text) in &mut lines {
        let name = match side {
            Side::Left => "Bevy's cascades".to_owned(),
            Side::Right => name(&fitted),
        };
        let figures = match measured.figures(*side) {
            Some(figures) => {
                format!("pixels per texel, 95%: {:.2}   wrong: {:.2}%", figures.pixels_per_texel, figures.wrong)
            }
            None => "measuring".to_owned(),
        };
        let line = format!("{name}   {figures}");
        if text.0 != line {
            text.0 = line;
        }
    }
}

/// Such as `shadowfit calm, our bias and splits`.
fn name(FittedShadows { fit, bias, splits }: &FittedShadows) -> String {
    let fit = format!("{fit:?}").to_lowercase();
    let whose = |is_ours: bool| if is_ours { "our" } else { "Bevy's" };
    let [bias, splits] = [*bias == FitBias::Ours, *splits == FitSplits::Ours].map(whose);
    if bias == splits {
        return format!("shadowfit {fit}, {bias} bias and splits");
    }
    format!("shadowfit {fit}, {bias} bias, {splits} splits")
}
