//! Entrants of the report: Bevy's cascades or a fit of the plugin, each with a bias.

use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy_shadowfit::{Fit, FitBias, FitSplits, FittedShadows};

/// View depth at which Bevy's first cascade ends, in metres: Bevy's default.
const FIRST_BOUND: f32 = 10.0;

/// Source of the cascades.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Cascades {
    /// Bevy's own cascades
    Bevy,
    /// This crate's stable fit
    Stable,
    /// This crate's calm fit
    Calm,
    /// This crate's fit to the visible points of the depth prepass
    Histogram,
    /// This crate's windows, read by coverage
    Windows,
}

/// Source of the bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Bias {
    /// The defaults of Bevy's light
    Bevys,
    /// This crate's bias
    Ours,
}

/// Source of the bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Splits {
    /// This crate's bounds, for its own fits
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

    /// Returns all valid pairs: Bevy's own cascades are combined only with Bevy's bias.
    pub(crate) fn of(cascades: &[Cascades], biases: &[Bias]) -> Vec<Self> {
        let entrants = cascades.iter().flat_map(|&cascades| biases.iter().map(move |&bias| Self { cascades, bias }));
        entrants.filter(|entrant| entrant.fit().is_some() || entrant.bias == Bias::Bevys).collect()
    }

    /// Returns the name in tables and files.
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

    /// Returns whether the fit uses the camera's depth prepass.
    pub(crate) fn reads_depth(&self) -> bool {
        matches!(self.cascades, Cascades::Calm | Cascades::Histogram | Cascades::Windows)
    }

    /// Returns the bounds of Bevy's cascades in a view that ends at `far`, in metres.
    pub(crate) fn config(far: f32) -> CascadeShadowConfigBuilder {
        CascadeShadowConfigBuilder {
            num_cascades: 4,
            first_cascade_far_bound: FIRST_BOUND,
            maximum_distance: far,
            ..default()
        }
    }

    /// Adds the plugin's component to a new light, if the cascades are one of its fits.
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
