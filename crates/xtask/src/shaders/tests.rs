//! Tests of the committed shaders: a compiler accepts every variant, and the constant blocks have the layout of the
//! Rust structs.

mod dxc;
mod glslang;

use shadowfit::PRESETS;

use super::*;

/// Entry points that call all functions.
const HLSL_LOOK_UP: &str = "
float4 entry(float4 at : SV_Position) : SV_Target {
    float3 p = at.xyz;
    return float4(
        shadowfit_factor_at(p, p, p.xy), shadowfit_factor(p, p), shadowfit_view_depth(p), shadowfit_map_index(p));
}
";
const HLSL_CASTER: &str = "
float4 entry(float3 position : POSITION) : SV_Position {
    return shadowfit_caster_position(position) * shadowfit_clamped_depth(shadowfit_caster_depth(position));
}
";

/// Returns the settings of each alternative of the look-up.
fn settings(language: Language) -> Vec<String> {
    let filters = filters(language).map(|(name, ..)| format!("#define SHADOWFIT_FILTER {name}\n"));
    let maps = MAPS.map(|maps| format!("#define SHADOWFIT_MAPS {maps}\n"));
    filters.chain(maps).chain(["#define SHADOWFIT_BY_VIEW_DEPTH 1\n".to_owned()]).collect()
}

/// Returns the text of a committed file.
fn committed(name: &str) -> String {
    let path = crate::process::root().join(FOLDER).join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn the_page_names_the_settings_of_every_preset_and_they_give_its_look_up() {
    let page = committed("README.md");
    for preset in &PRESETS {
        let descriptor = ShadowMapDescriptor::from(&preset.technique());
        let maps = descriptor.maps;
        let row = page.lines().find(|line| line.contains(&format!("`{}`", preset.name)));
        assert!(row.is_some_and(|row| row.ends_with(&format!("| {maps} |"))), "{}: {row:?}", preset.name);
        let usual = ShadowMapDescriptor::default();
        // A single map has no next one to blend into.
        let selection = if maps == 1 { descriptor.selection } else { usual.selection };
        let with_settings = ShadowMapDescriptor { maps, selection, ..usual };
        let wgsl = |descriptor| receiver_wgsl(descriptor, &WgslOptions::group(0));
        assert!(MAPS.contains(&maps) && wgsl(&descriptor) == wgsl(&with_settings), "{}", preset.name);
    }
}

#[test]
fn an_item_that_differs_along_two_axes_is_refused() {
    let item = |text: &str| vec![Item { name: "f".to_owned(), text: text.to_owned() }];
    let axis = |other: &str| Axis {
        alternatives: vec![("A".to_owned(), item("void f() {}\n")), ("B".to_owned(), item(other))],
    };
    assert!(merge::merge(&[axis("int f() {}\n"), axis("float f() {}\n")]).is_err());
    let merged = merge::merge(&[axis("int f() {}\n"), axis("void f() {}\n")]).unwrap();
    assert_eq!(merged, "\n#if A\nvoid f() {}\n#else\nint f() {}\n#endif\n");
}
