//! Rotating calipers: the outline, its least rectangle and square, and what every other angle costs.

use anyhow::Result;
use shadowfit::FitInput;
use shadowfit::glam::{DVec2, Vec3};
use shadowfit::settings::{FitKind, RectangleKind};

use super::canvas::{BLUE, Canvas, Frame, GREY, INK, PALE, PURPLE, Side, bounds, fill, stroke};
use super::scene::{Look, axes, camera, draw_frustum, fit_one, hull, plain_fit};

const LIGHT: Vec3 = Vec3::new(0.3, -0.85, 0.2);

pub(super) fn draw() -> Result<String> {
    let view = [camera(40.0, -4.0, 0.42, 40.0).frustum()?];
    let input = FitInput::new(&view, LIGHT);
    let look = Look::from_light(&fit_one(&input, &plain_fit())?);
    let settings = plain_fit().with_kind(FitKind::Oriented);
    let area = fit_one(&input, &settings)?;
    let square = fit_one(&input, &settings.with_rectangle(RectangleKind::MinimumSquare))?;
    let mut canvas = Canvas::new(392.0, "The least rectangle and the least square around an outline");

    let (areas, squares) = (look.map(&area), look.map(&square));
    let all = areas.into_iter().chain(squares);
    let frame = Frame::around(all, DVec2::new(20.0, 24.0), DVec2::new(320.0, 332.0));
    let corners = look.frustum(&view[0]);
    draw_frustum(&mut canvas, &frame, &corners);
    let outline = hull(&corners);
    canvas.polygon(outline.iter().map(|p| frame.at(*p)), stroke(INK, 1.5));
    for (map, colour) in [(&areas, BLUE), (&squares, PURPLE)] {
        canvas.polygon(map[..4].iter().map(|p| frame.at(*p)), stroke(colour, 2.2));
    }
    canvas.text(DVec2::new(20.0, 356.0), Side::Right, BLUE, "least area: one side on an edge");
    canvas.text(DVec2::new(20.0, 376.0), Side::Right, PURPLE, "least square: may lie between edges");

    let angle_of = |fit| {
        let [x, ..] = axes(fit);
        libm::atan2(look.up.dot(x), look.right.dot(x)).to_degrees()
    };
    plot(&mut canvas, &outline, angle_of(&area), angle_of(&square));
    Ok(canvas.finish())
}

/// Width and height of a polygon's rectangle at an angle in degrees.
fn size(outline: &[DVec2], degrees: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let axis = DVec2::new(cos, sin);
    let (low, high) = bounds(outline.iter().map(|p| DVec2::new(p.dot(axis), p.dot(axis.perp()))));
    high - low
}

/// Area and longer side by angle, with the angles of the edges and those that the fits chose.
fn plot(canvas: &mut Canvas, outline: &[DVec2], area: f64, square: f64) {
    let costs = [|s: DVec2| s.x * s.y, |s: DVec2| s.max_element()];
    let places = [(BLUE, area, "least area, m²", 34.0), (PURPLE, square, "least longer side, m", 204.0)];
    for (cost, (colour, chosen, name, top)) in costs.into_iter().zip(places) {
        let values: Vec<f64> = (-90..=90).map(|i| cost(size(outline, f64::from(i) * 0.5))).collect();
        let (least, most) = values.iter().fold((f64::MAX, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
        let low = DVec2::new(-45.0, least - 0.15 * (most - least));
        let (min, max) = (DVec2::new(404.0, top), DVec2::new(696.0, top + 120.0));
        let frame = Frame::stretched(low, DVec2::new(45.0, most), min, max);
        for i in 0..outline.len() {
            let edge = outline[(i + 1) % outline.len()] - outline[i];
            let angle = libm::atan2(edge.y, edge.x).to_degrees();
            let angle = angle - 90.0 * libm::round(angle / 90.0);
            let x = frame.at(DVec2::new(angle, 0.0)).x;
            canvas.line(DVec2::new(x, min.y), DVec2::new(x, max.y), stroke(PALE, 1.5));
        }
        let curve = values.iter().enumerate().map(|(i, v)| frame.at(DVec2::new(i as f64 * 0.5 - 45.0, *v)));
        canvas.path(curve, stroke(colour, 2.0));
        canvas.line(DVec2::new(min.x, max.y), max, stroke(INK, 1.0));
        let best = frame.at(DVec2::new(chosen, cost(size(outline, chosen))));
        canvas.circle(best, 5.0, fill(colour, 1.0));
        let heading = format!("{name}: {:.1}", cost(size(outline, chosen)));
        canvas.bold(min + DVec2::new(0.0, -8.0), Side::Right, colour, &heading);
        for angle in [-45.0, 0.0, 45.0] {
            let x = frame.at(DVec2::new(angle, 0.0)).x;
            canvas.small(DVec2::new(x, max.y + 16.0), Side::Middle, GREY, &format!("{angle}°").replace('-', "−"));
        }
    }
    canvas.text(DVec2::new(550.0, 376.0), Side::Middle, GREY, "turn of the map; grey: directions of edges");
}
