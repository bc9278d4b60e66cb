//! The look of all plots: font, colours and text styles.

use std::sync::Once;

use plotters::prelude::{FontStyle, IntoFont, RGBColor, TextStyle};
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Font family, under which the built-in font is registered. SVG files name it too, and browsers resolve it.
pub const FAMILY: &str = "sans-serif";
/// Size of text, in plotters' units of 0.8 pixels.
pub const TEXT: u32 = 16;
/// Size of titles, in the same units.
pub const TITLE: u32 = 20;
/// Height of a line of a legend, in pixels.
pub const LEGEND_LINE: i32 = 20;
/// Vertical centre of the first line of a legend, in pixels.
pub const LEGEND_TOP: i32 = 50;
/// Colour of the background. The CSS of pages matches this colour and the next three to replace them in dark
/// mode.
pub const PAPER: RGBColor = RGBColor(255, 255, 255);
/// Colour of text.
pub const INK: RGBColor = RGBColor(51, 54, 59);
/// Colour of grid lines.
pub const GRID: RGBColor = RGBColor(226, 228, 232);
/// Colour of axes.
pub const RULE: RGBColor = RGBColor(150, 154, 162);
/// Colours of lines, for light and dark backgrounds and for colour-blind readers (Paul Tol's bright scheme,
/// 2018).
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0x44, 0x77, 0xaa),
    RGBColor(0xee, 0x66, 0x77),
    RGBColor(0x22, 0x88, 0x33),
    RGBColor(0xcc, 0xbb, 0x44),
    RGBColor(0x66, 0xcc, 0xee),
    RGBColor(0xaa, 0x33, 0x77),
    RGBColor(0x99, 0x99, 0x99),
];

/// Registers the font with plotters, once.
pub fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // The built-in font is valid: a test draws with it.
        let _ = register_font(FAMILY, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}

/// Returns a text style of this size, vertically centred.
pub fn text_style(size: u32, align: HPos) -> TextStyle<'static> {
    TextStyle::from((FAMILY, size).into_font()).color(&INK).pos(Pos::new(align, VPos::Center))
}
