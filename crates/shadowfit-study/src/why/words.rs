//! Lengths, directions and names for people.

use glam::DVec3;
use shadowfit_scene::Scene;
use shadowfit_truth::PixelCamera;

use crate::SceneRays;

/// Units of length, their number per metre, and the number above which the next unit is used.
const UNITS: [(&str, f64, f64); 5] =
    [("µm", 1e6, 100.0), ("mm", 1e3, 20.0), ("cm", 1e2, 100.0), ("m", 1.0, 1000.0), ("km", 1e-3, f64::INFINITY)];

/// Returns a length, given in metres, in its most readable unit: 4 mm, 3.2 m.
pub(super) fn length(metres: f64) -> String {
    let fits = |(_, per_metre, end): &&(&str, f64, f64)| (metres.abs() * per_metre).round() < *end;
    let (unit, per_metre, _) = if metres == 0.0 { &UNITS[3] } else { UNITS.iter().find(fits).unwrap_or(&UNITS[4]) };
    format!("{} {unit}", number(metres * per_metre))
}

/// Returns a number with two digits, or with all digits before the point.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.*}", usize::from(value.abs() < 9.95));
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Returns a number of things.
pub(super) fn count(value: f64, thing: &str) -> String {
    let number = number(value);
    let plural = if number == "1" { "" } else { "s" };
    format!("{number} {thing}{plural}")
}

/// Returns a share of 0..=1 in per cent.
pub(super) fn percent(share: f64) -> String {
    format!("{:.0}%", 100.0 * share)
}

/// Returns the direction of `way` as seen by the camera, from a point; world axes, any length except zero.
pub(super) fn place(camera: &PixelCamera, way: DVec3) -> &'static str {
    let words = [
        (camera.right, ["to the right of it", "to the left of it"]),
        (camera.up, ["above it", "below it"]),
        (camera.forward, ["behind it", "before it"]),
    ];
    let along = words.map(|(axis, words)| (way.dot(axis), words));
    let strongest = along.into_iter().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    strongest.map_or("beside it", |(along, words)| words[usize::from(along < 0.0)])
}

/// Returns the name of a triangle's object, in quotes: the name of the scene's node, of the mesh, or of the
/// node's nearest ancestor with a name. `None` if none of them has a name.
pub(super) fn name(scene: &Scene, rays: &SceneRays, triangle: u32) -> Option<String> {
    let instance = rays.instance(triangle)?;
    let instance = *scene.instances().get(instance as usize)?;
    let parent = |node: &usize| scene.nodes[*node].parent;
    let nodes = std::iter::successors(Some(instance.node), parent).map(|node| &scene.nodes[node].name);
    let mesh = &scene.meshes[instance.mesh].name;
    let own = nodes.clone().take(1).chain([mesh]).chain(nodes.skip(1)).find(|name| !name.is_empty());
    own.map(|name| format!("\"{name}\""))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn lengths_read_in_the_unit_of_their_size() {
        for (metres, text) in [
            (0.0, "0 m"),
            (0.000_004_2, "4.2 µm"),
            (0.000_4, "0.4 mm"),
            (0.004, "4 mm"),
            (0.011, "11 mm"),
            (0.019_6, "2 cm"),
            (0.125, "12 cm"),
            (0.996, "1 m"),
            (3.24, "3.2 m"),
            (9.96, "10 m"),
            (128.4, "128 m"),
            (1500.0, "1.5 km"),
        ] {
            assert_eq!(length(metres), text);
        }
        assert_eq!(
            [count(1.0, "texel"), count(0.4, "texel"), count(7.04, "pixel")],
            ["1 texel", "0.4 texels", "7 pixels"]
        );
        assert_eq!(percent(0.296), "30%");
    }

    #[test]
    fn things_are_called_by_their_node_or_the_next_name_above_or_beside_it() {
        let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let mut scene = Scene::from_objects("court", &[vec![triangle], vec![triangle], vec![triangle]]);
        let rays = SceneRays::from_origin(&scene, &scene.pose(None, 0.0), DVec3::ZERO);
        for node in &mut scene.nodes {
            node.name.clear();
        }
        assert_eq!(name(&scene, &rays, 0), None);
        scene.nodes[0].name = "gate".to_owned();
        (scene.nodes[1].parent, scene.nodes[2].parent) = (Some(0), Some(0));
        scene.meshes[2].name = "hinge".to_owned();
        let names = [0, 1, 2].map(|triangle| name(&scene, &rays, triangle));
        assert_eq!(names, ["\"gate\"", "\"gate\"", "\"hinge\""].map(|name| Some(name.to_owned())));
    }
}
