//! A dark style with readable text.

use egui::{Color32, Context, FontFamily, FontId, Stroke, TextStyle, Theme, Visuals};

/// Gives the whole application the dark style that the panel was drawn for: text a little larger
/// and brighter than egui's own, quiet fills. The panel works with any other style too.
pub fn apply_style(ctx: &Context) {
    ctx.set_theme(Theme::Dark);
    ctx.style_mut_of(Theme::Dark, |style| {
        for (text, size) in
            [(TextStyle::Small, 11.5), (TextStyle::Body, 13.5), (TextStyle::Button, 13.5), (TextStyle::Heading, 18.0)]
        {
            style.text_styles.insert(text, FontId::new(size, FontFamily::Proportional));
        }
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        style.spacing.tooltip_width = 300.0;
        style.visuals = visuals();
    });
}

fn visuals() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = Color32::from_rgb(24, 26, 29);
    visuals.window_fill = Color32::from_rgb(28, 30, 34);
    visuals.faint_bg_color = Color32::from_rgb(32, 35, 39);
    visuals.weak_text_color = Some(Color32::from_gray(160));
    visuals.widgets.noninteractive.fg_stroke = Stroke::new(1.0, Color32::from_gray(208));
    visuals.widgets.inactive.fg_stroke = Stroke::new(1.0, Color32::from_gray(225));
    visuals.selection.bg_fill = Color32::from_rgb(44, 86, 128);
    visuals.slider_trailing_fill = true;
    visuals
}
