//! The classes of pixels in a judged picture.

/// Result of comparing a pixel of a picture with the truth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Class {
    /// Sky, or a surface that faces away from the light, lies beyond the shadow distance or lies outside of
    /// the light's image.
    NotJudged = 0,
    /// The map agrees with the truth.
    Right = 1,
    /// Lit in truth, shadowed by the map, away from edges: acne.
    FalseShadow = 2,
    /// Shadowed in truth, lit by the map, away from edges, though the map holds an occluder: peter-panning or
    /// a leak.
    FalseLight = 3,
    /// Shadowed in truth, lit because the map holds none of the point's occluders or no map covers the point:
    /// the result of clipping. Also used in the edge zone.
    Hole = 4,
    /// Wrong within the edge zone: aliasing.
    Edge = 5,
}

/// Returns whether a share of light counts as lit: at least half.
pub(crate) fn counts_as_lit(share: f32) -> bool {
    share >= 0.5
}
