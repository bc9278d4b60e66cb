//! The samples' scenes, as functions that a table can hold.

use shadowfit_scene::Scene;
use shadowfit_scene::builtin::SampleScene;

/// The XNA sample's character on its floor. Its first animation turns it once.
pub(super) fn shadow_mapping() -> Scene {
    SampleScene::ShadowMapping.build()
}
