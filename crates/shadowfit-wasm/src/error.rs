//! Errors as numbers, since their sentences would be larger than the code that computes the maps.

use shadowfit::FitError;

/// An error as numbers: its kind, the name of the input if there is one, and up to three values.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ErrorNumbers {
    /// Kind of the error, or 0 for a success.
    pub(crate) code: u32,
    pub(crate) input: &'static str,
    pub(crate) values: [f64; 3],
}

impl From<FitError> for ErrorNumbers {
    fn from(error: FitError) -> Self {
        let plain = |code| Self { code, ..Self::default() };
        match error {
            FitError::NotFinite { input, value } => Self { code: 1, input, values: [value, 0.0, 0.0] },
            FitError::OutOfRange { input, value, min, max } => Self { code: 2, input, values: [value, min, max] },
            FitError::BadDirection { input, length } => Self { code: 3, input, values: [length, 0.0, 0.0] },
            FitError::SingularMatrix { corner, w } => Self { values: [corner as f64, w, 0.0], ..plain(4) },
            FitError::UnusablePlane { plane, .. } => Self { input: plane, ..plain(5) },
            FitError::Endless => plain(6),
            FitError::OtherDepth { is_reversed, .. } => {
                Self { values: [f64::from(u8::from(is_reversed)), 0.0, 0.0], ..plain(7) }
            }
            FitError::EmptyFrustum { size } => Self { values: size.as_dvec3().to_array(), ..plain(8) },
            FitError::NearNotBelowFar { near, far } => {
                Self { values: [f64::from(near), f64::from(far), 0.0], ..plain(9) }
            }
            FitError::NoView => plain(10),
            FitError::ZeroResolution { .. } => plain(11),
            FitError::MissingFeature { feature } => Self { input: feature, ..plain(12) },
            _ => plain(99),
        }
    }
}
