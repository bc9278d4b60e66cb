//! Every field of the settings by name, so that tests see which ones the parameter table reaches.

use shadowfit::Technique;
use shadowfit::glam::{UVec2, Vec3};
use shadowfit::settings::{BiasSettings, FitSettings, HoldSettings, MAX_MAPS, SoftRadius, Softness, SplitScheme};
use shadowfit::tool::{CameraSettings, LightSettings, Settings, ViewSettings};

/// Every field with its value. Without `..` and `_`, so that a new field or variant does not compile until it stands
/// here, and the tests of the table do not pass until a row reaches it.
pub(crate) fn leaves(settings: &Settings) -> Vec<(String, String)> {
    let mut all = Vec::new();
    let mut leaf = |name: &str, value: &dyn core::fmt::Debug| all.push((name.to_owned(), format!("{value:?}")));
    let Settings { technique, light, camera, view } = settings;
    leaves_of_technique(technique, &mut leaf);
    let LightSettings { hour, azimuth, elevation, animate, animate_speed } = light;
    leaf("light.hour", hour);
    leaf("light.azimuth", azimuth);
    leaf("light.elevation", elevation);
    leaf("light.animate", animate);
    leaf("light.animate_speed", animate_speed);
    let CameraSettings { fov_y, near, far, speed } = camera;
    leaf("camera.fov_y", fov_y);
    leaf("camera.near", near);
    leaf("camera.far", far);
    leaf("camera.speed", speed);
    let ViewSettings { mode, judge, marks, shadows, inset, inset_map, inset_depths, outside_beside, freeze_fit, play } =
        view;
    leaf("view.mode", mode);
    leaf("view.judge", judge);
    leaf("view.marks", marks);
    leaf("view.shadows", shadows);
    leaf("view.inset", inset);
    leaf("view.inset_map", inset_map);
    leaf("view.inset_depths.0", &inset_depths.map(|[black, _]| black));
    leaf("view.inset_depths.1", &inset_depths.map(|[_, white]| white));
    leaf("view.outside_beside", outside_beside);
    leaf("view.freeze_fit", freeze_fit);
    leaf("view.play", play);
    all
}

/// Takes the name and the value of a field.
type Leaf<'a> = dyn FnMut(&str, &dyn core::fmt::Debug) + 'a;

fn leaves_of_technique(technique: &Technique, leaf: &mut Leaf) {
    let Technique {
        count,
        fit,
        splits,
        choice,
        blend,
        overlap,
        stabilise,
        hold,
        receivers,
        filter,
        softness,
        fade,
        bias,
        need,
        format,
    } = technique;
    leaves_of_fit(fit, leaf);
    leaf("count", count);
    let (lambda, ends) = match splits {
        SplitScheme::Uniform | SplitScheme::Logarithmic | SplitScheme::FromBoxes | SplitScheme::FromHistogram => {
            (None, None)
        }
        SplitScheme::Practical(lambda) => (Some(lambda), None),
        SplitScheme::Manual(ends) => (None, Some(ends)),
    };
    leaf("splits", &core::mem::discriminant(splits));
    leaf("splits.lambda", &lambda);
    for map in 0..MAX_MAPS - 1 {
        leaf(&format!("splits.manual[{map}]"), &ends.map(|ends| ends[map]));
    }
    leaf("choice", choice);
    leaf("blend", blend);
    leaf("overlap", overlap);
    leaf("stabilise", stabilise);
    let HoldSettings { margin, growth, waste, horizon } = hold;
    leaf("hold.margin", margin);
    leaf("hold.growth", growth);
    leaf("hold.waste", waste);
    leaf("hold.horizon", horizon);
    leaf("receivers", receivers);
    leaf("filter", filter);
    leaves_of_softness(softness, leaf);
    leaf("fade", fade);
    let BiasSettings { constant, slope, normal_offset, receiver_plane, depth_steps } = bias;
    leaf("bias.depth_steps", depth_steps);
    leaf("bias.constant", constant);
    leaf("bias.slope", slope);
    leaf("bias.normal_offset", normal_offset);
    leaf("bias.receiver_plane", receiver_plane);
    leaf("need", need);
    leaf("format", format);
}

fn leaves_of_softness(softness: &Softness, leaf: &mut Leaf) {
    let Softness { radius, floor, ceiling } = softness;
    let (metres, angle) = match radius {
        SoftRadius::Metres(metres) => (Some(metres), None),
        SoftRadius::SunAngle(angle) => (None, Some(angle)),
    };
    leaf("softness.radius", &core::mem::discriminant(radius));
    leaf("softness.metres", &metres);
    leaf("softness.angle", &angle);
    leaf("softness.floor", floor);
    leaf("softness.ceiling", ceiling);
}

fn leaves_of_fit(fit: &FitSettings, leaf: &mut Leaf) {
    let FitSettings {
        kind,
        rectangle,
        max_distance,
        margin,
        border,
        casters,
        caster_extension,
        up,
        max_texel_ratio,
        least_texel,
        resolution,
        depth,
    } = fit;
    let Vec3 { x: up_x, y: up_y, z: up_z } = up;
    let UVec2 { x: width, y: height } = resolution;
    leaf("fit.kind", kind);
    leaf("fit.rectangle", rectangle);
    leaf("fit.max_distance", max_distance);
    leaf("fit.margin", margin);
    leaf("fit.border", border);
    leaf("fit.casters", casters);
    leaf("fit.caster_extension", caster_extension);
    leaf("fit.up.x", up_x);
    leaf("fit.up.y", up_y);
    leaf("fit.up.z", up_z);
    leaf("fit.max_texel_ratio", max_texel_ratio);
    leaf("fit.least_texel", least_texel);
    leaf("fit.resolution.x", width);
    leaf("fit.resolution.y", height);
    leaf("fit.depth", depth);
}
