//! Fuzz target: an accepted technique must read back equal after writing, and fitting must not panic.

use shadowfit_study::NamedTechnique;

use super::finite::fit_simple_scene;

/// Reads a technique, writes it, reads it again, and fits it.
pub fn technique_toml(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Ok(named) = NamedTechnique::from_toml(text) else { return };
    let written = named.to_toml().unwrap_or_else(|error| panic!("{named:?}: {error:#}"));
    assert_eq!(NamedTechnique::from_toml(&written).ok(), Some(named.clone()), "{written}");
    fit_simple_scene(&named.technique);
}
