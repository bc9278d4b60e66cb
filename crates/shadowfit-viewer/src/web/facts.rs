//! What a page shows, as a line of JSON: tests of the page ask for it.

use serde_json::json;

use crate::viewer::Viewer;

/// Bytes of a page of memory, in WebAssembly's sense.
const PAGE_BYTES: usize = 1 << 16;

/// `size` is that of the canvas, in pixels.
pub(super) fn of(viewer: &Viewer, size: [u32; 2]) -> String {
    let stage = &viewer.stage;
    let figures = stage.judged_figures();
    let camera = &stage.camera;
    json!({
        "title": viewer.title(),
        "is_ready": viewer.is_ready(),
        "is_waiting": viewer.is_waiting(),
        "has_played": viewer.has_played(),
        "tried": viewer.tried(),
        "is_judged": stage.is_judged(),
        "size": size,
        "memory": core::arch::wasm32::memory_size(0) * PAGE_BYTES,
        "drawer": viewer.interface.drawer_open,
        "frame_ms": viewer.interface.frame_ms,
        "position": camera.position.to_array(),
        "angles": [camera.yaw, camera.pitch],
        "artefact": stage.shown().map(|shown| (format!("{:?}", shown.artefact), shown.fixed)),
        "view": format!("{:?}", stage.settings.view.mode),
        "wrong": figures.map(|figures| figures.wrong),
        "false_shadow": figures.map(|figures| figures.false_shadow),
        "hole": figures.map(|figures| figures.hole),
        "problem": stage.problem(),
        "message": viewer.message(),
        "settings": shadowfit_study::settings_to_toml(&stage.settings, ""),
    })
    .to_string()
}
