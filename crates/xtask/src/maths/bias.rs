//! Why a slope shadows itself, how far it has to be lifted, and what each form of bias costs by angle.

use anyhow::Result;
use shadowfit::bias::{Reach, acos_bias, acos_epsilon, normal_offset, receiver_plane_depth};
use shadowfit::glam::{DVec2, DVec3};
use shadowfit::settings::{FilterKind, FitKind};
use shadowfit::{FitInput, LightFit};

use super::canvas::{BLUE, Canvas, Frame, GREEN, GREY, INK, PALE, RED, Side, YELLOW, fill, stroke};
use super::scene::{axes, camera, fit_one, plain_fit};

/// Slope of the plane in the picture, in degrees from facing the light.
const SLOPE: f64 = 32.0;

pub(super) fn draw() -> Result<String> {
    let view = [camera(30.0, -5.0, 0.8, 20.0).frustum()?];
    let input = FitInput::new(&view, shadowfit::glam::Vec3::new(0.3, -0.8, 0.2));
    let settings = plain_fit().with_kind(FitKind::Sphere).with_caster_extension(30.0);
    let fit = fit_one(&input, &settings)?;
    let mut canvas = Canvas::new(424.0, "A slope under its stored depths, and biases by angle");
    stairs(&mut canvas, &fit)?;
    plot(&mut canvas, &fit)?;
    Ok(canvas.finish())
}

/// Normal of a plane that falls along the map's x by an angle in degrees.
fn normal(fit: &LightFit, degrees: f64) -> DVec3 {
    let [x, _, to_light] = axes(fit);
    let (sin, cos) = libm::sincos(degrees.to_radians());
    to_light * cos - x * sin
}

/// The plane, one stored depth a texel, and the plane lifted by the normal offset; lengths in texels.
fn stairs(canvas: &mut Canvas, fit: &LightFit) -> Result<()> {
    let slope = libm::tan(SLOPE.to_radians());
    let frame = Frame::scaled(DVec2::ZERO, DVec2::new(190.0, 186.0), 74.0);
    let on_plane = |x: f64| DVec2::new(x, slope * x);
    let texels = || (-2..2).map(f64::from);
    for x in texels() {
        let (a, b) = (frame.at(DVec2::new(x, 2.0)), frame.at(DVec2::new(x, -1.9)));
        canvas.line(a, b, stroke(PALE, 1.0));
        // Where the stored depth is nearer to the light than the plane, the plane is in its own shadow.
        canvas.polygon(
            [on_plane(x), on_plane(x + 0.5), DVec2::new(x, slope * (x + 0.5))].map(|p| frame.at(p)),
            fill(RED, 0.35),
        );
    }
    canvas.line(frame.at(on_plane(-2.0)), frame.at(on_plane(2.0)), stroke(INK, 2.5));
    for x in texels() {
        let height = slope * (x + 0.5);
        canvas.line(frame.at(DVec2::new(x, height)), frame.at(DVec2::new(x + 1.0, height)), stroke(BLUE, 2.5));
        canvas.circle(frame.at(on_plane(x + 0.5)), 3.0, fill(BLUE, 1.0));
        canvas.line(frame.at(on_plane(x)), frame.at(on_plane(x + 0.5)), stroke(RED, 4.0));
    }
    let lift = f64::from(normal_offset(fit, Reach::POINT, normal(fit, SLOPE).as_vec3())? / fit.texel_size.x);
    let (sin, cos) = libm::sincos(SLOPE.to_radians());
    let along = DVec2::new(-sin, cos);
    let lifted = |x: f64| on_plane(x) + along * lift;
    canvas.line(frame.at(lifted(-2.0)), frame.at(lifted(2.2)), stroke(GREEN, 2.0).dashed());
    let foot = 1.5;
    canvas.arrow(frame.at(on_plane(foot)), frame.at(lifted(foot)), GREEN, 2.0);
    canvas.bold(frame.at(lifted(foot)) + DVec2::new(-6.0, -8.0), Side::Left, GREEN, "h");
    canvas.arrow(DVec2::new(80.0, 40.0), DVec2::new(80.0, 92.0), YELLOW, 2.5);
    canvas.label(DVec2::new(90.0, 62.0), Side::Right, "light");
    let line = |y: f64| DVec2::new(24.0, y);
    canvas.text(line(368.0), Side::Right, BLUE, "blue: one stored depth for each texel");
    canvas.text(line(386.0), Side::Right, RED, "red: stored depth before the plane, acne");
    canvas.text(line(404.0), Side::Right, GREEN, &format!("lifted by h = {lift:.2} texels: clear (E = 0.5)"));
    Ok(())
}

/// Biases by the angle between normal and light, as texels along the light or the normal.
fn plot(canvas: &mut Canvas, fit: &LightFit) -> Result<()> {
    let (min, max) = (DVec2::new(424.0, 44.0), DVec2::new(690.0, 316.0));
    let frame = Frame::stretched(DVec2::ZERO, DVec2::new(90.0, 4.0), min, max);
    canvas.path([min, DVec2::new(min.x, max.y), max], stroke(INK, 1.0));
    canvas.bold(min - DVec2::new(0.0, 16.0), Side::Right, INK, "bias, texels (2×2, E = 1)");
    for value in 0..=4 {
        let at = frame.at(DVec2::new(0.0, f64::from(value)));
        canvas.small(at + DVec2::new(-6.0, 4.0), Side::Left, GREY, &format!("{value}"));
    }
    for angle in [0.0, 30.0, 60.0, 90.0] {
        let at = frame.at(DVec2::new(angle, 0.0));
        canvas.small(at + DVec2::new(0.0, 16.0), Side::Middle, GREY, &format!("{angle}°"));
    }
    canvas.small(DVec2::new(557.0, 349.0), Side::Middle, GREY, "θ, angle between normal and light");
    let texel = fit.texel_size.x;
    let (mut offsets, mut depths, mut classic) = (Vec::new(), Vec::new(), Vec::new());
    for degrees in (0..=89).map(f64::from) {
        let n = normal(fit, degrees).as_vec3();
        let push = |curve: &mut Vec<DVec2>, value: f32| {
            if value <= 4.0 {
                curve.push(frame.at(DVec2::new(degrees, f64::from(value))));
            }
        };
        push(&mut offsets, normal_offset(fit, FilterKind::Hardware2x2, n)? / texel);
        push(&mut depths, receiver_plane_depth(fit, FilterKind::Hardware2x2, n)? * fit.depth_range / texel);
        let cosine = n.dot(-fit.direction);
        push(&mut classic, acos_bias(acos_epsilon(FilterKind::Hardware2x2), cosine)? * fit.depth_range / texel);
    }
    canvas.path(classic, stroke(GREY, 2.2).dashed());
    canvas.path(depths, stroke(RED, 2.5));
    canvas.path(offsets, stroke(GREEN, 2.5));
    let line = |y: f64| DVec2::new(424.0, y);
    canvas.text(line(368.0), Side::Right, GREEN, "normal offset: E sin θ");
    canvas.text(line(386.0), Side::Right, RED, "depth bias: E tan θ");
    canvas.text(line(404.0), Side::Right, GREY, "dashed: the old ε / acos(N·L)");
    Ok(())
}
