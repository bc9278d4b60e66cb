//! Whose cascades are measured, and with which bias.

use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy_shadowfit::{Fit, FitBias, FitSplits, FittedShadows};

/// View depth at which Bevy's first cascade ends, in metres: its default.
const FIRST_BOUND: f32 = 10.0;

/// Whose cascades.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Contestant {
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
    pub(crate) contestant: Contestant,
    pub(crate) bias: Bias,
}

impl Entrant {
    /// Bevy's own cascades with its own bias, which others are compared with.
    pub(crate) const BEVY: Self = Self { contestant: Contestant::Bevy, bias: Bias::Bevys };

    /// Every pair that the plugin offers: it leaves Bevy's own cascades with Bevy's bias.
    pub(crate) fn of(contestants: &[Contestant], biases: &[Bias]) -> Vec<Self> {
        let pairs = contestants.iter().flat_map(|contestant| biases.iter().map(|bias| (*contestant, *bias)));
        let entrants = pairs.map(|(contestant, bias)| Self { contestant, bias });
        entrants.filter(|entrant| entrant.fit().is_some() || entrant.bias == Bias::Bevys).collect()
    }

    /// Name in tables and files.
    pub(crate) fn name(&self) -> String {
        let contestant = match self.contestant {
            Contestant::Bevy => return "bevy".to_owned(),
            Contestant::Stable => "stable",
            Contestant::Calm => "calm",
            Contestant::Histogram => "histogram",
            Contestant::Windows => "windows",
        };
        let bias = match self.bias {
            Bias::Bevys => "bevy's bias",
            Bias::Ours => "our bias",
        };
        format!("{contestant}, {bias}")
    }

    /// Whether the fit knows the view by the camera's depth prepass.
    pub(crate) fn reads_depth(&self) -> bool {
        matches!(self.contestant, Contestant::Calm | Contestant::Histogram | Contestant::Windows)
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

    /// Hands a new light to the plugin, if the contestant is one of its fits.
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
        match self.contestant {
            Contestant::Bevy => None,
            Contestant::Stable => Some(Fit::Stable),
            Contestant::Calm => Some(Fit::Calm),
            Contestant::Histogram => Some(Fit::Histogram),
            Contestant::Windows => Some(Fit::Windows),
        }
    }
}
