{
let mut technique = Technique::default().with_maps(Cascades { splits: SplitScheme::Practical(0.7), stabilise: Stabilise::Hysteresis(Hysteresis { look_ahead: 60, ..Hysteresis::default() }), ..Cascades::default() });
technique.fit.max_distance = f32::MIN;
technique.softness.radius = SoftRadius::SunAngle(0.01);
technique.bias.slope = 1.0;
technique
}
