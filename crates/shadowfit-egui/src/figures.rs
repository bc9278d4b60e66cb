//! The live figures: the table of the maps, those of the whole frame, and the plot of the frame times.

use std::collections::VecDeque;

use egui::{Grid, RichText, Ui};
use egui_plot::{HLine, Line, Plot, PlotPoints};
use shadowfit::figures::Figures;

use crate::maps;
use crate::units::grouped;

/// Frames that the plot looks back.
const FRAMES: usize = 240;

/// Times of the last frames, in milliseconds, oldest first.
#[derive(Clone, Debug, Default)]
pub(crate) struct History(VecDeque<f32>);

impl History {
    pub(crate) fn push(&mut self, time: Option<f32>) {
        if let Some(time) = time.filter(|time| time.is_finite()) {
            if self.0.len() == FRAMES {
                self.0.pop_front();
            }
            self.0.push_back(time);
        }
    }

    pub(crate) fn plot(&self, ui: &mut Ui) {
        /// A frame at 60 Hz, in milliseconds: the line to stay below.
        const SMOOTH_MS: f64 = 1000.0 / 60.0;
        let greatest = self.0.iter().copied().fold(0.0, f32::max);
        let points: PlotPoints<'_> = self.0.iter().enumerate().map(|(x, &y)| [x as f64, f64::from(y)]).collect();
        let line = Line::new("frame", points).color(ui.visuals().hyperlink_color).fill(0.0).allow_hover(false);
        let limit = HLine::new("60 Hz", SMOOTH_MS).color(ui.visuals().weak_text_color()).allow_hover(false);
        Plot::new("frame times")
            .height(54.0)
            .show_axes(false)
            .show_grid(false)
            .show_x(false)
            .show_y(false)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .default_x_bounds(0.0, FRAMES as f64)
            .default_y_bounds(0.0, f64::from(greatest).max(1.2 * SMOOTH_MS))
            .auto_bounds(false)
            .reset()
            .show(ui, |plot| {
                plot.hline(limit);
                plot.line(line);
            });
        let caption = if self.0.is_empty() {
            "Frame time: not measured".to_owned()
        } else {
            format!("Frame time: at most {greatest:.1} ms in {} frames; line: 60 Hz", self.0.len())
        };
        ui.label(RichText::new(caption).small());
    }
}

/// The figures of the whole frame as name, value and help.
fn lines(figures: &Figures) -> [(&'static str, Option<String>, &'static str); 6] {
    let map = figures.map_ahead.map_or_else(String::new, |map| format!(" on map {}", map + 1));
    [
        (
            "Pixels per texel",
            figures.pixels_per_texel.map(|pixels| format!("{pixels:.2}{map}")),
            "Screen pixels that one shadow texel covers at the picture's centre, along its worse axis, and the map that \
             is read there. Above 1, texels can be seen.",
        ),
        (
            "Frame",
            figures.frame_ms.map(|ms| format!("{ms:.2} ms, {:.0} Hz", 1000.0 / ms)),
            "Time of a whole frame, and frames a second.",
        ),
        ("Shadow passes", figures.shadow_pass_ms.map(time), "GPU time of drawing all shadow maps."),
        ("Scene pass", figures.scene_pass_ms.map(time), "GPU time of drawing the picture."),
        (
            "Shadow draws",
            figures.shadow_draws.map(|draws| grouped(draws.into())),
            "Draw calls of the shadow passes of all maps.",
        ),
        ("Shadow triangles", figures.shadow_triangles.map(grouped), "Triangles drawn into all shadow maps."),
    ]
}

pub(crate) fn show(ui: &mut Ui, figures: &Figures) {
    let gap = 12.0;
    let half = 0.5 * (ui.available_width() - gap);
    if figures.maps.iter().any(Option::is_some) {
        maps::table(ui, figures);
        ui.add_space(4.0);
    }
    Grid::new("figures").num_columns(2).min_col_width(half).spacing([gap, 3.0]).striped(true).show(ui, |ui| {
        for (name, value, help) in lines(figures) {
            ui.label(name).on_hover_text(help);
            let value = value.map_or_else(|| RichText::new("—").weak(), |value| RichText::new(value).strong());
            ui.label(value).on_hover_text(help);
            ui.end_row();
        }
    });
}

fn time(ms: f32) -> String {
    format!("{ms:.2} ms")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_history_forgets_the_oldest_and_what_is_no_time() {
        let mut history = History::default();
        for frame in 0..FRAMES + 3 {
            history.push(Some(frame as f32));
        }
        history.push(None);
        history.push(Some(f32::NAN));
        history.push(Some(f32::INFINITY));
        assert_eq!((history.0.len(), history.0.front()), (FRAMES, Some(&3.0)));
    }
}
