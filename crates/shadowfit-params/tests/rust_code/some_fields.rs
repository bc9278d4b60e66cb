{
let mut technique = Technique::default();
technique.fit.max_distance = f32::MIN;
technique.splits = SplitScheme::Practical(0.7);
technique.hold.horizon = 60;
technique.softness.radius = SoftRadius::SunAngle(0.01);
technique.bias.slope = 1.0;
technique
}
