{
let technique = Technique {
    fit: FitSettings {
        kind: FitKind::Windows,
        max_distance: f32::MIN,
        ..FitSettings::default()
    },
    splits: SplitScheme::Practical(0.7),
    hold: HoldSettings {
        horizon: 60,
        ..HoldSettings::default()
    },
    softness: Softness {
        radius: SoftRadius::SunAngle(0.01),
        ..Softness::default()
    },
    bias: BiasSettings {
        slope: 1.0,
        ..BiasSettings::default()
    },
    ..Technique::default()
};
technique
}
