//! Verdicts of the pass that classifies pixels, for Rust and for WGSL.

/// Result of comparing a pixel, or the texels around a point, with the maps.
///
/// The order matters: pixels with a verdict up to [`Self::Filtered`] face the light within the shadow
/// distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Verdict {
    /// No texel that the filter reads is nearer to the light than the point's plane.
    Lit,
    /// All texels shadow the point.
    Shadowed,
    /// The texels disagree: rays decide.
    Unsure,
    /// The filter decides.
    Filtered,
    /// The texels of a footprint do not all lie in the map, or are too many.
    TooWide,
    /// The surface faces away from the light.
    FacesAway,
    /// The point lies beyond the shadow distance.
    Beyond,
    /// The depth buffer holds no surface.
    NoSurface,
}

impl Verdict {
    /// All verdicts with their names in WGSL.
    const NAMES: [(Self, &'static str); 8] = [
        (Self::Lit, "LIT"),
        (Self::Shadowed, "SHADOWED"),
        (Self::Unsure, "UNSURE"),
        (Self::Filtered, "FILTERED"),
        (Self::TooWide, "TOO_WIDE"),
        (Self::FacesAway, "FACES_AWAY"),
        (Self::Beyond, "BEYOND"),
        (Self::NoSurface, "NO_SURFACE"),
    ];

    /// Returns the WGSL constants of all verdicts.
    pub(crate) fn wgsl() -> String {
        Self::NAMES.map(|(verdict, name)| format!("const {name}: u32 = {}u;\n", verdict as u32)).concat()
    }
}
