//! Sentences that tell where to look in the picture of an artefact.

use shadowfit::PerspectiveCamera;
use shadowfit_egui::Artefact;
use shadowfit_params::tool::Settings;

use super::view_search::{GRID, ViewSearch};

/// Returns the sentence about a view of an artefact.
pub(crate) fn tell(
    artefact: Artefact,
    search: &ViewSearch<'_>,
    camera: &PerspectiveCamera,
    settings: &Settings,
) -> String {
    let picture = search.look(camera);
    let middle = picture[(GRID[0] * GRID[1] / 2 + GRID[0] / 2) as usize];
    let Some((seen, fitted)) = middle.zip(search.fit(&settings.technique, camera)) else { return String::new() };
    let Some(map) = fitted.read_at(search.world(seen.position.as_dvec3())) else { return String::new() };
    let fit = fitted.maps[map].projection;
    let texel = length(fit.texel_size.max_element());
    // Pixels in a picture of height 720 that the texel covers if viewed head-on.
    let pixels = fit.texel_size.max_element() / (2.0 * (camera.fov_y * 0.5).tan() * seen.distance) * 720.0;
    match artefact {
        Artefact::Acne => format!(
            "Look for dark stripes on the sunlit side. A texel of map {} is {texel} wide here, and there is no bias: \
             in each stripe, half of a texel's area is behind the stored depth of its own surface.",
            map + 1
        ),
        Artefact::Aliasing => format!(
            "Look at the stairs along the shadow's edge. A texel of map {} is {texel} wide and covers about \
             {pixels:.0} pixels here; each stair is one texel.",
            map + 1
        ),
        Artefact::ClippingHole => {
            let is_left = search.holes(&search.shadowed(&picture), &fitted).contains(&Some(false));
            let [told, missing] = if is_left {
                ["The shadow breaks off, though its caster continues.", "the missing part"]
            } else {
                ["A shadow is missing here.", "this shadow"]
            };
            format!(
                "{told} Map {} reaches {} along the light, but toward the sun it ends with the camera's view. The \
                 caster of {missing} lies outside its box, as the view from outside shows.",
                map + 1,
                length(fit.depth_range)
            )
        }
    }
}

/// Returns a length as text for people.
fn length(metres: f32) -> String {
    match metres {
        m if m >= 1.0 => format!("{m:.1} m"),
        m if m >= 0.01 => format!("{:.1} cm", m * 100.0),
        m => format!("{:.1} mm", m * 1000.0),
    }
}

#[cfg(test)]
mod tests {
    use super::length;

    #[test]
    fn lengths_read_in_a_unit_that_fits() {
        assert_eq!([2.345, 0.0567, 0.0034].map(length), ["2.3 m", "5.7 cm", "3.4 mm"]);
    }
}
