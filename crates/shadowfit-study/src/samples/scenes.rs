//! Where the samples' scenes come from.

use shadowfit_scene::Scene;
use shadowfit_scene::builtin::BuiltinScene;

/// The XNA sample's character on its floor.
pub(super) fn shadow_mapping() -> Scene {
    BuiltinScene::Courtyard.build()
}
