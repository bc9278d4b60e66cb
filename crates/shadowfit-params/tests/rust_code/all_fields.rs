{
let technique = Technique {
    count: 3,
    fit: FitSettings {
        kind: FitKind::Oriented,
        rectangle: RectangleKind::MinimumSquare,
        max_distance: 80.25,
        margin: 0.25,
        border: Some(4.0),
        casters: CasterPolicy::DepthClamp,
        caster_extension: 7.0,
        up: Vec3::new(0.0, -0.0, 1.0),
        max_texel_ratio: 3.0,
        least_texel: 0.001,
        resolution: UVec2::new(1024, 512),
        depth: DepthConvention::Reversed,
    },
    splits: SplitScheme::Manual([
        1.0,
        2.5,
        0.1,
        1e-7,
        3000000000.0,
        16777216.0,
        f32::MAX,
    ]),
    choice: MapChoice::ViewDepth,
    blend: 2.5,
    overlap: 0.1,
    stabilise: Stabilise::Snap,
    hold: HoldSettings {
        margin: 0.5,
        growth: 2.0,
        waste: 3.0,
        horizon: 9,
    },
    overrides: [
        MapOverride {
            kind: Some(FitKind::XnaSample),
            resolution: Some(UVec2::new(256, 512)),
        },
        MapOverride {
            kind: Some(FitKind::FrustumAabb),
            resolution: Some(UVec2::new(512, 1024)),
        },
        MapOverride {
            kind: Some(FitKind::Oriented),
            resolution: Some(UVec2::new(1024, 2048)),
        },
        MapOverride {
            kind: Some(FitKind::Sphere),
            resolution: Some(UVec2::new(2048, 4096)),
        },
        MapOverride {
            kind: Some(FitKind::Focused),
            resolution: Some(UVec2::new(300, 600)),
        },
        MapOverride {
            kind: Some(FitKind::Sphere),
            resolution: Some(UVec2::new(4096, 8192)),
        },
        MapOverride {
            kind: Some(FitKind::Sphere),
            resolution: Some(UVec2::new(8192, 16384)),
        },
        MapOverride {
            kind: Some(FitKind::Sphere),
            resolution: Some(UVec2::new(1, 2)),
        },
    ],
    receivers: ReceiverSource::Objects,
    filter: FilterKind::Vogel8,
    softness: Softness {
        radius: SoftRadius::Metres(0.1),
        floor: 0.5,
        ceiling: 8.0,
    },
    fade: 0.2,
    bias: BiasSettings {
        constant: 0.33333334,
        slope: 0.2,
        normal_offset: 1e-9,
        receiver_plane: 1.5,
        depth_steps: 0.5,
    },
    need: NeedSource::Boxes,
    format: MapFormat::R32Float,
};
technique
}
