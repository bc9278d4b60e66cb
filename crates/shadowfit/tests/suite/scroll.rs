//! Maps on the world grid: the texels that are kept from frame to frame, and tiles that never change.

use std::collections::HashMap;

use proptest::prelude::*;
use shadowfit::glam::{DQuat, DVec2, DVec3, UVec2, Vec3};
use shadowfit::scroll::{GridPosition, Scroll, TexelRect, Tile, tiles};
use shadowfit::settings::{CasterPolicy, FitKind, FitSettings, RectangleKind, SplitScheme, Stabilise};
use shadowfit::{
    Aabb, Boxes, Cascades, CasterVolume, DepthConvention, FitError, FitInput, FitState, FittedMap, FittedMaps,
    LightProjection, PerspectiveCamera, Scratch, Technique,
};

use crate::support::{DIRECTION, SNAP, any_direction, camera, double, sliced};

fn settings(kind: FitKind, stabilise: Stabilise, resolution: u32) -> Technique {
    let fit = FitSettings::default()
        .with_kind(kind)
        .with_rectangle(RectangleKind::AxisAligned)
        .with_casters(CasterPolicy::PerObject)
        .with_resolution(UVec2::new(resolution, resolution * 3 / 4));
    let splits = SplitScheme::Manual([8.0, 18.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    sliced(&fit, Cascades { count: 3, splits, stabilise, ..Cascades::default() })
}

/// Returns houses on a square of ground around the tests' camera, relative to the world's origin.
fn town() -> Vec<Aabb> {
    let ground = Aabb::new(Vec3::new(-200.0, -1.0, -240.0), Vec3::new(200.0, 0.0, 160.0));
    let house = |i: u16| {
        let (x, z) = (f32::from(i % 20) * 20.0 - 200.0, f32::from(i / 20) * 20.0 - 240.0);
        let height = 3.0 + f32::from(i * 37 % 11);
        Aabb::new(Vec3::new(x, 0.0, z), Vec3::new(x + 7.0, height, z + 9.0))
    };
    std::iter::once(ground).chain((0..400).map(house)).collect()
}

fn frame(
    fitter: &mut FitState,
    camera: &PerspectiveCamera,
    direction: Vec3,
    settings: &Technique,
    boxes: &[Aabb],
) -> FittedMaps {
    let views = [camera.frustum().unwrap()];
    let boxes = Boxes { origin: DVec3::ZERO, boxes };
    let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, direction) };
    let mut storage = vec![DVec2::ZERO; Scratch::required(boxes.boxes.len(), 3)];
    fitter.fit(&input, settings, &mut Scratch::new(&mut storage)).unwrap()
}

/// Returns a map of 2 m texels straight below the light, with its left bottom corner on a grid line.
fn plain_map(first: [i64; 2], resolution: UVec2) -> FittedMap {
    let grid_position = GridPosition { first, texel: DVec2::splat(2.0), depth: [-10.0, 30.0] };
    FittedMap {
        projection: LightProjection { resolution, ..LightProjection::default() },
        grid_position: Some(grid_position),
        ..FittedMap::default()
    }
}

/// Returns world column and row, counted upward, of a texel of a map.
fn world_texel(grid_position: &GridPosition, resolution: UVec2, x: u32, y: u32) -> (i64, i64) {
    (grid_position.first[0] + i64::from(x), grid_position.first[1] + i64::from(resolution.y - 1 - y))
}

fn is_in(rect: &TexelRect, x: u32, y: u32) -> bool {
    (rect.min.x..rect.min.x + rect.size.x).contains(&x) && (rect.min.y..rect.min.y + rect.size.y).contains(&y)
}

proptest! {
    /// By brute force: each texel is either in exactly one strip, or it is kept, and the shift leads to the
    /// texel that had the same point of the world.
    #[test]
    fn shift_and_strips_are_exactly_what_moved_and_what_is_new(
        (x, y) in (-40_i64..40, -40_i64..40), (dx, dy) in (-14_i64..14, -14_i64..14), (w, h) in (1_u32..12, 1_u32..12),
    ) {
        let resolution = UVec2::new(w, h);
        let (before, now) = (plain_map([x, y], resolution), plain_map([x + dx, y + dy], resolution));
        let (old, new) = (before.grid_position.unwrap(), now.grid_position.unwrap());
        let held: HashMap<_, _> = (0..w).flat_map(|x| (0..h).map(move |y| (x, y)))
            .map(|(x, y)| (world_texel(&old, resolution, x, y), (x, y))).collect();
        let scroll = Scroll::between(&before, &now);
        prop_assert_eq!(scroll.is_new, dx.unsigned_abs() >= u64::from(w) || dy.unsigned_abs() >= u64::from(h));
        for (x, y) in (0..w).flat_map(|x| (0..h).map(move |y| (x, y))) {
            let strips = scroll.exposed().filter(|rect| is_in(rect, x, y)).count();
            if let Some((ox, oy)) = held.get(&world_texel(&new, resolution, x, y)) {
                prop_assert_eq!(strips, 0);
                let from = (i64::from(x) + i64::from(scroll.shift.x), i64::from(y) + i64::from(scroll.shift.y));
                prop_assert_eq!(from, (i64::from(*ox), i64::from(*oy)));
            } else {
                prop_assert_eq!(strips, 1);
            }
        }
        for rect in scroll.exposed() {
            prop_assert!(rect.min.x + rect.size.x <= w && rect.min.y + rect.size.y <= h);
        }
    }

    #[test]
    fn points_of_the_world_keep_their_texel_after_the_shift(
        direction in any_direction(), (x, y, z) in (double(-3.0, 3.0), double(-3.0, 3.0), double(-3.0, 3.0)),
        kind in prop::sample::select(vec![FitKind::Sphere, FitKind::FrustumAabb, FitKind::Focused]),
        stabilise in prop::sample::select(vec![SNAP, Stabilise::default()]),
        far_out in prop::sample::select(vec![0.0, 1e3, 1e5]), turn in double(0.0, 0.05),
    ) {
        let (settings, town, mut fitter) = (settings(kind, stabilise, 512), town(), FitState::new());
        let mut camera = camera();
        camera.eye += DVec3::new(far_out, 0.0, -far_out);
        let town: Vec<Aabb> = town.iter().map(|b| {
            let shift = DVec3::new(far_out, 0.0, -far_out).as_vec3();
            Aabb::new(b.min + shift, b.max + shift)
        }).collect();
        let before = frame(&mut fitter, &camera, direction, &settings, &town);
        camera.eye += DVec3::new(x, y, z);
        camera.forward = (DQuat::from_axis_angle(DVec3::Y, turn) * camera.forward.as_dvec3()).as_vec3();
        let now = frame(&mut fitter, &camera, direction, &settings, &town);
        for (before, now) in before.iter().zip(now.iter()) {
            let scroll = Scroll::between(before, now);
            if scroll.is_new {
                continue;
            }
            let centre = now.projection.corners().map(Vec3::as_dvec3).into_iter().sum::<DVec3>() / 8.0 + now.projection.origin;
            let apart = texel(&before.projection, centre) - texel(&now.projection, centre) - scroll.shift.as_dvec2();
            prop_assert!(apart.abs().max_element() < 0.02, "{apart} texels");
            prop_assert!(scroll.depth_changed || (before.projection.depth_range - now.projection.depth_range).abs() < 1e-6 * now.projection.depth_range);
            let depth = |fit: &LightProjection| place(fit, centre).z;
            prop_assert!(scroll.depth_changed || (depth(&before.projection) - depth(&now.projection)).abs() < 1e-4);
        }
    }

    #[test]
    fn tiles_cover_a_map_once_and_agree_with_it(
        direction in any_direction(), size in 1_u32..300, (a, b) in (double(0.0, 1.0), double(0.0, 1.0)),
        far_out in prop::sample::select(vec![0.0, 1e3, 1e5]), depth in prop::sample::select(vec![
            DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne,
        ]),
    ) {
        let mut settings = settings(FitKind::Sphere, SNAP, 256);
        settings.fit.depth = depth;
        let mut camera = camera();
        camera.eye += DVec3::splat(far_out);
        let maps = frame(&mut FitState::new(), &camera, direction, &settings, &[]);
        let map = &maps[1];
        let (min, max) = (map.projection.box_min.as_dvec3(), map.projection.box_max.as_dvec3());
        let inside = |x: f64, y: f64, z: f64| {
            let m = &map.projection.light_from_world;
            let p = min + (max - min) * DVec3::new(x, y, z) - m.w_axis.truncate().as_dvec3();
            let rows = m.transpose();
            map.projection.origin + rows.x_axis.truncate().as_dvec3() * p.x + rows.y_axis.truncate().as_dvec3() * p.y
                + rows.z_axis.truncate().as_dvec3() * p.z
        };
        let point = inside(a, b, 0.5);
        let all: Vec<Tile> = tiles(map, size).unwrap().collect();
        prop_assert_eq!(all.len(), tiles(map, size).unwrap().len());
        let area: u32 = all.iter().map(|tile| tile.map.size.x * tile.map.size.y).sum();
        prop_assert_eq!(area, map.projection.resolution.x * map.projection.resolution.y);
        let at = texel(&map.projection, point);
        let (x, y) = (at.x as u32, at.y as u32);
        let owners: Vec<&Tile> = all.iter().filter(|tile| is_in(&tile.map, x, y)).collect();
        prop_assert_eq!(owners.len(), 1);
        let tile = owners[0];
        let expected = at - tile.map.min.as_dvec2() + tile.from.as_dvec2();
        prop_assert!((texel(&tile.projection, point) - expected).abs().max_element() < 0.02);
        prop_assert!((place(&tile.projection, point).z - place(&map.projection, point).z).abs() < 1e-5);
        prop_assert!(tile.projection.direction == map.projection.direction && tile.projection.depth == depth);
    }
}

/// Returns texture coordinates and depth of a world position, in f64.
fn place(fit: &LightProjection, point: DVec3) -> DVec3 {
    let m = fit.uv_from_world.as_dmat4();
    let p = point - fit.origin;
    (m.x_axis * p.x + m.y_axis * p.y + m.z_axis * p.z + m.w_axis).truncate()
}

fn texel(fit: &LightProjection, point: DVec3) -> DVec2 {
    place(fit, point).truncate() * fit.resolution.as_dvec2()
}

#[test]
fn tiles_have_the_same_bits_wherever_the_camera_is() {
    let settings = settings(FitKind::Sphere, SNAP, 512);
    let (town, mut fitter, mut camera) = (town(), FitState::new(), camera());
    let mut known: HashMap<(usize, [i64; 2], [u64; 2]), LightProjection> = HashMap::new();
    let (mut again, mut levels) = (0, std::collections::HashSet::new());
    for _ in 0..60 {
        for (level, map) in frame(&mut fitter, &camera, DIRECTION, &settings, &town).iter().enumerate() {
            let depth = map.grid_position.unwrap().depth.map(f64::to_bits);
            for tile in tiles(map, 64).unwrap() {
                levels.insert((level, depth));
                let first = *known.entry((level, tile.index, depth)).or_insert(tile.projection);
                assert_eq!(first, tile.projection);
                again += 1;
            }
        }
        camera.eye += DVec3::new(0.37, 0.01, -0.73);
        camera.forward = (DQuat::from_axis_angle(DVec3::Y, 0.02) * camera.forward.as_dvec3()).as_vec3();
    }
    let tiles: usize = known.len();
    println!("{again} uses of {tiles} tiles, {} levels", levels.len());
    assert!(again > 10 * tiles, "{again} uses of {tiles} tiles");
}

/// Counts how often maps must be drawn completely while a camera moves at a jogger's pace and looks around.
#[test]
fn depth_ranges_hold_while_a_camera_walks() {
    let town = town();
    for (kind, stabilise) in [
        (FitKind::Sphere, SNAP),
        (FitKind::FrustumAabb, SNAP),
        (FitKind::Focused, SNAP),
        (FitKind::FrustumAabb, Stabilise::default()),
        (FitKind::Focused, Stabilise::default()),
    ] {
        let settings = settings(kind, stabilise, 1024);
        let (mut fitter, mut camera) = (FitState::new(), camera());
        let mut before = frame(&mut fitter, &camera, DIRECTION, &settings, &town);
        let (mut depth_changes, mut new, mut shifts, frames) = (0, 0, 0, 600);
        for i in 0..frames {
            camera.eye += DVec3::new(0.03, 0.0, -0.05);
            let turn = 0.01 * f64::sin(f64::from(i) * 0.02);
            camera.forward = (DQuat::from_axis_angle(DVec3::Y, turn) * camera.forward.as_dvec3()).as_vec3();
            let now = frame(&mut fitter, &camera, DIRECTION, &settings, &town);
            for (before, now) in before.iter().zip(now.iter()) {
                let scroll = Scroll::between(before, now);
                new += i32::from(scroll.is_new);
                depth_changes += i32::from(!scroll.is_new && scroll.depth_changed);
                shifts += i32::from(!scroll.is_redraw() && scroll.exposed().count() > 0);
            }
            before = now;
        }
        let maps = frames * 3;
        println!("{kind:?} {stabilise:?}: of {maps} maps {new} new, {depth_changes} with new depths, {shifts} shifted");
        assert!(depth_changes * 100 < maps, "{kind:?} {stabilise:?}: {depth_changes} of {maps}");
        if kind == FitKind::Sphere || stabilise == Stabilise::default() {
            assert!(new * 20 < maps, "{kind:?} {stabilise:?}: {new} of {maps}");
        }
    }
}

#[test]
fn what_changes_the_projection_makes_a_new_map() {
    let resolution = UVec2::splat(8);
    let before = plain_map([3, 4], resolution);
    let same = Scroll::between(&before, &before);
    assert!(!same.is_redraw() && same.exposed().count() == 0);
    let grid_position = before.grid_position.unwrap();
    let with = |grid_position: GridPosition| FittedMap { grid_position: Some(grid_position), ..before };
    let with_fit = |fit: LightProjection| FittedMap { projection: fit, ..before };
    let depth = Scroll::between(&before, &with(GridPosition { depth: [-10.0, 31.0], ..grid_position }));
    assert!(!depth.is_new && depth.depth_changed && depth.is_redraw() && depth.exposed().count() == 0);
    let mut turned = before.projection;
    turned.light_from_world.x_axis.y = 1e-7;
    for other in [
        with(GridPosition { texel: DVec2::new(2.0, 2.000_001), ..grid_position }),
        with(GridPosition { first: [i64::MAX, i64::MIN], ..grid_position }),
        with_fit(LightProjection { resolution: UVec2::new(8, 9), ..before.projection }),
        with_fit(LightProjection { depth: DepthConvention::Reversed, ..before.projection }),
        with_fit(turned),
        FittedMap { grid_position: None, ..before },
    ] {
        for scroll in [Scroll::between(&before, &other), Scroll::between(&other, &before)] {
            assert!(scroll.is_new && scroll.is_redraw(), "{other:?}");
        }
        let all: Vec<TexelRect> = Scroll::between(&before, &other).exposed().collect();
        assert_eq!(all, [TexelRect { min: UVec2::ZERO, size: other.projection.resolution }]);
    }
    // An empty map has no drawn content.
    assert!(Scroll::between(&with_fit(LightProjection { is_empty: true, ..before.projection }), &before).is_new);
    assert!(!Scroll::between(&before, &with_fit(LightProjection { is_empty: true, ..before.projection })).is_new);
}

#[test]
fn maps_on_no_grid_have_no_tiles_and_bad_ones_are_errors() {
    let free =
        frame(&mut FitState::new(), &camera(), DIRECTION, &settings(FitKind::Oriented, Stabilise::Off, 64), &town());
    assert!(free[0].grid_position.is_none());
    assert_eq!(tiles(&free[0], 64).unwrap_err(), FitError::NotOnGrid);
    let good = frame(&mut FitState::new(), &camera(), DIRECTION, &settings(FitKind::Oriented, SNAP, 64), &town())[0];
    assert!(tiles(&good, 64).is_ok());
    let grid_position = good.grid_position.unwrap();
    for size in [0, 65_537, u32::MAX] {
        assert!(matches!(tiles(&good, size), Err(FitError::OutOfRange { .. })), "{size}");
    }
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        let with = |grid_position: GridPosition| FittedMap { grid_position: Some(grid_position), ..good };
        assert!(tiles(&with(GridPosition { texel: DVec2::new(bad, 1.0), ..grid_position }), 64).is_err(), "{bad}");
        assert!(tiles(&with(GridPosition { depth: [0.0, bad], ..grid_position }), 64).is_err(), "{bad}");
        let mut fit = good.projection;
        fit.light_from_world.y_axis.y = bad as f32;
        fit.light_from_world.z_axis.y = bad as f32;
        assert!(tiles(&FittedMap { projection: fit, ..good }, 64).is_err(), "{bad}");
    }
    let far = GridPosition { first: [i64::MIN, i64::MAX], ..grid_position };
    assert!(tiles(&FittedMap { grid_position: Some(far), ..good }, 64).is_err());
}

proptest! {
    /// By brute force: a part of a map is stored texel by texel at (t + texel_offset) modulo the size, each
    /// texel once. The viewport of each piece maps the one position to the other.
    #[test]
    fn a_part_of_a_map_is_stored_wrapped_around_texel_by_texel(
        (w, h) in (1_u32..12, 1_u32..12), (x, y) in (0_u32..12, 0_u32..12), (dx, dy) in (0_u32..14, 0_u32..14),
        (wx, wy) in (0_u32..12, 0_u32..12),
    ) {
        let size = UVec2::new(w, h);
        let texel_offset = UVec2::new(wx % w, wy % h);
        let part = TexelRect { min: UVec2::new(x, y), size: UVec2::new(dx, dy) };
        let mut found = HashMap::new();
        for piece in part.stored(texel_offset, size) {
            prop_assert_eq!(piece.window.size, piece.stored.size);
            for column in 0..piece.stored.size.x {
                for row in 0..piece.stored.size.y {
                    let at = UVec2::new(column, row);
                    let stored = piece.stored.min + at;
                    prop_assert!(stored.cmplt(size).all());
                    prop_assert_eq!(stored.as_ivec2(), (piece.window.min + at).as_ivec2() + piece.viewport());
                    prop_assert!(found.insert(piece.window.min + at, stored).is_none());
                }
            }
        }
        let inside = part.intersection(TexelRect::all(size));
        prop_assert_eq!(found.len() as u64, inside.area());
        for (texel, stored) in found {
            prop_assert!(is_in(&inside, texel.x, texel.y));
            prop_assert_eq!(stored, (texel + texel_offset) % size);
        }
    }

    /// In successive frames, texels that both maps contain keep their storage position.
    #[test]
    fn kept_texels_stay_where_they_are_stored(
        shifts in prop::collection::vec((-9_i64..9, -9_i64..9), 1..20), (w, h) in (1_u32..12, 1_u32..12),
    ) {
        let size = UVec2::new(w, h);
        let (mut before, mut texel_offset) = (plain_map([40, -70], size), UVec2::ZERO);
        for (dx, dy) in shifts {
            let [x, y] = before.grid_position.unwrap().first;
            let now = plain_map([x + dx, y + dy], size);
            let scroll = Scroll::between(&before, &now);
            let next = scroll.texel_offset(texel_offset, size);
            prop_assert!(next.cmplt(size).all());
            if scroll.is_redraw() {
                prop_assert_eq!(next, UVec2::ZERO);
            } else {
                for column in 0..w {
                    for row in 0..h {
                        let now = UVec2::new(column, row);
                        let old = now.as_ivec2() + scroll.shift;
                        if old.cmpge(shadowfit::glam::IVec2::ZERO).all() && old.as_uvec2().cmplt(size).all() {
                            prop_assert_eq!((now + next) % size, (old.as_uvec2() + texel_offset) % size);
                        }
                    }
                }
            }
            (before, texel_offset) = (now, next);
        }
    }

    /// The texels of a box contain its corners and all points between them. The casters over a part of a map
    /// are the casters of its texels.
    #[test]
    fn the_texels_of_a_box_hold_it_and_parts_of_a_map_keep_the_casters_over_them(
        direction in any_direction(), centre in prop::array::uniform3(-30.0_f32..30.0),
        half in prop::array::uniform3(0.0_f32..8.0),
    ) {
        let (centre, half) = (Vec3::from(centre), Vec3::from(half));
        let aabb = Aabb::new(centre - half, centre + half);
        let origin = DVec3::new(1000.0, -3.0, 500.0);
        let mut camera = camera();
        camera.eye = origin;
        let fit = shadowfit::fit(&camera.frustum().unwrap(), direction, &FitSettings::default().with_max_distance(40.0)).unwrap();
        let rect = TexelRect::of_box(&fit, &aabb, origin);
        let volume = CasterVolume::of_part(&fit, CasterPolicy::DepthClamp, rect);
        let size = fit.resolution.as_vec2();
        for corner in aabb.corners() {
            let at = fit.uv_from_world.transform_point3(corner);
            let uv = at.truncate() * size;
            let is_over = uv.cmpge(shadowfit::glam::Vec2::ZERO).all() && uv.cmple(size).all();
            if is_over {
                let texel = uv.as_uvec2().min(fit.resolution - 1);
                prop_assert!(is_in(&rect, texel.x, texel.y), "{rect:?} {texel}");
                // Casters beyond the far plane cast no shadow into the map.
                prop_assert!(volume.intersects_sphere(corner, 0.0) || at.z > 1.0);
            }
        }
        if rect.is_empty() {
            prop_assert!(!CasterVolume::of_part(&fit, CasterPolicy::DepthClamp, TexelRect::all(fit.resolution))
                .intersects_sphere(centre, 0.0));
        }
    }
}

#[test]
fn an_empty_box_has_no_texels_and_one_beside_the_map_none_either() {
    let fit = shadowfit::fit(&camera().frustum().unwrap(), DIRECTION, &FitSettings::default()).unwrap();
    assert!(TexelRect::of_box(&fit, &Aabb::EMPTY, fit.origin).is_empty());
    let far = Aabb::new(Vec3::splat(1e5), Vec3::splat(1e5 + 1.0));
    assert!(TexelRect::of_box(&fit, &far, fit.origin).is_empty());
}
