{
let technique = Technique::preset("xna-1").expect("a preset of shadowfit");
technique
}
