//! The three artefacts of shadow maps: what they are called, why they happen and what cures them;
//! and the part of the panel that shows and fixes them.

use egui::{
    Align2, Button, Color32, Frame, RichText, Role, Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo,
};

use crate::Action;

/// What can be wrong with a shadow-mapped picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Artefact {
    /// False shadow on surfaces that shadow themselves.
    Acne,
    /// Jagged edges, where a texel covers many pixels.
    Aliasing,
    /// Missing shadows of casters that the map does not cover.
    ClippingHole,
}

impl Artefact {
    /// All artefacts, in the order of their keys.
    pub const ALL: [Self; 3] = [Self::Acne, Self::Aliasing, Self::ClippingHole];

    /// Readable name.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Acne => "Acne",
            Self::Aliasing => "Aliasing",
            Self::ClippingHole => "Clipping hole",
        }
    }

    /// Key that shows it, see [`KEYS`](crate::KEYS).
    pub const fn key(self) -> &'static str {
        match self {
            Self::Acne => "1",
            Self::Aliasing => "2",
            Self::ClippingHole => "3",
        }
    }

    /// What is seen and why it happens, in a paragraph.
    pub const fn explanation(self) -> &'static str {
        match self {
            Self::Acne => {
                "Lit surfaces are covered with dark stripes or dots. The map stores one depth per texel, but a \
                 texel covers a patch of a sloped surface: half of the patch lies behind its stored depth and \
                 so takes the surface itself for a caster. Rounding of the stored depths does the same on \
                 surfaces that face the light."
            }
            Self::Aliasing => {
                "Shadow edges near the camera are staircases. A map is spread evenly over all that it covers, while \
                 the camera magnifies what is near, so one texel there covers many pixels. The figure 'pixels per \
                 texel' says how many."
            }
            Self::ClippingHole => {
                "A shadow that should be there is missing or cut off. A map's box is fitted to what the camera \
                 sees; a caster between the light and that box is outside it, is never drawn into the map, and \
                 so throws no shadow into the view."
            }
        }
    }

    /// What the cure does, in a paragraph.
    pub const fn cure(self) -> &'static str {
        match self {
            Self::Acne => {
                "Each texel is compared with the depth that the lit surface's own plane has there, moved toward \
                 the light by the plane's rise over the reach of one comparison: the least that clears a plane at \
                 any slope. A constant bias of one texel clears the creases of curved things; more would detach \
                 shadows from their casters."
            }
            Self::Aliasing => {
                "Each map is laid closely around what is seen, without a margin, so that its texels are spent there; \
                 a single map also ends its shadows where little is seen. Windows, which cannot be made coarse and \
                 gave way to focused maps, are back. Maps that were small are larger, and the filter blends \
                 neighbouring texels."
            }
            Self::ClippingHole => {
                "The near plane of each map is moved toward the light to the first caster that can throw a shadow \
                 into view, so that casters outside the view are drawn into the map. A single map is also fitted to \
                 what is seen of the scene. Slices of the view keep the size of their texels, and only the depth \
                 range grows. Windows hold every caster over them, so they gave way to focused maps, and are back."
            }
        }
    }
}

/// The buttons, and the card of the artefact that is shown.
pub(crate) fn show(ui: &mut Ui, shown: Option<Artefact>, fixed: bool, action: &mut Option<Action>) {
    ui.label(RichText::new("Show an artefact").strong());
    ui.columns_const(|columns: &mut [Ui; 3]| {
        for (ui, artefact) in columns.iter_mut().zip(Artefact::ALL) {
            if button(ui, artefact, shown == Some(artefact)) {
                *action = Some(Action::ShowArtefact(artefact));
            }
        }
    });
    if let Some(artefact) = shown {
        ui.add_space(2.0);
        card(ui, artefact, fixed, action);
    }
    ui.add_space(4.0);
}

/// A button with its key under its name: painted here, since egui's buttons hold one line of one
/// size.
fn button(ui: &mut Ui, artefact: Artefact, selected: bool) -> bool {
    let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), 42.0), Sense::click());
    let name = format!("Show {}", artefact.label().to_lowercase());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, &name));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact_selectable(&response, selected);
        let (fill, stroke) = (visuals.weak_bg_fill, visuals.bg_stroke);
        ui.painter().rect(rect, visuals.corner_radius, fill, stroke, StrokeKind::Inside);
        let line = |offset: f32, text: &str, style: TextStyle| {
            let at = rect.center() + Vec2::new(0.0, offset);
            ui.painter().text(at, Align2::CENTER_CENTER, text, style.resolve(ui.style()), visuals.text_color());
        };
        line(-8.0, artefact.label(), TextStyle::Button);
        line(10.0, artefact.key(), TextStyle::Small);
    }
    response.on_hover_text(artefact.explanation()).clicked()
}

fn card(ui: &mut Ui, artefact: Artefact, fixed: bool, action: &mut Option<Action>) {
    let accent = if fixed { Color32::from_rgb(88, 166, 104) } else { Color32::from_rgb(214, 131, 56) };
    Frame::group(ui.style()).stroke(Stroke::new(1.5, accent)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        let title = if fixed { format!("{}: fixed", artefact.label()) } else { artefact.label().to_owned() };
        ui.label(RichText::new(title).strong().color(accent));
        let text = if fixed { artefact.cure() } else { artefact.explanation() };
        ui.add(egui::Label::new(text).wrap());
        ui.add_space(2.0);
        let size = Vec2::new(ui.available_width(), 30.0);
        if fixed {
            if ui.add_sized(size, Button::new("Show again")).clicked() {
                *action = Some(Action::ShowArtefact(artefact));
            }
        } else {
            let text = RichText::new("Fix (F)").strong().color(Color32::WHITE);
            let fix = Button::new(text).fill(Color32::from_rgb(46, 112, 66));
            if ui.add_sized(size, fix).on_hover_text(artefact.cure()).clicked() {
                *action = Some(Action::FixArtefact(artefact));
            }
        }
    });
}
