//! The entrants of the report: cascades of Bevy or a fit of the plugin, each with a bias.

use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy_shadowfit::{Fit, FitBias, FitSplits, FittedShadows};

/// View depth at which Bevy's first cascade ends, in metres: its default.
const FIRST_BOUND: f32 = 10.0;

/// Whose cascades.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Cascades {
    /// Bevy's own cascades
    Bevy,
    /// This crate's fit that stands still
    Stable,
    /// This crate's fit that seldom moves
    Calm,
    /// This crate's fit to what the camera sees, by its depth prepass
    Histogram,
    /// This crate's windows, read by coverage
    Windows,
}

/// Whose bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Bias {
    /// The defaults of Bevy's light
    Bevys,
    /// This crate's
    Ours,
}

/// Whose bounds cascades have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Splits {
    /// This crate's, in its own fits
    Ours,
    /// The defaults of Bevy's config
    Bevys,
}

/// A row of the report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entrant {
    pub(crate) cascades: Cascades,
    pub(crate) bias: Bias,
}

impl Entrant {
    /// Bevy's own cascades with its own bias. The tables compare all others with it.
    pub(crate) const BEVY: Self = Self { cascades: Cascades::Bevy, bias: Bias::Bevys };

    /// Every pair that the plugin offers: it leaves Bevy's own cascades with Bevy's bias.
    pub(crate) fn of(cascades: &[Cascades], biases: &[Bias]) -> Vec<Self> {
        let entrants = cascades.iter().flat_map(|&cascades| biases.iter().map(move |&bias| Self { cascades, bias }));
        entrants.filter(|entrant| entrant.fit().is_some() || entrant.bias == Bias::Bevys).collect()
    }

    /// Name in tables and files.
    pub(crate) fn name(&self) -> String {
        let cascades = match self.cascades {
            Cascades::Bevy => return "bevy".to_owned(),
            Cascades::Stable => "stable",
            Cascades::Calm => "calm",
            Cascades::Histogram => "histogram",
            Cascades::Windows => "windows",
        };
        let bias = match self.bias {
            Bias::Bevys => "bevy's bias",
            Bias::Ours => "our bias",
        };
        format!("{cascades}, {bias}")
    }

    /// Whether the fit knows the view by the camera's depth prepass.
    pub(crate) fn reads_depth(&self) -> bool {
        matches!(self.cascades, Cascades::Calm | Cascades::Histogram | Cascades::Windows)
    }

    /// Bounds of Bevy's cascades in a view that ends at `far`, in metres.
    pub(crate) fn config(far: f32) -> CascadeShadowConfigBuilder {
        CascadeShadowConfigBuilder {
            num_cascades: 4,
            first_cascade_far_bound: FIRST_BOUND,
            maximum_distance: far,
            ..default()
        }
    }

    /// Hands a new light to the plugin, if the cascades are one of its fits.
    pub(crate) fn take(&self, light: &mut EntityWorldMut, splits: Splits) {
        let Some(fit) = self.fit() else { return };
        let bias = match self.bias {
            Bias::Bevys => FitBias::Bevys,
            Bias::Ours => FitBias::Ours,
        };
        let splits = match splits {
            Splits::Ours => FitSplits::Ours,
            Splits::Bevys => FitSplits::Bevys,
        };
        light.insert(FittedShadows { fit, bias, splits });
    }

    fn fit(&self) -> Option<Fit> {
        match self.cascades {
            Cascades::Bevy => None,
            Cascades::Stable => Some(Fit::Stable),
            Cascades::Calm => Some(Fit::Calm),
            Cascades::Histogram => Some(Fit::Histogram),
            Cascades::Windows => Some(Fit::Windows),
        }
    }
}
