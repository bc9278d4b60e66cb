//! The live figures of maps and passes.

use egui::{Grid, Ui};
use shadowfit_params::figures::Figures;

use crate::maps;
use crate::quality::known;
use crate::units::{brief_count, grouped};

/// A figure of the whole frame: name, value, help.
type Line = (&'static str, Option<String>, &'static str);

/// Figures that only techniques with traced edges have.
const OF_TRACED_EDGES: [&str; 2] = ["Traced pixels", "Edge passes"];

fn lines(figures: &Figures) -> [Line; 10] {
    let map = figures.map_ahead.map_or_else(String::new, |map| format!(" on map {}", map + 1));
    [
        (
            "Pixels per texel",
            figures.pixels_per_texel.map(|pixels| format!("{pixels:.2}{map}")),
            "Screen pixels per shadow texel at the picture's centre, along the texel's worse axis, and the map that is \
             read there. Above 1, texels are visible.",
        ),
        (
            "Frame",
            figures.frame_ms.map(|ms| format!("{ms:.2} ms, {:.0} Hz", 1000.0 / ms)),
            "Time of a whole frame, and frames per second.",
        ),
        ("Shadow passes", figures.shadow_pass_ms.map(time), "GPU time of drawing all shadow maps."),
        ("Scene pass", figures.scene_pass_ms.map(time), "GPU time of drawing the picture."),
        (
            "Traced pixels",
            figures.traced.map(|share| format!("{share:.2} %")),
            "Pixels that the maps could not decide, so that rays decided them, in per cent of the pixels that face the \
             light.",
        ),
        ("Edge passes", figures.edges_ms.map(time), "GPU time of the passes that trace edges, and of their inputs."),
        (
            "Judging",
            figures.judge_ms.map(time),
            "GPU time of judging the picture: the probe pass, and shadow rays unless a thread traces them.",
        ),
        (
            "Shadow draws",
            figures.shadow_draws.map(|draws| grouped(draws.into())),
            "Draw calls of the shadow passes of all maps.",
        ),
        ("Shadow triangles", figures.shadow_triangles.map(grouped), "Triangles drawn into all shadow maps."),
        (
            "Texels drawn",
            figures.shadow_texels.map(|texels| brief_count(texels as f64)),
            "Texels of the maps that were drawn in this frame; all others were kept.",
        ),
    ]
}

/// Returns the summary of the folded section: the frame time.
pub(crate) fn summary(figures: &Figures) -> String {
    figures.frame_ms.map(time).unwrap_or_default()
}

pub(crate) fn show(ui: &mut Ui, figures: &Figures) {
    // These lines hold only text.
    ui.spacing_mut().interact_size.y = 0.0;
    let gap = 12.0;
    let half = 0.5 * (ui.available_width() - gap);
    if figures.maps.iter().any(Option::is_some) {
        maps::tables(ui, figures);
        ui.add_space(6.0);
    }
    Grid::new("figures").num_columns(2).min_col_width(half).spacing([gap, 3.0]).show(ui, |ui| {
        // Most techniques trace no edges.
        let is_there = |line: &Line| line.1.is_some() || !OF_TRACED_EDGES.contains(&line.0);
        for (name, value, help) in lines(figures).into_iter().filter(is_there) {
            ui.label(name).on_hover_text(help);
            ui.label(known(value)).on_hover_text(help);
            ui.end_row();
        }
    });
}

fn time(ms: f32) -> String {
    format!("{ms:.2} ms")
}
