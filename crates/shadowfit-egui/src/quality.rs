//! The share of wrong pixels, judged against rays, for one technique or two.

use egui::text::LayoutJob;
use egui::{
    Align, Color32, CornerRadius, Grid, Layout, Rect, Response, RichText, Role, Sense, StrokeKind, TextFormat,
    TextStyle, Ui, Vec2, WidgetInfo,
};
use shadowfit_params::figures::{Figures, JudgedFigures};

use crate::classes::shares;
use crate::theme::{Palette, figure_font};
use crate::units::{percent, percent_number};
use crate::widgets::{ValueRow, caption, card, title};

/// Age from which the card shows it, in seconds.
const OLD: f32 = 0.15;

/// Help of the total.
const WRONG_HELP: &str = "Pixels whose verdict, lit or not, differs from the rays, in per cent of the pixels that face \
                          the light within the shadow distance. Edges count.";

/// A figure other than a class: name, help, value.
type Figure = (&'static str, &'static str, fn(&JudgedFigures) -> Option<String>);

/// The figures below the classes.
const FIGURES: [Figure; 4] = [
    (
        "Light error",
        "Error of the sunlight, in per cent of the sunlight without shadows. Includes soft edges. Surfaces at grazing \
         light weigh as little as they show.",
        |judged| Some(percent(judged.light_error)),
    ),
    (
        "FLIP",
        "How different the picture looks from the same picture with true shadows: the mean FLIP error of rendering \
         papers, 0 (equal) to 1. Measured once nothing moves (Space pauses), but not in browsers.",
        |judged| judged.flip.map(|flip| format!("{flip:.4}")),
    ),
    (
        "Crawl",
        "Pixels near edges whose verdict changed only because the maps changed, in per cent of the compared pixels: \
         edges that crawl while the camera flies.",
        |judged| judged.crawl.map(percent),
    ),
    (
        "Pixels per texel 99%",
        "Screen pixels per texel, along the texel's worse axis, in the worst hundredth of the picture (99% quantile). \
         Above 1, texels are visible.",
        |judged| judged.pixels_per_texel.map(|[_, _, worst]| format!("{worst:.2}")),
    ),
];

/// Shows the card. `unjudged` is the reason why there can be no figures.
pub(crate) fn show(ui: &mut Ui, figures: &Figures, is_compared: bool, unjudged: Option<&str>) {
    card(ui, None, |ui| {
        ui.horizontal(|ui| {
            title(ui, "Quality").on_hover_text("Comparison of the picture with rays, which find every shadow exactly.");
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| age(ui, figures.judged.as_ref()));
        });
        match (&figures.judged, &figures.judged_other) {
            (None, _) => {
                caption(ui, unjudged.unwrap_or("No picture has been judged against rays yet."));
            }
            (Some(a), b) if is_compared => two(ui, a, b.as_ref()),
            (Some(judged), _) => one(ui, judged),
        }
    });
}

fn age(ui: &mut Ui, judged: Option<&JudgedFigures>) {
    if let Some(judged) = judged.filter(|judged| judged.age >= OLD) {
        let text = if judged.age < 60.0 { format!("{:.1} s", judged.age) } else { "a minute or more".to_owned() };
        ui.label(RichText::new(format!("judged {text} ago")).small().weak());
    }
}

fn one(ui: &mut Ui, judged: &JudgedFigures) {
    wrong(ui, judged, Palette::of(ui).strong);
    bar(ui, judged, judged.wrong);
    ui.spacing_mut().item_spacing.x = 16.0;
    ui.columns_const(|columns: &mut [Ui; 2]| {
        for (index, (class, fill, share)) in shares(judged).into_iter().enumerate() {
            row(&mut columns[index % 2], Some(fill), class.label(), class.help(), &[Some(percent(share))]);
        }
    });
    ui.add_space(3.0);
    ui.spacing_mut().interact_size.y = 0.0;
    Grid::new("quality figures")
        .num_columns(FIGURES.len())
        .min_col_width(0.17 * ui.available_width())
        .spacing([14.0, 1.0])
        .show(ui, |ui| {
            for (name, help, _) in FIGURES {
                ui.label(RichText::new(name).small().weak()).on_hover_text(help);
            }
            ui.end_row();
            for (_, help, value) in FIGURES {
                ui.label(known(value(judged))).on_hover_text(help);
            }
            ui.end_row();
        });
}

fn two(ui: &mut Ui, a: &JudgedFigures, b: Option<&JudgedFigures>) {
    let palette = Palette::of(ui);
    let sides = [("A", Some(a), palette.accent), ("B", b, palette.second)];
    // Both bars have the same scale.
    let full = b.map_or(a.wrong, |b| b.wrong.max(a.wrong));
    ui.columns_const(|columns: &mut [Ui; 2]| {
        for (ui, (name, judged, color)) in columns.iter_mut().zip(sides) {
            ui.label(RichText::new(name).color(color));
            match judged {
                Some(judged) => {
                    wrong(ui, judged, color);
                    bar(ui, judged, full);
                }
                None => {
                    caption(ui, "not judged yet");
                }
            }
        }
    });
    ui.add_space(2.0);
    let others = b.map(shares);
    for (index, (class, fill, share)) in shares(a).into_iter().enumerate() {
        let other = others.map(|others| percent(others[index].2));
        row(ui, Some(fill), class.label(), class.help(), &[Some(percent(share)), other]);
    }
    ui.separator();
    for (name, help, read) in FIGURES {
        row(ui, None, name, help, &[read(a), b.and_then(read)]);
    }
}

/// Shows a row of a table, close to the previous one.
fn row(ui: &mut Ui, fill: Option<Color32>, name: &str, help: &str, values: &[Option<String>]) {
    /// Width of a column of values, in points.
    const WIDTH: f32 = 72.0;
    ui.spacing_mut().item_spacing.y = 0.0;
    ValueRow { fill, name, values, width: WIDTH }.show(ui).on_hover_text(help);
}

/// Returns a value, or a dash if it was not measured.
pub(crate) fn known(value: Option<String>) -> RichText {
    value.map_or_else(|| RichText::new("—").weak(), |value| RichText::new(value).strong())
}

/// Shows the share of wrong pixels in large digits.
fn wrong(ui: &mut Ui, judged: &JudgedFigures, color: Color32) -> Response {
    let mut job = LayoutJob::default();
    let format = |font_id, color| TextFormat { font_id, color, valign: Align::BOTTOM, ..TextFormat::default() };
    job.append(&percent_number(judged.wrong), 0.0, format(figure_font(ui), color));
    let small = format(TextStyle::Body.resolve(ui.style()), ui.visuals().weak_text_color());
    job.append("\u{a0}% wrong", 0.0, small);
    ui.label(job).on_hover_text(WRONG_HELP)
}

/// Shows the classes of wrong pixels beside each other. The full width means `full` per cent.
fn bar(ui: &mut Ui, judged: &JudgedFigures, full: f32) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), 8.0), Sense::hover());
    let shares = shares(judged);
    let text = shares.map(|(class, _, share)| format!("{} {}", class.label(), percent(share))).join(", ");
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("Wrong pixels: {text}")));
    if ui.is_rect_visible(rect) {
        let radius = CornerRadius::same(3);
        ui.painter().rect_filled(rect, radius, ui.visuals().extreme_bg_color);
        let mut left = rect.left();
        for (_, fill, share) in shares {
            let width = if full > 0.0 { (share / full).clamp(0.0, 1.0) * rect.width() } else { 0.0 };
            let right = (left + width).min(rect.right());
            ui.painter().rect_filled(Rect::from_x_y_ranges(left..=right, rect.y_range()), CornerRadius::ZERO, fill);
            left = right;
        }
        let line = ui.visuals().widgets.noninteractive.bg_stroke;
        ui.painter().rect_stroke(rect, radius, line, StrokeKind::Outside);
    }
    response.on_hover_text(text)
}
