//! The three artefacts of shadow maps: their names, causes and cures.

/// An artefact of a shadow-mapped picture.
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

    /// Returns the name for people.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Acne => "Acne",
            Self::Aliasing => "Aliasing",
            Self::ClippingHole => "Clipping hole",
        }
    }

    /// Returns the name for a narrow button.
    pub(crate) const fn short_label(self) -> &'static str {
        match self {
            Self::Acne => "acne",
            Self::Aliasing => "aliasing",
            Self::ClippingHole => "hole",
        }
    }

    /// Returns the appearance and the cause, in a paragraph.
    pub const fn explanation(self) -> &'static str {
        match self {
            Self::Acne => {
                "Lit surfaces are covered with dark stripes or dots. The map stores one depth per texel, but a texel \
                 covers a patch of a sloped surface. Half of the patch lies behind the stored depth, and is shadowed \
                 by the surface itself. On surfaces that face the light, rounding of the stored depths has the same \
                 effect."
            }
            Self::Aliasing => {
                "Shadow edges near the camera are staircases. A map spreads its texels evenly over the area that it \
                 covers, but the camera magnifies near surfaces, so that one texel there covers many pixels. The \
                 figure 'Pixels per texel' shows how many."
            }
            Self::ClippingHole => {
                "A shadow is missing or cut off. A map's box is fitted to the camera's view. A caster between the \
                 light and that box is not drawn into the map, and so casts no shadow into the view."
            }
        }
    }

    /// Returns the effect of the cure, in a paragraph.
    pub const fn cure(self) -> &'static str {
        match self {
            Self::Acne => {
                "Each texel is compared with the depth of the receiver's own plane at that texel, moved toward the \
                 light by the plane's height change over the reach of one comparison. This is the smallest bias that \
                 removes acne from planes at any slope. A constant bias of one texel removes it from the creases of \
                 curved surfaces. More would detach shadows from their casters."
            }
            Self::Aliasing => {
                "Each map is fitted closely to the visible area, without a margin. With a single map, shadows also end \
                 at the distance beyond which little is visible. If the technique had windows, which the demonstration \
                 replaced by coarser focused maps, they return. Small maps become larger, and the filter blends \
                 neighbouring texels."
            }
            Self::ClippingHole => {
                "The near plane of each map is moved toward the light to the first caster of a visible shadow, so that \
                 casters outside the view are drawn into the map. A single map is also fitted to the visible part of \
                 the scene. Cascades keep their texel size; only their depth range grows. If the technique had \
                 windows, which the demonstration replaced by focused maps, they return: windows hold every caster \
                 between their area and the light."
            }
        }
    }
}
