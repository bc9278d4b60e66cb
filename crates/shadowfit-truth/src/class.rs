//! The classes of pixels in a judged picture.

/// How a pixel of a picture compares with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Class {
    /// Sky, a surface that faces away from the light, or one beyond the shadow distance or outside of the light's image.
    NotJudged = 0,
    /// The map agrees with the truth.
    Right = 1,
    /// Lit in truth, shadowed by the map, away from edges: acne.
    FalseShadow = 2,
    /// Shadowed in truth, lit by the map, away from edges, though an occluder is in the map:
    /// peter-panning or a leak.
    FalseLight = 3,
    /// Shadowed in truth, lit because the map holds no occluder of it, or no map covers the
    /// point: the hole that clipping leaves. In the edge zone too.
    Hole = 4,
    /// Wrong within the edge zone: aliasing.
    Edge = 5,
}

/// Whether a share of light counts as lit: at least half.
pub(crate) fn counts_as_lit(share: f32) -> bool {
    share >= 0.5
}
