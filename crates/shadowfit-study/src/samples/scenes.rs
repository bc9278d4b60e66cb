//! The samples' scenes, as functions that a table can hold.

use shadowfit_scene::Scene;
use shadowfit_scene::builtin::SampleScene;

/// The XNA sample's character on its floor. Its first animation turns it once.
pub(super) fn shadow_mapping() -> Scene {
    SampleScene::ShadowMapping.build()
}

/// The street at night.
pub(super) fn street() -> Scene {
    SampleScene::Street.build()
}

/// The still life.
pub(super) fn still_life() -> Scene {
    SampleScene::StillLife.build()
}
