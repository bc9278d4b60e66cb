//! The building blocks of the panel: cards, sections, buttons with icons or keys, and colour patches.

mod button;
mod card;
mod chip;
mod section;

pub use crate::icon::Icon;
pub(crate) use button::{KeyButton, at_least, main_button};
pub use button::{icon_button, named_icon_button};
pub(crate) use card::card;
pub(crate) use chip::{ValueRow, badge, color, color_entry, color_line, swatch};
pub(crate) use section::{Section, caption, title};
