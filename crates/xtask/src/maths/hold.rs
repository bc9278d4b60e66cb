//! Held maps: a turning camera, its fresh fits, and the few maps that hysteresis makes instead.

use anyhow::Result;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::{FitKind, Stabilise};
use shadowfit::{FitInput, LightFit, MapFitter, PerspectiveCamera, ViewFrustum, Workspace};

use super::canvas::{Canvas, Frame, GREY, INK, Side, fill, stroke};
use super::scene::{Look, axes, camera, draw_frustum, fit_one, plain_fit, plain_maps};
use super::splits::MAPS;

const LIGHT: Vec3 = Vec3::new(0.25, -0.9, 0.2);

/// Frames of the camera's turn.
const FRAMES: usize = 96;

pub(super) fn draw() -> Result<String> {
    let views = views()?;
    let (fresh, held) = (maps(&views, Stabilise::Off)?, maps(&views, Stabilise::Hysteresis)?);
    let mut canvas = Canvas::new(404.0, "A turning camera with fresh and with held maps");
    let plain = plain_fit().with_kind(FitKind::FrustumAabb);
    let plain = fit_one(&FitInput::new(&views[..1], LIGHT), &plain)?;
    let look = Look { origin: DVec3::ZERO, ..Look::from_light(&plain) };
    let all = held.iter().chain(&fresh).flat_map(|fit| look.map(fit));
    let frame = Frame::around(all, DVec2::new(18.0, 18.0), DVec2::new(372.0, 340.0));
    for view in [&views[0], &views[FRAMES - 1]] {
        draw_frustum(&mut canvas, &frame, &look.frustum(view));
    }
    for fit in fresh.iter().step_by(FRAMES / 6) {
        canvas.polygon(look.map(fit)[..4].iter().map(|p| frame.at(*p)), stroke(GREY, 0.9));
    }
    let made = made_anew(&held);
    for (i, colour) in MAPS.into_iter().cycle().take(made.len()).enumerate() {
        let last = made.get(i + 1).copied().unwrap_or(FRAMES) - 1;
        let map = |i: usize| look.map(&held[i]).into_iter().take(4).map(|p| frame.at(p));
        canvas.polygon(map(last), stroke(colour, 1.6).dashed());
        canvas.polygon(map(made[i]), stroke(colour, 2.8));
    }
    canvas.text(DVec2::new(18.0, 366.0), Side::Right, GREY, "grey: some of the 96 fresh fits");
    canvas.label(DVec2::new(18.0, 386.0), Side::Right, "coloured: held maps, dashed when given up");
    plots(&mut canvas, &look, &fresh, &held);
    Ok(canvas.finish())
}

/// A camera that turns by 0.8 degrees a frame while it walks.
fn views() -> Result<Vec<ViewFrustum>> {
    let at = |i: usize| {
        let turned = camera(0.8 * i as f64 - 40.0, -4.0, 0.6, 30.0);
        PerspectiveCamera { eye: DVec3::new(0.03 * i as f64, 1.7, -0.02 * i as f64), ..turned }.frustum()
    };
    Ok((0..FRAMES).map(at).collect::<Result<_, _>>()?)
}

/// One map a frame.
fn maps(views: &[ViewFrustum], stabilise: Stabilise) -> Result<Vec<LightFit>> {
    let settings =
        plain_maps().with_fit(plain_fit().with_kind(FitKind::Oriented)).with_count(1).with_stabilise(stabilise);
    let mut fitter = MapFitter::new();
    let mut fit = |view: &ViewFrustum| {
        let mut storage = [DVec2::ZERO; Workspace::required(0, 1)];
        let input = FitInput::new(std::slice::from_ref(view), LIGHT);
        Ok(fitter.fit(&input, &settings, &mut Workspace::new(&mut storage))?[0].fit)
    };
    views.iter().map(&mut fit).collect()
}

/// Frames at which the texels change their size or direction.
fn made_anew(maps: &[LightFit]) -> Vec<usize> {
    let texels = |fit: &LightFit| (fit.texel_size, fit.light_from_world.x_axis, fit.light_from_world.y_axis);
    (0..maps.len()).filter(|&i| i == 0 || texels(&maps[i]) != texels(&maps[i - 1])).collect()
}

/// Angle of a map about the light, in degrees.
fn turn(look: &Look, fit: &LightFit) -> f64 {
    let [x, ..] = axes(fit);
    libm::atan2(look.up.dot(x), look.right.dot(x)).to_degrees()
}

/// Side of a texel, in centimetres.
fn side(fit: &LightFit) -> f64 {
    libm::sqrt(f64::from(fit.texel_size.x * fit.texel_size.y)) * 100.0
}

/// A plot's name, its place on the page, the ends of its axis, and what it shows of a map.
type Row<'a> = (&'a str, f64, [f64; 2], &'a dyn Fn(&LightFit) -> f64);

/// Angle and texels, frame by frame.
fn plots(canvas: &mut Canvas, look: &Look, fresh: &[LightFit], held: &[LightFit]) {
    let rows: [Row; 2] = [
        ("turn of the map, degrees", 42.0, [-45.0, 45.0], &|fit| turn(look, fit)),
        ("side of a texel, cm", 204.0, [0.0, 2.0], &side),
    ];
    let made = made_anew(held);
    for (name, top, [low, high], value) in rows {
        let (min, max) = (DVec2::new(434.0, top), DVec2::new(696.0, top + 108.0));
        let frame = Frame::stretched(DVec2::new(0.0, low), DVec2::new(FRAMES as f64, high), min, max);
        canvas.path([min, DVec2::new(min.x, max.y), max], stroke(INK, 1.0));
        canvas.bold(min - DVec2::new(0.0, 14.0), Side::Right, INK, name);
        for mark in [low, (low + high) * 0.5, high] {
            let text = format!("{mark}").replace('-', "−");
            canvas.small(frame.at(DVec2::new(0.0, mark)) + DVec2::new(-6.0, 4.0), Side::Left, GREY, &text);
        }
        for (i, fit) in fresh.iter().enumerate() {
            canvas.circle(frame.at(DVec2::new(i as f64 + 0.5, value(fit))), 1.3, fill(GREY, 1.0));
        }
        for (i, colour) in MAPS.into_iter().cycle().take(made.len()).enumerate() {
            let end = made.get(i + 1).copied().unwrap_or(FRAMES);
            let steps = (made[i]..end).flat_map(|i| [0.0, 1.0].map(|t| DVec2::new(i as f64 + t, value(&held[i]))));
            canvas.path(steps.map(|p| frame.at(p)), stroke(colour, 3.2));
        }
    }
    canvas.small(DVec2::new(565.0, 332.0), Side::Middle, GREY, "96 frames");
    let line = |y: f64| DVec2::new(434.0, y);
    canvas.text(line(366.0), Side::Right, GREY, &format!("Off: texels change {} times", made_anew(fresh).len()));
    canvas.label(line(386.0), Side::Right, &format!("Hysteresis: {} maps, still between", made.len()));
}
