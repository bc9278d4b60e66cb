//! Widgets that a host shows beside the panel: the bar of views, legends, the card of a pixel, the table of
//! keys.

use egui::accesskit::Role;
use egui::{Pos2, Rect, Theme, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, HarnessBuilder};
use shadowfit_egui::{
    Artefact, Command, KEYS, PixelClass, WhyCard, has_legend, help_overlay, keys_of, legend_overlay, view_bar,
    why_card, why_overlay,
};
use shadowfit_params::figures::Figures;
use shadowfit_params::tool::{ErrorMarks, ViewMode, ViewSettings};

use crate::host::builder;
use crate::layout::assert_no_text_is_clipped;
use crate::states::{figures, judged_better};

fn small<State>(size: [f32; 2]) -> HarnessBuilder<State> {
    builder(Vec2::from(size), Theme::Dark, 1.0)
}

fn bar(width: f32) -> Harness<'static, ViewSettings> {
    small([width, 200.0]).build_ui_state(
        |ui, view: &mut ViewSettings| {
            view_bar(ui, view, None);
        },
        ViewSettings::default(),
    )
}

#[test]
fn the_bar_has_a_button_for_each_view_that_chooses_it() {
    let mut harness = bar(1280.0);
    let labels = [
        "Final",
        "Truth",
        "Errors",
        "Pixels per texel",
        "Maps",
        "Texel grid",
        "Demand",
        "Map updates",
        "Outside",
        "Traced",
    ];
    for (mode, label) in ViewMode::ALL.into_iter().zip(labels) {
        let name = format!("View: {label}");
        harness.get_by_role_and_label(Role::Button, &name).click();
        harness.run();
        assert_eq!(harness.state().mode, mode);
    }
}

#[test]
fn the_bar_takes_one_line_of_a_wide_window_and_wraps_in_a_narrow_one() {
    for (width, is_one_line) in [(1280.0 - 360.0, true), (400.0, false)] {
        let harness = bar(width);
        let rects: Vec<Rect> = harness.query_all_by_role(Role::Button).map(|button| button.rect()).collect();
        assert_eq!(rects.len(), ViewMode::ALL.len());
        assert!(rects.iter().all(|rect| rect.right() <= width), "{width}: {rects:?}");
        assert_eq!(rects.iter().all(|rect| rect.top() == rects[0].top()), is_one_line, "{width}");
        assert_no_text_is_clipped(&harness, "the bar");
    }
}

#[test]
fn legends_explain_the_colours_of_their_views() {
    let mut figures = figures();
    for (mode, marks, texts) in [
        (ViewMode::Error, ErrorMarks::Off, &["false shadow 0.81\u{a0}%", "edge 1.21\u{a0}%"][..]),
        (ViewMode::Final, ErrorMarks::Blink, &["hole 0.02\u{a0}%"]),
        (ViewMode::PixelsPerTexel, ErrorMarks::Off, &["Colours of 1/8 to 8 pixels per texel"]),
        (ViewMode::Maps, ErrorMarks::Off, &["map 1", "map 4"]),
        (ViewMode::Demand, ErrorMarks::Off, &["map 1", "Colours of 1/8 to 8 pixels per texel"]),
        (ViewMode::Updates, ErrorMarks::Off, &["kept", "redrawn", "moving"]),
        (ViewMode::Traced, ErrorMarks::Off, &["traced", "left to the filter"]),
    ] {
        let view = ViewSettings { mode, marks, ..ViewSettings::default() };
        let harness = overlay(view, &figures);
        for text in texts {
            assert!(harness.query_by_label(text).is_some(), "{mode:?}: {text}");
        }
        assert_no_text_is_clipped(&harness, "a legend");
    }
    figures.judged_other = Some(judged_better());
    let view = ViewSettings { mode: ViewMode::Error, ..ViewSettings::default() };
    overlay(view, &figures).get_by_label("edge 1.21\u{a0}% | 0.62\u{a0}%");
}

#[test]
fn a_view_without_colours_has_no_legend() {
    let harness = overlay(ViewSettings::default(), &figures());
    assert!(!has_legend(&ViewSettings::default()));
    assert_eq!(harness.query_all_by_role(Role::Label).count(), 0);
}

fn overlay(view: ViewSettings, figures: &Figures) -> Harness<'static, ()> {
    let figures = *figures;
    let mut harness = small([480.0, 300.0]).build_ui_state(
        move |ui, (): &mut ()| {
            let picture = Rect::from_min_size(Pos2::ZERO, Vec2::new(480.0, 300.0));
            legend_overlay(ui.ctx(), picture, &view, &figures);
        },
        (),
    );
    harness.run();
    harness
}

/// A pixel of a real session.
pub(crate) const WHY: WhyCard<'static> = WhyCard {
    class: Some(PixelClass::FalseShadow),
    reason: "The surface is compared with itself: its stored depth is 0.4 texels nearer than the bias allows.",
    map_reason: "Map 2 is the finest window that holds this point.",
    position: Some([-12.341, 0.102, 4.25]),
    map: Some(1),
    texel: Some([1204, 877]),
    stored_depth: Some(0.482_113),
    compared_depth: Some(0.482_155),
    pixels_per_texel: Some(2.71),
};

#[test]
fn the_card_of_a_pixel_says_its_class_the_reasons_and_what_was_read() {
    let harness = small([300.0, 300.0]).build_ui_state(|ui, (): &mut ()| why_card(ui, &WHY), ());
    for text in
        ["False shadow", WHY.reason, WHY.map_reason, "Map 2", "-12.34, 0.10, 4.25 m", "1204, 877", "0.482113", "2.71"]
    {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
    assert_no_text_is_clipped(&harness, "the card");
}

#[test]
fn what_is_not_known_of_a_pixel_gets_no_line() {
    let unknown = WhyCard { class: None, position: None, map: None, texel: None, stored_depth: None, ..WHY };
    let harness = small([300.0, 300.0]).build_ui_state(move |ui, (): &mut ()| why_card(ui, &unknown), ());
    harness.get_by_label("Not judged");
    harness.get_by_label("Compared depth");
    for name in ["Map", "Position", "Stored depth"] {
        assert!(harness.query_by_label(name).is_none(), "{name}");
    }
}

#[test]
fn the_card_of_a_pixel_stays_within_the_picture_beside_the_pointer() {
    // Pictures of windows from phones to 4K, with a bar above and a panel to the right.
    for size in [[360.0, 300.0], [840.0, 620.0], [900.0, 640.0], [3200.0, 1800.0]] {
        let picture = Rect::from_min_size(Pos2::new(12.0, 40.0), size.into());
        let window = [size[0] + 352.0, size[1] + 80.0];
        for share in [Vec2::ZERO, Vec2::ONE, Vec2::new(0.99, 0.02), Vec2::new(0.03, 0.97), Vec2::splat(0.5)] {
            let pointer = picture.lerp_inside(share);
            let shown = move |ui: &mut egui::Ui, (): &mut ()| why_overlay(ui.ctx(), picture, pointer, &WHY);
            let mut harness = small(window).build_ui_state(shown, ());
            harness.run();
            let area = harness.ctx.memory(|memory| memory.area_rect(egui::Id::unique("shadowfit why")));
            let card = area.expect("a card");
            assert!(picture.expand(0.5).contains_rect(card), "{size:?}, {share}: {card:?}");
            let covers = card.contains(pointer);
            assert!(!covers || size[0] < 600.0, "{size:?}, {share}: {card:?} hides {pointer}");
            assert_no_text_is_clipped(&harness, "the card");
        }
    }
}

#[test]
fn a_picture_smaller_than_the_card_cuts_it_off() {
    let picture = Rect::from_min_size(Pos2::new(50.0, 60.0), Vec2::new(120.0, 40.0));
    let shown = move |ui: &mut egui::Ui, (): &mut ()| why_overlay(ui.ctx(), picture, picture.center(), &WHY);
    let mut harness = small([400.0, 300.0]).build_ui_state(shown, ());
    harness.run();
    let shapes = &harness.output().shapes;
    let is_within = |shape: &egui::epaint::ClippedShape| picture.expand(0.5).contains_rect(shape.clip_rect);
    assert!(shapes.iter().filter(|shape| shape.clip_rect.height() < 200.0).all(is_within));
    assert!(shapes.iter().any(is_within));
}

#[test]
fn positions_in_small_models_have_three_digits() {
    let small_model = WhyCard { position: Some([0.0123, -0.004, 0.0]), ..WHY };
    let harness = small([300.0, 300.0]).build_ui_state(move |ui, (): &mut ()| why_card(ui, &small_model), ());
    harness.get_by_label("0.0123, -0.0040, 0.0000 m");
}

fn help(size: [f32; 2]) -> Harness<'static, bool> {
    small(size).build_ui_state(|ui, open: &mut bool| help_overlay(ui.ctx(), open), true)
}

#[test]
fn the_help_lists_every_key_and_closes() {
    let mut harness = help([600.0, 700.0]);
    for line in KEYS.iter().flat_map(|group| &group.keys) {
        harness.get_all_by_label(line.keys).next().expect(line.keys);
        harness.get_all_by_label(&line.does).next().expect(&line.does);
    }
    harness.get_by_role_and_label(Role::Button, "Close window").click();
    harness.run();
    assert!(!*harness.state());
    assert!(harness.query_by_label(KEYS[0].heading).is_none());
}

#[test]
fn the_help_fits_a_common_window_without_scrolling() {
    let mut harness = help([1280.0, 720.0]);
    harness.run();
    for line in KEYS.iter().flat_map(|group| &group.keys) {
        for node in harness.get_all_by_label(&line.does) {
            let rect = node.rect();
            assert!(rect.bottom() <= 720.0 && rect.right() <= 1280.0, "{}: {rect:?}", line.does);
        }
    }
    assert_no_text_is_clipped(&harness, "the help");
}

#[test]
fn the_help_fits_a_low_screen_and_scrolls() {
    let harness = help([400.0, 300.0]);
    let title = harness.get_by_role_and_label(Role::Button, "Close window").rect();
    assert!(title.top() >= 0.0, "the title bar is cut off: {title:?}");
    let last = KEYS.last().and_then(|group| group.keys.last()).expect("there are keys");
    let last = harness.get_all_by_label(&last.does).next_back().expect("it is there").rect();
    assert!(last.top() > 300.0, "the last line should wait to be scrolled to: {last:?}");
}

#[test]
fn the_keys_of_artefacts_and_views_are_in_the_table() {
    let find = |key: &str| KEYS.iter().flat_map(|group| &group.keys).find(|line| line.keys == key).expect("the key");
    for artefact in Artefact::ALL {
        assert!(find(keys_of(&Command::ShowArtefact(artefact))).does.contains(&artefact.label().to_lowercase()));
    }
    let harness = bar(1280.0);
    let buttons: Vec<_> = harness.query_all_by_role(Role::Button).collect();
    for (index, button) in buttons.iter().enumerate() {
        // The tenth has 0.
        let key = (index + 1) % 10;
        let name = button.accesskit_node().label().expect("a name").replace("View: ", "").to_lowercase();
        let does = &find(&key.to_string()).does;
        assert!(does.contains(name.trim_end_matches('s')), "{name}: {does}");
    }
}
