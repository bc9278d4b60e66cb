//! Figures and states of a real session, and the widest ones.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use shadowfit::BoundSource;
use shadowfit::Technique;
use shadowfit::diagnostics::DepthRounding;
use shadowfit::settings::MAX_MAPS;
use shadowfit_egui::{Artefact, Changes, Tune, UserPreset};
use shadowfit_params::figures::{Figures, JudgedFigures, MapFigures};

use crate::host::{Host, Shown};

/// A picture that was judged in a real session.
pub(crate) fn judged() -> JudgedFigures {
    JudgedFigures {
        wrong: 2.13,
        false_shadow: 0.81,
        false_light: 0.09,
        hole: 0.02,
        edge: 1.21,
        light_error: 0.64,
        flip: Some(0.0112),
        uncovered: 0.0,
        pixels_per_texel: Some([0.82, 1.94, 3.27]),
        crawl: Some(0.11),
        age: 0.3,
        size: [1280, 720],
    }
}

/// The same picture with a better technique.
pub(crate) fn judged_better() -> JudgedFigures {
    JudgedFigures {
        wrong: 0.74,
        false_shadow: 0.004,
        false_light: 0.12,
        hole: 0.0,
        edge: 0.62,
        light_error: 0.21,
        flip: Some(0.0043),
        pixels_per_texel: Some([0.44, 1.02, 1.6]),
        ..judged()
    }
}

fn map(index: usize) -> MapFigures {
    let scale = 4.0_f32.powf(index as f32);
    MapFigures {
        view_depths: Some([0.1 + 6.0 * (scale - 1.0), 0.1 + 6.0 * (4.0 * scale - 1.0)]),
        bounds_from: [BoundSource::Receivers; 6],
        is_empty: false,
        extent: [8.2 * scale, 8.2 * scale],
        texel_size: [0.004 * scale, 0.004 * scale],
        depth_range: 21.4 + 3.0 * scale,
        rounding: DepthRounding { step: 0.000_013, needed: 0.000_02, bias: 0.000_3 },
        casters: Some(214),
        draws: Some(61),
        triangles: Some(182_114),
        texels: Some(if index < 2 { 4_194_304 } else { 0 }),
        pass_ms: Some(0.22 / scale),
        waste: Some(0.18 + 0.07 * index as f32),
    }
}

/// The figures of a real session.
pub(crate) fn figures() -> Figures {
    Figures {
        maps: std::array::from_fn(|index| (index < 4).then(|| map(index))),
        map_ahead: Some(0),
        pixels_per_texel: Some(1.23),
        frame_ms: Some(8.4),
        shadow_pass_ms: Some(0.41),
        scene_pass_ms: Some(1.25),
        edges_ms: None,
        traced: None,
        shadow_draws: Some(244),
        shadow_triangles: Some(728_456),
        shadow_texels: Some(8_388_608),
        judge_ms: Some(2.31),
        judged: Some(judged()),
        judged_other: None,
    }
}

/// A panel in a real session.
pub(crate) fn session() -> Host {
    Host {
        figures: figures(),
        changes: Changes { undo: Some("Constant bias"), redo: None },
        presets: vec![UserPreset { name: "evening street".into(), technique: Technique::default().with_fade(0.2) }],
        ..Host::default()
    }
}

/// Returns the changes of a search or a cure.
pub(crate) fn changed() -> Vec<String> {
    vec!["Constant bias: 0 → 1 texel".into(), "Receiver plane: 0 → 2.5 texels".into(), "Filter: Point → PCF 5×5".into()]
}

/// Returns a finished search.
pub(crate) fn tune_done(is_applied: bool) -> Tune<'static> {
    Tune::Done { before: judged(), after: judged_better(), changes: changed().leak(), is_applied }
}

/// Returns a host that shows an artefact, compares two techniques, and has finished a search.
pub(crate) fn busy() -> Host {
    let mut host = session();
    host.message = Some("Saved shadowfit-004.png");
    host.shown = Shown {
        artefact: Some(Artefact::Acne),
        fixed: false,
        narration: "Look at the left wall: it faces the sun and is striped.".into(),
        changes: Vec::new(),
    };
    host.compare = Some((Technique::preset("calm-4").expect("a preset"), true));
    host.figures.judged_other = Some(judged_better());
    host.tune = tune_done(false);
    host
}

/// Returns a map with the widest figures of a real scene.
pub(crate) fn wide_map() -> MapFigures {
    MapFigures {
        view_depths: Some([888.8, 8888.8]),
        bounds_from: [BoundSource::CasterExtension; 6],
        is_empty: false,
        extent: [888.8, 888.8],
        texel_size: [0.8888, 0.8888],
        depth_range: 888.8,
        rounding: DepthRounding { step: 0.000_088_8, needed: 0.000_1, bias: 0.000_3 },
        casters: Some(8888),
        draws: Some(8888),
        triangles: Some(8_888_888),
        texels: Some(67_108_864),
        pass_ms: Some(88.88),
        waste: Some(0.88),
    }
}

/// Returns a judgement with the widest figures.
pub(crate) fn wide_judged() -> JudgedFigures {
    JudgedFigures {
        wrong: 88.8,
        false_shadow: 22.2,
        false_light: 22.2,
        hole: 22.2,
        edge: 22.2,
        light_error: 88.8,
        flip: Some(0.8888),
        uncovered: 88.8,
        pixels_per_texel: Some([888.8, 888.8, 888.8]),
        crawl: Some(88.8),
        age: 59.9,
        size: [3840, 2160],
    }
}

/// Returns a host with the widest content in every part.
pub(crate) fn widest() -> Host {
    let mut host = busy();
    host.shown.artefact = Some(Artefact::ClippingHole);
    host.notes = vec!["The texture 'bark.ktx2' has a compression that is not supported; it is drawn grey.".into()];
    host.message = Some("Saved the picture as shadowfit-2026-07-02-12-30-00.png in the current folder.");
    host.presets[0].name = "a name of the greatest length, so to say".into();
    host.figures = Figures {
        maps: [Some(wide_map()); MAX_MAPS],
        map_ahead: Some(7),
        pixels_per_texel: Some(888.88),
        frame_ms: Some(888.88),
        shadow_pass_ms: Some(88.88),
        scene_pass_ms: Some(88.88),
        edges_ms: Some(88.88),
        traced: Some(88.88),
        shadow_draws: Some(88_888),
        shadow_triangles: Some(88_888_888),
        shadow_texels: Some(536_870_912),
        judge_ms: Some(88.88),
        judged: Some(wide_judged()),
        judged_other: Some(wide_judged()),
    };
    host
}

/// Opens the plots, and changes the figures for half a minute.
pub(crate) fn play(harness: &mut Harness<'_, Host>) {
    for section in ["Fit", "Figures"] {
        // The sections above stay folded.
        assert!(harness.query_by_role_and_label(Role::DisclosureTriangle, section).is_some());
    }
    harness.get_by_role_and_label(Role::DisclosureTriangle, "Plots").click();
    harness.run();
    for step in 0..600 {
        let t = step as f32 * 0.05;
        let wave = |speed: f32| 1.0 + 0.3 * (speed * t).sin();
        let figures = &mut harness.state_mut().figures;
        let judged = JudgedFigures {
            false_shadow: 0.81 * wave(0.7),
            edge: 1.21 * wave(0.31),
            false_light: 0.3 * wave(1.7),
            hole: 0.2 * wave(0.11),
            ..judged()
        };
        let wrong = judged.false_shadow + judged.edge + judged.false_light + judged.hole;
        figures.judged = Some(JudgedFigures { wrong, ..judged });
        figures.frame_ms = Some(8.4 * wave(2.0));
        harness.step();
    }
    harness.get_by_role_and_label(Role::ComboBox, "Plot").scroll_to_me();
    harness.run();
}
