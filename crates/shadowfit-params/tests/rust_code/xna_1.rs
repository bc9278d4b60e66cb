{
let technique = Technique {
    count: 1,
    fit: FitSettings {
        kind: FitKind::XnaSample,
        ..FitSettings::default()
    },
    splits: SplitScheme::Logarithmic,
    stabilise: Stabilise::Off,
    receivers: ReceiverSource::Objects,
    ..Technique::default()
};
technique
}
