//! One technique is recommended, and everything that a newcomer reads first uses it.

use shadowfit::presets::RECOMMENDED;
use shadowfit::settings::{
    BiasSettings, FilterKind, FitKind, FitSettings, HoldSettings, MapChoice, MapFormat, NeedSource, ReceiverSource,
    SplitScheme, Stabilise,
};
use shadowfit::{PRESETS, Technique};

#[test]
fn the_default_technique_is_the_recommended_preset() {
    assert_eq!(Technique::preset(RECOMMENDED), Some(Technique::default()));
    assert_eq!(PRESETS.iter().filter(|preset| preset.technique() == Technique::default()).count(), 1);
}

#[test]
fn the_defaults_of_its_parts_are_those_of_the_technique() {
    let technique = Technique::default();
    // A single map, which has no frame before, is no window.
    assert_eq!((technique.fit.kind, FitSettings::default().kind), (FitKind::Windows, FitKind::Focused));
    assert_eq!(technique.fit, FitSettings::default().with_kind(FitKind::Windows));
    assert_eq!((technique.choice, technique.need), (MapChoice::default(), NeedSource::default()));
    assert_eq!(technique.hold, HoldSettings::default());
    assert_eq!(technique.bias, BiasSettings::default());
    assert_eq!(technique.bias, BiasSettings::automatic(technique.filter));
    assert_eq!((technique.splits, technique.stabilise), (SplitScheme::default(), Stabilise::default()));
    assert_eq!((technique.filter, technique.format), (FilterKind::default(), MapFormat::default()));
    assert_eq!(technique.receivers, ReceiverSource::default());
}
