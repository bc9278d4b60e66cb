//! The figures of the picture, of the maps and of the passes.

use egui_kittest::kittest::{NodeT, Queryable};
use shadowfit::settings::MAX_MAPS;
use shadowfit_params::figures::MapFigures;

use crate::host::{Host, harness, harness_with, wait_for_the_tooltip};
use crate::states::{busy, judged, judged_better, session, wide_map};

#[test]
fn figures_that_were_not_measured_are_dashes() {
    let mut harness = harness_with(Host::default(), "Figures");
    assert_eq!(harness.query_all_by_label("—").count(), 8);
    assert!(harness.query_by_label("Map 1").is_none());
    harness.state_mut().figures.shadow_triangles = Some(1_234_567);
    harness.state_mut().figures.frame_ms = Some(5.0);
    harness.state_mut().figures.maps[0] = Some(MapFigures::default());
    harness.run();
    // View depths and waste of the map, and all of its costs, are unknown.
    assert_eq!(harness.query_all_by_label("—").count(), 6 + 6);
    harness.get_by_label("1\u{a0}234\u{a0}567");
    harness.get_by_label("5.00 ms, 200 Hz");
}

#[test]
fn each_map_has_lines_of_figures_that_tell_more_when_hovered() {
    let mut harness = harness_with(Host::default(), "Figures");
    for count in [1, 4, MAX_MAPS] {
        for (map, figures) in harness.state_mut().figures.maps.iter_mut().enumerate() {
            *figures = (map < count).then(|| MapFigures { draws: Some(700 + map as u32), ..wide_map() });
        }
        harness.run();
        for map in 1..=MAX_MAPS {
            let badges = harness.query_all_by_label(&format!("Map {map}")).count();
            assert_eq!(badges, if map <= count { 2 } else { 0 }, "{map} of {count}");
            assert_eq!(harness.query_by_label(&(699 + map).to_string()).is_some(), map <= count, "{map} of {count}");
        }
    }
    for text in ["88\u{a0}%", "67.1\u{a0}M", "88.88\u{a0}ms"] {
        assert_eq!(harness.query_all_by_label(text).count(), MAX_MAPS, "{text}");
    }
    harness.state_mut().figures.maps[1] = Some(MapFigures { is_empty: true, ..wide_map() });
    (harness.state_mut().figures.pixels_per_texel, harness.state_mut().figures.map_ahead) = (Some(1.5), Some(2));
    harness.run();
    harness.get_by_label("1.50 on map 3");
    harness.get_by_label("empty").hover();
    wait_for_the_tooltip(&mut harness);
    let details = harness.get_by_label_contains("Map 2: no receiver is in view");
    let text = details.accesskit_node().label().or(details.value()).expect("a text");
    assert!(text.contains("left caster extension") && text.contains("Triangles: 8\u{a0}888\u{a0}888"), "{text}");
}

#[test]
fn the_quality_of_a_picture_is_its_wrong_pixels_by_class_and_three_more_figures() {
    let mut harness = harness(Host::default());
    harness.get_by_label("No picture has been judged against rays yet.");
    harness.state_mut().figures.judged = Some(judged());
    harness.run();
    harness.get_by_label("2.13\u{a0}% wrong");
    for text in ["False shadow 0.81\u{a0}%", "False light 0.09\u{a0}%", "Hole 0.02\u{a0}%", "Edge 1.21\u{a0}%"] {
        harness.get_by_label(text);
    }
    for text in ["0.64\u{a0}%", "0.11\u{a0}%", "3.27", "judged 0.3 s ago"] {
        harness.get_by_label(text);
    }
    harness.get_by_label_contains("Wrong pixels: False shadow 0.81");
}

#[test]
fn a_fresh_judgement_has_no_age_and_what_was_not_measured_is_a_dash() {
    let mut host = session();
    host.figures.judged = Some(shadowfit_params::figures::JudgedFigures { age: 0.02, crawl: None, ..judged() });
    let harness = harness(host);
    assert!(harness.query_by_label_contains("ago").is_none());
    assert_eq!(harness.query_all_by_label("—").count(), 1);
}

#[test]
fn the_quality_of_two_techniques_stands_side_by_side() {
    let mut harness = harness(busy());
    harness.get_by_label("2.13\u{a0}% wrong");
    harness.get_by_label("0.74\u{a0}% wrong");
    harness.get_by_label("Edge 1.21\u{a0}%, 0.62\u{a0}%");
    harness.get_by_label("Pixels per texel 99% 3.27, 1.60");
    assert_eq!(harness.state().figures.judged_other, Some(judged_better()));
    harness.state_mut().figures.judged_other = None;
    harness.run();
    harness.get_by_label("not judged yet");
    harness.get_by_label("Edge 1.21\u{a0}%, —");
}

#[test]
fn the_top_names_scene_notes_and_message() {
    let notes = vec!["One texture is missing.".to_owned()];
    let harness = harness(Host { notes, message: Some("Saved."), ..Host::default() });
    harness.get_by_label("Courtyard, 262\u{a0}144 triangles");
    harness.get_by_label("One texture is missing.");
    harness.get_by_label("Saved.");
}
