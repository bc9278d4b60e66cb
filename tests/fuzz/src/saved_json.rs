//! Fuzz target: data that engines save from the core reads back equal, and never makes a fit panic.

use std::fmt::Debug;

use serde::{Deserialize, Serialize};
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::spot::SpotLight;
use shadowfit::{Aabb, Boxes, FitInput, FitState, FittedMaps, PerspectiveCamera, Scratch, Technique, ViewFrustum};

use super::finite::{check_maps, check_spot, fit_simple_scene};

/// A saved game.
#[derive(Debug, Serialize, Deserialize)]
struct Saved {
    technique: Option<Technique>,
    state: Option<FitState>,
    maps: Option<FittedMaps>,
    camera: Option<PerspectiveCamera>,
    view: Option<ViewFrustum>,
    lamp: Option<SpotLight>,
}

/// Reads saved data, continues from it, writes it and reads it again.
pub fn saved_json(data: &[u8]) {
    let Ok(value) = serde_json::from_slice::<serde_json::Value>(data) else { return };
    // JSON has no infinity, but a number too large for f32 would become one.
    if !fits_f32(&value) {
        return;
    }
    let Ok(saved) = serde_json::from_slice::<Saved>(data) else { return };
    let written = serde_json::to_string(&saved).expect("JSON");
    let read: Saved = serde_json::from_str(&written).unwrap_or_else(|error| panic!("{error}: {written}"));
    assert_same(&read, &saved);
    go_on(&saved);
}

/// Compares the `Debug` texts, which distinguish all bits.
fn assert_same(a: &impl Debug, b: &impl Debug) {
    assert_eq!(format!("{a:?}"), format!("{b:?}"));
}

fn fits_f32(value: &serde_json::Value) -> bool {
    match value {
        serde_json::Value::Number(number) => number.as_f64().is_some_and(|number| (number as f32).is_finite()),
        serde_json::Value::Array(values) => values.iter().all(fits_f32),
        serde_json::Value::Object(values) => values.values().all(fits_f32),
        _ => true,
    }
}

fn go_on(saved: &Saved) {
    let technique = saved.technique.unwrap_or_default();
    fit_simple_scene(&technique);
    if let Some(lamp) = &saved.lamp {
        check_spot(lamp, UVec2::new(512, 256));
    }
    let views: Vec<ViewFrustum> =
        saved.view.into_iter().chain(saved.camera.and_then(|camera| camera.frustum().ok())).collect();
    if let Some(maps) = &saved.maps {
        let _ = maps.read(&technique, DVec3::new(0.0, 1.0, -20.0), 25.0);
        let _ = maps.caster_volumes(&views, &technique);
    }
    let ground = [Aabb::new(Vec3::new(-80.0, -0.1, -80.0), Vec3::new(80.0, 0.0, 80.0))];
    let boxes = Boxes::world(&ground);
    let sun = Vec3::new(0.3, -0.8, 0.2);
    let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, sun) };
    let mut state = saved.state.clone().unwrap_or_default();
    let mut storage = vec![DVec2::ZERO; input.scratch()];
    for _ in 0..2 {
        if let Ok(maps) = state.fit(&input, &technique, &mut Scratch::new(&mut storage)) {
            check_maps(&maps);
        }
    }
}
