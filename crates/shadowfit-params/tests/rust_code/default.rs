{
let technique = Technique::default();
technique
}
