//! Nothing is clipped, in any state, theme and scale.

use egui::accesskit::Role;
use egui::epaint::ClippedShape;
use egui::{Rect, Theme, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use shadowfit::settings::SplitScheme;
use shadowfit_egui::{Artefact, PANEL_WIDTH, Tune, size_for_fingers};
use shadowfit_params::tool::Settings;
use shadowfit_params::{Kind, Number, PARAMETERS, Value};

use crate::controls::{all_rows, everything};
use crate::host::{HEIGHT, Host, builder, find, harness_of, open_harness, open_sections, query_control, visit_texts};
use crate::states::{busy, session, tune_done, wide_judged, widest};

/// Distance that text may extend beyond its clip rectangle, in points, for the rounding of its place.
const SLACK: f32 = 1.0;

/// Asserts that every text is drawn whole: none extends beyond its clip rectangle, and none was shortened.
/// Texts that are scrolled out of view are skipped.
pub(crate) fn assert_no_text_is_clipped<State>(harness: &Harness<'_, State>, state: &str) {
    let mut texts = 0;
    for ClippedShape { clip_rect, shape, .. } in &harness.output().shapes {
        visit_texts(shape, &mut |rect, text, is_shortened| {
            if !rect.intersect(*clip_rect).is_positive() {
                return;
            }
            texts += 1;
            assert!(!is_shortened, "{state}: {text:?} is shortened");
            let allowed = clip_rect.x_range().expand(SLACK);
            let is_whole = allowed.contains(rect.left()) && allowed.contains(rect.right());
            assert!(is_whole, "{state}: {text:?} at {rect:?} is cut off by {clip_rect:?}");
        });
    }
    assert!(texts > 0, "{state}: no text was found");
}

fn set_widest(settings: &mut Settings) {
    for parameter in PARAMETERS {
        let value = match &parameter.kind {
            // Not the greatest value, since the width has that value, which would mean square. This one is as
            // wide.
            Kind::Number(Number { unset: Some(_), max, .. }) => Value::Number(0.999 * max),
            Kind::Number(number) => Value::Number(number.max),
            Kind::Choice(_) if parameter.id == "splits.scheme" => continue,
            Kind::Choice(_) => {
                let is_first = parameter.get(&Settings::default()) == Some(Value::Option(0));
                Value::Option(usize::from(is_first))
            }
            Kind::Toggle => Value::Toggle(parameter.get(&Settings::default()) == Some(Value::Toggle(false))),
        };
        parameter.set(settings, value);
    }
}

#[test]
fn everything_fits_the_panel_width() {
    for settings in all_rows() {
        let mut host = Host { settings, ..widest() };
        // The controls of A, whose rows belong to the settings.
        host.compare = None;
        // The widest values, all changed so that the reset buttons show.
        set_widest(&mut host.settings);
        assert_fits(&open_harness(host));
    }
}

fn assert_fits(harness: &Harness<'_, Host>) {
    let (right, panel) = (harness.state().content_right, harness.state().panel_rect.expect("it was shown"));
    assert!(panel.width() <= PANEL_WIDTH && right <= panel.right(), "the content ends at {right} of {panel:?}");
    for parameter in PARAMETERS {
        let reset = format!("Reset {}", parameter.label);
        let list = format!("{}: powers of two", parameter.label);
        let labels = harness.query_all_by_role(Role::Label).filter(|n| n.value().as_deref() == Some(parameter.label));
        let labels: Vec<_> = labels.filter(|node| node.rect().left() < 100.0).collect();
        let widgets: Vec<Rect> = labels
            .into_iter()
            .take(1)
            .chain(query_control(harness, parameter))
            .chain(find(harness, Role::SpinButton, parameter.label))
            .chain(find(harness, Role::ComboBox, &list))
            .chain(find(harness, Role::Button, &reset))
            .map(|node| node.rect())
            .collect();
        for (index, rect) in widgets.iter().enumerate() {
            assert!(rect.right() <= PANEL_WIDTH, "{}", parameter.id);
            for other in &widgets[..index] {
                let overlap = rect.intersect(*other);
                assert!(!overlap.is_positive(), "{}: {overlap:?}", parameter.id);
            }
        }
    }
}

/// Returns the panel in every state with its own look.
fn all_states() -> Vec<(&'static str, Host)> {
    let mut states = vec![("new", Host::default()), ("session", session()), ("busy", busy()), ("widest", widest())];
    for artefact in Artefact::ALL {
        for fixed in [false, true] {
            let mut host = busy();
            (host.shown.artefact, host.shown.fixed) = (Some(artefact), fixed);
            host.shown.changes = crate::states::changed();
            states.push(("an artefact", host));
        }
    }
    let running = Tune::Running {
        tried: 188,
        at_most: 240,
        start_error: 88.8,
        best_error: 22.2,
        what: "Constant bias 1.50 texels",
    };
    let begun = Tune::Running {
        tried: 0,
        at_most: 1,
        start_error: f32::NAN,
        best_error: f32::NAN,
        what: "Preparing a separate device and the scene",
    };
    let worse = Tune::Done { before: wide_judged(), after: wide_judged(), changes: &[], is_applied: false };
    for tune in [begun, running, tune_done(true), worse, Tune::Failed("The picture has no pixel that faces the light.")]
    {
        states.push(("tune", Host { tune, ..session() }));
    }
    let mut one_judged = busy();
    one_judged.figures.judged_other = None;
    states.push(("B is not judged yet", one_judged));
    states
}

/// Themes and scales of the panel.
const LOOKS: [(Theme, f32); 3] = [(Theme::Dark, 1.0), (Theme::Light, 1.0), (Theme::Dark, 2.0)];

/// Asserts that a state of the panel clips no text in a theme and scale.
fn assert_shows_all((name, mut host): (&str, Host), (theme, scale): (Theme, f32)) {
    host.settings = everything(SplitScheme::Practical(0.5));
    // The menu's button shortens the longest names of saved techniques.
    let mut harness = harness_of(host, theme, scale, HEIGHT);
    open_sections(&mut harness);
    assert_no_text_is_clipped(&harness, &format!("{name}, {theme:?}, scale {scale}"));
    assert_fits(&harness);
}

#[test]
fn no_text_is_clipped_in_any_state_with_a_theme_and_scale_in_turn() {
    for (state, look) in all_states().into_iter().zip(LOOKS.into_iter().cycle()) {
        assert_shows_all(state, look);
    }
}

#[test]
#[ignore = "the full product of states, themes and scales: cargo xtask test --all"]
fn no_text_is_clipped_in_any_state_theme_and_scale() {
    for look in LOOKS {
        for state in all_states() {
            assert_shows_all(state, look);
        }
    }
}

#[test]
fn no_text_is_clipped_in_the_drawer_of_a_phone() {
    /// Nine tenths of 390 points.
    const WIDTH: f32 = 351.0;
    for (name, mut host) in all_states() {
        (host.settings, host.width) = (everything(SplitScheme::Practical(0.5)), Some(WIDTH));
        let harness = builder(Vec2::new(WIDTH, 2.0 * HEIGHT), Theme::Dark, 1.0);
        let mut harness = harness.build_ui_state(|ui, host: &mut Host| host.show(ui), host);
        size_for_fingers(&harness.ctx, true);
        harness.run();
        open_sections(&mut harness);
        assert_no_text_is_clipped(&harness, name);
        let right = harness.state().content_right;
        assert!(right <= WIDTH, "{name}: the content ends at {right}");
        for role in [Role::Button, Role::ComboBox, Role::Slider, Role::CheckBox, Role::DisclosureTriangle] {
            let low = harness.query_all_by_role(role).find(|node| node.rect().height() < 35.5);
            assert!(low.is_none(), "{name}: {:?}", low.map(|node| (node.accesskit_node().label(), node.rect())));
        }
    }
}

#[test]
fn a_long_message_wraps() {
    let harness = harness_of(widest(), Theme::Light, 1.0, HEIGHT);
    let message = harness.state().message.expect("one");
    assert!(harness.get_by_label(message).rect().height() > 25.0);
}

#[test]
fn the_panel_scrolls_in_a_low_window_and_keeps_its_top() {
    let mut harness = builder(Vec2::new(1280.0, 400.0), Theme::Dark, 1.0)
        .build_ui_state(|ui, host: &mut Host| host.show(ui), session());
    let help = harness.get_by_role_and_label(Role::Button, "Help").rect();
    harness.get_by_role_and_label(Role::DisclosureTriangle, "View").scroll_to_me();
    harness.run();
    let view = harness.get_by_role_and_label(Role::DisclosureTriangle, "View").rect();
    assert!(view.bottom() <= 400.0, "{view:?}");
    assert_eq!(harness.get_by_role_and_label(Role::Button, "Help").rect(), help);
}

#[test]
fn sections_stay_as_a_person_left_them() {
    let mut harness = harness_of(session(), Theme::Dark, 1.0, HEIGHT);
    let is_open = |harness: &Harness<'_, Host>| {
        let section = harness.get_by_role_and_label(Role::DisclosureTriangle, "Light");
        section.accesskit_node().data().is_expanded()
    };
    assert_eq!(is_open(&harness), Some(false));
    harness.get_by_role_and_label(Role::DisclosureTriangle, "Light").click();
    harness.run();
    harness.state_mut().message = Some("Something else happened.");
    harness.state_mut().compare = busy().compare;
    harness.run();
    assert_eq!(is_open(&harness), Some(true));
}
