//! The samples' scenes, as functions that a table can hold.

use shadowfit_scene::Scene;
use shadowfit_scene::builtin::SampleScene;

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
