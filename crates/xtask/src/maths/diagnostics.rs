//! Texels on the ground as the camera sees them, and what pixels per texel says of them.

use anyhow::Result;
use shadowfit::diagnostics::{PixelsPerTexel, pixels_per_texel};
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{DepthConvention, FitInput, LightFit, PerspectiveCamera};

use super::canvas::{Canvas, GREEN, INK, RED, Side, YELLOW, fill, stroke};
use super::scene::{camera, fit_one, plain_fit};

/// Size of the camera's picture, in pixels: those of this picture.
const PICTURE: UVec2 = UVec2::new(688, 344);

/// Texels of the map each way.
const TEXELS: u32 = 24;

/// A map and the camera whose picture is drawn.
struct Ground {
    fit: LightFit,
    camera: PerspectiveCamera,
}

pub(super) fn draw() -> Result<String> {
    let mut canvas = Canvas::new(432.0, "Texels of a coarse map on the ground, as the camera sees them");
    let camera = PerspectiveCamera { eye: DVec3::new(0.0, 7.0, 0.0), aspect: 2.0, ..camera(20.0, -24.0, 0.75, 34.0) };
    let view = [camera.frustum()?];
    let input = FitInput::new(&view, Vec3::new(0.5, -0.7, 0.3));
    let settings = plain_fit().with_kind(FitKind::Oriented).with_resolution(UVec2::splat(TEXELS));
    let ground = Ground { fit: fit_one(&input, &settings)?, camera };
    canvas.rectangle(DVec2::new(16.0, 16.0), DVec2::new(704.0, 360.0), fill("#dfe9f0", 1.0));
    let mut labels = Vec::new();
    for i in 0..TEXELS * TEXELS {
        let (u, v) = (f64::from(i % TEXELS), f64::from(i / TEXELS));
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let seen: Vec<DVec2> = corners.iter().filter_map(|(x, y)| ground.seen(u + x, v + y)).collect();
        let Some(pixels) = ground.pixels(u + 0.5, v + 0.5)? else { continue };
        if seen.len() < 4 || !seen.iter().all(|p| is_inside(*p)) {
            continue;
        }
        canvas.polygon(seen, stroke("#ffffff", 1.0).filled(colour(pixels.worse_axis), 0.55));
        if (i % TEXELS) % 4 == 2 && (i / TEXELS) % 4 == 1 {
            labels.push((u, v, pixels));
        }
    }
    for (u, v, pixels) in labels {
        let around = (0..48).filter_map(|k| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / 48.0);
            ground.seen(u + 0.5 + 0.5 * cos, v + 0.5 + 0.5 * sin)
        });
        canvas.polygon(around, stroke(INK, 1.6));
        if let Some(at) = ground.seen(u + 0.5, v + 0.5).filter(|_| pixels.area > 16.0 * pixels.worse_axis) {
            canvas.bold(at + DVec2::new(0.0, 5.0), Side::Middle, INK, &format!("{:.0}", pixels.worse_axis));
        }
    }
    legend(&mut canvas);
    Ok(canvas.finish())
}

fn is_inside(p: DVec2) -> bool {
    p.x > 16.0 && p.x < 704.0 && p.y > 16.0 && p.y < 360.0
}

/// Colour of a number of pixels per texel.
fn colour(pixels: f32) -> &'static str {
    match pixels {
        p if p < 32.0 => GREEN,
        p if p < 64.0 => YELLOW,
        _ => RED,
    }
}

fn legend(canvas: &mut Canvas) {
    canvas.label(DVec2::new(16.0, 388.0), Side::Right, "pixels per texel, worse axis:");
    for (i, (colour, text)) in [(GREEN, "below 32"), (YELLOW, "32 to 64"), (RED, "more")].into_iter().enumerate() {
        let x = 280.0 + 128.0 * i as f64;
        canvas.rectangle(DVec2::new(x, 376.0), DVec2::new(x + 16.0, 390.0), fill(colour, 0.55));
        canvas.label(DVec2::new(x + 23.0, 388.0), Side::Right, text);
    }
    canvas.label(
        DVec2::new(16.0, 414.0),
        Side::Right,
        "the ellipse that a texel's circle becomes is as long as the number says",
    );
}

impl Ground {
    /// The point of the ground under a place of the map, in texels from its left top corner, relative to the eye.
    fn point(&self, u: f64, v: f64) -> DVec3 {
        let corners = self.fit.corners().map(Vec3::as_dvec3);
        let share = DVec2::new(u, v) / f64::from(TEXELS);
        let on_near = corners[0] + (corners[1] - corners[0]) * share.x + (corners[3] - corners[0]) * share.y;
        let along = self.fit.direction.as_dvec3();
        on_near - along * ((on_near.y + self.fit.origin.y) / along.y)
    }

    /// Where it is in the picture, if it is before the camera.
    fn seen(&self, u: f64, v: f64) -> Option<DVec2> {
        let matrix = self.camera.clip_from_world(DepthConvention::ZeroToOne).as_dmat4();
        let clip = matrix * self.point(u, v).extend(1.0);
        let half = PICTURE.as_dvec2() * 0.5;
        let at = DVec2::new(clip.x, -clip.y) / clip.w;
        (clip.w > 0.1).then_some(DVec2::splat(16.0) + half + at * half)
    }

    fn pixels(&self, u: f64, v: f64) -> Result<Option<PixelsPerTexel>> {
        let clip_from_world = self.camera.clip_from_world(DepthConvention::ZeroToOne);
        Ok(pixels_per_texel(&self.fit, &clip_from_world, PICTURE, self.point(u, v).as_vec3(), Vec3::Y)?)
    }
}
