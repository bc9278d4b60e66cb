//! Effects of the plugin on lights, in an app without a window or a GPU.

use bevy::asset::RenderAssetUsages;
use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::{NoCpuCulling, NoFrustumCulling, RenderLayers, VisibilityRange};
use bevy::light::{CascadeShadowConfig, CascadeShadowConfigBuilder, DirectionalLight, NotShadowReceiver};
use bevy::mesh::PrimitiveTopology;
use bevy::prelude::*;
use bevy_shadowfit::prelude::*;

use crate::support::*;

/// Returns the next pseudo-random number, in the same sequence in each run.
fn random(state: &mut u64) -> f32 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 40) as f32 / (1_u64 << 24) as f32
}

#[test]
fn every_receiver_in_view_lies_in_the_cascade_that_reads_it_in_every_frame_of_a_path() {
    for fit in [Fit::Stable, Fit::Calm, Fit::Histogram] {
        for splits in [FitSplits::Ours, FitSplits::Bevys] {
            let mut app = app();
            let (light, camera) = scene(&mut app, FittedShadows { fit, splits, ..default() });
            let mut seed = 7;
            for _ in 0..60 {
                let at = Vec3::new(random(&mut seed) * 60.0 - 30.0, 1.0 + random(&mut seed) * 9.0, 20.0);
                let to = Vec3::new(random(&mut seed) * 80.0 - 40.0, random(&mut seed) * 3.0, -40.0 * random(&mut seed));
                *app.world_mut().get_mut::<Transform>(camera).unwrap() =
                    Transform::from_translation(at).looking_at(to, Vec3::Y);
                app.update();
                prove(&mut app, light, camera);
            }
        }
    }
}

#[test]
fn bounds_are_those_of_the_maps_until_the_next_frame_begins_and_end_where_the_user_says() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows::default());
    let users = config(&app, light).clone();
    app.update();
    let bounds = config(&app, light).bounds.clone();
    assert_ne!(bounds, users.bounds);
    assert_eq!(bounds.len(), 4);
    assert!(bounds.is_sorted());
    assert_eq!(bounds.last(), users.bounds.last());
    assert_eq!(config(&app, light).overlap_proportion, users.overlap_proportion);
    assert_eq!(cascades(&app, light, camera).len(), 4);
    // In the user's systems the config contains the user's values.
    let seen = seen_in_update(&mut app, light);
    assert_eq!(seen, users.bounds);
    assert!(!was_changed(&mut app, light), "change detection ignores the plugin's changes");
}

#[test]
fn splits_of_bevy_are_kept_as_they_are() {
    let mut app = app();
    let (light, _) = scene(&mut app, FittedShadows { splits: FitSplits::Bevys, ..default() });
    let users = config(&app, light).bounds.clone();
    app.update();
    assert_eq!(config(&app, light).bounds, users);
}

#[test]
fn what_the_user_changes_is_kept_and_given_back_when_the_component_goes() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows::default());
    app.update();
    app.update();
    let other: CascadeShadowConfig =
        CascadeShadowConfigBuilder { num_cascades: 3, maximum_distance: 60.0, ..default() }.into();
    let end = other.bounds[2];
    *app.world_mut().get_mut::<CascadeShadowConfig>(light).unwrap() = other.clone();
    sun_mut(&mut app, light).shadow_normal_bias = 0.7;
    app.update();
    assert_eq!(cascades(&app, light, camera).len(), 3);
    assert_eq!(config(&app, light).bounds.last(), Some(&end));
    app.world_mut().entity_mut(light).remove::<FittedShadows>();
    assert_eq!(config(&app, light).bounds, other.bounds);
    assert_eq!(sun_mut(&mut app, light).shadow_normal_bias, 0.7);
    app.update();
    assert_eq!(config(&app, light).bounds, other.bounds);
    assert_same(&cascades(&app, light, camera), &bevys_cascades(&app, light, camera));
}

#[test]
fn lights_without_the_component_are_bevys() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows::default());
    app.world_mut().entity_mut(light).remove::<FittedShadows>();
    let users = config(&app, light).bounds.clone();
    app.update();
    assert_eq!(config(&app, light).bounds, users);
    assert_same(&cascades(&app, light, camera), &bevys_cascades(&app, light, camera));
}

/// Returns the largest texel on screen of a light's cascades beyond 2 m, as a share of its view depth.
fn coarsest(app: &App, light: Entity, camera: Entity) -> f32 {
    let (config, cascades) = (config(app, light), cascades(app, light, camera));
    let nearest =
        std::iter::once(2.0).chain(config.bounds.iter().map(|bound| bound * (1.0 - config.overlap_proportion)));
    cascades.iter().zip(nearest).map(|(cascade, near)| cascade.texel_size / near.max(2.0)).fold(0.0, f32::max)
}

#[test]
fn texels_are_finer_than_bevys() {
    for (fit, least) in [(Fit::Calm, 1.5), (Fit::Histogram, 1.5)] {
        let mut app = app();
        let (light, camera) = scene(&mut app, FittedShadows { fit, ..default() });
        app.update();
        let ours = coarsest(&app, light, camera);
        app.world_mut().entity_mut(light).remove::<FittedShadows>();
        app.update();
        let bevys = coarsest(&app, light, camera);
        assert!(ours * least < bevys, "{fit:?}: {ours} to {bevys}");
    }
}

#[test]
fn all_views_have_cascades_of_their_own_with_the_same_bounds() {
    let mut app = app();
    let (light, first) = scene(&mut app, FittedShadows::default());
    let other = Transform::from_xyz(-20.0, 30.0, 5.0).looking_at(Vec3::new(0.0, 0.0, -10.0), Vec3::Y);
    let second = app.world_mut().spawn((Camera3d::default(), other)).id();
    let flat = Projection::Orthographic(OrthographicProjection {
        scaling_mode: bevy::camera::ScalingMode::FixedVertical { viewport_height: 20.0 },
        ..OrthographicProjection::default_3d()
    });
    let third = app.world_mut().spawn((Camera3d::default(), flat, other)).id();
    app.update();
    for camera in [first, second, third] {
        prove(&mut app, light, camera);
    }
    assert_ne!(cascades(&app, light, first)[0].clip_from_world, cascades(&app, light, second)[0].clip_from_world);
    app.world_mut().despawn(second);
    app.update();
    prove(&mut app, light, first);
}

#[test]
fn a_camera_beyond_the_shadows_changes_nothing_for_others() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows::default());
    let far = Projection::Perspective(PerspectiveProjection { near: 400.0, far: 4000.0, ..default() });
    app.world_mut().spawn((Camera3d::default(), far, Transform::from_xyz(0.0, 500.0, 0.0)));
    app.update();
    prove(&mut app, light, camera);
}

#[test]
fn only_views_whose_layers_the_light_shares_are_fitted() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows::default());
    app.world_mut().entity_mut(camera).insert(RenderLayers::layer(3));
    let users = config(&app, light).bounds.clone();
    app.update();
    assert_eq!(config(&app, light).bounds, users);
    assert_same(&cascades(&app, light, camera), &bevys_cascades(&app, light, camera));
}

#[test]
fn meshes_that_receive_nothing_do_not_widen_the_maps() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows { fit: Fit::Histogram, ..default() });
    let sky = spawn_box(&mut app, Vec3::ZERO, Vec3::splat(2000.0));
    app.update();
    let wide = cascades(&app, light, camera)[3].texel_size;
    for hide in [
        (|sky| _ = sky.insert(NotShadowReceiver)) as fn(&mut EntityWorldMut),
        |sky| _ = sky.remove::<NotShadowReceiver>().insert(RenderLayers::layer(2)),
        |sky| _ = sky.remove::<RenderLayers>().insert(Visibility::Hidden),
        |sky| _ = sky.insert(Visibility::Inherited).insert(VisibilityRange::abrupt(5000.0, 6000.0)),
    ] {
        hide(&mut app.world_mut().entity_mut(sky));
        app.update();
        app.update();
        let narrow = cascades(&app, light, camera)[3].texel_size;
        assert!(narrow < wide * 0.9, "{narrow} m to {wide} m");
    }
}

#[test]
fn meshes_without_a_box_may_be_anywhere_in_view() {
    for unknown in [true, false] {
        let mut app = app();
        let (light, camera) = scene(&mut app, FittedShadows { fit: Fit::Histogram, ..default() });
        let mesh = spawn_box(&mut app, Vec3::new(0.0, 1.0, -3.0), Vec3::splat(0.5));
        app.update();
        let narrow = cascades(&app, light, camera)[3].texel_size;
        if unknown {
            app.world_mut().entity_mut(mesh).insert(NoFrustumCulling);
        }
        app.update();
        let now = cascades(&app, light, camera)[3].texel_size;
        assert_eq!(now > narrow, unknown, "{now} m after {narrow} m");
    }
}

#[test]
fn what_cannot_be_fitted_keeps_bevys_cascades_and_works_again_afterwards() {
    type Harm = fn(&mut App, Entity, Entity);
    let harms: [(&str, Harm); 8] = [
        ("a mesh that is not finite", |app, _, _| {
            spawn_box(app, Vec3::new(0.0, 0.0, -5.0), Vec3::splat(f32::INFINITY));
        }),
        ("a scaled camera", |app, _, camera| {
            app.world_mut().get_mut::<Transform>(camera).unwrap().scale = Vec3::splat(2.0);
        }),
        ("too many cascades", |app, light, _| {
            config_mut(app, light).bounds = vec![5.0, 10.0, 20.0, 40.0, 80.0];
        }),
        ("no cascades", |app, light, _| config_mut(app, light).bounds = Vec::new()),
        ("bounds that are not finite", |app, light, _| config_mut(app, light).bounds[1] = f32::NAN),
        ("a light without a direction", |app, light, _| {
            app.world_mut().get_mut::<Transform>(light).unwrap().scale = Vec3::ZERO;
        }),
        ("a bound of zero", |app, light, _| config_mut(app, light).bounds[0] = 0.0),
        ("bounds that descend", |app, light, _| config_mut(app, light).bounds.reverse()),
    ];
    for (name, harm) in harms {
        let mut app = app();
        let (light, camera) = scene(&mut app, FittedShadows::default());
        app.update();
        harm(&mut app, light, camera);
        app.update();
        app.update();
        let bounds = config(&app, light).bounds.clone();
        let seen = seen_in_update(&mut app, light);
        assert_eq!(format!("{bounds:?}"), format!("{seen:?}"), "{name}: bounds of the user");
        assert_same(&cascades(&app, light, camera), &bevys_cascades(&app, light, camera));
    }
}

#[test]
fn nothing_to_see_is_no_harm() {
    let mut empty = app();
    let light = spawn_sun(&mut empty, FittedShadows::default());
    empty.update();
    let camera = empty.world_mut().spawn((Camera3d::default(), Transform::default())).id();
    empty.update();
    assert!(cascades(&empty, light, camera).iter().all(|cascade| cascade.clip_from_world.is_finite()));
    let point = spawn_box(&mut empty, Vec3::new(0.0, 0.0, -10.0), Vec3::ZERO);
    empty.update();
    prove(&mut empty, light, camera);
    assert_eq!(empty.world().get::<Aabb>(point).unwrap().half_extents, Vec3::ZERO.into());
}

#[test]
fn a_mirrored_light_is_fitted_along_the_direction_that_it_shines_in() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows::default());
    app.world_mut().get_mut::<Transform>(light).unwrap().scale = Vec3::new(1.0, 3.0, -2.0);
    app.update();
    let forward = app.world().get::<GlobalTransform>(light).unwrap().forward();
    let seen = cascades(&app, light, camera)[0].world_from_cascade.z_axis.truncate();
    assert!((seen + *forward).length() < 1e-5, "{seen} and {forward:?}");
    prove(&mut app, light, camera);
}

#[test]
fn lights_come_and_go() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows::default());
    app.update();
    let second = spawn_sun(&mut app, FittedShadows { fit: Fit::Stable, ..default() });
    app.update();
    prove(&mut app, light, camera);
    prove(&mut app, second, camera);
    app.world_mut().despawn(light);
    app.update();
    prove(&mut app, second, camera);
    app.world_mut().get_mut::<DirectionalLight>(second).unwrap().shadow_maps_enabled = false;
    app.update();
    app.update();
    app.world_mut().get_mut::<DirectionalLight>(second).unwrap().shadow_maps_enabled = true;
    app.update();
    prove(&mut app, second, camera);
}

#[test]
fn casters_far_off_toward_the_light_are_drawn() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows::default());
    let toward = -*app.world().get::<Transform>(light).unwrap().forward();
    let tower = spawn_box(&mut app, Vec3::new(0.0, 0.0, -8.0) + toward * 500.0, Vec3::splat(2.0));
    app.update();
    app.update();
    let drawn = drawn_into_cascades(&app, light, camera);
    assert!(drawn.iter().any(|entities| entities.contains(&tower)), "Bevy culls it");
}

#[test]
fn stable_bounds_end_where_the_farthest_mesh_does() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows { fit: Fit::Stable, ..default() });
    app.update();
    let ours = (config(&app, light).bounds.clone(), cascades(&app, light, camera)[2].texel_size);
    app.world_mut().entity_mut(light).remove::<FittedShadows>();
    app.update();
    let bevys = (config(&app, light).bounds.clone(), cascades(&app, light, camera)[2].texel_size);
    assert_eq!((ours.0[0], ours.0[3]), (bevys.0[0], bevys.0[3]));
    assert!(ours.0[2] < bevys.0[2] && ours.1 < bevys.1, "{ours:?} and {bevys:?}");
}

#[test]
fn meshes_that_the_cpu_does_not_cull_are_covered() {
    let mut app = app();
    let light = spawn_sun(&mut app, FittedShadows { fit: Fit::Histogram, ..default() });
    let at = Transform::from_xyz(0.0, 2.0, 10.0).looking_at(Vec3::ZERO, Vec3::Y);
    let camera = app.world_mut().spawn((Camera3d::default(), at)).id();
    spawn_box(&mut app, Vec3::ZERO, Vec3::ONE);
    let far = spawn_box(&mut app, Vec3::new(4.0, 0.0, -30.0), Vec3::ONE);
    app.world_mut().entity_mut(far).insert(NoCpuCulling);
    app.update();
    app.update();
    prove(&mut app, light, camera);
}

#[test]
fn stable_maps_hold_far_meshes_that_come_with_another_number_of_cascades() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows { fit: Fit::Stable, ..default() });
    app.update();
    for count in [1, 4, 2] {
        spawn_box(&mut app, Vec3::new(0.0, 0.0, -60.0 - 20.0 * count as f32), Vec3::ONE);
        let config = CascadeShadowConfigBuilder { num_cascades: count, ..default() };
        *config_mut(&mut app, light) = config.into();
        app.update();
        app.update();
        assert_eq!(cascades(&app, light, camera).len(), count);
        prove(&mut app, light, camera);
    }
}

/// Returns a flat ground with a high mast at its corner, as one mesh. Nearly all of its box is empty.
fn ground_and_mast() -> Mesh {
    let mut positions = Vec::new();
    let mut quad = |a: [f32; 3], b: [f32; 3], c: [f32; 3], d: [f32; 3]| positions.extend([a, b, c, a, c, d]);
    for i in 0..144 {
        let (x, z) = ((i % 12) as f32 * 10.0 - 60.0, (i / 12) as f32 * 10.0 - 60.0);
        quad([x, 0.0, z], [x + 10.0, 0.0, z], [x + 10.0, 0.0, z + 10.0], [x, 0.0, z + 10.0]);
    }
    quad([-60.0, 0.0, -60.0], [-59.0, 0.0, -60.0], [-59.0, 60.0, -60.0], [-60.0, 60.0, -60.0]);
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
}

#[test]
fn large_meshes_count_with_boxes_around_their_triangles() {
    // Boxes are computed in the background. Ends with the first frame whose texels are finer than `enough`.
    let texel = |is_whole: bool, frames: usize, enough: f32| {
        let mut app = app();
        let light = spawn_sun(&mut app, FittedShadows { fit: Fit::Histogram, ..default() });
        let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(ground_and_mast());
        let scene = app.world_mut().spawn((Mesh3d(mesh), Transform::default())).id();
        if is_whole {
            app.world_mut().entity_mut(scene).insert(WholeBox);
        }
        let at = Transform::from_xyz(0.0, 2.0, 40.0).looking_at(Vec3::new(0.0, 0.0, 0.0), Vec3::Y);
        let camera = app.world_mut().spawn((Camera3d::default(), at)).id();
        let mut finest = f32::MAX;
        for _ in 0..frames {
            app.update();
            finest = finest.min(coarsest(&app, light, camera));
            if finest < enough {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        finest
    };
    let whole = texel(true, 100, 0.0);
    let cut = texel(false, 10_000, whole * 0.9);
    assert!(cut < whole * 0.9, "{cut} to {whole}");
}

#[test]
fn stable_maps_move_by_whole_texels_while_the_camera_turns_and_walks() {
    let mut app = app();
    let (light, camera) = scene(&mut app, FittedShadows { fit: Fit::Stable, ..default() });
    let mut last: Option<Vec<Mat4>> = None;
    let mut bounds = Vec::new();
    for frame in 0..40 {
        let share = frame as f32;
        let eye = Vec3::new(0.05 * share, 1.7, 15.0 - 0.1 * share);
        let turn = Quat::from_rotation_y(0.02 * share);
        *app.world_mut().get_mut::<Transform>(camera).unwrap() = Transform::from_translation(eye).with_rotation(turn);
        app.update();
        let now: Vec<Mat4> = cascades(&app, light, camera).iter().map(|cascade| cascade.clip_from_world).collect();
        if let Some(last) = last {
            assert_eq!(bounds, config(&app, light).bounds, "frame {frame}");
            for (now, last) in now.iter().zip(&last) {
                assert_eq!(now.transpose().x_axis.truncate(), last.transpose().x_axis.truncate());
                assert_eq!(now.transpose().y_axis.truncate(), last.transpose().y_axis.truncate());
                let moved = (now.w_axis - last.w_axis).truncate().truncate() * 1024.0;
                assert_eq!(moved, moved.round(), "frame {frame}");
            }
        }
        last = Some(now);
        bounds.clone_from(&config(&app, light).bounds);
    }
}
