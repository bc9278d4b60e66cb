//! The bars above and below the picture: each control is found by its name and works.

use egui::accesskit::{Node, Role};
use egui::{Event, Modifiers, PlatformOutput, PointerButton};

use super::*;

/// Wide enough for each bar to fit into one line.
const WIDE: [f32; 2] = [1280.0, 400.0];

fn wide_frame(viewer: &mut Viewer, events: Vec<Event>) -> PlatformOutput {
    let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(WIDE[0], WIDE[1])));
    let input = RawInput { screen_rect, time: Some(viewer.clock), events, ..Default::default() };
    viewer.frame(input, FRAME).1
}

/// Returns the middle of the control with a name, and its role.
fn control(viewer: &mut Viewer, name: &str) -> Option<(Pos2, Role)> {
    let update = wide_frame(viewer, Vec::new()).accesskit_update.expect("names are told");
    let is_it = |node: &&Node| node.label() == Some(name);
    let node = update.nodes.iter().map(|(_, node)| node).find(is_it)?;
    let bounds = node.bounds()?;
    let at = Pos2::new(0.5 * (bounds.x0 + bounds.x1) as f32, 0.5 * (bounds.y0 + bounds.y1) as f32);
    Some((at, node.role()))
}

/// Clicks on the control with a name, `to_the_right` points beside its middle.
fn click(viewer: &mut Viewer, name: &str, to_the_right: f32) {
    let (at, _) = control(viewer, name).unwrap_or_else(|| panic!("no control is called {name:?}"));
    let pos = at + vec2(to_the_right, 0.0);
    let button =
        |pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
    wide_frame(viewer, vec![Event::PointerMoved(pos)]);
    wide_frame(viewer, vec![button(true)]);
    wide_frame(viewer, vec![button(false)]);
    wide_frame(viewer, Vec::new());
}

fn with_names() -> Viewer {
    let mut viewer = ready(&[], None);
    viewer.interface.context.enable_accesskit();
    // The window was narrow until now, with other bars.
    (0..3).for_each(|_| drop(wide_frame(&mut viewer, Vec::new())));
    viewer
}

#[test]
fn gpu_the_bar_above_opens_scenes_and_changes_views() {
    let mut viewer = with_names();
    for (name, mode) in [("Truth", ViewMode::Truth), ("Maps", ViewMode::Maps), ("Final", ViewMode::Final)] {
        click(&mut viewer, &format!("View: {name}"), 0.0);
        assert_eq!(viewer.stage.settings.view.mode, mode, "{name}");
    }
    click(&mut viewer, "Freeze", 0.0);
    assert!(viewer.stage.settings.view.freeze_fit);
    click(&mut viewer, "Freeze", 0.0);
    click(&mut viewer, "A | B", 0.0);
    assert!(viewer.stage.is_comparing() && control(&mut viewer, "Bar between A and B").is_some());
    click(&mut viewer, "A | B", 0.0);
    assert!(!viewer.stage.is_comparing());
    click(&mut viewer, "Scene", 0.0);
    click(&mut viewer, "Plain", 0.0);
    until(&mut viewer, "the plain", |viewer| viewer.source == SceneSource::from_text("plain"));
}

#[test]
fn gpu_escape_closes_what_is_open_before_it_quits() {
    let mut viewer = with_names();
    click(&mut viewer, "Scene", 0.0);
    assert!(control(&mut viewer, "Plain").is_some());
    run(&mut viewer, Command::Escape);
    frame(&mut viewer);
    assert!(control(&mut viewer, "Plain").is_none() && !viewer.window_requests.quit);
    run(&mut viewer, Command::ToggleHelp);
    run(&mut viewer, Command::Escape);
    assert!(!viewer.interface.help_open && !viewer.window_requests.quit);
    run(&mut viewer, Command::Escape);
    assert!(viewer.window_requests.quit);
}

#[test]
fn gpu_the_bar_below_poses_the_scene_and_sets_the_sun_and_the_speed() {
    let mut viewer = with_names();
    click(&mut viewer, "Play", 0.0);
    assert!(viewer.stage.settings.view.play);
    click(&mut viewer, "Pause", 0.0);
    assert!(!viewer.stage.settings.view.play);
    let before = viewer.stage.seconds();
    click(&mut viewer, "Time of the animation", 10.0);
    assert!((viewer.stage.seconds() - before).abs() > 0.5, "{before} and {} s", viewer.stage.seconds());
    click(&mut viewer, "Sun", 0.0);
    assert!(viewer.stage.settings.light.animate);
    click(&mut viewer, "Sun", 0.0);
    click(&mut viewer, "Time of day", 10.0);
    assert!(viewer.stage.settings.light.hour.is_some());
    click(&mut viewer, "Sun by angles", 0.0);
    assert_eq!(viewer.stage.settings.light.hour, None);
    let role = control(&mut viewer, "Flying speed").map(|(_, role)| role);
    assert_eq!(role, Some(Role::SpinButton));
}
