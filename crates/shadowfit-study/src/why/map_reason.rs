//! The map that a point reads, and the reason in words.

use glam::{DVec2, DVec3};
use shadowfit::selection::MapRead;
use shadowfit_truth::MapReading;

use super::At;
use super::words::{count, length, number, percent, place};
use crate::maps::NO_END;

/// Returns a sentence like "map 2 of 4: the finest that holds this point; map 1 ends 3.1 m to the left of
/// it".
pub(super) fn map_reason(at: &At<'_>) -> String {
    let all = at.maps.maps.len();
    let Some(read) = at.read else { return no_map(at) };
    let (main, finer) = (read.main(), read.map);
    let why = match at.maps.reading {
        MapReading::Coverage { .. } if all == 1 => "the only one, and it holds this point".to_owned(),
        MapReading::Coverage { .. } if main != finer => {
            let share = percent(1.0 - read.blend.map_or(1.0, |blend| blend.weight));
            return format!(
                "map {} of {all}: it takes over near the border of map {}, which is finer and counts {share} here",
                main + 1,
                finer + 1
            );
        }
        MapReading::Coverage { .. } => by_coverage(at, main),
        MapReading::ViewDepth => by_view_depth(at, main),
    };
    format!("map {} of {all}: {why}{}", main + 1, blended(&read))
}

fn no_map(at: &At<'_>) -> String {
    let all = at.maps.maps.len();
    let nearest = (0..all).min_by(|a, b| beyond(at, *a).total_cmp(&beyond(at, *b)));
    match nearest {
        None => "no map: there are none".to_owned(),
        Some(map) if all == 1 => format!("no map: {}", miss(at, map)),
        Some(map) => format!("no map: none of the {all} holds this point, and {}", miss(at, map)),
    }
}

fn by_coverage(at: &At<'_>, main: usize) -> String {
    let MapReading::Coverage { order, .. } = at.maps.reading else { return String::new() };
    let finer: Vec<usize> = order.iter().take_while(|map| *map != main).collect();
    let cut = if texels_to_edge(at, main) < f64::from(at.maps.filter_radius) {
        ", though the filter reads beyond its border"
    } else {
        ""
    };
    match finer.last() {
        None => format!("the finest of all, and it holds this point{cut}"),
        Some(map) => format!("the finest that holds this point{cut}; {}", miss(at, *map)),
    }
}

fn by_view_depth(at: &At<'_>, main: usize) -> String {
    let (maps, depth) = (at.maps.maps, at.point.view_depth);
    let here = length(depth);
    let own = maps.iter().position(|map| depth < map.split_far).unwrap_or(main);
    if own < main {
        return format!(
            "view depth {here} belongs to map {}, which does not hold this point: {}",
            own + 1,
            miss(at, own)
        );
    }
    let before = (0..main).rev().find(|map| maps[*map].split_far > 0.0);
    let begin = before.map(|map| (maps[map].split_far, map + 1));
    let end = Some(maps[main].split_far).filter(|end| *end < NO_END);
    match (begin, end) {
        (Some((begin, _)), Some(end)) => {
            format!("view depth {here} lies between {} and {}", length(begin), length(end))
        }
        (Some((begin, map)), None) => format!("view depth {here} lies beyond {}, where map {map} ends", length(begin)),
        (None, Some(end)) => format!("view depth {here} lies before {}, where it ends", length(end)),
        (None, None) => "it covers every view depth".to_owned(),
    }
}

fn blended(read: &MapRead) -> String {
    let Some(blend) = read.blend else { return String::new() };
    let (other, weight) =
        if read.main() == blend.map { (read.map, 1.0 - blend.weight) } else { (blend.map, blend.weight) };
    format!("; blended with map {}, which counts {} here", other + 1, percent(weight))
}

/// Returns why a point does not read a map alone, like "map 1 ends 3.1 m to the left of it".
pub(super) fn miss(at: &At<'_>, map: usize) -> String {
    let (number_of, fit) = (map + 1, &at.input.maps[map].projection);
    let measured = &at.maps.maps[map];
    let position = measured.project(at.point.position);
    let way = way_beside(at, map, at.point.position);
    if !measured.is_within_sides(&position) {
        return format!("map {number_of} ends {} {}", length(way.length()), place(at.truth.camera, way));
    }
    let range = f64::from(fit.depth_range);
    if position.depth < 0.0 {
        return format!("map {number_of} begins {} behind it, seen from the light", length(-position.depth * range));
    }
    if position.depth > 1.0 {
        let before = length((position.depth - 1.0) * range);
        return format!("map {number_of} ends {before} before it, seen from the light");
    }
    let free = count(texels_to_edge(at, map), "texel");
    let reach = number(f64::from(at.maps.filter_radius));
    format!("map {number_of} ends {free} beside it, and the filter reads {reach}")
}

fn texels_to_edge(at: &At<'_>, map: usize) -> f64 {
    let measured = &at.maps.maps[map];
    measured.texels_to_edge(&measured.project(at.point.position))
}

/// Returns the vector from a point to the nearest side of a map, across the light, in metres; zero within the
/// sides.
pub(super) fn way_beside(at: &At<'_>, map: usize, point: DVec3) -> DVec3 {
    let (measured, fit) = (&at.maps.maps[map], &at.input.maps[map].projection);
    let texel = measured.project(point).texel;
    let way = texel.clamp(DVec2::ZERO, measured.size) - texel;
    let [x, y] = [0, 1].map(|row| fit.light_from_world.row(row).truncate().as_dvec3());
    x * (way.x * f64::from(fit.texel_size.x)) - y * (way.y * f64::from(fit.texel_size.y))
}

/// Returns the distance of the point from a map, in metres, across the light or along it.
fn beyond(at: &At<'_>, map: usize) -> f64 {
    let depth = at.maps.maps[map].project(at.point.position).depth;
    let along = (depth - depth.clamp(0.0, 1.0)).abs() * f64::from(at.input.maps[map].projection.depth_range);
    way_beside(at, map, at.point.position).length().max(along)
}
