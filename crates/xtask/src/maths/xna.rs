//! The XNA sample's depth: the light stands at the far face, so half of the range is empty.

use anyhow::Result;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{Aabb, FitInput, LightFit, ViewFrustum};

use super::canvas::{BLUE, Canvas, Frame, GREEN, GREY, INK, RED, Side, YELLOW, bounds, stroke};
use super::scene::{Look, camera, draw_body, draw_frustum, fit_one, plain_fit};

/// A light in the page's plane.
const LIGHT: Vec3 = Vec3::new(0.5, -0.86, 0.0);

/// A caster out of view, toward the light.
const CASTER: Aabb = Aabb::new(Vec3::new(1.0, 9.5, -0.8), Vec3::new(3.2, 11.5, 0.8));

pub(super) fn draw() -> Result<String> {
    let view = camera(90.0, 4.0, 0.8, 15.0).frustum()?;
    let views = [view];
    let input = FitInput::new(&views, LIGHT);
    let settings = plain_fit().with_caster_extension(9.0);
    let tight = fit_one(&input, &settings)?;
    let xna = fit_one(&input, &settings.with_kind(FitKind::XnaSample))?;
    let look = Look::from_side(&tight);
    let mut canvas = Canvas::new(470.0, "Depth of the XNA sample's map and of the frustum's box, from the side");
    let (low, high) = bounds(look.map(&xna).into_iter().chain(look.map(&tight)));
    let scale = 380.0 / (high.y - low.y);
    let panel = |x: f64| Frame::scaled((low + high) * 0.5, DVec2::new(x, 228.0), scale);
    let (left, right) = (panel(180.0), panel(510.0));
    side(&mut canvas, &left, &look, &view, &xna, RED);
    side(&mut canvas, &right, &look, &view, &tight, BLUE);
    depths(&mut canvas, &left, &look, &xna);
    depths(&mut canvas, &right, &look, &tight);
    let top = look.frustum(&view).iter().map(|p| p.y).fold(f64::MIN, f64::max);
    let (_, high) = bounds(look.map(&tight));
    let beside = |z: f64| right.at(DVec2::new(high.x, z)) + DVec2::new(12.0, 0.0);
    canvas.measure(beside(top), beside(high.y), INK);
    canvas.label((beside(top) + beside(high.y)) * 0.5 + DVec2::new(8.0, -3.0), Side::Right, "caster");
    canvas.label((beside(top) + beside(high.y)) * 0.5 + DVec2::new(8.0, 15.0), Side::Right, "extension");
    canvas.bold(DVec2::new(180.0, 450.0), Side::Middle, RED, "XNA sample");
    canvas.bold(DVec2::new(510.0, 450.0), Side::Middle, BLUE, "Frustum AABB");
    Ok(canvas.finish())
}

fn side(canvas: &mut Canvas, frame: &Frame, look: &Look, view: &ViewFrustum, fit: &LightFit, colour: &'static str) {
    let (low, high) = bounds(look.map(fit));
    canvas.rectangle(frame.at(low), frame.at(high), stroke(colour, 2.5).filled(colour, 0.05));
    draw_frustum(canvas, frame, &look.frustum(view));
    let caster = look.aabb(&CASTER);
    let is_stored = caster.iter().all(|p| p.y < high.y);
    let (colour, word) = if is_stored { (GREEN, "stored") } else { (RED, "lost") };
    draw_body(canvas, frame, &caster, stroke(colour, 1.5).filled(colour, 0.35), stroke(colour, 0.8));
    let (low, high) = bounds(caster.map(|p| frame.at(p)));
    let below = DVec2::new((low.x + high.x) * 0.5, high.y + 18.0);
    canvas.text(below, Side::Middle, colour, &format!("caster: {word}"));
}

/// Names the planes of a map by the depth that it stores there.
fn depths(canvas: &mut Canvas, frame: &Frame, look: &Look, fit: &LightFit) {
    let (low, high) = bounds(look.map(fit));
    let light = look.at(fit.light_position());
    let label = |canvas: &mut Canvas, z: f64, text: &str| {
        let at = frame.at(DVec2::new(low.x, z));
        canvas.line(at - DVec2::new(6.0, 0.0), at, stroke(INK, 1.2));
        canvas.label(at + DVec2::new(-10.0, 5.0), Side::Left, text);
    };
    label(canvas, high.y, "0");
    label(canvas, low.y, "1");
    let stored = |p: DVec3| fit.clip_from_world.as_dmat4().transform_point3(p - fit.origin).z;
    let at_light = stored(fit.light_position());
    let at = frame.at(light);
    if at_light > 0.25 {
        label(canvas, light.y, "½");
        canvas.line(
            frame.at(DVec2::new(low.x, light.y)),
            frame.at(DVec2::new(high.x, light.y)),
            stroke(RED, 1.2).dashed(),
        );
        canvas.text(
            frame.at(DVec2::new(light.x, (low.y + light.y) * 0.5)),
            Side::Middle,
            GREY,
            "empty half of the range",
        );
    }
    canvas.circle(at, 8.0, stroke(INK, 1.2).filled(YELLOW, 1.0));
    let below = if at_light > 0.25 { 22.0 } else { -14.0 };
    canvas.label(at + DVec2::new(0.0, below), Side::Middle, "the light");
}
