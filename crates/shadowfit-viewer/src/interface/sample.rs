//! The sample on show, as the panel takes it.

use shadowfit_egui::{SampleCard, SampleChoice, SampleControl, SampleFigure, SampleRow};
use shadowfit_study::samples::{OptionKind, Sample};

use crate::stage::SampleShow;

/// What the card of a sample borrows.
pub(super) struct Parts {
    sample: &'static Sample,
    shown: Option<usize>,
    is_technique: bool,
    variants: Vec<SampleChoice<'static>>,
    rows: Vec<SampleRow<'static>>,
}

impl Parts {
    pub(super) fn new(show: &SampleShow) -> Self {
        let sample = show.sample;
        let row = |(option, value): (&'static shadowfit_study::samples::SampleOption, f32)| SampleRow {
            label: option.label,
            help: option.help,
            control: match option.kind {
                OptionKind::Choice(choices) => SampleControl::Choice(choices),
                OptionKind::Number { min, max, unit, .. } => SampleControl::Number { min, max, unit },
                OptionKind::Toggle { .. } => SampleControl::Toggle,
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
                .map(|variant| SampleChoice { label: variant.label, text: variant.text })
                .collect(),
            rows: show.values.iter().map(row).collect(),
        }
    }

    pub(super) fn card<'a>(&'a self, figures: &'a [SampleFigure]) -> SampleCard<'a> {
        SampleCard {
            title: self.sample.title,
            text: self.sample.teaches,
            flaw: self.sample.flaw,
            is_technique: self.is_technique,
            variants: &self.variants,
            shown: self.shown,
            rows: &self.rows,
            is_measurable: self.sample.is_measurable,
            figures,
        }
    }
}
