//! The building blocks of the panel: cards, sections, buttons with icons or keys, and what shows colours.

mod button;
mod card;
mod chip;
mod icon;
mod section;

pub(crate) use button::{KeyButton, icon_button, main_button};
pub(crate) use card::card;
pub(crate) use chip::{ValueRow, badge, color, color_entry, color_line, swatch};
pub(crate) use icon::Icon;
pub(crate) use section::{Section, caption, title};
