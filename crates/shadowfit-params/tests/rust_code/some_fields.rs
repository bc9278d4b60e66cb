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
    overrides: [
        MapOverride::default(),
        MapOverride {
            kind: Some(FitKind::Sphere),
            ..MapOverride::default()
        },
        MapOverride::default(),
        MapOverride {
            resolution: Some(UVec2::new(1024, 1024)),
            ..MapOverride::default()
        },
        MapOverride::default(),
        MapOverride::default(),
        MapOverride::default(),
        MapOverride::default(),
    ],
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
