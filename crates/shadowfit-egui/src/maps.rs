//! What tells maps apart: their numbers on their tints, the table of their figures, and the buttons
//! that choose one.

use egui::{Button, Color32, CornerRadius, Grid, Response, RichText, Role, Sense, Stroke, Ui, Vec2, WidgetInfo};
use shadowfit::figures::{Figures, MAP_TINTS, MapFigures};
use shadowfit::light_fit::Constraint;
use shadowfit::settings::MAX_MAPS;

use crate::accessibility::rename;
use crate::units::{grouped, length, short, size};

/// The tint of a map, and what can be read on it.
fn colours(map: usize) -> (Color32, Color32) {
    let [r, g, b] = MAP_TINTS[map % MAX_MAPS];
    // Rec. 709 weights of the encoded values: enough to choose between black and white.
    let brightness = 0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b);
    (Color32::from_rgb(r, g, b), if brightness > 128.0 { Color32::BLACK } else { Color32::WHITE })
}

/// The number of a map on its tint.
fn badge(ui: &mut Ui, map: usize) -> Response {
    let (tint, text) = colours(map);
    let (rect, response) = ui.allocate_exact_size(Vec2::new(22.0, 16.0), Sense::hover());
    let name = format!("Map {}", map + 1);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &name));
    if ui.is_rect_visible(rect) {
        ui.painter().rect_filled(rect, CornerRadius::same(3), tint);
        let font = egui::TextStyle::Button.resolve(ui.style());
        ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, (map + 1).to_string(), font, text);
    }
    response
}

/// A button for each of `count` maps, with the one of `selected` filled; returns the index of the one
/// that was clicked.
pub(crate) fn selector(
    ui: &mut Ui,
    count: u32,
    selected: usize,
    explain: impl Fn(Response) -> Response,
) -> Option<usize> {
    ui.spacing_mut().item_spacing.x = 2.0;
    ui.spacing_mut().button_padding.x = 4.0;
    let mut clicked = None;
    for map in 0..(count as usize).min(MAX_MAPS) {
        let (tint, text) = colours(map);
        let is_selected = map == selected;
        let number = RichText::new((map + 1).to_string());
        let number = if is_selected { number.strong().color(text) } else { number };
        let fill = if is_selected { tint } else { ui.visuals().widgets.inactive.weak_bg_fill };
        let button = Button::new(number).fill(fill).stroke(Stroke::new(1.0, tint));
        let response = explain(ui.add(button));
        let name = format!("Show map {} in the inset", map + 1);
        response.widget_info(|| WidgetInfo::selected(Role::RadioButton, ui.is_enabled(), is_selected, &name));
        rename(ui, &response, name.clone());
        if response.clicked() {
            clicked = Some(map);
        }
    }
    clicked
}

/// Names of the columns and what they say.
const COLUMNS: [(&str, &str); 5] = [
    (
        "Map",
        "Number of the map, the nearest first and of windows the finest first, on the colour that Tint by map gives it.",
    ),
    (
        "Made for",
        "Distances from the camera, in metres, that the map is made for; by view depth, points between them read it. Of \
         a window, which is made for no distances, the width and height of what it holds across the light.",
    ),
    ("Texel", "Width and height of one texel across the light."),
    ("Depth", "Extent of the map along the light."),
    ("Draws", "Draw calls of the map's shadow pass."),
];

/// One line for each map; hovering it says all that is known of the map.
pub(crate) fn table(ui: &mut Ui, figures: &Figures) {
    let maps = figures.maps.iter().enumerate().filter_map(|(map, figures)| Some((map, figures.as_ref()?)));
    Grid::new("maps").num_columns(COLUMNS.len()).spacing([10.0, 3.0]).min_col_width(0.0).striped(true).show(ui, |ui| {
        for (name, help) in COLUMNS {
            ui.label(RichText::new(name).small()).on_hover_text(help);
        }
        ui.end_row();
        for (map, figures) in maps {
            let details = details(map, figures);
            badge(ui, map).on_hover_text(&details);
            for text in cells(figures) {
                let text = text.map_or_else(|| RichText::new("—").weak(), |text| RichText::new(text).strong());
                ui.label(text).on_hover_text(&details);
            }
            ui.end_row();
        }
    });
}

/// The texts of a map's line behind its number.
fn cells(figures: &MapFigures) -> [Option<String>; 4] {
    let is_window = figures.set_by[0] == Constraint::Window;
    let view_depths = figures.view_depths.map(|[near, far]| format!("{} – {}", short(near), short(far)));
    [
        view_depths.or_else(|| is_window.then(|| size(figures.extent))),
        Some(if figures.is_empty { "empty".into() } else { size(figures.texel_size) }),
        Some(length(figures.depth_range)),
        figures.draws.map(|draws| grouped(draws.into())),
    ]
}

/// All that is known of a map, line by line.
fn details(map: usize, figures: &MapFigures) -> String {
    let [left, right, bottom, top, far, near] = figures.set_by.map(name);
    let title = if figures.is_empty { ": no receiver is in view" } else { "" };
    let mut lines = vec![
        format!("Map {}{title}", map + 1),
        format!("Width and height: {}, in texels of {}", size(figures.extent), size(figures.texel_size)),
        format!("Depth range: {}, in steps of {}", length(figures.depth_range), length(figures.depth_step)),
        format!("Sides set by: left {left}, right {right}, bottom {bottom}, top {top}"),
        format!("Near plane (toward the light) set by {near}, far plane by {far}"),
    ];
    let drawn = [
        ("Casters kept", figures.casters.map(u64::from)),
        ("Draw calls", figures.draws.map(u64::from)),
        ("Triangles", figures.triangles),
    ];
    lines.extend(drawn.iter().filter_map(|(name, count)| Some(format!("{name}: {}", grouped((*count)?)))));
    lines.join("\n")
}

/// What set a plane, in a word.
fn name(constraint: Constraint) -> &'static str {
    match constraint {
        Constraint::View => "view",
        Constraint::Receivers => "scene",
        Constraint::Casters => "casters",
        Constraint::CasterExtension => "caster extension",
        Constraint::Sphere => "sphere",
        Constraint::Window => "window",
        Constraint::Held => "held map",
        _ => "other",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_made_for_distances_and_a_window_for_what_it_holds() {
        let map = MapFigures { view_depths: Some([0.1, 12.0]), extent: [40.0, 20.0], ..MapFigures::default() };
        let window = MapFigures { view_depths: None, set_by: [Constraint::Window; 6], ..map };
        assert_eq!(cells(&map)[0].as_deref(), Some("0.10 – 12.0"));
        assert_eq!(cells(&window)[0].as_deref(), Some("40.0 × 20.0 m"));
        assert_eq!(cells(&MapFigures { view_depths: None, ..map })[0], None);
    }

    #[test]
    fn numbers_are_readable_on_their_tints() {
        /// Relative luminance of an sRGB colour (WCAG 2.1).
        fn luminance(colour: Color32) -> f32 {
            let [r, g, b, _] = egui::Rgba::from(colour).to_array();
            0.2126 * r + 0.7152 * g + 0.0722 * b
        }
        for map in 0..MAX_MAPS {
            let (tint, text) = colours(map);
            let (a, b) = (luminance(tint), luminance(text));
            let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
            // What WCAG asks of bold or large text.
            assert!(contrast >= 3.0, "map {}: {contrast}", map + 1);
        }
    }

    #[test]
    fn the_details_name_every_plane_and_count() {
        let figures = MapFigures {
            set_by: [
                Constraint::View,
                Constraint::Receivers,
                Constraint::Sphere,
                Constraint::Held,
                Constraint::CasterExtension,
                Constraint::Casters,
            ],
            is_empty: true,
            texel_size: [0.03, 0.005],
            extent: [61.44, 10.24],
            depth_range: 110.0,
            depth_step: 0.000_013,
            casters: Some(14),
            draws: None,
            triangles: Some(1_234),
            ..MapFigures::default()
        };
        let text = details(1, &figures);
        for part in [
            "Map 2: no receiver is in view",
            "61.4 × 10.2 m, in texels of 3.00 × 0.50 cm",
            "110 m, in steps of 13.0 µm",
            "left view, right scene, bottom sphere, top held map",
            "Near plane (toward the light) set by casters, far plane by caster extension",
            "Casters kept: 14",
            "Triangles: 1\u{a0}234",
        ] {
            assert!(text.contains(part), "{part} is not in {text}");
        }
        assert!(!text.contains("Draw calls"));
    }
}
