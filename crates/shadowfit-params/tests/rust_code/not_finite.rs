{
let mut technique = Technique::default().with_maps(Cascades { splits: SplitScheme::Practical(f32::NAN), selection: MapSelection::ViewDepth { overlap: f32::INFINITY }, ..Cascades::default() });
technique.fit.border = Some(f32::NAN);
technique.fit.up.x = f32::NEG_INFINITY;
technique.fit.up.y = f32::NAN;
technique.fit.up.z = f32::MAX;
technique
}
