//! Fuzz target: accepted settings must read back equal after writing.

use shadowfit_params::tool::Settings;
use shadowfit_study::{settings_from_toml, settings_to_toml};

/// Reads settings, writes them, and reads them again.
pub fn settings_toml(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Some(settings) = read(text) else { return };
    let written = settings_to_toml(&settings, "");
    assert_eq!(read(&written), Some(settings), "{written}");
}

fn read(text: &str) -> Option<Settings> {
    let mut settings = Settings::default();
    settings_from_toml(&toml::from_str(text).ok()?, &mut settings).ok()?;
    Some(settings)
}
