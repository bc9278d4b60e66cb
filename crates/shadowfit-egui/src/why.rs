//! The card that explains a pixel.

use egui::{Align2, Area, Context, Frame, Grid, Id, Order, Pos2, Rect, RichText, Ui, Vec2};

use crate::PixelClass;
use crate::maps;
use crate::widgets::{caption, color, swatch, title};

/// Width of the card, in points.
const WIDTH: f32 = 268.0;

/// Distance of the card from the pointer, in points.
const GAP: f32 = 16.0;

/// The reason why a pixel is lit or not, and the values that it read. `None` means not known, and gets no
/// line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WhyCard<'a> {
    /// Verdict compared with rays; `None` if the pixel was not judged.
    pub class: Option<PixelClass>,
    /// Reason for the verdict, in a sentence or two.
    pub reason: &'a str,
    /// Reason for the choice of the map, in a sentence.
    pub map_reason: &'a str,
    /// World position of the surface, in metres.
    pub position: Option<[f64; 3]>,
    /// Index of the map that the pixel reads, 0..8.
    pub map: Option<u32>,
    /// Column and row of the texel that the pixel reads.
    pub texel: Option<[u32; 2]>,
    /// Depth in that texel.
    pub stored_depth: Option<f32>,
    /// Depth that the stored depth is compared with, bias included.
    pub compared_depth: Option<f32>,
    /// Screen pixels per texel, along the texel's worse axis.
    pub pixels_per_texel: Option<f32>,
}

impl WhyCard<'_> {
    /// Returns the lines of the list: name and value.
    fn lines(&self) -> impl Iterator<Item = (&'static str, String)> {
        let position = self.position.map(|[x, y, z]| {
            // Two decimals, or three digits in small models.
            let largest = x.abs().max(y.abs()).max(z.abs()).max(1e-6);
            let decimals = (2.0 - largest.log10().floor()).clamp(2.0, 8.0) as usize;
            format!("{x:.decimals$}, {y:.decimals$}, {z:.decimals$} m")
        });
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

/// Shows the card in the whole width of `ui`.
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

/// Shows the [`why_card`] on its own background beside `pointer`, within `picture`: right of the pointer if
/// there is room, else left of it. A picture smaller than the card clips it. The card ignores the pointer.
pub fn why_overlay(ctx: &Context, picture: Rect, pointer: Pos2, why: &WhyCard<'_>) {
    let frame = Frame::popup(&ctx.global_style());
    let sides = frame.total_margin().sum().x;
    let width = WIDTH.min(picture.width() - sides).max(0.0);
    let room = |side: f32| side >= GAP + width + sides;
    let is_left = !room(picture.right() - pointer.x) && room(pointer.x - picture.left());
    let (pivot, aside) = if is_left { (Align2::RIGHT_TOP, -GAP) } else { (Align2::LEFT_TOP, GAP) };
    Area::new(Id::unique("shadowfit why"))
        .order(Order::Tooltip)
        .interactable(false)
        .pivot(pivot)
        .fixed_pos(pointer + Vec2::new(aside, GAP))
        .constrain_to(picture)
        .show(ctx, |ui| {
            ui.set_clip_rect(picture);
            frame.show(ui, |ui| {
                ui.set_width(width);
                why_card(ui, why);
            });
        });
}
