//! The card of the current sample, for the panel.

use shadowfit_classics::{OptionKind, Sample};
use shadowfit_egui::{Card, CardChoice, CardControl, CardFigure, CardRow};

use crate::stage::SampleShow;

/// Help text of the button that measures a sample.
const MEASURE: &str = "Judges this view against rays, with the sample's shadows and with modern maps.";

/// Texts for the card of a sample.
pub(super) struct Parts {
    sample: &'static Sample,
    shown: Option<usize>,
    is_technique: bool,
    variants: Vec<CardChoice<'static>>,
    rows: Vec<CardRow<'static>>,
}

impl Parts {
    pub(super) fn new(show: &SampleShow) -> Self {
        let sample = show.sample;
        let row = |(option, value): (&'static shadowfit_classics::SampleOption, f32)| CardRow {
            label: option.label,
            help: option.help,
            control: match option.kind {
                OptionKind::Choice(choices) => CardControl::Choice(choices),
                OptionKind::Number { min, max, unit, .. } => CardControl::Number { min, max, unit },
                OptionKind::Toggle { .. } => CardControl::Toggle,
            },
            value,
        };
        Self {
            sample,
            shown: show.variant.and_then(|shown| sample.variants.iter().position(|variant| variant == shown)),
            is_technique: sample.is_technique(&show.values),
            variants: sample
                .variants
                .iter()
                .map(|variant| CardChoice { label: variant.label, text: variant.text })
                .collect(),
            rows: show.values.iter().map(row).collect(),
        }
    }

    pub(super) fn card<'a>(&'a self, figures: &'a [CardFigure]) -> Card<'a> {
        Card {
            title: self.sample.title,
            text: self.sample.teaches,
            flaw: self.sample.flaw,
            is_technique: self.is_technique,
            first: "As its source",
            variants: &self.variants,
            shown: self.shown,
            rows: &self.rows,
            measure: self.sample.is_measurable.then_some(MEASURE),
            figures,
        }
    }
}
