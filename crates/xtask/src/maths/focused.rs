//! Box ∩ frustum from 12 + 12 clipped segments, and the map around what they give.

use anyhow::Result;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{Aabb, FitInput, ViewFrustum};

use super::canvas::{BLUE, Canvas, Frame, GREEN, GREY, INK, RED, Side, bounds, fill, stroke};
use super::scene::{EDGES, Look, boxes, camera, corners, draw_body, draw_frustum, fit_one, hull, plain_fit};

/// A long hall that the view cuts through.
const HALL: Aabb = Aabb::new(Vec3::new(-1.0, 0.0, -15.5), Vec3::new(11.0, 8.0, -9.0));

const LIGHT: Vec3 = Vec3::new(0.3, -0.85, 0.2);

pub(super) fn draw() -> Result<String> {
    let view = camera(8.0, 2.0, 0.62, 20.0).frustum()?;
    let mut canvas = Canvas::new(392.0, "A box clipped to a frustum, from 12 and 12 segments");
    let (ends_of_box, ends_of_view) = vertices(&view);
    let (right, up) = (DVec3::new(0.82, 0.0, 0.5723), DVec3::new(-0.26, 0.891, 0.3725));
    let look = Look { origin: DVec3::ZERO, right, up };
    let all = look.frustum(&view).into_iter().chain(look.aabb(&HALL));
    let frame = Frame::around(all, DVec2::new(18.0, 20.0), DVec2::new(350.0, 316.0));
    draw_frustum(&mut canvas, &frame, &look.frustum(&view));
    draw_body(&mut canvas, &frame, &look.aabb(&HALL), fill(GREY, 0.18), stroke(GREY, 1.0));
    let both: Vec<DVec3> = ends_of_box.iter().chain(&ends_of_view).copied().collect();
    let seen: Vec<DVec2> = both.iter().map(|p| look.at(*p)).collect();
    canvas.polygon(hull(&seen).into_iter().map(|p| frame.at(p)), stroke(GREEN, 1.5).filled(GREEN, 0.25));
    for p in &ends_of_view {
        canvas.circle(frame.at(look.at(*p)), 4.5, fill(RED, 1.0));
    }
    for p in &ends_of_box {
        canvas.circle(frame.at(look.at(*p)), 4.5, stroke(RED, 2.0).filled("#ffffff", 1.0));
    }
    canvas.circle(DVec2::new(24.0, 349.0), 4.5, fill(RED, 1.0));
    canvas.label(DVec2::new(36.0, 354.0), Side::Right, "ends of the frustum's edges in the box");
    canvas.circle(DVec2::new(24.0, 369.0), 4.5, stroke(RED, 2.0).filled("#ffffff", 1.0));
    canvas.label(DVec2::new(36.0, 374.0), Side::Right, "ends of the box's edges in the frustum");
    from_light(&mut canvas, &view, &both)?;
    Ok(canvas.finish())
}

/// The same from the light, with the maps that know of the box and that do not.
fn from_light(canvas: &mut Canvas, view: &ViewFrustum, both: &[DVec3]) -> Result<()> {
    let (views, halls) = ([*view], [HALL]);
    let input = FitInput { receivers: Some(boxes(&halls)), ..FitInput::new(&views, LIGHT) };
    let focused = fit_one(&input, &plain_fit().with_kind(FitKind::Focused))?;
    let oriented = fit_one(&input, &plain_fit().with_kind(FitKind::Oriented))?;
    let look = Look::from_light(&fit_one(&input, &plain_fit())?);
    let all = look.map(&oriented).into_iter().chain(look.aabb(&HALL));
    let frame = Frame::around(all, DVec2::new(390.0, 20.0), DVec2::new(702.0, 316.0));
    draw_frustum(canvas, &frame, &look.frustum(view));
    draw_body(canvas, &frame, &look.aabb(&HALL), fill(GREY, 0.18), stroke(GREY, 0.8));
    let seen: Vec<DVec2> = both.iter().map(|p| look.at(*p)).collect();
    canvas.polygon(hull(&seen).into_iter().map(|p| frame.at(p)), stroke(GREEN, 1.0).filled(GREEN, 0.35));
    canvas.polygon(look.map(&oriented)[..4].iter().map(|p| frame.at(*p)), stroke(BLUE, 2.0).dashed());
    canvas.polygon(look.map(&focused)[..4].iter().map(|p| frame.at(*p)), stroke(GREEN, 2.5));
    let area = |fit: &shadowfit::LightFit| {
        let (low, high) = bounds(Look::from_light(fit).map(fit));
        (high.x - low.x) * (high.y - low.y)
    };
    let share = 100.0 * area(&focused) / area(&oriented);
    canvas.text(DVec2::new(546.0, 354.0), Side::Middle, BLUE, "dashed: Oriented, without knowledge");
    canvas.text(DVec2::new(546.0, 374.0), Side::Middle, GREEN, &format!("Focused: {share:.0}% of its area"));
    canvas.small(DVec2::new(702.0, 24.0), Side::Left, INK, "from the light");
    Ok(())
}

/// Ends of the box's edges clipped to the frustum, and of the frustum's edges clipped to the box.
fn vertices(view: &ViewFrustum) -> (Vec<DVec3>, Vec<DVec3>) {
    let frustum = view.corners.map(|corner| corner.as_dvec3() + view.origin);
    let hall = corners(&HALL);
    (clipped(&hall, &planes(&frustum)), clipped(&frustum, &planes(&hall)))
}

/// Corners of each face of a body of eight corners.
const FACES: [[usize; 4]; 6] = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// Planes of a body, as (normal, d) with the body where n·p + d >= 0.
fn planes(body: &[DVec3; 8]) -> [(DVec3, f64); 6] {
    let centre = body.iter().copied().sum::<DVec3>() * 0.125;
    FACES.map(|[a, b, c, _]| {
        let normal = (body[b] - body[a]).cross(body[c] - body[b]);
        let normal = if normal.dot(centre - body[a]) < 0.0 { -normal } else { normal };
        (normal, -normal.dot(body[a]))
    })
}

/// Ends of a body's edges where they are inside planes.
fn clipped(body: &[DVec3; 8], planes: &[(DVec3, f64)]) -> Vec<DVec3> {
    let mut ends = Vec::new();
    for (i, j) in EDGES {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (normal, d) in planes {
            let (a, b) = (normal.dot(body[i]) + d, normal.dot(body[j]) + d);
            if a < 0.0 && b < 0.0 {
                enter = 2.0;
            } else if a < 0.0 {
                enter = enter.max(a / (a - b));
            } else if b < 0.0 {
                leave = leave.min(a / (a - b));
            }
        }
        if enter <= leave {
            ends.extend([enter, leave].map(|t| body[i] * (1.0 - t) + body[j] * t));
        }
    }
    ends
}
