//! The three artefacts of shadow maps: what they are called, why they happen and what cures them.

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

    /// Name for a narrow button.
    pub(crate) const fn short_label(self) -> &'static str {
        match self {
            Self::Acne => "acne",
            Self::Aliasing => "aliasing",
            Self::ClippingHole => "hole",
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
                 what is seen of the scene. Cascades keep the size of their texels, and only the depth \
                 range grows. Windows hold every caster over them, so they gave way to focused maps, and are back."
            }
        }
    }
}
