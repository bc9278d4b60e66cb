//! Errors of a sun's shadows.

use core::fmt;

use shadowfit::FitError;

use crate::ShadowMapError;
use crate::demand::DemandPassError;

/// The reason why a call of [`SunShadows`](crate::SunShadows) failed.
#[derive(Clone, Debug, PartialEq)]
pub enum SunShadowsError {
    /// Views, light, boxes or technique are invalid.
    Fit(FitError),
    /// The maps cannot be created, or cannot hold the fits.
    Map(ShadowMapError),
    /// The depth buffer cannot be read.
    Demand(DemandPassError),
    /// No frame has been fitted yet.
    NoFrame,
}

impl fmt::Display for SunShadowsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fit(error) => write!(f, "the sun's shadows cannot be fitted: {error}"),
            Self::Map(error) => write!(f, "the sun's shadow maps: {error}"),
            Self::Demand(error) => write!(f, "visible points cannot be counted: {error}"),
            Self::NoFrame => f.write_str("the sun's shadows have no frame yet: call update first"),
        }
    }
}

impl core::error::Error for SunShadowsError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Fit(error) => Some(error),
            Self::Map(error) => Some(error),
            Self::Demand(error) => Some(error),
            Self::NoFrame => None,
        }
    }
}

impl From<FitError> for SunShadowsError {
    fn from(error: FitError) -> Self {
        Self::Fit(error)
    }
}

impl From<ShadowMapError> for SunShadowsError {
    fn from(error: ShadowMapError) -> Self {
        Self::Map(error)
    }
}

impl From<DemandPassError> for SunShadowsError {
    fn from(error: DemandPassError) -> Self {
        Self::Demand(error)
    }
}
