//! The figures over time, one plot at a time.

use egui::{Color32, ComboBox, Ui, Vec2};
use egui_plot::{GridMark, HLine, HoverPosition, Line, Plot, PlotPoints};
use shadowfit_params::figures::{ERROR_COLORS, MAP_TINTS};

use crate::Command;
use crate::accessibility::rename;
use crate::history::{History, SERIES};
use crate::theme::{Palette, readable};
use crate::units::brief_count;
use crate::widgets::{caption, color, color_entry, color_line};

/// Height of the plot, in points.
const HEIGHT: f32 = 150.0;

/// Greatest height of the menu, in points: all plots without scrolling.
const MENU_HEIGHT: f32 = 300.0;

/// Space for half of the last time label below the plot, in points.
const RIGHT_MARGIN: f32 = 14.0;

/// Shortest time range of a plot, in seconds.
const LEAST_SECONDS: f64 = 10.0;

/// Time of a frame at 60 Hz, in milliseconds, drawn as a line.
const SMOOTH_MS: f64 = 1000.0 / 60.0;

/// A group of series in one plot.
struct Choice {
    name: &'static str,
    help: &'static str,
    series: &'static [&'static str],
}

/// The plots, in display order.
const PLOTS: [Choice; 9] = [
    Choice {
        name: "Wrong pixels",
        help: "Wrong pixels and their classes, in per cent of the judged pixels.",
        series: &["wrong", "false shadow", "false light", "hole", "edge"],
    },
    Choice {
        name: "Wrong pixels, A | B",
        help: "Wrong pixels of both techniques, in per cent of the judged pixels.",
        series: &["wrong", "wrong of B"],
    },
    Choice {
        name: "Light error",
        help: "Error of the sunlight, in per cent of the sunlight without shadows.",
        series: &["light error", "light error of B"],
    },
    Choice {
        name: "FLIP",
        help: "Mean FLIP error of the picture against the same picture with true shadows, while the view rests.",
        series: &["flip", "flip of B"],
    },
    Choice {
        name: "Crawl",
        help: "Pixels near edges that changed only because the maps changed, in per cent of the compared pixels.",
        series: &["crawl"],
    },
    Choice {
        name: "Pixels per texel",
        help: "Screen pixels per texel, 95% quantile of the picture.",
        series: &["pixels per texel 95%"],
    },
    Choice {
        name: "Traced pixels",
        help: "Pixels whose edges rays decide, in per cent of the pixels that face the light.",
        series: &["traced"],
    },
    Choice {
        name: "Time of passes",
        help: "GPU time of the passes, and time of the whole frame. Line: a frame at 60 Hz.",
        series: &["shadow passes", "scene pass", "edge passes", "judging", "frame"],
    },
    Choice {
        name: "Texels drawn",
        help: "Texels of the maps that were drawn, without kept texels.",
        series: &["texels drawn"],
    },
];

/// The chosen plot, and the figures.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plots {
    pub(crate) history: History,
    chosen: usize,
}

impl Plots {
    /// Shows the menu, the plot, a legend with the last values, and the buttons.
    pub(crate) fn show(&mut self, ui: &mut Ui, command: &mut Option<Command>) {
        let mut chosen = self.chosen;
        let list = ComboBox::from_id_salt("plot").width(ui.available_width()).height(MENU_HEIGHT);
        let list = list.selected_text(PLOTS[chosen].name).show_ui(ui, |ui| {
            for (index, plot) in PLOTS.iter().enumerate() {
                ui.selectable_value(&mut chosen, index, plot.name).on_hover_text(plot.help);
            }
        });
        rename(ui, &list.response, "Plot".to_owned());
        self.chosen = chosen;
        let plot = &PLOTS[chosen];
        list.response.on_hover_text(plot.help);
        let lines: Vec<(usize, Color32)> = plot.series.iter().map(|name| line(ui, name)).collect();
        self.plot(ui, plot, &lines);
        legend(ui, &self.history, &lines);
        self.buttons(ui, command);
    }

    fn plot(&self, ui: &mut Ui, choice: &Choice, lines: &[(usize, Color32)]) {
        let greatest =
            lines.iter().flat_map(|(series, _)| self.history.points(*series)).map(|[_, y]| y).fold(0.0, f64::max);
        let unit = SERIES[lines[0].0].unit;
        let has_limit = unit == "ms";
        let top = if has_limit { (1.1 * greatest).max(1.2 * SMOOTH_MS) } else { (1.1 * greatest).max(1e-3) };
        let weak = ui.visuals().weak_text_color();
        let seconds = self.history.seconds().max(LEAST_SECONDS);
        fixed_plot(ui, choice.name, seconds, top, unit).show(ui, |plot| {
            if has_limit {
                plot.hline(HLine::new("60 Hz", SMOOTH_MS).color(weak).allow_hover(false));
            }
            for (series, color) in lines {
                let points: PlotPoints<'_> = self.history.points(*series).collect();
                plot.line(Line::new(SERIES[*series].name, points).color(*color).width(1.5));
            }
        });
        if self.history.is_empty() {
            caption(ui, "Nothing measured yet.");
        }
    }

    fn buttons(&mut self, ui: &mut Ui, command: &mut Option<Command>) {
        ui.horizontal(|ui| {
            let (pause, help) = if self.history.is_paused {
                ("Resume", "Continues plotting.")
            } else {
                ("Pause", "Stops plotting, so that you can study the plot.")
            };
            if ui.button(pause).on_hover_text(help).clicked() {
                self.history.is_paused = !self.history.is_paused;
            }
            if ui.button("Clear").on_hover_text("Clears all plots.").clicked() {
                self.history.clear();
            }
            let save = ui.add_enabled(!self.history.is_empty(), egui::Button::new("Save CSV"));
            if save.on_hover_text("Saves all figures of the last minute as comma-separated values.").clicked() {
                *command = Some(Command::SaveFigures(None));
            }
        });
    }
}

/// Returns an empty plot of the last `seconds`, with values in `unit` from 0 to `top`, that cannot be moved.
fn fixed_plot(ui: &Ui, name: &str, seconds: f64, top: f64, unit: &'static str) -> Plot<'static> {
    let line = ui.visuals().widgets.noninteractive.bg_stroke.color;
    Plot::new(("plot", name))
        .height(HEIGHT)
        .width(ui.available_width() - RIGHT_MARGIN)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .set_margin_fraction(Vec2::ZERO)
        .default_x_bounds(-seconds, 0.0)
        .default_y_bounds(0.0, top)
        .auto_bounds(false)
        .reset()
        .y_axis_min_width(34.0)
        .label_formatter(move |hover| Some(hovered(hover, unit)))
        .x_grid_spacer(move |_| grid(-seconds))
        .y_grid_spacer(move |_| grid(top))
        .grid_color(line.gamma_multiply(0.8))
        .x_axis_formatter(move |mark, _| time_value(mark.value, seconds))
        .y_axis_formatter(move |mark, _| axis_value(mark.value, unit))
}

/// Returns the grid lines from 0 to a range that may be negative: three to six lines at round numbers.
fn grid(range: f64) -> Vec<GridMark> {
    let step = round_step(range.abs());
    let count = (range.abs() / step) as i32;
    let mark = |index: i32| GridMark { value: f64::from(index) * step * range.signum(), step_size: step };
    (0..=count).map(mark).collect()
}

/// Returns the least of 1, 2 and 5, times a power of ten, that fits at most five times into a range.
fn round_step(range: f64) -> f64 {
    let power = 10.0_f64.powf((range / 5.0).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|step| step * power).into_iter().find(|step| range / step <= 5.0);
    step.unwrap_or(range)
}

/// Returns the label of a time on the axis, in seconds before now.
fn time_value(time: f64, range: f64) -> String {
    match time {
        0.0 => "now".to_owned(),
        // The first label would collide with the corner of the other axis.
        _ if time < -0.97 * range => String::new(),
        _ => format!("{time:.0} s"),
    }
}

/// Returns the text beside the pointer: value and time, and the name of the nearest series.
fn hovered(hover: &HoverPosition<'_>, unit: &str) -> String {
    let (name, position) = match hover {
        HoverPosition::NearDataPoint { plot_name, position, .. } => (format!("{plot_name}\n"), position),
        HoverPosition::Elsewhere { position } => (String::new(), position),
    };
    format!("{name}{}\n{:.1} s ago", with_unit(position.y, unit), -position.x)
}

/// Returns a value with its unit, with two decimals or as a brief count.
fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "texels" => brief_count(value),
        _ => format!("{value:.2}\u{a0}{unit}"),
    }
}

/// Returns the label of a value on the axis, with its unit.
fn axis_value(value: f64, unit: &str) -> String {
    match unit {
        "texels" => brief_count(value),
        _ => format!("{} {unit}", short_number(value)),
    }
}

/// Returns a round number without the rounding digits of its binary fraction.
fn short_number(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Returns the index of a series, and its colour in a plot.
fn line(ui: &Ui, name: &str) -> (usize, Color32) {
    let palette = Palette::of(ui);
    let index = SERIES.iter().position(|series| series.name == name).unwrap_or(0);
    let fill = match name {
        "false shadow" => color(ERROR_COLORS[0]),
        "false light" => color(ERROR_COLORS[1]),
        "hole" => color(ERROR_COLORS[2]),
        "edge" => color(ERROR_COLORS[3]),
        "wrong" | "frame" => palette.strong,
        "wrong of B" | "light error of B" | "scene pass" => palette.second,
        "judging" => color(MAP_TINTS[4]),
        _ => palette.accent,
    };
    (index, readable(fill, ui.visuals().extreme_bg_color))
}

fn legend(ui: &mut Ui, history: &History, lines: &[(usize, Color32)]) {
    color_line(ui, |ui| {
        for (index, color) in lines {
            let series = &SERIES[*index];
            let value = history.last(*index).map(|value| with_unit(f64::from(value), series.unit));
            let value = value.unwrap_or_else(|| "—".to_owned());
            color_entry(ui, *color, series.name, Some(&value));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_have_a_few_lines_at_round_numbers() {
        for (range, step) in [(10.0, 2.0), (20.0, 5.0), (60.0, 20.0), (0.7, 0.2), (3.0, 1.0), (5e6, 1e6)] {
            let found = round_step(range);
            assert!((found - step).abs() < 1e-9 * step, "{range}: {found}");
        }
        assert!(grid(-10.0).iter().map(|mark| mark.value).eq([0.0, -2.0, -4.0, -6.0, -8.0, -10.0]));
    }

    #[test]
    fn every_plot_shows_series_of_one_unit_and_every_series_is_in_a_plot() {
        let find = |name: &str| SERIES.iter().position(|series| series.name == name).expect("a series");
        let mut seen = [false; SERIES.len()];
        for plot in &PLOTS {
            let unit = SERIES[find(plot.series[0])].unit;
            for name in plot.series {
                assert_eq!(SERIES[find(name)].unit, unit, "{}", plot.name);
                seen[find(name)] = true;
            }
        }
        assert_eq!(seen, [true; SERIES.len()]);
    }
}
