//! Where a map's roll comes from: the map's up for every position of the sun, by both rules.

use anyhow::Result;
use shadowfit::FitInput;
use shadowfit::glam::DVec2;
use shadowfit::settings::FitKind;
use shadowfit_params::tool::LightSettings;

use super::canvas::{BLUE, Canvas, GREY, PALE, RED, Side, YELLOW, fill, stroke};
use super::scene::{axes, camera, fit_one, plain_fit};

/// Pixels from the zenith to a sun 15° above the horizon.
const RADIUS: f64 = 132.0;

/// Elevation of the outermost ring, in degrees.
const LOWEST: f64 = 15.0;

pub(super) fn draw() -> Result<String> {
    let mut canvas = Canvas::new(398.0, "The map's up for each place of the sun, by two rules");
    sky(&mut canvas, DVec2::new(190.0, 168.0), FitKind::XnaSample, RED)?;
    sky(&mut canvas, DVec2::new(530.0, 168.0), FitKind::FrustumAabb, BLUE)?;
    canvas.bold(DVec2::new(190.0, 334.0), Side::Middle, RED, "Look-at with +y (XNA)");
    canvas.bold(DVec2::new(530.0, 334.0), Side::Middle, BLUE, "Shortest arc (all others)");
    canvas.label(DVec2::new(190.0, 354.0), Side::Middle, "turns about the zenith: it flips there");
    canvas.label(DVec2::new(530.0, 354.0), Side::Middle, "smooth, wherever the sun goes");
    let note = "the sky from above, sun in the middle: overhead; rings: 60° and 30° high, arrows: the map's up";
    canvas.small(DVec2::new(360.0, 384.0), Side::Middle, GREY, note);
    Ok(canvas.finish())
}

/// The sky from above with the zenith in its middle; an arrow at each sun shows where the map's up points.
fn sky(canvas: &mut Canvas, middle: DVec2, kind: FitKind, colour: &'static str) -> Result<()> {
    let view = [camera(0.0, 0.0, 0.8, 30.0).frustum()?];
    canvas.circle(middle, RADIUS + 20.0, stroke(PALE, 1.0).filled("#eef5fa", 1.0));
    for elevation in [30.0, 60.0] {
        let radius = RADIUS * (90.0 - elevation) / (90.0 - LOWEST);
        canvas.circle(middle, radius, stroke(PALE, 1.0));
    }
    for (ring, count) in [(0.02, 1), (0.22, 7), (0.48, 13), (0.74, 19), (1.0, 25)] {
        for i in 0..count {
            let azimuth = std::f64::consts::TAU * f64::from(i) / f64::from(count);
            let elevation = (90.0 - ring * (90.0 - LOWEST)).to_radians();
            let (azimuth, elevation) = (azimuth as f32, elevation as f32);
            let light = LightSettings { azimuth, elevation, ..LightSettings::default() };
            let settings = plain_fit().with_kind(kind);
            let [_, up, to_light] = axes(&fit_one(&FitInput::new(&view, light.direction()), &settings)?);
            // A plan: x to the right and -z up, so that z is the page's y.
            let place = DVec2::new(to_light.x, to_light.z);
            let place = middle + place * (ring * RADIUS / libm::sqrt(place.dot(place)));
            let along = DVec2::new(up.x, up.z);
            let half = along * (11.0 / libm::sqrt(along.dot(along)));
            canvas.arrow(place - half, place + half, colour, 1.6);
        }
    }
    canvas.circle(middle, 3.5, fill(YELLOW, 1.0));
    Ok(())
}
