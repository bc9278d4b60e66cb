//! Maps by number and tint: the table of their figures, and the buttons that choose one.

use egui::{Button, Color32, Grid, Response, RichText, Role, Stroke, Ui, WidgetInfo};
use shadowfit::BoundSource;
use shadowfit::diagnostics::DepthRounding;
use shadowfit::settings::MAX_MAPS;
use shadowfit_params::figures::{Figures, MAP_TINTS, MapFigures};

use crate::accessibility::rename;
use crate::quality::known;
use crate::theme::contrast;
use crate::units::{brief_count, grouped, length, short, size};
use crate::widgets::{badge, color};

/// Returns the tint of a map, and the text colour on it.
fn colours(map: usize) -> (Color32, Color32) {
    let tint = color(MAP_TINTS[map % MAX_MAPS]);
    let is_light = contrast(tint, Color32::BLACK) > contrast(tint, Color32::WHITE);
    (tint, if is_light { Color32::BLACK } else { Color32::WHITE })
}

/// Shows the number of a map on its tint.
pub(crate) fn badge_of(ui: &mut Ui, map: usize) -> Response {
    let (tint, text) = colours(map);
    badge(ui, &(map + 1).to_string(), tint, text, &format!("Map {}", map + 1))
}

/// Shows a button for each of `count` maps, with `selected` filled. Returns the index of the clicked one.
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

/// A column: its name and its help.
type Column = (&'static str, &'static str);

/// Columns for the contents of the maps.
const HOLD: [Column; 5] = [
    ("Map", "Number of the map, in its colour in the view Maps. Map 1 is the nearest one, or the finest window."),
    (
        "Made for",
        "Range of view depths that the map is fitted to, in metres. With selection by view depth, points in this range \
         read the map. For a window, which has no such range: the width and height of its area, perpendicular to the \
         light.",
    ),
    ("Texel", "Width and height of one texel, perpendicular to the light."),
    (
        "Depth",
        "Depth range of the map along the light. ⚠ marks a map whose depths are rounded by more than its bias, so that \
         lit surfaces darken in bands: raise Depth steps of the bias.",
    ),
    ("Waste", "Share of the map's area outside the part of the view that the map is made for."),
];

/// Columns for the cost of the maps.
const COST: [Column; 5] = [
    HOLD[0],
    ("Draws", "Draw calls of the map's shadow pass."),
    ("Triangles", "Triangles drawn into the map."),
    ("Texels drawn", "Texels of the map that were drawn in this frame; all others were kept."),
    ("Pass", "GPU time of the map's shadow passes."),
];

/// Shows two tables with a line for each map: its contents and its cost. Hovering over a line shows all
/// details.
pub(crate) fn tables(ui: &mut Ui, figures: &Figures) {
    table(ui, "What the maps hold", HOLD, figures, held);
    ui.add_space(4.0);
    table(ui, "What the maps cost", COST, figures, costs);
}

fn table(
    ui: &mut Ui,
    title: &str,
    columns: [Column; 5],
    figures: &Figures,
    cells: fn(&MapFigures) -> [Option<String>; 4],
) {
    let maps = figures.maps.iter().enumerate().filter_map(|(map, figures)| Some((map, figures.as_ref()?)));
    Grid::new(title).num_columns(columns.len()).spacing([10.0, 3.0]).min_col_width(0.0).show(ui, |ui| {
        for (name, help) in columns {
            ui.label(RichText::new(name).small().weak()).on_hover_text(help);
        }
        ui.end_row();
        for (map, figures) in maps {
            let details = details(map, figures);
            badge_of(ui, map).on_hover_text(&details);
            for text in cells(figures) {
                ui.label(known(text).small()).on_hover_text(&details);
            }
            ui.end_row();
        }
    });
}

/// Returns the cells for the contents of a map.
fn held(figures: &MapFigures) -> [Option<String>; 4] {
    let is_window = figures.bounds_from[0] == BoundSource::Window;
    let view_depths = figures.view_depths.map(|[near, far]| format!("{} – {}", short(near), short(far)));
    [
        view_depths.or_else(|| is_window.then(|| size(figures.extent))),
        Some(if figures.is_empty { "empty".into() } else { size(figures.texel_size) }),
        Some(length(figures.depth_range) + if figures.rounding.is_covered() { "" } else { " ⚠" }),
        figures.waste.map(|waste| format!("{:.0}\u{a0}%", 100.0 * waste)),
    ]
}

/// Returns the cells for the cost of a map.
fn costs(figures: &MapFigures) -> [Option<String>; 4] {
    [
        figures.draws.map(|draws| grouped(draws.into())),
        figures.triangles.map(|triangles| brief_count(triangles as f64)),
        figures.texels.map(|texels| brief_count(texels as f64)),
        figures.pass_ms.map(|ms| format!("{ms:.2}\u{a0}ms")),
    ]
}

/// Returns all details of a map, line by line.
fn details(map: usize, figures: &MapFigures) -> String {
    let [left, right, bottom, top, far, near] = figures.bounds_from.map(name);
    let title = if figures.is_empty { ": no receiver is in view" } else { "" };
    let mut lines = vec![
        format!("Map {}{title}", map + 1),
        format!("Width and height: {}, in texels of {}", size(figures.extent), size(figures.texel_size)),
        format!("Depth range: {}, in steps of {}", length(figures.depth_range), length(figures.rounding.step)),
        format!("Sides set by: left {left}, right {right}, bottom {bottom}, top {top}"),
        format!("Near plane (toward the light) set by {near}, far plane by {far}"),
    ];
    if !figures.rounding.is_covered() {
        let DepthRounding { needed, bias, .. } = figures.rounding;
        lines.push(format!("Depths are rounded by {}, more than the bias of {}", length(needed), length(bias)));
    }
    let drawn = [
        ("Casters kept", figures.casters.map(u64::from)),
        ("Draw calls", figures.draws.map(u64::from)),
        ("Triangles", figures.triangles),
        ("Texels drawn", figures.texels),
    ];
    lines.extend(drawn.iter().filter_map(|(name, count)| Some(format!("{name}: {}", grouped((*count)?)))));
    lines.join("\n")
}

/// Returns the cause of a plane, in a word or two.
fn name(constraint: BoundSource) -> &'static str {
    match constraint {
        BoundSource::View => "view",
        BoundSource::Receivers => "scene",
        BoundSource::Casters => "casters",
        BoundSource::CasterExtension => "caster extension",
        BoundSource::Sphere => "sphere",
        BoundSource::Window => "window",
        BoundSource::Held => "held map",
        _ => "other",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_made_for_distances_and_a_window_for_what_it_holds() {
        let map = MapFigures { view_depths: Some([0.1, 12.0]), extent: [40.0, 20.0], ..MapFigures::default() };
        let window = MapFigures { view_depths: None, bounds_from: [BoundSource::Window; 6], ..map };
        assert_eq!(held(&map)[0].as_deref(), Some("0.10 – 12.0"));
        assert_eq!(held(&window)[0].as_deref(), Some("40.0 × 20.0 m"));
        assert_eq!(held(&MapFigures { view_depths: None, ..map })[0], None);
    }

    #[test]
    fn numbers_are_readable_on_their_tints() {
        for map in 0..MAX_MAPS {
            let (tint, text) = colours(map);
            let ratio = contrast(tint, text);
            assert!(ratio >= 4.5, "map {}: {ratio}", map + 1);
        }
    }

    #[test]
    fn the_details_name_every_plane_and_count() {
        let figures = MapFigures {
            bounds_from: [
                BoundSource::View,
                BoundSource::Receivers,
                BoundSource::Sphere,
                BoundSource::Held,
                BoundSource::CasterExtension,
                BoundSource::Casters,
            ],
            is_empty: true,
            texel_size: [0.03, 0.005],
            extent: [61.44, 10.24],
            depth_range: 110.0,
            rounding: DepthRounding { step: 0.000_013, needed: 0.002, bias: 0.0005 },
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
            "Depths are rounded by 2.00 mm, more than the bias of 0.50 mm",
            "Casters kept: 14",
            "Triangles: 1\u{a0}234",
        ] {
            assert!(text.contains(part), "{part} is not in {text}");
        }
        assert!(!text.contains("Draw calls"));
    }
}
