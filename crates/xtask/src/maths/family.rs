//! The family at a glance: one camera, one sun, six maps.

use anyhow::Result;
use shadowfit::glam::{DVec2, Vec3};
use shadowfit::settings::{FitKind, RectangleKind};
use shadowfit::{Boxes, FitInput, LightFit};

use super::canvas::{BLUE, Canvas, Frame, GREEN, GREY, INK, PURPLE, RED, Side, YELLOW, bounds, fill, stroke};
use super::scene::{Look, VILLAGE, boxes, camera, draw_box, draw_frustum, fit_one, plain_fit};

const LIGHT: Vec3 = Vec3::new(0.3, -0.85, 0.2);

/// Height of a row of maps, in pixels.
const ROW: f64 = 262.0;

pub(super) fn draw() -> Result<String> {
    let view = [camera(40.0, -4.0, 0.42, 40.0).frustum()?];
    let receivers: Boxes = boxes(&VILLAGE);
    let input = FitInput { receivers: Some(receivers), casters: Some(receivers), ..FitInput::new(&view, LIGHT) };
    let rules = [
        ("XNA sample", FitKind::XnaSample, RectangleKind::AxisAligned, GREY),
        ("Frustum AABB", FitKind::FrustumAabb, RectangleKind::AxisAligned, RED),
        ("Oriented, least area", FitKind::Oriented, RectangleKind::MinimumArea, BLUE),
        ("Oriented, least square", FitKind::Oriented, RectangleKind::MinimumSquare, PURPLE),
        ("Sphere", FitKind::Sphere, RectangleKind::AxisAligned, YELLOW),
        ("Focused", FitKind::Focused, RectangleKind::MinimumArea, GREEN),
    ];
    let mut canvas = Canvas::new(2.0 * ROW + 36.0, "Six maps of one camera and one sun, seen from the light");
    let settings = |kind, rectangle| plain_fit().with_kind(kind).with_rectangle(rectangle);
    let look = Look::from_light(&fit_one(&input, &settings(FitKind::FrustumAabb, RectangleKind::AxisAligned))?);
    let fits = rules.map(|(_, kind, rectangle, _)| fit_one(&input, &settings(kind, rectangle)));
    let fits = fits.into_iter().collect::<Result<Vec<_>>>()?;
    // One scale for all, each map in the middle of its place.
    let extent = |map: &[DVec2; 8]| bounds(map.iter().copied());
    let widest = fits.iter().map(|fit| extent(&look.map(fit))).map(|(low, high)| (high - low).max_element());
    let scale = (ROW - 58.0) / widest.fold(0.0, f64::max);
    for (i, (name, _, _, colour)) in rules.into_iter().enumerate() {
        let middle = DVec2::new(122.0 + 238.0 * (i % 3) as f64, 122.0 + ROW * (i / 3) as f64);
        let map = look.map(&fits[i]);
        let (low, high) = extent(&map);
        let frame = Frame::scaled((low + high) * 0.5, middle, scale);
        draw_frustum(&mut canvas, &frame, &look.frustum(&view[0]));
        for house in &VILLAGE[1..] {
            draw_box(&mut canvas, &frame, &look.aabb(house));
        }
        canvas.polygon(map[..4].iter().map(|p| frame.at(*p)), stroke(colour, 2.5).filled(colour, 0.08));
        let below = middle + DVec2::new(0.0, 122.0);
        canvas.bold(below, Side::Middle, INK, name);
        canvas.label(below + DVec2::new(0.0, 18.0), Side::Middle, &texels(&fits[i], &fits[1]));
    }
    let note = DVec2::new(64.0, 2.0 * ROW + 24.0);
    canvas.circle(note - DVec2::new(14.0, 5.0), 6.0, fill("#f4e3b2", 1.0));
    let text = "what the camera sees, and houses; one texel of 2048², its area beside the AABB's";
    canvas.text(note, Side::Right, GREY, text);
    Ok(canvas.finish())
}

/// Size of a fit's texels, and their area beside another fit's.
fn texels(fit: &LightFit, other: &LightFit) -> String {
    let (size, other) = (fit.texel_size * 100.0, other.texel_size * 100.0);
    let share = 100.0 * size.x * size.y / (other.x * other.y);
    format!("{:.2} × {:.2} cm, {share:.0}%", size.x, size.y)
}
