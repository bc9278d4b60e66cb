//! Draws windows for a turning camera, next to cascades of equal sharpness and next to cascades of equal
//! stability.

use anyhow::{Context, Result};
use shadowfit::diagnostics::pixels_per_texel;
use shadowfit::glam::{DVec2, IVec2};
use shadowfit::scroll::Scroll;
use shadowfit::{DepthConvention, Technique};

use super::canvas::{Canvas, Frame, INK, LEFT, RED, RIGHT};
use super::scene::PICTURE;
use super::windows::{Step, Walk, street};

/// Number of frames of the turn. It follows an equal number of frames without movement.
const FRAMES: usize = 60;

/// Interval between drawn frames.
const DRAWN: usize = 30;

/// Turn of the camera per frame, in degrees.
const TURN: f64 = 0.25;

/// Side of a panel, in pixels.
const SIDE: f64 = 216.0;

/// Extent of the plane in the panels, in metres.
const REACH: f64 = 52.0;

pub(super) fn draw() -> Result<String> {
    let mut canvas = Canvas::new(388.0, "A turning camera: windows, equally sharp cascades, equally stable cascades");
    for (i, preset) in ["windows-4", "focused-4", "stable-4"].into_iter().enumerate() {
        let technique = Technique::preset(preset).context("no such preset")?;
        let steps = turn(&technique)?;
        let (low, size) = (DVec2::new(20.0 + 232.0 * i as f64, 38.0), DVec2::splat(SIDE));
        let look = steps[0].look();
        let frame = Frame::scaled(DVec2::new(-3.0, 20.0), low + size * 0.5, SIDE / REACH);
        canvas.panel(low, size, preset, |canvas| {
            street(canvas, &look, &frame);
            for (i, step) in steps.iter().enumerate().step_by(DRAWN) {
                step.outline(canvas, &look, &frame, if i == FRAMES { 2.8 } else { 1.1 });
            }
        });
        figures(&mut canvas, &technique, &steps, low.with_y(38.0 + SIDE))?;
    }
    let note = "The camera turns by 15° in 60 frames; thin: the maps of frames 0 and 30, thick: of frame 60";
    canvas.small(DVec2::new(20.0, 374.0), RIGHT, INK, note);
    Ok(canvas.finish())
}

/// Returns the frames of the turn.
fn turn(technique: &Technique) -> Result<Vec<Step>> {
    let mut walk = Walk::new(technique);
    let heading = |frame: usize| TURN * (frame.saturating_sub(FRAMES) as f64 - FRAMES as f64 * 0.5);
    (0..=2 * FRAMES).map(|frame| walk.step(heading(frame))).skip(FRAMES).collect()
}

/// Draws the changes of the maps from frame to frame, and their sharpness.
fn figures(canvas: &mut Canvas, technique: &Technique, steps: &[Step], corner: DVec2) -> Result<()> {
    let pairs = steps.windows(2).flat_map(|pair| pair[0].maps.iter().zip(pair[1].maps.iter()));
    let scrolls: Vec<Scroll> = pairs.map(|(before, now)| Scroll::between(before, now)).collect();
    let is_still = |scroll: &&Scroll| !scroll.is_new && scroll.shift == IVec2::ZERO;
    let lines = [
        (scrolls.iter().filter(is_still).count(), "stay where they are"),
        (scrolls.iter().filter(|scroll| !scroll.is_new && scroll.shift != IVec2::ZERO).count(), "move by whole texels"),
        (scrolls.iter().filter(|scroll| scroll.is_new).count(), "have new texels"),
    ];
    for (i, (count, what)) in lines.into_iter().enumerate() {
        let at = corner + DVec2::new(44.0, 24.0 + 22.0 * i as f64);
        let share = count as f64 / scrolls.len() as f64 * 100.0;
        canvas.bold(at, LEFT, INK, &format!("{share:.0}%"));
        canvas.text(at + DVec2::new(8.0, 0.0), RIGHT, INK, what);
    }
    let at = corner + DVec2::new(44.0, 94.0);
    canvas.bold(at, LEFT, RED, &format!("{:.1}", mean(technique, steps)?));
    canvas.text(at + DVec2::new(8.0, 0.0), RIGHT, RED, "pixels per texel, mean");
    Ok(())
}

/// Returns the mean of pixels per texel over the points of the drawn frames.
fn mean(technique: &Technique, steps: &[Step]) -> Result<f64> {
    let mut pixels: Vec<f64> = Vec::new();
    for step in steps.iter().step_by(DRAWN) {
        let clip_from_world = step.camera.clip_from_world(DepthConvention::ZeroToOne);
        for seen in step.seen.iter().filter(|seen| step.octave(seen).is_some()) {
            let point = step.camera.eye + seen.point.as_dvec3();
            let read = step.maps.read(technique, point, seen.depth).context("a point in no map")?;
            let fit = &step.maps[read.main()].projection;
            let found = pixels_per_texel(fit, &clip_from_world, PICTURE, seen.point, seen.normal)?;
            pixels.extend(found.map(|found| f64::from(found.worse_axis)));
        }
    }
    Ok(pixels.iter().sum::<f64>() / pixels.len() as f64)
}
