//! The legends of the views' colours.

use egui::{
    Align2, Area, Context, CornerRadius, Frame, Id, Mesh, Order, Pos2, Rect, Role, Sense, Shape, TextStyle, Ui, Vec2,
    WidgetInfo,
};
use shadowfit_params::figures::{EDGE_COLORS, Figures, MAP_TINTS, PIXELS_PER_TEXEL_COLORS, pixels_per_texel_color};
use shadowfit_params::tool::{ErrorMarks, ViewColors, ViewSettings};

use crate::classes::shares;
use crate::units::percent;
use crate::widgets::{caption, color, color_entry, color_line};

/// Colours of the view of map updates, as sRGB bytes: kept texels, redrawn texels, and moving casters.
pub const MAP_UPDATE_COLORS: [[u8; 3]; 3] = [[86, 180, 233], [230, 159, 0], [204, 121, 167]];

/// Meanings of [`MAP_UPDATE_COLORS`].
const MAP_UPDATES: [(&str, &str); 3] = [
    ("kept", "Texels kept from an earlier frame."),
    ("redrawn", "Texels drawn in this frame."),
    ("moving", "Moving casters, drawn over the kept texels."),
];

/// Meanings of [`EDGE_COLORS`].
const EDGES: [(&str, &str); 2] = [
    ("traced", "Pixels that the maps could not decide: rays decide."),
    ("left to the filter", "Undecided pixels without a ray: the filter decides."),
];

/// Width of the scale of pixels per texel, in points.
const RAMP_WIDTH: f32 = 216.0;

/// Returns whether the view or its marks have colours to explain. If not, [`legend`] shows nothing.
pub fn has_legend(view: &ViewSettings) -> bool {
    !view.mode.colors().is_empty() || has_marks(view)
}

/// Returns whether wrong pixels are marked, which only views of the camera can do.
fn has_marks(view: &ViewSettings) -> bool {
    view.marks != ErrorMarks::Off && view.mode.shows_camera()
}

/// Shows the meanings of the view's colours: the classes of wrong pixels with their shares, the scale of
/// pixels per texel, the tints of the maps, or the kinds of map updates.
pub fn legend(ui: &mut Ui, view: &ViewSettings, figures: &Figures) {
    let colors = view.mode.colors();
    for color in colors {
        match color {
            ViewColors::Classes => classes(ui, figures),
            ViewColors::PixelsPerTexel => ramp(ui, "pixels per texel"),
            ViewColors::Maps => maps(ui, figures),
            ViewColors::Demand => ramp(ui, "pixels per texel at visible points"),
            ViewColors::Updates => named(ui, MAP_UPDATES.into_iter().zip(MAP_UPDATE_COLORS)),
            ViewColors::Traced => named(ui, EDGES.into_iter().zip(EDGE_COLORS)),
        }
    }
    if has_marks(view) && !colors.contains(&ViewColors::Classes) {
        classes(ui, figures);
    }
}

/// Shows the [`legend`] on its own background, in the lower right corner of `picture`. Shows nothing if the
/// view has no colours to explain.
pub fn legend_overlay(ctx: &Context, picture: Rect, view: &ViewSettings, figures: &Figures) {
    /// Distance from the edges of the picture, in points.
    const MARGIN: f32 = 10.0;
    if !has_legend(view) {
        return;
    }
    Area::new(Id::unique("shadowfit legend"))
        .order(Order::Middle)
        .interactable(false)
        .pivot(Align2::RIGHT_BOTTOM)
        .fixed_pos(picture.right_bottom() - Vec2::splat(MARGIN))
        .constrain_to(picture)
        .show(ctx, |ui| {
            ui.set_max_width((picture.width() - 2.0 * MARGIN).max(0.0));
            Frame::popup(ui.style()).show(ui, |ui| legend(ui, view, figures));
        });
}

fn classes(ui: &mut Ui, figures: &Figures) {
    let (a, b) = (figures.judged.as_ref().map(shares), figures.judged_other.as_ref().map(shares));
    let entries = shares(&Default::default());
    color_line(ui, |ui| {
        for (index, (class, fill, _)) in entries.into_iter().enumerate() {
            let value = match (a, b) {
                (Some(a), Some(b)) => Some(format!("{} | {}", percent(a[index].2), percent(b[index].2))),
                (Some(a), None) => Some(percent(a[index].2)),
                (None, _) => None,
            };
            color_entry(ui, fill, &class.label().to_lowercase(), value.as_deref()).on_hover_text(class.help());
        }
    });
}

fn maps(ui: &mut Ui, figures: &Figures) {
    let there = figures.maps.iter().zip(MAP_TINTS).enumerate().filter(|(_, (map, _))| map.is_some());
    color_line(ui, |ui| {
        for (map, (_, tint)) in there {
            let help = "Surfaces that read this map. Map 1 is the nearest one, or the finest window.";
            color_entry(ui, color(tint), &format!("map {}", map + 1), None).on_hover_text(help);
        }
    });
}

/// Shows colours with their names and helps.
fn named(ui: &mut Ui, entries: impl Iterator<Item = ((&'static str, &'static str), [u8; 3])>) {
    color_line(ui, |ui| {
        for ((name, help), fill) in entries {
            color_entry(ui, color(fill), name, None).on_hover_text(help);
        }
    });
}

/// Shows the scale of pixels per texel, with a tick at each octave.
fn ramp(ui: &mut Ui, title: &str) {
    /// Number of colour steps.
    const STEPS: usize = 48;
    caption(ui, title);
    let small = TextStyle::Small.resolve(ui.style());
    let size = Vec2::new(RAMP_WIDTH, 12.0 + ui.text_style_height(&TextStyle::Small));
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Colours of 1/8 to 8 pixels per texel"));
    // Half of the first and the last number extends beyond the bar.
    let bar = Rect::from_min_max(rect.min + Vec2::new(10.0, 0.0), Pos2::new(rect.right() - 10.0, rect.top() + 10.0));
    let octaves = PIXELS_PER_TEXEL_COLORS.len() - 1;
    let mut mesh = Mesh::default();
    for step in 0..=STEPS {
        let share = step as f32 / STEPS as f32;
        let fill = color(pixels_per_texel_color(PIXELS_PER_TEXEL_COLORS[0].0 * (share * octaves as f32).exp2()));
        let x = egui::lerp(bar.x_range(), share);
        mesh.colored_vertex(Pos2::new(x, bar.top()), fill);
        mesh.colored_vertex(Pos2::new(x, bar.bottom()), fill);
        if step > 0 {
            let last = mesh.vertices.len() as u32 - 1;
            mesh.add_triangle(last - 3, last - 2, last - 1);
            mesh.add_triangle(last - 2, last - 1, last);
        }
    }
    let line = ui.visuals().widgets.noninteractive.bg_stroke;
    ui.painter().add(Shape::mesh(mesh));
    ui.painter().rect_stroke(bar, CornerRadius::ZERO, line, egui::StrokeKind::Outside);
    for (index, label) in ["1/8", "1/4", "1/2", "1", "2", "4", "8"].into_iter().enumerate() {
        let at = Pos2::new(egui::lerp(bar.x_range(), index as f32 / octaves as f32), bar.bottom() + 2.0);
        ui.painter().text(at, Align2::CENTER_TOP, label, small.clone(), ui.visuals().text_color());
    }
}

#[cfg(test)]
mod tests {
    use shadowfit_params::tool::ViewMode;

    use super::*;

    #[test]
    fn views_with_colours_or_marks_have_a_legend() {
        let with = [
            ViewMode::Error,
            ViewMode::PixelsPerTexel,
            ViewMode::Maps,
            ViewMode::Demand,
            ViewMode::Updates,
            ViewMode::Traced,
        ];
        for mode in ViewMode::ALL {
            let view = ViewSettings { mode, ..ViewSettings::default() };
            assert_eq!(has_legend(&view), with.contains(&mode), "{mode:?}");
            let marked = ViewSettings { marks: ErrorMarks::Outline, ..view };
            assert_eq!(has_legend(&marked), with.contains(&mode) || mode.shows_camera(), "{mode:?}");
        }
    }
}
