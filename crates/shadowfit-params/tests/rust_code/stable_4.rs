{
let technique = Technique {
    fit: FitSettings {
        kind: FitKind::Sphere,
        ..FitSettings::default()
    },
    splits: SplitScheme::FromBoxes,
    stabilise: Stabilise::Snap,
    hold: HoldSettings {
        waste: 4.0,
        ..HoldSettings::default()
    },
    ..Technique::default()
};
technique
}
