//! The viewer in a real window, driven like a user would: on an X server without a screen (Xvfb), with keys
//! pressed by xdotool and screenshots by `ImageMagick`. There is no window manager. The test itself gives the
//! window its focus, moves and resizes it, and "minimises" it by unmapping, as iconifying does on X11. The
//! assertions are that pictures change, come back or stay the same. Every wait is for a visible change, with
//! a generous limit. The slowest tests run only with `cargo xtask test --all`.

mod desktop;
mod hours;
mod shot;

use std::time::{Duration, Instant};

use desktop::{Desktop, Viewer, missing_tools};
use shot::{Area, Shot};

/// Size of the window at the start, in pixels; smaller than the [`desktop::SCREEN`] so that a resize can grow
/// it.
const SIZE: (u32, u32) = (960, 600);

/// Start options of the viewer: the driver that every machine has, a scene without movement, and progress
/// messages on standard error.
const ARGUMENTS: [&str; 6] = ["--size", "960x600", "--software", "--no-play", "--no-state", "--log-frames"];

/// The part of the window that shows the scene, between the bars above and below it and the panel beside it.
const PICTURE: Area = Area { x: 24, y: 120, width: 500, height: 380 };

/// Mean difference, in levels of 255, from which two pictures count as different. A software driver draws a
/// still scene with the same bits each time, and a move of a few pixels shifts every edge of the picture by
/// far more than this.
const CHANGED: f32 = 1.0;

/// Mean difference, in levels of 255, up to which two pictures count as the same.
const SAME: f32 = 0.1;

/// Time without a change after which a picture counts as settled: some frames of a software driver on a busy
/// machine.
const STILL: Duration = Duration::from_millis(2500);

/// Time limit of a frame or a change of some frames: for a software driver, two cores, a cold shader cache.
const PATIENCE: Duration = Duration::from_mins(1);

#[test]
fn the_real_window_flies_shows_an_artefact_resizes_and_quits() {
    let Some(desktop) = desktop("smoke") else { return };
    let mut viewer = started(&desktop);
    every_key_moves_the_picture(&desktop, &viewer, &["w"]);
    every_artefact_has_a_picture_of_its_own(&desktop, &viewer, &[("z", "acne")]);
    a_resized_window_is_filled(&desktop, &viewer, (1120, 700));
    quit(&mut viewer);
}

#[test]
#[ignore = "waits for some thirty pictures to come to rest: cargo xtask test --all"]
fn the_real_window_obeys_every_key_at_every_size_and_after_it_was_hidden() {
    let Some(desktop) = desktop("by-hand") else { return };
    let mut viewer = started(&desktop);
    // In pairs that undo each other, so that the scene stays visible.
    every_key_moves_the_picture(&desktop, &viewer, &["w", "s", "a", "d", "Left", "Right", "Up", "Down"]);
    every_artefact_has_a_picture_of_its_own(&desktop, &viewer, &[("z", "acne"), ("x", "aliasing"), ("c", "hole")]);
    for size in [(860, 520), (1, 1), (1120, 700)] {
        a_resized_window_is_filled(&desktop, &viewer, size);
    }
    viewer.resize(SIZE);
    every_key_moves_the_picture(&desktop, &viewer, &["Left"]);
    a_hidden_window_comes_back_unchanged(&desktop, &mut viewer);
    quit(&mut viewer);
}

/// Starts the viewer, and waits for a picture.
fn started(desktop: &Desktop) -> Viewer {
    let mut viewer = Viewer::start(desktop, &ARGUMENTS);
    viewer.wait_for_line("ready", PATIENCE);
    viewer.focus();
    let start = settled(desktop, "start");
    assert!(start.spread(PICTURE) > 5.0, "the picture is one flat colour: {}", start.file());
    viewer
}

fn quit(viewer: &mut Viewer) {
    viewer.press("Escape");
    assert_eq!(viewer.exit_code(PATIENCE), Some(0), "Escape must end the viewer with success\n{}", viewer.log());
}

/// Starts an empty desktop. Returns `None` if the machine lacks the programs for it.
fn desktop(test: &str) -> Option<Desktop> {
    let missing = missing_tools();
    if missing.is_empty() {
        return Some(Desktop::start(test));
    }
    let reason = format!("{} not found (cargo xtask test installs them on Debian)", missing.join(", "));
    assert!(std::env::var_os("SHADOWFIT_REQUIRE_GPU").is_none(), "the window test cannot run: {reason}");
    println!("SKIPPED: {reason}");
    None
}

#[test]
fn a_lost_device_is_told_once_and_the_window_comes_back_as_it_was() {
    let Some(desktop) = desktop("lost") else { return };
    let (script, before, after) = (desktop.file("lose.txt"), desktop.file("before.png"), desktop.file("after.png"));
    let lines = [
        "await loaded".to_owned(),
        "set view.judge off".to_owned(),
        "technique stable-4".to_owned(),
        "frames 4".to_owned(),
        format!("picture {}", before.display()),
        "lose-device".to_owned(),
        "frames 8".to_owned(),
        format!("picture {}", after.display()),
        "lose-device".to_owned(),
        "frames 4".to_owned(),
    ];
    std::fs::write(&script, lines.join("\n")).expect("the script is written");
    let script = script.display().to_string();
    let mut viewer = Viewer::start(&desktop, &[&ARGUMENTS[..], &["--script", &script]].concat());
    viewer.wait_for_line("lost", PATIENCE * 2);
    // The second loss follows the first one so soon that the viewer must give up.
    assert_eq!(viewer.exit_code(PATIENCE * 2), Some(2), "{}", viewer.log());
    let log = viewer.log();
    assert_eq!(log.matches("opening a new one").count(), 1, "{log}");
    assert!(log.contains("lost again") && log.contains("--software") && !log.contains("panicked"), "{log}");
    let [before, after] = [before, after].map(|path| image::open(path).expect("a picture").to_rgb8());
    assert!(before == after, "the picture is another one after the loss");
}

#[test]
fn a_surface_that_has_no_texture_for_a_frame_has_one_later() {
    let Some(desktop) = desktop("refused") else { return };
    let (script, before, after) = (desktop.file("refuse.txt"), desktop.file("before.png"), desktop.file("after.png"));
    let still = "await loaded\nset view.judge off\ntechnique stable-4\nframes 4\n";
    let refused = ["lost", "outdated", "timeout", "occluded", "lost"].map(|answer| {
        // The surface is recreated with another size than at the start.
        format!("refuse-frame {answer}\nframes 3\nresize 700 500\nrefuse-frame {answer}\nresize 960 600\nframes 4\n")
    });
    let (refused, [shown, later]) = (refused.concat(), [&before, &after].map(|path| path.display()));
    std::fs::write(&script, format!("{still}picture {shown}\n{refused}picture {later}\nquit\n")).expect("a script");
    let script = script.display().to_string();
    let mut viewer = Viewer::start(&desktop, &[&ARGUMENTS[..], &["--script", &script]].concat());
    assert_eq!(viewer.exit_code(PATIENCE * 2), Some(0), "{}", viewer.log());
    let log = viewer.log();
    assert!(!log.contains("panicked") && !log.to_lowercase().contains("validation"), "{log}");
    let [before, after] = [before, after].map(|path| image::open(path).expect("a picture").to_rgb8());
    assert_eq!(before.dimensions(), after.dimensions());
    assert!(before == after, "the picture is another one after what the surface refused");
}

#[test]
fn a_bad_line_of_a_script_is_named_and_the_exit_code_is_2() {
    let Some(desktop) = desktop("bad-script") else { return };
    let script = desktop.file("bad.txt");
    std::fs::write(&script, "view truth\nview sideways\n").expect("the script is written");
    let mut viewer = Viewer::start(&desktop, &["--software", "--no-state", "--script", &script.display().to_string()]);
    assert_eq!(viewer.exit_code(PATIENCE), Some(2), "{}", viewer.log());
    assert!(viewer.log().contains("bad.txt:2: view sideways"), "{}", viewer.log());
}

#[test]
#[ignore = "waits until the viewer has tried twice, for twelve seconds: cargo xtask test --all"]
fn settings_that_cannot_be_saved_are_told_once_and_the_viewer_goes_on() {
    let Some(desktop) = desktop("unsaved") else { return };
    let (script, state) = (desktop.file("wait.txt"), desktop.file("folder"));
    std::fs::create_dir_all(&state).expect("a folder");
    // Longer than the viewer needs for two attempts.
    std::fs::write(&script, "await loaded\nwait 12\nquit\n").expect("the script is written");
    let (script, state) = (script.display().to_string(), state.display().to_string());
    let mut viewer = Viewer::start(&desktop, &["--software", "--state", &state, "--script", &script]);
    assert_eq!(viewer.exit_code(PATIENCE), Some(0), "{}", viewer.log());
    let log = viewer.log();
    assert!(log.contains(&state) && log.contains("it is a folder"), "{log}");
    assert_eq!(log.matches("cannot be saved").count(), 1, "{log}");
}

/// Holds each key until the picture changes.
fn every_key_moves_the_picture(desktop: &Desktop, viewer: &Viewer, keys: &[&str]) {
    for key in keys {
        let before = settled(desktop, &format!("before-{key}"));
        viewer.hold(key);
        let moved = desktop.wait_for(PATIENCE, |shot| shot.difference(&before, PICTURE) > CHANGED);
        viewer.release(key);
        let Some(_) = moved else {
            panic!("holding {key} changes nothing: compare {} and {}", before.file(), desktop.shoot(key).file());
        };
    }
}

/// Presses each artefact's key, then the key that fixes it.
fn every_artefact_has_a_picture_of_its_own(desktop: &Desktop, viewer: &Viewer, artefacts: &[(&str, &str)]) {
    let mut previous = settled(desktop, "before-artefacts");
    for (key, name) in artefacts {
        for (key, name) in [(*key, (*name).to_owned()), ("f", format!("{name}-fixed"))] {
            viewer.press(key);
            let shown = desktop.wait_for(PATIENCE, |shot| shot.difference(&previous, PICTURE) > SAME);
            assert!(shown.is_some(), "{key} ({name}) changes nothing since {}\n{}", previous.file(), viewer.log());
            let settled = settled(desktop, &name);
            // The first change may be only the card that announces the search for a view.
            let difference = settled.difference(&previous, PICTURE);
            assert!(difference > SAME, "{key} ({name}) shows the same as {}\n{}", previous.file(), viewer.log());
            previous = settled;
        }
    }
}

/// Resizes the window, and asserts that its picture fills it. A window that is too small for the picture
/// loses it.
fn a_resized_window_is_filled(desktop: &Desktop, viewer: &Viewer, size: (u32, u32)) {
    viewer.resize(size);
    let name = format!("resized-{}x{}", size.0, size.1);
    if size.0 < PICTURE.x + PICTURE.width {
        let gone = desktop.wait_for(PATIENCE, |shot| !shot.is_painted(PICTURE));
        assert!(gone.is_some(), "the window does not become {size:?}: {}", desktop.shoot(&name).file());
        return;
    }
    // The right edge and the lower edge: a surface with the old size leaves them unpainted.
    let (right, below) = (Area::new(size.0 - 12, 40, 8, size.1 - 80), Area::new(40, size.1 - 12, 200, 8));
    let filled = desktop.wait_for(PATIENCE, |shot| shot.is_painted(right) && shot.is_painted(below));
    assert!(filled.is_some(), "a window of {size:?} is not filled: {}", desktop.shoot(&name).file());
    let outside = Area::new(size.0 + 4, 0, 40, size.1);
    let shot = settled(desktop, &name);
    assert!(!shot.is_painted(outside), "the window is larger than {size:?}: {}", shot.file());
}

/// Hides the window and shows it again.
fn a_hidden_window_comes_back_unchanged(desktop: &Desktop, viewer: &mut Viewer) {
    let before = settled(desktop, "before-hiding");
    viewer.hide();
    let gone = desktop.wait_for(PATIENCE, |shot| !shot.is_painted(PICTURE));
    assert!(gone.is_some(), "the window does not go away");
    viewer.show();
    let back = desktop.wait_for(PATIENCE, |shot| shot.difference(&before, PICTURE) <= SAME);
    let now = desktop.shoot("after-hiding");
    assert!(back.is_some(), "the picture does not come back: compare {} and {}", before.file(), now.file());
    assert!(viewer.is_running(), "the viewer ended while its window was hidden\n{}", viewer.log());
}

/// Returns a screenshot that no longer changes.
fn settled(desktop: &Desktop, name: &str) -> Shot {
    let mut last: Option<(Shot, Instant)> = None;
    let still = desktop.wait_for(PATIENCE, |shot| {
        let since = last.as_ref().filter(|(old, _)| shot.difference(old, PICTURE) <= SAME).map(|(_, since)| *since);
        last = Some((shot.clone(), since.unwrap_or_else(Instant::now)));
        since.is_some_and(|since| since.elapsed() > STILL)
    });
    let shot = desktop.keep(still.as_ref(), name);
    assert!(still.is_some(), "the picture never stands still: {}", shot.file());
    shot
}
