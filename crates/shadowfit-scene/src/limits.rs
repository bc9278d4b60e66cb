//! Greatest numbers allowed in files and poses.

/// Greatest coordinate, in metres. Up to here, transforms in f64 are exact to a millimetre, and the product
/// of three coordinates, such as a volume, is finite in f32.
pub(crate) const MAX_COORDINATE: f32 = 1e12;

/// Greatest weight of a morph target. The longest allowed displacement, times this weight and the largest
/// matrix of a pose, stays far below the largest f32.
pub(crate) const MAX_MORPH_WEIGHT: f32 = 1e6;
