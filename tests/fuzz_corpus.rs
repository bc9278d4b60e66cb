//! Runs the fuzz targets over `tests/fuzz/corpus`, which also contains the findings of fuzzing. Targets that
//! need private parts of a crate have their test in that crate.

#![expect(unreachable_pub, reason = "the package of the fuzz targets makes them public")]

#[path = "fuzz/src/bytes.rs"]
mod bytes;
#[path = "fuzz/src/cache_plan.rs"]
mod cache_plan;
#[path = "fuzz/src/corpus.rs"]
mod corpus;
#[path = "fuzz/src/finite.rs"]
mod finite;
#[path = "fuzz/src/fit_input.rs"]
mod fit_input;
#[path = "fuzz/src/gltf_import.rs"]
mod gltf_import;
#[path = "fuzz/src/saved_json.rs"]
mod saved_json;
#[path = "fuzz/src/settings_toml.rs"]
mod settings_toml;
#[path = "fuzz/src/technique_toml.rs"]
mod technique_toml;

#[test]
fn scenes_are_refused_or_finite_in_every_pose() {
    corpus::replay("gltf_import", gltf_import::gltf_import);
}

#[test]
fn settings_are_refused_or_read_back_the_same() {
    corpus::replay("settings_toml", settings_toml::settings_toml);
}

#[test]
fn techniques_are_refused_or_read_back_the_same_and_fitted() {
    corpus::replay("technique_toml", technique_toml::technique_toml);
}

#[test]
fn saved_games_read_back_the_same_and_go_on() {
    corpus::replay("saved_json", saved_json::saved_json);
}

#[test]
fn floats_of_any_bits_give_errors_or_finite_maps() {
    corpus::replay("fit_input", fit_input::fit_input);
}

#[test]
fn histories_of_casters_leave_maps_as_full_redraws_do() {
    corpus::replay("cache_plan", cache_plan::cache_plan);
}
