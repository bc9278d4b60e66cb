//! Draws held maps: a turning camera, its fresh fits, and the few maps that hysteresis keeps instead.

use anyhow::Result;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::{FitKind, FitSettings, Stabilise};
use shadowfit::{FitInput, LightProjection, PerspectiveCamera, ViewFrustum};

use super::canvas::{Canvas, Frame, GREY, INK, LEFT, MAPS, MIDDLE, RIGHT, fill, stroke};
use super::scene::{Fitter, Look, camera, draw_frustum, one_map, plain_fit};

const LIGHT: Vec3 = Vec3::new(0.25, -0.9, 0.2);

/// Number of frames of the camera's turn.
const FRAMES: usize = 96;

pub(super) fn draw() -> Result<String> {
    let views: Vec<ViewFrustum> = (0..FRAMES).map(view).collect::<Result<_>>()?;
    let oriented = plain_fit(FitKind::Oriented);
    let (fresh, held) = (maps(&views, oriented, Stabilise::Off)?, maps(&views, oriented, Stabilise::default())?);
    let plain = maps(&views[..1], plain_fit(FitKind::FrustumAabb), Stabilise::Off)?;
    let look = Look { origin: DVec3::ZERO, ..Look::from_light(&plain[0]) };
    let runs = runs(&held);
    let mut canvas = Canvas::new(404.0, "A turning camera with fresh and with held maps");
    let all = held.iter().chain(&fresh).flat_map(|fit| look.map(fit));
    let frame = Frame::around(all, DVec2::new(18.0, 18.0), DVec2::new(372.0, 340.0));
    for view in [&views[0], &views[FRAMES - 1]] {
        draw_frustum(&mut canvas, &frame, &look.frustum(view));
    }
    let rectangle = |fit: &LightProjection| look.map(fit).map(|p| frame.at(p));
    for fit in fresh.iter().step_by(FRAMES / 6) {
        canvas.polygon(rectangle(fit), stroke(GREY, 0.9));
    }
    for (&[first, end], colour) in runs.iter().zip(MAPS.into_iter().cycle()) {
        canvas.polygon(rectangle(&held[end - 1]), stroke(colour, 1.6).dashed());
        canvas.polygon(rectangle(&held[first]), stroke(colour, 2.8));
    }
    canvas.text(DVec2::new(18.0, 366.0), RIGHT, GREY, "grey: some of the 96 fresh fits");
    canvas.text(DVec2::new(18.0, 386.0), RIGHT, INK, "coloured: held maps, dashed when given up");
    let turn = |fit: &LightProjection| {
        let x = Look::from_light(fit).right;
        libm::atan2(look.up.dot(x), look.right.dot(x)).to_degrees()
    };
    let side = |fit: &LightProjection| libm::sqrt(f64::from(fit.texel_size.x * fit.texel_size.y)) * 100.0;
    plot(&mut canvas, ("turn of the map, degrees", 42.0, [-45.0, 45.0]), &turn, &fresh, &held);
    plot(&mut canvas, ("side of a texel, cm", 204.0, [0.0, 2.0]), &side, &fresh, &held);
    canvas.small(DVec2::new(565.0, 332.0), MIDDLE, GREY, "96 frames");
    let line = |y: f64| DVec2::new(434.0, y);
    canvas.text(line(366.0), RIGHT, GREY, &format!("Off: texels change {} times", self::runs(&fresh).len()));
    canvas.text(line(386.0), RIGHT, INK, &format!("Hysteresis: {} maps, still between", runs.len()));
    Ok(canvas.finish())
}

/// Returns the view of a camera that turns by 0.8 degrees per frame while it walks.
fn view(frame: usize) -> Result<ViewFrustum> {
    let turned = camera(0.8 * frame as f64 - 40.0, -4.0, 0.6, 30.0);
    let eye = DVec3::new(0.03 * frame as f64, 1.7, -0.02 * frame as f64);
    Ok(PerspectiveCamera { eye, ..turned }.frustum()?)
}

/// Returns one map per frame.
fn maps(views: &[ViewFrustum], fit: FitSettings, stabilise: Stabilise) -> Result<Vec<LightProjection>> {
    let technique = one_map(fit);
    let technique = technique.with_maps(technique.maps.with_stabilise(stabilise));
    let mut fitter = Fitter::new();
    let fit = |view| Ok(fitter.fit(&FitInput::new(std::slice::from_ref(view), LIGHT), &technique)?[0].projection);
    views.iter().map(fit).collect()
}

/// Returns runs of frames with constant texel size and direction, each as its first frame and the frame after
/// its last.
fn runs(maps: &[LightProjection]) -> Vec<[usize; 2]> {
    let texels = |fit: &LightProjection| (fit.texel_size, fit.light_from_world.x_axis, fit.light_from_world.y_axis);
    let runs = maps.chunk_by(|a, b| texels(a) == texels(b));
    runs.scan(0, |first, run| {
        let begin = *first;
        *first += run.len();
        Some([begin, *first])
    })
    .collect()
}

/// Plots a figure of all maps, frame by frame, with its name, its position on the page and the ends of its
/// axis.
fn plot(
    canvas: &mut Canvas,
    (name, top, [low, high]): (&str, f64, [f64; 2]),
    figure: &dyn Fn(&LightProjection) -> f64,
    fresh: &[LightProjection],
    held: &[LightProjection],
) {
    let (min, max) = (DVec2::new(434.0, top), DVec2::new(696.0, top + 108.0));
    let frame = Frame::stretched(DVec2::new(0.0, low), DVec2::new(FRAMES as f64, high), min, max);
    canvas.path([min, DVec2::new(min.x, max.y), max], stroke(INK, 1.0));
    canvas.bold(min - DVec2::new(0.0, 14.0), RIGHT, INK, name);
    for mark in [low, (low + high) * 0.5, high] {
        let text = format!("{mark}").replace('-', "−");
        canvas.small(frame.at(DVec2::new(0.0, mark)) + DVec2::new(-6.0, 4.0), LEFT, GREY, &text);
    }
    for (i, fit) in fresh.iter().enumerate() {
        canvas.circle(frame.at(DVec2::new(i as f64 + 0.5, figure(fit))), 1.3, fill(GREY, 1.0));
    }
    for ([first, end], colour) in runs(held).into_iter().zip(MAPS.into_iter().cycle()) {
        let steps = (first..end).flat_map(|i| [0.0, 1.0].map(|t| DVec2::new(i as f64 + t, figure(&held[i]))));
        canvas.path(steps.map(|p| frame.at(p)), stroke(colour, 3.2));
    }
}
