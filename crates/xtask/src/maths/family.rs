//! Draws six kinds of maps for the same camera and sun.

use anyhow::Result;
use shadowfit::glam::{DVec2, Vec3};
use shadowfit::settings::{FitKind, RectangleKind};
use shadowfit::{Aabb, Boxes, FitInput, LightProjection};

use super::canvas::{BLUE, Canvas, Frame, GREEN, GREY, INK, MIDDLE, PURPLE, RED, RIGHT, YELLOW, bounds, fill, stroke};
use super::scene::{Fitter, Look, camera, draw_box, draw_frustum, one_map, plain_fit};

const LIGHT: Vec3 = Vec3::new(0.3, -0.85, 0.2);

/// A square of ground and some houses on it, in world coordinates.
const VILLAGE: [Aabb; 6] = [
    Aabb::new(Vec3::new(-40.0, -0.3, -60.0), Vec3::new(60.0, 0.0, 20.0)),
    Aabb::new(Vec3::new(6.0, 0.0, -12.0), Vec3::new(9.0, 2.5, -9.0)),
    Aabb::new(Vec3::new(15.0, 0.0, -14.0), Vec3::new(19.0, 4.0, -10.0)),
    Aabb::new(Vec3::new(9.0, 0.0, -23.0), Vec3::new(13.0, 4.0, -18.0)),
    Aabb::new(Vec3::new(21.0, 0.0, -23.0), Vec3::new(26.0, 5.0, -18.0)),
    Aabb::new(Vec3::new(19.0, 0.0, -32.0), Vec3::new(23.0, 4.0, -28.0)),
];

/// The maps and their colours. The second one is the reference for comparisons.
const MAPS: [(&str, FitKind, RectangleKind, &str); 6] = [
    ("XNA sample", FitKind::XnaSample, RectangleKind::AxisAligned, GREY),
    ("Frustum AABB", FitKind::FrustumAabb, RectangleKind::AxisAligned, RED),
    ("Oriented, least area", FitKind::Oriented, RectangleKind::MinimumArea, BLUE),
    ("Oriented, least square", FitKind::Oriented, RectangleKind::MinimumSquare, PURPLE),
    ("Sphere", FitKind::Sphere, RectangleKind::AxisAligned, YELLOW),
    ("Focused", FitKind::Focused, RectangleKind::MinimumArea, GREEN),
];

/// Height of a row of maps, in pixels.
const ROW: f64 = 262.0;

pub(super) fn draw() -> Result<String> {
    let view = [camera(40.0, -4.0, 0.42, 40.0).frustum()?];
    let village = Some(Boxes::world(&VILLAGE));
    let input = FitInput { receivers: village, casters: village, ..FitInput::new(&view, LIGHT) };
    let mut fits = Vec::new();
    for (_, kind, rectangle, _) in MAPS {
        fits.push(Fitter::new().fit(&input, &one_map(plain_fit(kind).with_rectangle(rectangle)))?[0].projection);
    }
    let mut canvas = Canvas::new(2.0 * ROW + 36.0, "Six maps of one camera and one sun, seen from the light");
    let look = Look::from_light(&fits[1]);
    // One scale for all maps, each centred in its cell.
    let extents = fits.iter().map(|fit| bounds(look.map(fit)));
    let scale = (ROW - 58.0) / extents.map(|(low, high)| (high - low).max_element()).fold(0.0, f64::max);
    for (i, (name, _, _, colour)) in MAPS.into_iter().enumerate() {
        let middle = DVec2::new(122.0 + 238.0 * (i % 3) as f64, 122.0 + ROW * (i / 3) as f64);
        let map = look.map(&fits[i]);
        let (low, high) = bounds(map);
        let frame = Frame::scaled((low + high) * 0.5, middle, scale);
        draw_frustum(&mut canvas, &frame, &look.frustum(&view[0]));
        for house in &VILLAGE[1..] {
            draw_box(&mut canvas, &frame, &look.aabb(house));
        }
        canvas.polygon(map.map(|p| frame.at(p)), stroke(colour, 2.5).filled(colour, 0.08));
        let below = middle + DVec2::new(0.0, 122.0);
        canvas.bold(below, MIDDLE, INK, name);
        canvas.text(below + DVec2::new(0.0, 18.0), MIDDLE, INK, &texels(&fits[i], &fits[1]));
    }
    let note = DVec2::new(64.0, 2.0 * ROW + 24.0);
    canvas.circle(note - DVec2::new(14.0, 5.0), 6.0, fill("#f4e3b2", 1.0));
    let text = "view frustum and houses; one texel of 2048², and its area relative to the AABB's";
    canvas.text(note, RIGHT, GREY, text);
    Ok(canvas.finish())
}

/// Returns the size of a fit's texels, and their area relative to another fit's.
fn texels(fit: &LightProjection, other: &LightProjection) -> String {
    let (size, other) = (fit.texel_size * 100.0, other.texel_size * 100.0);
    let share = 100.0 * size.x * size.y / (other.x * other.y);
    format!("{:.2} × {:.2} cm, {share:.0}%", size.x, size.y)
}
