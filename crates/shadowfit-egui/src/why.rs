//! The card that says why a pixel is as it is.

use egui::{Area, Context, Frame, Grid, Id, Order, Pos2, RichText, Ui, Vec2};

use crate::PixelClass;
use crate::maps;
use crate::widgets::{caption, color, swatch, title};

/// Width of the card, in points.
const WIDTH: f32 = 268.0;

/// Distance of the card from the pointer, in points.
const GAP: f32 = 16.0;

/// Why a pixel is lit or not, and what was read for it. `None` means not known, and gets no line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WhyCard<'a> {
    /// How it compares with rays; `None` where it was not judged.
    pub class: Option<PixelClass>,
    /// Why it is so, in a sentence or two.
    pub reason: &'a str,
    /// Why it reads this map, in a sentence.
    pub map_reason: &'a str,
    /// World position of the surface, in metres.
    pub position: Option<[f64; 3]>,
    /// Index of the map that it reads, 0..8.
    pub map: Option<u32>,
    /// Column and row of the texel that it reads.
    pub texel: Option<[u32; 2]>,
    /// Depth in that texel.
    pub stored_depth: Option<f32>,
    /// Depth that it is compared with, bias included.
    pub compared_depth: Option<f32>,
    /// Screen pixels that the texel covers, along its worse axis.
    pub pixels_per_texel: Option<f32>,
}

impl WhyCard<'_> {
    /// The lines of the list: name and value.
    fn lines(&self) -> impl Iterator<Item = (&'static str, String)> {
        let position = self.position.map(|[x, y, z]| format!("{x:.2}, {y:.2}, {z:.2} m"));
        [
            ("Position", position),
            ("Texel", self.texel.map(|[x, y]| format!("{x}, {y}"))),
            ("Stored depth", self.stored_depth.map(|depth| format!("{depth:.6}"))),
            ("Compared depth", self.compared_depth.map(|depth| format!("{depth:.6}"))),
            ("Pixels per texel", self.pixels_per_texel.map(|pixels| format!("{pixels:.2}"))),
        ]
        .into_iter()
        .filter_map(|(name, value)| Some((name, value?)))
    }
}

/// The card, in the whole width of `ui`.
pub fn why_card(ui: &mut Ui, why: &WhyCard<'_>) {
    ui.horizontal(|ui| {
        if let Some(fill) = why.class.and_then(PixelClass::color) {
            swatch(ui, color(fill));
        }
        title(ui, why.class.map_or("Not judged", PixelClass::label));
    });
    ui.add(egui::Label::new(why.reason).wrap());
    if !why.map_reason.is_empty() {
        caption(ui, why.map_reason);
    }
    ui.add_space(2.0);
    ui.spacing_mut().interact_size.y = 0.0;
    Grid::new("why").num_columns(2).spacing([12.0, 3.0]).show(ui, |ui| {
        if let Some(map) = why.map {
            ui.label(RichText::new("Map").small().weak());
            maps::badge_of(ui, map as usize);
            ui.end_row();
        }
        for (name, value) in why.lines() {
            ui.label(RichText::new(name).small().weak());
            ui.label(RichText::new(value).small().strong());
            ui.end_row();
        }
    });
}

/// The [`why_card`] on a ground of its own beside `pointer`, kept within the window. It lets the pointer through.
pub fn why_overlay(ctx: &Context, pointer: Pos2, why: &WhyCard<'_>) {
    Area::new(Id::unique("shadowfit why"))
        .order(Order::Tooltip)
        .interactable(false)
        .fixed_pos(pointer + Vec2::splat(GAP))
        .constrain_to(ctx.content_rect())
        .show(ctx, |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_width(WIDTH);
                why_card(ui, why);
            });
        });
}
