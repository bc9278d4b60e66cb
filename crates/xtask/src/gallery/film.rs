//! The animated picture at the top of the README. The viewer plays a script and saves pictures of its window,
//! and the program `film` combines them. [`storyboard`] defines all frames and their durations.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::{bytes, empty_folder, open, save};
use crate::machine::Machine;
use crate::{process, run};

/// Its file name among the docs' pictures.
const FILE: &str = "film.webp";

/// Size limit of the film, in bytes: acceptable for a page that loads it at once.
const MOST_BYTES: u64 = 3_000_000;

/// Size of the viewer's window, in pixels: the smallest one that fits each bar in a line. The README
/// shows the film about 830 pixels wide, where its text must stay readable.
const WINDOW: &str = "1024x576";

/// Duration of a frame with movement, in milliseconds: about 16 frames per second.
const STEP: u32 = 64;

/// Number of frames for fading the last picture into the first one.
const FADE: u32 = 6;

/// Number of frames until the viewer's interface and its maps settle after a change.
const SETTLING: u32 = 20;

/// Eye and target of a camera, in metres.
type View = [[f32; 3]; 2];

/// The courtyard's start view.
const WIDE: View = [[-2.1, 1.6, 4.5], [1.3, 1.3, -1.0]];

/// The wanderer from close by: the viewer shows acne at this place in that pose, so the text of its card is
/// true here.
const CLOSE: View = [[1.22, 1.36, 1.05], [-0.03, 1.36, 0.05]];

/// Times of the animation between which the wanderer walks up, in seconds. The second one is both its end and
/// its start.
const WALK: [f32; 2] = [9.64, 11.88];

/// A picture of the film: the viewer's actions before it, and its duration in milliseconds.
struct Frame {
    actions: Vec<String>,
    shown: u32,
}

/// Renders the film and saves it among the docs' pictures.
pub(super) fn film(machine: &Machine, images: &Path) -> Result<()> {
    let folder = empty_folder("film")?;
    let frames = storyboard();
    let script = folder.with_extension("txt");
    fs::write(&script, self::script(&frames)).with_context(|| format!("{}: cannot be written", script.display()))?;
    let mut viewer = run::viewer(machine);
    viewer.arg("--headless").arg(&folder).arg("--script").arg(&script);
    process::run(viewer.args(["--size", WINDOW, "--software", "--set", "view.inset=off", "courtyard"]))?;
    let end = fade(&folder, &frames)?;
    let mut film = process::cargo("run");
    film.args(["--quiet", "--release", "--package", "xtask", "--features", "film", "--bin", "film", "--"]);
    let file = images.join(FILE);
    process::run(film.arg(&folder).arg(end.to_string()).arg(&file))?;
    ensure!(bytes(&file)? <= MOST_BYTES, "{}: more than {MOST_BYTES} bytes; show less of it", file.display());
    Ok(())
}

/// Returns the frames: a flight, acne, its wrong pixels, its cure, and two techniques side by side.
fn storyboard() -> Vec<Frame> {
    let begin = format!("scrub {}", WALK[0]);
    let mut frames = vec![still(&[&begin], 240)];
    frames.extend(flight([WIDE, CLOSE], WALK, 36));
    // Set the camera, since the view that the viewer finds may differ between versions.
    frames.push(still(&["scrub 0", "show acne", "await loaded", &look(CLOSE)], 1200));
    frames.push(still(&["view error"], 1000));
    frames.push(still(&["fix", "await loaded"], 680));
    frames.push(still(&["view final"], 800));
    let sides = ["close", "technique windows-4", "compare on", "swap", "technique xna-1"];
    frames.push(still(&[&sides[..], &[&look(WIDE), &begin]].concat(), 720));
    frames.push(still(&["view pixels_per_texel"], 400));
    frames.extend((1..12).map(|step| moving(vec![format!("split {}", mix(0.5, 0.15, eased(step as f32 / 12.0)))])));
    frames.push(still(&["split 0.15"], 560));
    frames
}

/// Returns a picture that is shown for some milliseconds, taken after everything has settled.
fn still(actions: &[&str], shown: u32) -> Frame {
    let settled = format!("frames {SETTLING}");
    let all = actions.iter().copied().chain(["await judged", &settled]);
    Frame { actions: all.map(str::to_owned).collect(), shown }
}

/// Returns a picture of a movement.
fn moving(mut actions: Vec<String>) -> Frame {
    actions.extend(["await judged", "frames 2"].map(str::to_owned));
    Frame { actions, shown: STEP }
}

/// Returns the frames of a camera flight that ends at the second view and time, while the animation plays.
fn flight([from, to]: [View; 2], [start, end]: [f32; 2], frames: u8) -> impl Iterator<Item = Frame> {
    (1..=frames).map(move |frame| {
        let share = f32::from(frame) / f32::from(frames);
        let view = [0, 1].map(|point| [0, 1, 2].map(|axis| mix(from[point][axis], to[point][axis], eased(share))));
        moving(vec![format!("scrub {}", mix(start, end, share)), look(view)])
    })
}

fn look([eye, target]: View) -> String {
    let [eye, target] = [eye, target].map(|[x, y, z]| format!("{x} {y} {z}"));
    format!("look {eye} to {target}")
}

fn mix(from: f32, to: f32, share: f32) -> f32 {
    from + (to - from) * share
}

/// Converts a share of a movement's time to a share of its way, with a smooth start and end.
fn eased(share: f32) -> f32 {
    share * share * (3.0 - 2.0 * share)
}

/// Returns the script for the viewer. The name of each picture is its start time, in milliseconds.
fn script(frames: &[Frame]) -> String {
    let mut lines = vec!["await loaded".to_owned()];
    let mut start = 0;
    for Frame { actions, shown } in frames {
        lines.extend(actions.iter().cloned());
        lines.push(format!("window {}", file(start)));
        start += shown;
    }
    lines.push("quit\n".to_owned());
    lines.join("\n")
}

fn file(start: u32) -> String {
    format!("{start:05}.png")
}

/// Fades the last picture into the first one. Returns the end time of the film, in milliseconds.
fn fade(folder: &Path, frames: &[Frame]) -> Result<u32> {
    let end: u32 = frames.iter().map(|frame| frame.shown).sum();
    let last = end - frames.last().map_or(0, |frame| frame.shown);
    let [from, to] = [open(&folder.join(file(last)))?, open(&folder.join(file(0)))?];
    for step in 0..FADE {
        let share = (step + 1) as f32 / (FADE + 1) as f32;
        let mut picture = from.clone();
        for (value, &other) in picture.iter_mut().zip(to.iter()) {
            *value = mix(f32::from(*value), f32::from(other), share).round() as u8;
        }
        save(&picture, &folder.join(file(end + step * STEP)))?;
    }
    Ok(end + FADE * STEP)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn the_film_lasts_six_to_nine_seconds_and_no_two_pictures_have_one_time() {
        let frames = storyboard();
        let length = frames.iter().map(|frame| frame.shown).sum::<u32>() + FADE * STEP;
        assert!((6000..=9000).contains(&length), "{length} ms");
        let script = script(&frames);
        let files: BTreeSet<&str> = script.lines().filter(|line| line.starts_with("window ")).collect();
        assert_eq!(files.len(), frames.len());
    }

    #[test]
    fn the_film_of_the_docs_is_no_larger_than_a_page_may_load() {
        let film = process::root().join(super::super::IMAGES).join(FILE);
        assert!(bytes(&film).unwrap() <= MOST_BYTES);
    }
}
