{
let technique = Technique::preset("stable-4").expect("a preset of shadowfit");
technique
}
