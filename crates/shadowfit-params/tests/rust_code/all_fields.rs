{
let mut technique = Technique::default().with_maps(Cascades { count: 3, shape: Shape { kind: FitKind::Oriented, rectangle: RectangleKind::MinimumSquare, max_texel_ratio: 3.0 }, splits: SplitScheme::Manual([1.0, 2.5, 0.1, 1e-7, 3000000000.0, 16777216.0, f32::MAX]), selection: MapSelection::ViewDepth { overlap: 0.1 }, stabilise: Stabilise::Snap { max_oversize: 3.0 } });
technique.fit.least_texel = 0.001;
technique.fit.max_distance = 80.25;
technique.fit.casters = CasterPolicy::DepthClamp;
technique.fit.caster_extension = 7.0;
technique.fit.border = Some(4.0);
technique.fit.margin = 0.25;
technique.fit.up.y = -0.0;
technique.fit.up.z = 1.0;
technique.fit.resolution = UVec2::new(1024, 512);
technique.format = MapFormat::R32Float;
technique.filter = FilterKind::Vogel8;
technique.edges = Edges::Traced { samples: 9 };
technique.fade = 0.2;
technique.fit.depth = DepthConvention::Reversed;
technique.softness.radius = SoftRadius::Metres(0.1);
technique.softness.floor = 0.5;
technique.softness.ceiling = 8.0;
technique.bias.constant = 0.33333334;
technique.bias.slope = 0.2;
technique.bias.normal_offset = 1e-9;
technique.bias.receiver_plane = 1.5;
technique.bias.depth_steps = 0.5;
technique
}
