//! Windows as narrow or as low as on phones: nothing lies outside, and the picture gets most of the height.

use egui::accesskit::{Node, Role};
use egui::{Event, Modifiers, PointerButton};
use shadowfit_params::tool::ErrorMarks;

use super::*;

const UPRIGHT: [f32; 2] = [390.0, 844.0];
const LYING: [f32; 2] = [844.0, 390.0];

/// Draws a frame in a window of a size. Returns the name, role and place of each control.
fn draw(viewer: &mut Viewer, size: [f32; 2], events: Vec<Event>) -> Vec<(String, Role, Rect)> {
    draw_after(viewer, size, FRAME, events)
}

/// Draws a frame like [`draw`], a number of seconds after the previous frame.
fn draw_after(viewer: &mut Viewer, size: [f32; 2], seconds: f32, events: Vec<Event>) -> Vec<(String, Role, Rect)> {
    let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(size[0], size[1])));
    let input = RawInput { screen_rect, time: Some(viewer.clock), events, ..Default::default() };
    let update = viewer.frame(input, seconds).1.accesskit_update.expect("names are told");
    let place = |node: &Node| {
        let bounds = node.bounds()?;
        let [min, max] = [(bounds.x0, bounds.y0), (bounds.x1, bounds.y1)].map(|(x, y)| Pos2::new(x as f32, y as f32));
        Some((node.label().or(node.value())?.to_owned(), node.role(), Rect::from_min_max(min, max)))
    };
    update.nodes.iter().filter_map(|(_, node)| place(node)).collect()
}

fn find(controls: &[(String, Role, Rect)], name: &str) -> Option<Rect> {
    controls.iter().find(|(other, _, _)| other == name).map(|(_, _, rect)| *rect)
}

fn click_at(viewer: &mut Viewer, size: [f32; 2], pos: Pos2) {
    let button =
        |pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
    draw(viewer, size, vec![Event::PointerMoved(pos)]);
    draw(viewer, size, vec![button(true)]);
    draw(viewer, size, vec![button(false), Event::PointerGone]);
    draw(viewer, size, Vec::new());
}

fn click(viewer: &mut Viewer, size: [f32; 2], name: &str) {
    let controls = draw(viewer, size, Vec::new());
    let at = find(&controls, name).unwrap_or_else(|| panic!("no control is called {name:?}")).center();
    click_at(viewer, size, at);
}

fn with_names(arguments: &[&str]) -> Viewer {
    let mut viewer = ready(arguments, None);
    viewer.interface.context.enable_accesskit();
    (0..3).for_each(|_| drop(draw(&mut viewer, UPRIGHT, Vec::new())));
    viewer
}

/// Returns the size of the picture, in points.
fn picture_size(viewer: &Viewer) -> [f32; 2] {
    let points = viewer.interface.context.pixels_per_point().recip();
    viewer.interface.pictures.size().map(|pixels| pixels as f32 * points)
}

/// Returns the picture's share of the height.
fn picture_share(viewer: &Viewer, size: [f32; 2]) -> f32 {
    picture_size(viewer)[1] / size[1]
}

fn assert_inside(controls: &[(String, Role, Rect)], size: [f32; 2]) {
    for (name, role, rect) in controls {
        let is_inside = rect.left() >= -0.5 && rect.right() <= size[0] + 0.5;
        assert!(is_inside, "{name:?}, a {role:?}, lies at {rect:?}, in {size:?}");
    }
}

#[test]
fn gpu_a_phone_has_the_whole_width_for_the_picture_and_bars_that_fit() {
    let mut viewer = with_names(&[]);
    for size in [UPRIGHT, LYING] {
        (0..3).for_each(|_| drop(draw(&mut viewer, size, Vec::new())));
        let controls = draw(&mut viewer, size, Vec::new());
        assert_inside(&controls, size);
        assert!(picture_share(&viewer, size) >= 0.6, "{size:?}: {}", picture_share(&viewer, size));
        let is_beside = find(&controls, "Auto-tune").is_some();
        assert_eq!(is_beside, size == LYING, "the panel is closed at first where it is narrow");
    }
    draw(&mut viewer, UPRIGHT, Vec::new());
    draw(&mut viewer, UPRIGHT, Vec::new());
    assert!((picture_size(&viewer)[0] - 390.0).abs() < 4.0, "to a pixel, which has four points");
    for name in ["Scene", "Views", "More", "Tune", "Play", "Time of day", "Flying speed"] {
        let rect = find(&draw(&mut viewer, UPRIGHT, Vec::new()), name).unwrap_or_else(|| panic!("{name}"));
        assert!(rect.height() >= 35.5, "{name} is {} points high", rect.height());
    }
}

#[test]
fn gpu_the_drawer_opens_and_closes_by_its_button_beside_it_and_by_escape() {
    let mut viewer = with_names(&[]);
    let is_open = |viewer: &mut Viewer| find(&draw(viewer, UPRIGHT, Vec::new()), "Auto-tune").is_some();
    for way in 0..3 {
        assert!(!is_open(&mut viewer));
        click(&mut viewer, UPRIGHT, "Tune");
        assert!(is_open(&mut viewer), "{way}");
        let panel = find(&draw(&mut viewer, UPRIGHT, Vec::new()), "Panel").expect("a panel");
        assert!(panel.width() <= 0.9 * UPRIGHT[0] + 0.5 && panel.height() >= UPRIGHT[1] - 1.0, "{panel:?}");
        // A click between its controls does not close it.
        click_at(&mut viewer, UPRIGHT, panel.left_top() + vec2(3.0, 3.0));
        assert!(is_open(&mut viewer));
        match way {
            0 => click(&mut viewer, UPRIGHT, "Close the panel"),
            1 => click_at(&mut viewer, UPRIGHT, Pos2::new(15.0, 500.0)),
            _ => {
                viewer.ask(Command::Escape);
                draw(&mut viewer, UPRIGHT, Vec::new());
            }
        }
        assert!(!viewer.window_requests.quit);
    }
    assert!(!is_open(&mut viewer));
    click(&mut viewer, UPRIGHT, "Tune");
    draw(&mut viewer, LYING, Vec::new());
    assert!(!viewer.interface.drawer_open, "a wide window has its panel beside the picture");
}

#[test]
fn gpu_every_control_of_the_panel_is_reached_by_scrolling() {
    let mut viewer = with_names(&[]);
    for size in [UPRIGHT, LYING] {
        if size == UPRIGHT {
            click(&mut viewer, size, "Tune");
        }
        let inside = Pos2::new(size[0] - 100.0, 0.8 * size[1]);
        let wheel = |y: f32| Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: vec2(0.0, y),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        };
        let mut seen: Vec<String> = Vec::new();
        let step = 0.4 * size[1];
        for _ in 0..(2500.0 / step) as u32 {
            let controls = draw(&mut viewer, size, vec![Event::PointerMoved(inside), wheel(-step)]);
            // One second, until the panel stops scrolling.
            (0..2).for_each(|_| drop(draw_after(&mut viewer, size, 0.5, Vec::new())));
            assert_inside(&controls, size);
            let is_whole = |rect: &Rect| rect.top() >= 0.0 && rect.bottom() <= size[1];
            seen.extend(controls.into_iter().filter(|(_, _, rect)| is_whole(rect)).map(|(name, _, _)| name));
        }
        for name in ["Auto-tune", "Technique", "Bias", "Figures", "Plots", "Light", "View"] {
            assert!(seen.iter().any(|other| other == name), "{name} in {size:?}: {seen:?}");
        }
        viewer.ask(Command::Escape);
        draw(&mut viewer, size, Vec::new());
        viewer.window_requests.quit = false;
    }
}

#[test]
fn gpu_views_and_what_is_used_less_are_in_menus() {
    let mut viewer = with_names(&[]);
    click(&mut viewer, UPRIGHT, "Views");
    click(&mut viewer, UPRIGHT, "View: Maps");
    assert_eq!(viewer.stage.settings.view.mode, ViewMode::Maps);
    for (name, is_so) in [
        ("Compare A | B", (|viewer| viewer.stage.is_comparing()) as fn(&Viewer) -> bool),
        ("Freeze", |viewer| viewer.stage.settings.view.freeze_fit),
        ("Mark wrong pixels", |viewer| viewer.stage.settings.view.marks != ErrorMarks::Off),
        ("Help", |viewer| viewer.interface.help_open),
    ] {
        click(&mut viewer, UPRIGHT, "More");
        click(&mut viewer, UPRIGHT, name);
        assert!(is_so(&viewer), "{name}");
    }
    let controls = draw(&mut viewer, UPRIGHT, Vec::new());
    assert_inside(&controls, UPRIGHT);
}

#[test]
fn gpu_an_artefact_is_told_over_the_picture_while_the_panel_is_closed() {
    let mut viewer = with_names(&[]);
    click(&mut viewer, UPRIGHT, "Tune");
    click(&mut viewer, UPRIGHT, "Show acne");
    assert!(!viewer.interface.drawer_open, "the picture is to be looked at");
    until(&mut viewer, "acne", |viewer| viewer.stage.shown().is_some());
    (0..3).for_each(|_| drop(draw(&mut viewer, UPRIGHT, Vec::new())));
    let controls = draw(&mut viewer, UPRIGHT, Vec::new());
    assert_inside(&controls, UPRIGHT);
    let card = find(&controls, "Fix").expect("a button");
    assert!(card.bottom() < 0.6 * UPRIGHT[1], "{card:?}");
    click(&mut viewer, UPRIGHT, "Fix");
    assert_eq!(viewer.stage.shown().map(|shown| shown.fixed), Some(true));
    click(&mut viewer, UPRIGHT, "Close the artefact");
    assert!(viewer.stage.shown().is_none());
}
