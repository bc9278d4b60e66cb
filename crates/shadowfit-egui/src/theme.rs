//! The look of the panel, dark and light: type, spacing, corners and colours.
//!
//! The panel works in any egui style. This style is its own.

mod palette;

use egui::epaint::text::{FontData, FontInsert, FontPriority, InsertFontFamily};
use egui::style::{HandleShape, ScrollStyle, Selection, WidgetVisuals, Widgets};
use egui::{
    Color32, Context, CornerRadius, FontDefinitions, FontFamily, FontId, Margin, Stroke, Style, TextStyle, Theme,
    ThemePreference, Ui, Vec2, Visuals,
};

use crate::icon::add_icons;

pub(crate) use palette::{Palette, contrast, readable};

/// Sizes of text, in points.
const TYPE_SCALE: [(TextStyle, f32); 4] =
    [(TextStyle::Small, 11.5), (TextStyle::Body, 13.5), (TextStyle::Button, 13.5), (TextStyle::Heading, 17.0)];

/// Size of monospaced text, in points.
const MONOSPACE: f32 = 12.5;

/// Heights of controls for a mouse and for a finger, in points.
const ROW: f32 = 22.0;
const FINGER: f32 = 36.0;

/// Corner radius of buttons and fields, in points.
const CONTROL_RADIUS: u8 = 5;

/// Corner radius of cards, menus and windows, in points.
pub(crate) const CARD_RADIUS: u8 = 8;

/// Gives the whole application the look of the panel, both dark and light, and shows `theme`: an
/// [`egui::Theme`], or [`ThemePreference::System`] for the system's theme.
///
/// [`Context::set_theme`] changes between them later.
pub fn apply_theme(ctx: &Context, theme: impl Into<ThemePreference>) {
    for (theme, palette) in [(Theme::Dark, &Palette::DARK), (Theme::Light, &Palette::LIGHT)] {
        ctx.style_mut_of(theme, |style| {
            measures(style);
            style.visuals = visuals(theme, palette);
        });
    }
    add_arrows(ctx);
    add_icons(ctx);
    ctx.set_theme(theme);
}

/// Makes controls high enough for fingers, for touch screens and narrow windows, or resets them for a mouse.
/// It changes both themes. [`apply_theme`] sets the sizes for a mouse.
pub fn size_for_fingers(ctx: &Context, is_touched: bool) {
    let height = if is_touched { FINGER } else { ROW };
    ctx.all_styles_mut(|style| style.spacing.interact_size.y = height);
}

/// Adds arrows to text, as in "0 → 1 texel". egui's font for text lacks them, its font for code has them.
fn add_arrows(ctx: &Context) {
    /// Name of egui's font for code, whose license allows this use.
    const CODE_FONT: &str = "Hack";
    if let Some(font) = FontDefinitions::default().font_data.get(CODE_FONT) {
        let after_all = InsertFontFamily { family: FontFamily::Proportional, priority: FontPriority::Lowest };
        ctx.add_font(FontInsert::new("shadowfit arrows", FontData::clone(font), vec![after_all]));
    }
}

/// Returns whether text can have arrows, as it can after [`apply_theme`].
pub(crate) fn has_arrows(ui: &Ui) -> bool {
    let font = TextStyle::Body.resolve(ui.style());
    ui.ctx().fonts_mut(|fonts| fonts.has_glyph(&font, '→'))
}

/// Sets sizes and distances, which both themes share.
fn measures(style: &mut Style) {
    for (text, size) in TYPE_SCALE {
        style.text_styles.insert(text, FontId::new(size, FontFamily::Proportional));
    }
    style.text_styles.insert(TextStyle::Monospace, FontId::new(MONOSPACE, FontFamily::Monospace));
    let spacing = &mut style.spacing;
    spacing.item_spacing = Vec2::new(6.0, 5.0);
    spacing.button_padding = Vec2::new(8.0, 3.0);
    spacing.interact_size = Vec2::new(40.0, ROW);
    spacing.slider_rail_height = 4.0;
    spacing.icon_width = 16.0;
    spacing.icon_width_inner = 9.0;
    spacing.icon_spacing = 6.0;
    spacing.menu_margin = Margin::same(6);
    spacing.window_margin = Margin::same(12);
    spacing.tooltip_width = 300.0;
    // Beside the content, not over it.
    spacing.scroll = ScrollStyle { bar_width: 8.0, floating_allocated_width: 8.0, ..ScrollStyle::thin() };
    style.interaction.selectable_labels = false;
}

fn visuals(theme: Theme, palette: &Palette) -> Visuals {
    let radius = CornerRadius::same(CARD_RADIUS);
    let mut visuals = theme.default_visuals();
    visuals.widgets = widgets(palette);
    visuals.selection = Selection { bg_fill: palette.accent_fill, stroke: Stroke::new(1.0, palette.on_accent) };
    visuals.weak_text_color = Some(palette.weak);
    visuals.hyperlink_color = palette.accent;
    visuals.warn_fg_color = palette.warning;
    visuals.error_fg_color = palette.error;
    visuals.panel_fill = palette.panel;
    visuals.window_fill = palette.card;
    visuals.window_stroke = Stroke::new(1.0, palette.border);
    visuals.faint_bg_color = palette.card;
    visuals.extreme_bg_color = palette.field;
    visuals.code_bg_color = palette.field;
    visuals.window_corner_radius = radius;
    visuals.menu_corner_radius = radius;
    visuals.text_cursor.stroke.color = palette.accent;
    visuals.handle_shape = HandleShape::Rect { aspect_ratio: 0.5 };
    visuals.slider_trailing_fill = true;
    visuals
}

/// Returns the look of widgets at rest, hovered, pressed or focused, and open. A focused widget has a ring in
/// the accent colour.
fn widgets(palette: &Palette) -> Widgets {
    let widget = |fill, line: Stroke, text: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: line,
        corner_radius: CornerRadius::same(CONTROL_RADIUS),
        fg_stroke: Stroke::new(1.5, text),
        expansion: 0.0,
    };
    let thin = |color| Stroke::new(1.0, color);
    Widgets {
        noninteractive: widget(palette.panel, thin(palette.border), palette.text),
        inactive: widget(palette.control, thin(palette.control_line), palette.text),
        hovered: widget(palette.hovered, thin(palette.weak), palette.strong),
        active: widget(palette.pressed, Stroke::new(2.0, palette.accent), palette.strong),
        open: widget(palette.hovered, thin(palette.accent), palette.strong),
    }
}

/// Returns the font of a prominent figure, twice as high as text.
pub(crate) fn figure_font(ui: &Ui) -> FontId {
    FontId::proportional(2.0 * TextStyle::Body.resolve(ui.style()).size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_themes_are_set_and_the_preference_is_kept() {
        let ctx = Context::default();
        apply_theme(&ctx, ThemePreference::System);
        for (theme, palette) in [(Theme::Dark, &Palette::DARK), (Theme::Light, &Palette::LIGHT)] {
            let style = ctx.style_of(theme);
            assert_eq!(style.visuals.panel_fill, palette.panel);
            assert_eq!(style.visuals.dark_mode, theme == Theme::Dark);
            assert_eq!(style.visuals.strong_text_color(), palette.strong);
        }
        assert_eq!(ctx.options(|options| options.theme_preference), ThemePreference::System);
        apply_theme(&ctx, Theme::Light);
        assert_eq!(ctx.theme(), Theme::Light);
    }
}
