//! Where the caster policies put the near plane.

use anyhow::Result;
use shadowfit::glam::{DVec2, Vec3};
use shadowfit::settings::{CasterPolicy, FitKind};
use shadowfit::{Aabb, FitInput};

use super::canvas::{BLUE, Canvas, Frame, GREEN, GREY, INK, PURPLE, RED, Side, bounds, fill, stroke};
use super::scene::{Look, boxes, camera, draw_body, draw_frustum, fit_one, hull, plain_fit};

const LIGHT: Vec3 = Vec3::new(0.5, -0.86, 0.0);

/// Casters: a tower of which a part is over the outline, a house in view, a crane that is beside it, a far mast.
const CASTERS: [Aabb; 4] = [
    Aabb::new(Vec3::new(-7.5, 0.0, -1.0), Vec3::new(-1.0, 9.0, 1.0)),
    Aabb::new(Vec3::new(8.0, 0.0, -0.7), Vec3::new(11.0, 4.0, 0.7)),
    Aabb::new(Vec3::new(22.0, 4.5, -0.7), Vec3::new(26.0, 8.5, 0.7)),
    Aabb::new(Vec3::new(-14.0, 3.0, -0.7), Vec3::new(-12.5, 14.0, 0.7)),
];

pub(super) fn draw() -> Result<String> {
    let view = [camera(90.0, 0.0, 0.7, 16.0).frustum()?];
    let input = FitInput { casters: Some(boxes(&CASTERS)), ..FitInput::new(&view, LIGHT) };
    let settings = plain_fit().with_kind(FitKind::Oriented).with_caster_extension(16.0);
    let fit = |policy| fit_one(&input, &settings.with_casters(policy));
    let list = fit(CasterPolicy::List)?;
    let look = Look::from_side(&fit_one(&input, &settings.with_kind(FitKind::FrustumAabb))?);
    let mut canvas = Canvas::new(470.0, "Near planes by caster policy, from the side");
    let policies = [
        (CasterPolicy::Extend, GREY, "Extend, by 16 m"),
        (CasterPolicy::SceneBounds, PURPLE, "SceneBounds"),
        (CasterPolicy::List, GREEN, "List"),
        (CasterPolicy::None, RED, "None, DepthClamp"),
    ];
    let mut maps = Vec::new();
    for (policy, colour, name) in policies {
        let (low, high) = bounds(look.map(&fit(policy)?));
        maps.push((low, high, colour, name));
    }
    let corners = CASTERS.iter().flat_map(|aabb| look.aabb(aabb));
    let frame = Frame::around(
        corners.chain(maps.iter().map(|map| map.1)).chain(look.map(&list)),
        DVec2::new(20.0, 24.0),
        DVec2::new(570.0, 444.0),
    );
    let (low, high) = bounds(look.map(&list));
    let top = maps.iter().map(|map| map.1.y).fold(f64::MIN, f64::max);
    canvas.rectangle(frame.at(low), frame.at(DVec2::new(high.x, top)), fill(BLUE, 0.06));
    for x in [low.x, high.x] {
        canvas.line(frame.at(DVec2::new(x, low.y)), frame.at(DVec2::new(x, top)), stroke(BLUE, 1.2));
    }
    canvas.line(frame.at(low), frame.at(DVec2::new(high.x, low.y)), stroke(BLUE, 2.5));
    draw_frustum(&mut canvas, &frame, &look.frustum(&view[0]));
    for aabb in &CASTERS {
        draw_caster(&mut canvas, &frame, &look.aabb(aabb), (low.x, high.x));
    }
    for (_, map, colour, name) in &maps {
        let end = frame.at(DVec2::new(high.x, map.y));
        canvas.line(frame.at(DVec2::new(low.x, map.y)), end, stroke(colour, 2.5));
        canvas.bold(end + DVec2::new(8.0, 5.0), Side::Right, colour, name);
    }
    canvas.bold(frame.at(DVec2::new(high.x, low.y)) + DVec2::new(8.0, 5.0), Side::Right, BLUE, "far plane");
    Ok(canvas.finish())
}

/// A caster, with the part that is over the outline marked, and the dot where that is highest.
fn draw_caster(canvas: &mut Canvas, frame: &Frame, corners: &[DVec2; 8], (low, high): (f64, f64)) {
    draw_body(canvas, frame, corners, stroke(INK, 1.2).filled(GREY, 0.25), stroke(INK, 0.0));
    let mut over = hull(corners);
    for (sign, limit) in [(1.0, low), (-1.0, -high)] {
        over = cut(&over, |p| sign * p.x - limit);
    }
    if let Some(top) = over.iter().copied().reduce(|a, b| if b.y > a.y { b } else { a }) {
        canvas.polygon(over.iter().map(|p| frame.at(*p)), fill(GREEN, 0.4));
        canvas.dot(frame.at(top), INK);
    }
}

/// The part of a polygon where a linear function is not negative.
pub(super) fn cut(polygon: &[DVec2], inside: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut out = Vec::new();
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (da, db) = (inside(*a), inside(b));
        if da >= 0.0 {
            out.push(*a);
        }
        if (da >= 0.0) != (db >= 0.0) {
            out.push(*a + (b - *a) * (da / (da - db)));
        }
    }
    out
}
