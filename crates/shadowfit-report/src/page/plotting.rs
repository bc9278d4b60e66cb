//! What all plots look like: their font, their colours, their text.

use std::sync::Once;

use plotters::prelude::{FontStyle, IntoFont, RGBColor, TextStyle};
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The family that the font is known by; SVG files name it too, and browsers have one of that kind.
pub const FAMILY: &str = "sans-serif";
/// Size of text, in plotters' units of 0.8 pixels.
pub const TEXT: u32 = 16;
/// Size of titles, in the same units.
pub const TITLE: u32 = 20;
/// Height of a line of a legend, in pixels.
pub const LEGEND_LINE: i32 = 20;
/// Middle of its first line, in pixels.
pub const LEGEND_TOP: i32 = 50;
/// Colour of the ground. The style of pages recognises this colour and the next three, and turns them dark.
pub const PAPER: RGBColor = RGBColor(255, 255, 255);
/// Colour of text.
pub const INK: RGBColor = RGBColor(51, 54, 59);
/// Colour of grid lines.
pub const GRID: RGBColor = RGBColor(226, 228, 232);
/// Colour of axes.
pub const RULE: RGBColor = RGBColor(150, 154, 162);
/// Colours of lines that the colour-blind tell apart, on light and dark ground (Paul Tol's bright scheme, 2018).
pub const COLOURS: [RGBColor; 7] = [
    RGBColor(0x44, 0x77, 0xaa),
    RGBColor(0xee, 0x66, 0x77),
    RGBColor(0x22, 0x88, 0x33),
    RGBColor(0xcc, 0xbb, 0x44),
    RGBColor(0x66, 0xcc, 0xee),
    RGBColor(0xaa, 0x33, 0x77),
    RGBColor(0x99, 0x99, 0x99),
];

/// Makes the font known to plotters, once.
pub fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // The font is known to be one: a test draws with it.
        let _ = register_font(FAMILY, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}

/// Text of a size, with its middle at a line.
pub fn text_style(size: u32, align: HPos) -> TextStyle<'static> {
    TextStyle::from((FAMILY, size).into_font()).color(&INK).pos(Pos::new(align, VPos::Center))
}
