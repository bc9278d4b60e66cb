//! Icons of the Lucide set, drawn with a font.
//!
//! `fonts/icons.ttf` holds the used icons and a few more, instead of the whole set's megabyte. To add one,
//! run `pyftsubset lucide.ttf --unicodes=…` (fonttools) with the code points of all of them on the font of
//! the `lucide-icons` crate.

use egui::epaint::text::{FontData, FontInsert, FontPriority, InsertFontFamily};
use egui::{Align2, Color32, Context, FontFamily, FontId, Pos2, Ui};

pub use lucide_icons::Icon;

/// The font of the icons: a subset of Lucide, <https://lucide.dev/license> (ISC).
const FONT_BYTES: &[u8] = include_bytes!("../fonts/icons.ttf");

/// Height of an icon, in points.
const SIZE: f32 = 15.0;

/// Name of the font and of its family.
const FONT: &str = "lucide";

/// Adds the font of the icons.
pub(crate) fn add_icons(ctx: &Context) {
    let family = InsertFontFamily { family: FontFamily::Name(FONT.into()), priority: FontPriority::Highest };
    ctx.add_font(FontInsert::new(FONT, FontData::from_static(FONT_BYTES), vec![family]));
}

/// Paints an icon around a point. In a host that did not call [`apply_theme`](crate::apply_theme), the first
/// call adds the font, and icons appear from the next frame on.
pub(crate) fn paint_icon(ui: &Ui, icon: Icon, center: Pos2, color: Color32) {
    let family = FontFamily::Name(FONT.into());
    if ui.ctx().fonts(|fonts| fonts.definitions().families.contains_key(&family)) {
        ui.painter().text(center, Align2::CENTER_CENTER, char::from(icon), FontId::new(SIZE, family), color);
    } else {
        add_icons(ui.ctx());
        ui.ctx().request_repaint();
    }
}
