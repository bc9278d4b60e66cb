{
let technique = Technique {
    fit: FitSettings {
        kind: FitKind::Windows,
        border: Some(f32::NAN),
        up: Vec3::new(f32::NEG_INFINITY, f32::NAN, f32::MAX),
        ..FitSettings::default()
    },
    splits: SplitScheme::Practical(f32::NAN),
    overlap: f32::INFINITY,
    ..Technique::default()
};
technique
}
