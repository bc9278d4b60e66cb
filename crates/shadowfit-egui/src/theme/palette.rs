//! The colours of both themes, by their use.

use egui::{Color32, Ui};

/// The colours of a theme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Palette {
    /// Text of labels and controls.
    pub(crate) text: Color32,
    /// Titles and figures.
    pub(crate) strong: Color32,
    /// Units, captions and hints.
    pub(crate) weak: Color32,
    /// Background.
    pub(crate) panel: Color32,
    /// Cards, menus and windows.
    pub(crate) card: Color32,
    /// Text fields, and the background of bars and plots.
    pub(crate) field: Color32,
    /// Buttons at rest.
    pub(crate) control: Color32,
    /// Outlines of buttons at rest.
    pub(crate) control_line: Color32,
    /// Hovered buttons.
    pub(crate) hovered: Color32,
    /// Pressed or focused buttons.
    pub(crate) pressed: Color32,
    /// Outlines of cards, and lines between sections.
    pub(crate) border: Color32,
    /// Text or lines that ask for attention: messages, focus rings, side A.
    pub(crate) accent: Color32,
    /// Selected items, and the main button of a card.
    pub(crate) accent_fill: Color32,
    /// Text on [`Self::accent_fill`] and [`Self::success_fill`].
    pub(crate) on_accent: Color32,
    /// Text or lines of side B of a comparison.
    pub(crate) second: Color32,
    /// Text or lines of success.
    pub(crate) success: Color32,
    /// The button that applies a cure.
    pub(crate) success_fill: Color32,
    /// Text or lines that warn about the picture or the scene.
    pub(crate) warning: Color32,
    /// Failures.
    pub(crate) error: Color32,
}

impl Palette {
    pub(crate) const DARK: Self = Self {
        text: Color32::from_rgb(208, 213, 220),
        strong: Color32::from_rgb(244, 246, 249),
        weak: Color32::from_rgb(166, 173, 184),
        panel: Color32::from_rgb(22, 24, 28),
        card: Color32::from_rgb(30, 33, 38),
        field: Color32::from_rgb(16, 18, 21),
        control: Color32::from_rgb(43, 47, 54),
        control_line: Color32::from_rgb(56, 61, 69),
        hovered: Color32::from_rgb(54, 59, 67),
        pressed: Color32::from_rgb(58, 63, 72),
        border: Color32::from_rgb(47, 51, 58),
        accent: Color32::from_rgb(110, 176, 255),
        accent_fill: Color32::from_rgb(46, 110, 194),
        on_accent: Color32::from_rgb(255, 255, 255),
        second: Color32::from_rgb(232, 176, 88),
        success: Color32::from_rgb(102, 196, 132),
        success_fill: Color32::from_rgb(38, 115, 68),
        warning: Color32::from_rgb(240, 163, 82),
        error: Color32::from_rgb(255, 128, 118),
    };

    pub(crate) const LIGHT: Self = Self {
        text: Color32::from_rgb(44, 49, 57),
        strong: Color32::from_rgb(14, 17, 22),
        weak: Color32::from_rgb(82, 90, 101),
        panel: Color32::from_rgb(245, 246, 248),
        card: Color32::from_rgb(255, 255, 255),
        field: Color32::from_rgb(255, 255, 255),
        control: Color32::from_rgb(232, 235, 239),
        control_line: Color32::from_rgb(205, 210, 217),
        hovered: Color32::from_rgb(220, 225, 231),
        pressed: Color32::from_rgb(208, 215, 223),
        border: Color32::from_rgb(216, 220, 226),
        accent: Color32::from_rgb(10, 86, 164),
        accent_fill: Color32::from_rgb(22, 100, 184),
        on_accent: Color32::from_rgb(255, 255, 255),
        second: Color32::from_rgb(140, 78, 0),
        success: Color32::from_rgb(16, 104, 52),
        success_fill: Color32::from_rgb(24, 112, 60),
        warning: Color32::from_rgb(150, 72, 0),
        error: Color32::from_rgb(178, 28, 28),
    };

    /// Returns the colours for the style of `ui`.
    pub(crate) fn of(ui: &Ui) -> &'static Self {
        if ui.visuals().dark_mode { &Self::DARK } else { &Self::LIGHT }
    }
}

/// Returns the contrast of two opaque colours, 1..=21, by the Web Content Accessibility Guidelines 2.1.
pub(crate) fn contrast(a: Color32, b: Color32) -> f32 {
    let luminance = |colour: Color32| {
        let [r, g, b, _] = egui::Rgba::from(colour).to_array();
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

/// Returns a line colour, darkened on a light background until its contrast is sufficient.
pub(crate) fn readable(color: Color32, ground: Color32) -> Color32 {
    let mut darker = color;
    while contrast(darker, ground) < SHAPE_CONTRAST && contrast(ground, Color32::WHITE) < 2.0 {
        let [r, g, b, _] = darker.to_array().map(|byte| (f32::from(byte) * 0.95) as u8);
        darker = Color32::from_rgb(r, g, b);
    }
    darker
}

/// Contrast that level AA of the guidelines requires of meaningful lines and shapes.
const SHAPE_CONTRAST: f32 = 3.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// Contrast that level AA requires of text.
    const TEXT: f32 = 4.5;

    #[test]
    fn black_on_white_has_the_greatest_contrast() {
        assert!((contrast(Color32::BLACK, Color32::WHITE) - 21.0).abs() < 1e-3);
        assert_eq!(contrast(Color32::RED, Color32::RED), 1.0);
    }

    #[test]
    fn every_text_is_readable_on_every_fill_that_it_stands_on() {
        for (theme, p) in [("dark", Palette::DARK), ("light", Palette::LIGHT)] {
            let grounds = [("panel", p.panel), ("card", p.card), ("field", p.field)];
            let buttons = [("control", p.control), ("hovered", p.hovered), ("pressed", p.pressed)];
            let on_ground = [
                ("accent", p.accent),
                ("second", p.second),
                ("success", p.success),
                ("warning", p.warning),
                ("error", p.error),
            ];
            let everywhere = [("text", p.text), ("strong", p.strong), ("weak", p.weak)];
            let fills = [("accent fill", p.accent_fill), ("success fill", p.success_fill)];
            let pairs =
                everywhere.into_iter().flat_map(|text| grounds.into_iter().chain(buttons).map(move |g| (text, g)));
            let pairs = pairs.chain(on_ground.into_iter().flat_map(|text| grounds.map(|ground| (text, ground))));
            let pairs = pairs.chain(fills.map(|fill| (("on accent", p.on_accent), fill)));
            for ((text, color), (fill, ground)) in pairs {
                let ratio = contrast(color, ground);
                assert!(ratio >= TEXT, "{theme}: {text} on {fill} has {ratio:.2}");
            }
        }
    }

    #[test]
    fn the_ring_of_focus_and_the_slider_stand_out() {
        for (theme, p) in [("dark", Palette::DARK), ("light", Palette::LIGHT)] {
            for (name, ground) in [("panel", p.panel), ("card", p.card), ("field", p.field)] {
                let (ring, fill) = (contrast(p.accent, ground), contrast(p.accent_fill, ground));
                assert!(ring >= SHAPE_CONTRAST, "{theme}: the ring on {name} has {ring:.2}");
                assert!(fill >= SHAPE_CONTRAST, "{theme}: the fill on {name} has {fill:.2}");
            }
        }
    }
}
