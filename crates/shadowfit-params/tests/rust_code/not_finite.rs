{
let mut technique = Technique::default();
technique.fit.border = Some(f32::NAN);
technique.fit.up.x = f32::NEG_INFINITY;
technique.fit.up.y = f32::NAN;
technique.fit.up.z = f32::MAX;
technique.splits = SplitScheme::Practical(f32::NAN);
technique.overlap = f32::INFINITY;
technique
}
