//! The panel, driven through its accessibility tree as a person would drive it, and drawn.
//! The harness itself fails on a widget without a name and on a glyph that egui's fonts lack.

mod card;
mod commands;
mod controls;
mod device_check;
mod figures;
mod golden;
mod host;
mod layout;
mod overlays;
mod renderer;
mod states;
mod techniques;
