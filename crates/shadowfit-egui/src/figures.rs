//! The live figures in a two-column grid, and the plot of the frame times.

use std::collections::VecDeque;

use egui::{Grid, RichText, Ui};
use egui_plot::{HLine, Line, Plot, PlotPoints};
use shadowfit::Constraint;
use shadowfit::figures::Figures;

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

/// The figures as name, value and help.
fn lines(figures: &Figures) -> [(&'static str, Option<String>, &'static str); 11] {
    [
        ("Texel size", figures.texel_size.map(size), "Width and height of one shadow texel across the light."),
        (
            "Pixels per texel",
            figures.pixels_per_texel.map(|pixels| format!("{pixels:.2}")),
            "Screen pixels that one shadow texel covers at the picture's centre, along its worse axis. Above 1, \
             texels can be seen.",
        ),
        ("Depth range", figures.depth_range.map(length), "Extent of the map along the light."),
        (
            "Depth step",
            figures.depth_step.map(length),
            "Smallest depth difference that the map's format resolves at its far end.",
        ),
        (
            "Sides set by",
            figures.set_by.map(|set_by| {
                if figures.is_empty == Some(true) { "no receiver in view".into() } else { sides(set_by) }
            }),
            "What set the four sides of the map's box: the view, the boxes of the scene that receive shadows, the \
             stable sphere, or an earlier frame. Where it is the view, a shorter shadow distance has finer texels.",
        ),
        (
            "Near, far set by",
            figures.set_by.map(|[.., far, near]| format!("{}, {}", name(near), name(far))),
            "What set the map's near plane, which is the one toward the light, and its far plane.",
        ),
        (
            "Frame",
            figures.frame_ms.map(|ms| format!("{ms:.2} ms, {:.0} Hz", 1000.0 / ms)),
            "Time of a whole frame, and frames a second.",
        ),
        ("Shadow pass", figures.shadow_pass_ms.map(time), "GPU time of drawing the shadow map."),
        ("Scene pass", figures.scene_pass_ms.map(time), "GPU time of drawing the picture."),
        ("Shadow draws", figures.shadow_draws.map(|draws| grouped(draws.into())), "Draw calls of the shadow pass."),
        ("Shadow triangles", figures.shadow_triangles.map(grouped), "Triangles drawn into the shadow map."),
    ]
}

pub(crate) fn show(ui: &mut Ui, figures: &Figures) {
    let gap = 12.0;
    let half = 0.5 * (ui.available_width() - gap);
    Grid::new("figures").num_columns(2).min_col_width(half).spacing([gap, 3.0]).striped(true).show(ui, |ui| {
        for (name, value, help) in lines(figures) {
            ui.label(name).on_hover_text(help);
            let value = value.map_or_else(|| RichText::new("—").weak(), |value| RichText::new(value).strong());
            ui.label(value).on_hover_text(help);
            ui.end_row();
        }
    });
}

/// What set the four sides, each named once.
fn sides(set_by: [Constraint; 6]) -> String {
    let mut names: Vec<&str> = set_by[..4].iter().map(|constraint| name(*constraint)).collect();
    names.sort_unstable();
    names.dedup();
    names.join(", ")
}

/// One word for what set a plane.
fn name(constraint: Constraint) -> &'static str {
    match constraint {
        Constraint::View => "view",
        Constraint::Receivers => "scene",
        Constraint::Casters => "casters",
        Constraint::CasterExtension => "extension",
        Constraint::Sphere => "sphere",
        Constraint::Held => "held",
        _ => "other",
    }
}

fn time(ms: f32) -> String {
    format!("{ms:.2} ms")
}

fn size([u, v]: [f32; 2]) -> String {
    let (unit, scale) = unit(u.max(v));
    format!("{:.2} × {:.2} {unit}", u * scale, v * scale)
}

fn length(metres: f32) -> String {
    let (unit, scale) = unit(metres);
    format!("{:.2} {unit}", metres * scale)
}

/// The unit in which a length reads best, and how many of it are a metre.
fn unit(metres: f32) -> (&'static str, f32) {
    match metres.abs() {
        m if m >= 1000.0 => ("km", 1e-3),
        m if m >= 1.0 => ("m", 1.0),
        m if m >= 0.01 => ("cm", 1e2),
        m if m >= 1e-4 => ("mm", 1e3),
        m if m == 0.0 || m.is_nan() => ("m", 1.0),
        _ => ("µm", 1e6),
    }
}

/// A count with its digits in groups of three.
pub(crate) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped_by_thousands() {
        for (count, text) in [(0, "0"), (999, "999"), (1000, "1 000"), (262_144, "262 144"), (1_000_000, "1 000 000")] {
            assert_eq!(grouped(count).replace('\u{a0}', " "), text);
        }
    }

    #[test]
    fn what_set_the_sides_is_named_once_each() {
        let (view, scene) = (Constraint::View, Constraint::Receivers);
        assert_eq!(sides([view, scene, view, scene, Constraint::Held, Constraint::Casters]), "scene, view");
        assert_eq!(sides([Constraint::Sphere; 6]), "sphere");
    }

    #[test]
    fn lengths_read_in_a_fitting_unit() {
        for (metres, text) in [
            (2345.0, "2.35 km"),
            (110.0, "110.00 m"),
            (0.029, "2.90 cm"),
            (0.0034, "3.40 mm"),
            (0.000_013, "13.00 µm"),
            (0.0, "0.00 m"),
        ] {
            assert_eq!(length(metres), text);
        }
        assert_eq!(size([0.03, 0.005]), "3.00 × 0.50 cm");
    }

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
