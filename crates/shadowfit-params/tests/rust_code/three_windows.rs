{
let technique = Technique::default().with_maps(Windows { count: 3, ..Windows::default() });
technique
}
