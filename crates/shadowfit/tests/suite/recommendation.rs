//! A single technique is recommended, and all introductory documents use it.

use shadowfit::Preset;
use shadowfit::settings::{
    BiasSettings, FilterKind, FitKind, FitSettings, Hysteresis, MapFormat, MapSelection, MapSettings, Shape,
    SplitScheme, Stabilise,
};
use shadowfit::{Cascades, Maps, PRESETS, SingleMap, Technique, Windows};

#[test]
fn the_default_technique_is_the_recommended_preset() {
    assert_eq!(Technique::preset(Preset::RECOMMENDED), Some(Technique::default()));
    assert_eq!(PRESETS.iter().filter(|preset| preset.technique() == Technique::default()).count(), 1);
}

#[test]
fn the_defaults_of_its_parts_are_those_of_the_technique() {
    let technique = Technique::default();
    assert_eq!((technique.maps, technique.fit), (Maps::default(), MapSettings::default()));
    assert_eq!(technique.maps, Windows::default().into());
    assert_eq!(technique.bias, BiasSettings::default());
    assert_eq!(technique.bias, BiasSettings::automatic(technique.filter));
    assert_eq!((technique.filter, technique.format), (FilterKind::default(), MapFormat::default()));
}

#[test]
fn the_kinds_of_maps_have_the_same_defaults() {
    let (windows, cascades, one) = (Windows::default(), Cascades::default(), SingleMap::default());
    // A single map is fitted without earlier frames, so it is not a window.
    let single = FitSettings::default();
    assert_eq!((single.shape.kind, single.map), (FitKind::Focused, MapSettings::default()));
    assert_eq!([single.shape, cascades.shape, one.shape], [Shape::default(); 3]);
    assert_eq!((cascades.splits, cascades.selection), (SplitScheme::default(), MapSelection::default()));
    assert_eq!([cascades.stabilise, one.stabilise], [Stabilise::default(); 2]);
    assert_eq!([windows.blend, cascades.selection.blend()], [MapSelection::DEFAULT_BLEND; 2]);
    assert_eq!(
        [windows.max_depth_oversize, cascades.stabilise.max_oversize()],
        [Hysteresis::default().max_oversize; 2]
    );
    assert_eq!(cascades.stabilise, Stabilise::Hysteresis(Hysteresis::default()));
    assert_eq!(windows.count, cascades.count);
}
