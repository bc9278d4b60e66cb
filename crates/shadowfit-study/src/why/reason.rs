//! The reason why a point is lit or dark, and right or wrong, in words, for each cause that rays can
//! distinguish.

use glam::DVec3;
use shadowfit_truth::{Class, Occluder};

use super::At;
use super::look_up::{LookUp, Tap};
use super::map_reason::way_beside;
use super::words::{count, length, name, percent};

/// Smallest cosine between the normals of triangles that count as one surface: about 8 degrees.
const SAME_NORMAL: f32 = 0.99;

pub(super) fn reason(at: &At<'_>) -> String {
    let is_lit = at.point.verdict() == Some(true);
    match at.finding.class {
        Class::NotJudged => not_judged(at),
        Class::Right if is_lit => lit_rightly(at),
        Class::Right => dark_rightly(at),
        Class::Edge => edge(at),
        Class::FalseShadow => format!("wrongly dark: {}", false_shadow(at)),
        Class::FalseLight => format!("wrongly lit: {}", beyond(at).unwrap_or_else(|| false_light(at))),
        Class::Hole => format!("wrongly lit: {}", beyond(at).unwrap_or_else(|| hole(at))),
    }
}

fn not_judged(at: &At<'_>) -> String {
    if at.point.facing <= 0.0 {
        return "facing away from the sun".to_owned();
    }
    let end = length(at.truth.settings.max_distance);
    format!("beyond {end}, up to which shadows are judged")
}

fn lit_rightly(at: &At<'_>) -> String {
    let share = f64::from(at.point.lit);
    if share < 1.0 {
        return format!("correctly lit: {} of the sun is visible past {}", percent(share), nearest(at));
    }
    "correctly lit: nothing blocks the sun".to_owned()
}

fn dark_rightly(at: &At<'_>) -> String {
    let share = f64::from(at.point.lit);
    let rest = if share > 0.0 { format!(", but {} of the sun is visible", percent(share)) } else { String::new() };
    let Some(occluder) = nearest_occluder(at) else { return "correctly in shadow".to_owned() };
    let distance = length(occluder.distance);
    match named(at, occluder.triangle) {
        Some(name) => format!("correctly in shadow: {name}, {distance} toward the light, casts it{rest}"),
        None => format!("correctly in shadow: an object {distance} toward the light casts it{rest}"),
    }
}

/// Returns the reason if the technique lets shadows end before the point.
fn beyond(at: &At<'_>) -> Option<String> {
    let depth = at.point.view_depth;
    let [begin, end] = at.input.descriptor.fade.map(f64::from);
    let distance = f64::from(at.input.technique.fit.max_distance);
    let farther = |end: f64| format!("at {} it is beyond the shadow distance of {}", length(depth), length(end));
    if depth >= end {
        return Some(farther(end));
    }
    if depth > begin {
        let [begin, end] = [begin, end].map(length);
        return Some(format!("shadows fade out between {begin} and {end}, and it is {} away", length(depth)));
    }
    (at.read.is_none() && depth > distance).then(|| farther(distance))
}

fn hole(at: &At<'_>) -> String {
    let Some(map) = at.read.map(|read| read.main()) else {
        return match at.maps.maps.len() {
            0 => "there is no map".to_owned(),
            _ => format!("no map holds it, so {} cannot shadow it", nearest(at)),
        };
    };
    let range = f64::from(at.input.maps[map].projection.depth_range);
    let occluders = at.occluders();
    let way = |occluder: &Occluder| way_beside(at, map, occluder.position).length();
    let before = |occluder: &Occluder| -at.maps.maps[map].project(occluder.position).depth * range;
    // The occluder that the map misses by the smallest distance.
    let nearly = occluders.iter().min_by(|a, b| way(a).max(before(a)).total_cmp(&way(b).max(before(b))));
    let Some(occluder) = nearly else { return format!("map {} holds none of its occluders", map + 1) };
    let who = its(at, occluder);
    let (beside, before, number) = (way(occluder), before(occluder), map + 1);
    if beside > 0.0 {
        format!("{who} is {} beside map {number}", length(beside))
    } else if before > 0.0 {
        format!("{who} is {} before the near plane of map {number}", length(before))
    } else {
        format!("{who} is behind it in map {number}, which was fitted to another light direction")
    }
}

fn false_light(at: &At<'_>) -> String {
    let Some((look_up, centre)) = &at.look_up else {
        return format!("it reads no map, but {} shadows it", nearest(at));
    };
    let mut occluders = at.occluders();
    occluders.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    // The map stores the occluder nearest to the light.
    let Some(stored) = occluders.iter().find(|occluder| is_held(at, occluder.position)) else {
        return "no ray hits its occluder".to_owned();
    };
    let bias = look_up.bias();
    if stored.distance <= bias {
        let (who, distance, bias) = (its(at, stored), length(stored.distance), length(bias));
        return format!("{who} is only {distance} in front of it, less than the bias of {bias}");
    }
    let looked_up = at.point.position + at.point.normal * look_up.offset;
    let ray = at.truth.settings.light.ray_from(looked_up);
    let is_occluded = || {
        let (from, toward) = (looked_up.as_vec3(), ray.direction.as_vec3());
        at.truth.tracer.is_occluded_within(from, toward, ray.length as f32)
    };
    if look_up.offset > at.truth.settings.ray_offset && !is_occluded() {
        let offset = length(look_up.offset);
        return format!("the bias looks it up {offset} off its surface, where {} is not in the way", plain(at, stored));
    }
    let map = at.finding.map_index.map_or(0, usize::from) + 1;
    let (who, distance) = (plain(at, stored), length(stored.distance));
    if centre.is_dark() {
        return format!("map {map} holds {who}, {distance} toward the light, but the filter lets light through");
    }
    if look_up.centre(at.truth.tracer, None).is_dark() {
        return format!("map {map} should store {who}, {distance} toward the light, but does not");
    }
    let width = length(look_up.texel_width());
    format!("{} lies between the centres of the texels of map {map}, which are {width} wide", its(at, stored))
}

/// Returns whether the map that is read holds an occluder, including one clamped to its near plane.
fn is_held(at: &At<'_>, occluder: DVec3) -> bool {
    at.read.is_some_and(|read| {
        let map = &at.maps.maps[read.main()];
        let position = map.project(occluder);
        map.is_inside(&position) || (at.maps.depth_clamp && position.depth < 0.0 && map.is_within_sides(&position))
    })
}

fn false_shadow(at: &At<'_>) -> String {
    let Some((look_up, _)) = &at.look_up else { return "no map holds it, but it is shadowed".to_owned() };
    let taps = look_up.taps(at.truth.tracer, at.input.stored.as_ref());
    let nearest = taps.iter().filter(|tap| tap.is_dark());
    let culprit = nearest.min_by(|a, b| a.away.length_squared().total_cmp(&b.away.length_squared()));
    let Some(tap) = culprit else {
        return "the map stores something in front of it that no ray hits, such as an object that has moved".to_owned();
    };
    let nearer = tap.compared + look_up.bias() - tap.stored.unwrap_or(tap.compared);
    if tap.triangle.is_none_or(|triangle| is_same_surface(at, look_up, triangle)) {
        let (nearer, bias) = (length(nearer), length(look_up.bias()));
        return format!(
            "the map stores this surface itself, {nearer} nearer to the light than the point, but the bias is only \
             {bias}"
        );
    }
    let (away, nearer) = (away(look_up, tap), length(nearer));
    let name = tap.triangle.and_then(|triangle| named(at, triangle));
    let is_own = tap.triangle.is_some_and(|triangle| instance(at, triangle) == instance(at, at.point.triangle));
    let who = match name {
        Some(name) if is_own => format!("another part of {name}"),
        Some(name) => name,
        None => "another surface".to_owned(),
    };
    format!("the filter reads a texel {away} away, which stores {who}, {nearer} nearer to the light")
}

/// Returns the distance of a texel's centre from the look-up, across the light.
fn away(look_up: &LookUp<'_>, tap: &Tap) -> String {
    length((tap.away * look_up.fit.texel_size.as_dvec2()).length())
}

/// Returns whether a triangle continues the point's own surface: it belongs to the same object, and its plane
/// passes within a texel at nearly the same slope.
fn is_same_surface(at: &At<'_>, look_up: &LookUp<'_>, triangle: u32) -> bool {
    let tracer = at.truth.tracer;
    let (own, other) = (at.point.normal.as_vec3(), tracer.normal(triangle));
    let corner = tracer.corners(triangle)[0].as_dvec3();
    let height = (at.point.position - corner).dot(other.as_dvec3()).abs();
    let is_near = own.dot(other).abs() >= SAME_NORMAL && height <= look_up.texel_width();
    is_near && instance(at, triangle) == instance(at, at.point.triangle)
}

fn instance(at: &At<'_>, triangle: u32) -> Option<u32> {
    at.input.rays.instance(triangle)
}

fn edge(at: &At<'_>) -> String {
    let index = at.read.map(|read| read.main());
    let texel = f64::from(at.finding.pixels_per_texel);
    let pixels = if texel.is_finite() { texel.max(1.0) } else { 1.0 };
    let width = at.maps.edge_width(index);
    let distance = f64::from(at.truth.transition_distance(at.pixel, width * pixels as f32));
    let in_texels = distance / pixels;
    let (unit, size) = if pixels > 1.0 {
        ("texel", format!("a texel covers {} here", count(pixels, "pixel")))
    } else {
        ("pixel", "texels are finer than pixels here".to_owned())
    };
    let (away, reach) = (count(in_texels, unit), count(f64::from(width), unit));
    if in_texels < 1.0 {
        format!("wrong by less than a {unit}: the true edge of the shadow is {away} away, and {size}")
    } else {
        format!(
            "wrong beside an edge: the true edge of the shadow is {away} away, within the {reach} that the filter \
             blurs over, and {size}"
        )
    }
}

fn nearest_occluder(at: &At<'_>) -> Option<Occluder> {
    let occluders = at.occluders();
    occluders.into_iter().min_by(|a, b| a.distance.total_cmp(&b.distance))
}

/// Returns the name of a point's first occluder, seen from the point.
fn nearest(at: &At<'_>) -> String {
    nearest_occluder(at).map_or_else(|| "its occluder".to_owned(), |occluder| plain(at, &occluder))
}

fn plain(at: &At<'_>, occluder: &Occluder) -> String {
    named(at, occluder.triangle).unwrap_or_else(|| "its occluder".to_owned())
}

fn its(at: &At<'_>, occluder: &Occluder) -> String {
    named(at, occluder.triangle).map_or_else(|| "its occluder".to_owned(), |name| format!("its occluder, {name},"))
}

fn named(at: &At<'_>, triangle: u32) -> Option<String> {
    name(&at.input.scene, &at.input.rays, triangle)
}
