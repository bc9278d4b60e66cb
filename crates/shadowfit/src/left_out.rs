//! Stand-ins for the kinds of maps that a build leaves out, with the same functions. A build that only needs
//! windows or only needs cascades is then much smaller, which matters in a browser.

#[cfg(not(feature = "cascades"))]
pub(crate) mod cascades {
    use glam::DVec2;

    use crate::base::FitError;
    use crate::fits::{Frame, PlacedMaps};
    use crate::technique::Cascades;

    #[derive(Clone, Copy, Debug)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
    pub(crate) struct HeldCascades;

    pub(crate) fn place(
        _: &Frame,
        _: &Cascades,
        _: Option<&HeldCascades>,
        _: &mut [DVec2],
    ) -> Result<(PlacedMaps, HeldCascades), FitError> {
        Err(FitError::MissingFeature { feature: "cascades" })
    }

    pub(crate) fn fewest(_: &Frame, settings: &Cascades, _: f64) -> u32 {
        settings.count
    }
}

#[cfg(not(feature = "windows"))]
pub(crate) mod windows {
    use glam::DVec2;

    use crate::base::FitError;
    use crate::fits::{Frame, PlacedMaps};
    use crate::technique::Windows;

    #[derive(Clone, Copy, Debug)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
    pub(crate) struct HeldWindows;

    impl HeldWindows {
        pub(crate) fn is_guess(&self) -> bool {
            true
        }
    }

    pub(crate) fn place(
        _: &Frame,
        _: &Windows,
        _: Option<&HeldWindows>,
        _: &mut [DVec2],
    ) -> Result<(PlacedMaps, HeldWindows), FitError> {
        Err(FitError::MissingFeature { feature: "windows" })
    }
}
