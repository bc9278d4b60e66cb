//! Splits by depth alone: the same view split by three schemes.

use anyhow::Result;
use shadowfit::glam::{DVec2, Vec3};
use shadowfit::settings::{FitKind, SplitScheme, Stabilise};
use shadowfit::{FitInput, FittedMaps, MapFitter, Technique, ViewFrustum, Workspace};

use super::canvas::{BLUE, Canvas, Frame, GREEN, GREY, INK, PURPLE, Side, YELLOW, stroke};
use super::scene::{camera, plain_fit, plain_maps};

/// Colours of the maps, the nearest first.
pub(super) const MAPS: [&str; 4] = [BLUE, GREEN, YELLOW, PURPLE];

pub(super) fn draw() -> Result<String> {
    let view = camera(0.0, 0.0, 0.5, 80.0).frustum()?;
    let schemes = [
        ("Uniform", SplitScheme::Uniform),
        ("Practical, λ = 0.5", SplitScheme::Practical(0.5)),
        ("Logarithmic", SplitScheme::Logarithmic),
    ];
    let mut canvas = Canvas::new(430.0, "One view split into four slices by three schemes");
    for (i, (name, splits)) in schemes.into_iter().enumerate() {
        let settings = settings(splits);
        let maps = cascades(&FitInput::new(&[view], Vec3::new(0.3, -0.8, 0.2)), &settings)?;
        row(&mut canvas, &view, &maps, 22.0 + 136.0 * i as f64, name);
    }
    Ok(canvas.finish())
}

/// Four maps around slices of the frustum, without anything that holds them.
fn settings(splits: SplitScheme) -> Technique {
    let fit = plain_fit().with_kind(FitKind::Oriented).with_max_distance(80.0);
    plain_maps().with_fit(fit).with_splits(splits).with_stabilise(Stabilise::Off)
}

/// Fits one frame's maps, with as much storage as that takes.
pub(super) fn cascades(input: &FitInput, settings: &Technique) -> Result<FittedMaps> {
    let count = input
        .receivers
        .map_or(0, |receivers| receivers.boxes.len())
        .max(input.casters.map_or(0, |casters| casters.boxes.len()));
    let mut storage = vec![DVec2::ZERO; Workspace::required(count, input.views.len())];
    Ok(MapFitter::new().fit(input, settings, &mut Workspace::new(&mut storage))?)
}

/// The view from above, split.
fn row(canvas: &mut Canvas, view: &ViewFrustum, maps: &FittedMaps, top: f64, name: &str) {
    let spread = f64::from(view.corners[5].x / view.corners[5].z).abs() * 80.0;
    let (min, max) = (DVec2::new(24.0, top), DVec2::new(696.0, top + 92.0));
    let frame = Frame::stretched(DVec2::new(0.0, -spread), DVec2::new(80.0, spread), min, max);
    let edge = |depth: f64, side: f64| frame.at(DVec2::new(depth, side * spread * depth / 80.0));
    for (map, colour) in maps.iter().zip(MAPS) {
        let (near, far) = (f64::from(map.near), f64::from(map.far.min(80.0)));
        let slice = [edge(near, 1.0), edge(far, 1.0), edge(far, -1.0), edge(near, -1.0)];
        canvas.polygon(slice, stroke(colour, 1.5).filled(colour, 0.35));
        let end = DVec2::new(edge(far, 0.0).x, max.y);
        canvas.line(edge(far, -1.0), end + DVec2::new(0.0, 4.0), stroke(GREY, 0.8));
        let unit = if far == 80.0 { " m" } else { "" };
        let side = if far == 80.0 { Side::Left } else { Side::Middle };
        canvas.label(end + DVec2::new(0.0, 18.0), side, &format!("{far:.1}{unit}").replace(".0", ""));
    }
    canvas.bold(min + DVec2::new(0.0, 12.0), Side::Right, INK, name);
}
