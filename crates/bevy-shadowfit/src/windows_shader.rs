//! Extension of Bevy's shader for windows. Windows are read by coverage, but Bevy's shader selects the
//! cascade by view depth. The text of its shader library `shadows.wesl` is therefore extended once it is
//! loaded: two functions get a branch that only lights with [`Fit::Windows`] take.

use std::borrow::Cow;

use bevy::prelude::*;
use bevy::shader::{Shader, Source};

use crate::bias::{WINDOWS_MAX_TANGENT, WINDOWS_SLOPE_BIAS};
use crate::settings::{Fit, FittedShadows};

/// Path of the library in Bevy.
const PATH: &str = "bevy_pbr/render/shadows.wesl";

/// Beginnings of Bevy's functions, and the text to add after each.
const ADDITIONS: [(&str, &str); 2] = [
    (
        "fn get_cascade_index(light_id: u32, view_z: f32) -> u32 {",
        "
    // The last window covers all visible points.
    if (shadowfit_has_windows(light_id)) {
        let light = &view_bindings::lights.directional_lights[light_id];
        return select((*light).num_cascades - 1u, (*light).num_cascades, -view_z >= (*light).cascades[0].far_bound);
    }
",
    ),
    (
        "fn fetch_directional_shadow(
    light_id: u32,
    frag_position: vec4<f32>,
    surface_normal: vec3<f32>,
    view_z: f32,
    frag_coord_xy: vec2<f32>,
) -> f32 {",
        "
    if (shadowfit_has_windows(light_id)) {
        return shadowfit_fetch(light_id, frag_position, surface_normal, view_z, frag_coord_xy);
    }
",
    ),
];

/// State of the extended shader library.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum WindowsShader {
    /// Bevy's library is not loaded yet.
    #[default]
    Awaited,
    /// The library is extended. Bevy's renderer receives it in the next frame.
    Extended,
    /// The renderer receives the library in this frame, together with the windows.
    Ready,
    /// The library's text differs from the expected one, or is missing.
    Unknown,
}

/// Extends Bevy's shader library when a light requests windows and the library is loaded.
pub(crate) fn extend(
    mut state: ResMut<WindowsShader>,
    lights: Query<&FittedShadows>,
    shaders: Option<ResMut<Assets<Shader>>>,
) {
    if *state == WindowsShader::Extended {
        *state = WindowsShader::Ready;
    }
    let is_asked_for = lights.iter().any(|fitted| fitted.fit == Fit::Windows);
    let Some(mut shaders) = shaders.filter(|_| is_asked_for && *state == WindowsShader::Awaited) else { return };
    let library =
        shaders.iter().find(|(_, shader)| shader.path.ends_with(PATH)).map(|(id, shader)| (id, &shader.source));
    let Some((id, source)) = library else { return };
    let extended = match source {
        Source::Wesl(text) => extended(text),
        _ => None,
    };
    match (extended, shaders.get_mut(id)) {
        (Some(text), Some(mut shader)) => {
            shader.source = Source::Wesl(Cow::Owned(text));
            *state = WindowsShader::Extended;
        }
        _ => {
            warn!("Fit::Windows falls back to Fit::Calm, because {PATH} differs from Bevy 0.20");
            *state = WindowsShader::Unknown;
        }
    }
}

/// Returns Bevy's text with the additions, if all places for them are found.
fn extended(text: &str) -> Option<String> {
    let mut extended = text.replace("\r\n", "\n");
    for (place, addition) in ADDITIONS {
        let end = extended.find(place)? + place.len();
        extended.insert_str(end, addition);
    }
    extended.push_str(&format!("\nconst SHADOWFIT_SLOPE_BIAS: f32 = {WINDOWS_SLOPE_BIAS:?};\n"));
    extended.push_str(&format!("const SHADOWFIT_MAX_TANGENT: f32 = {WINDOWS_MAX_TANGENT:?};\n"));
    extended.push_str(include_str!("windows.wesl"));
    Some(extended)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_library_with_both_functions_is_extended() {
        let [(index, first), (fetch, second)] = ADDITIONS;
        let library = format!("{index}\n    return 0u;\n}}\n\n{fetch}\n    return 1.0;\n}}\n");
        let text = extended(&library).expect("it has both functions");
        assert!(text.starts_with(&format!("{index}{first}")) && text.contains(&format!("{fetch}{second}")));
        assert_eq!(extended(&library.replace('\n', "\r\n")), Some(text));
        assert_eq!(extended(&library.replace("view_z: f32,", "depth: f32,")), None);
        assert_eq!(extended(&library.replace("get_cascade_index", "cascade_of")), None);
        assert_eq!(extended(""), None);
    }
}
