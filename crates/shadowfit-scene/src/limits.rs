//! Greatest numbers that files and poses may have.

/// Greatest coordinate accepted, in metres: transforms in f64 are exact to a millimetre up to here, and the product of
/// three coordinates, as in a volume, is still finite in f32.
pub(crate) const MAX_COORDINATE: f32 = 1e12;

/// Greatest weight of a morph target. The longest accepted displacement, times this weight and the largest matrix of a pose,
/// stays far below the largest f32.
pub(crate) const MAX_MORPH_WEIGHT: f32 = 1e6;
