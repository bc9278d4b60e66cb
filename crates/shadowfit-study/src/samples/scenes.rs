//! The samples' scenes, as functions that a table can hold.

use shadowfit_scene::Scene;
use shadowfit_scene::builtin::{BuiltinScene, SampleScene};

/// The XNA sample's character on its floor. Its first animation turns it once.
pub(super) fn shadow_mapping() -> Scene {
    SampleScene::ShadowMapping.build()
}

/// The headlight's street.
pub(super) fn street() -> Scene {
    SampleScene::Street.build()
}

/// Stones and chess pieces under a lamp.
pub(super) fn still_life() -> Scene {
    SampleScene::StillLife.build()
}

/// Hills with vehicles.
pub(super) fn terrain() -> Scene {
    SampleScene::Terrain.build()
}

/// A long view over open land.
pub(super) fn plain() -> Scene {
    BuiltinScene::Plain.build()
}

/// Columns and vaults.
pub(super) fn arcade() -> Scene {
    BuiltinScene::Arcade.build()
}

/// A courtyard under an open sky.
pub(super) fn courtyard() -> Scene {
    BuiltinScene::Courtyard.build()
}
