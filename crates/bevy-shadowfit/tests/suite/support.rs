//! An app without a window or a GPU, its scene, and access for tests.

use bevy::asset::AssetPlugin;
use bevy::camera::CameraPlugin;
use bevy::camera::primitives::Aabb;
use bevy::camera::visibility::CascadesVisibleEntities;
use bevy::light::cascade::Cascade;
use bevy::light::{CascadeShadowConfig, Cascades, DirectionalLight, DirectionalLightShadowMap, LightPlugin};
use bevy::mesh::MeshPlugin;
use bevy::prelude::*;
use bevy_shadowfit::prelude::*;
use shadowfit::bias::FilterRadius;
use shadowfit::glam::{DMat4, DVec2, DVec3, UVec2, Vec3 as FitVec3};
use shadowfit::proof::{CoverageQuery, prove as prove_map};
use shadowfit::settings::CasterPolicy;
use shadowfit::{Boxes, DepthConvention, FitInput, LightProjection, Scratch, ViewFrustum};

/// Creates an app with everything that lights need, and the plugin.
pub fn app() -> App {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        TransformPlugin,
        AssetPlugin::default(),
        MeshPlugin,
        CameraPlugin,
        LightPlugin,
        ShadowfitPlugin,
    ));
    app.init_asset::<Image>();
    app.init_resource::<Seen>();
    app.add_systems(Update, look);
    app.finish();
    app.cleanup();
    app
}

/// State that the user's systems see.
#[derive(Resource, Default)]
struct Seen {
    bounds: Vec<(Entity, Vec<f32>)>,
    changed: Vec<Entity>,
}

fn look(
    mut seen: ResMut<Seen>,
    lights: Query<(Entity, &CascadeShadowConfig)>,
    configs: Query<Entity, Changed<CascadeShadowConfig>>,
    suns: Query<Entity, Changed<DirectionalLight>>,
) {
    seen.bounds = lights.iter().map(|(light, config)| (light, config.bounds.clone())).collect();
    seen.changed = configs.iter().chain(&suns).collect();
}

pub fn seen_in_update(app: &mut App, light: Entity) -> Vec<f32> {
    app.update();
    let seen = &app.world().resource::<Seen>().bounds;
    seen.iter().find(|(entity, _)| *entity == light).unwrap().1.clone()
}

pub fn was_changed(app: &mut App, light: Entity) -> bool {
    app.update();
    app.world().resource::<Seen>().changed.contains(&light)
}

/// Spawns a ground, houses on it, a sun and a camera.
pub fn scene(app: &mut App, fitted: FittedShadows) -> (Entity, Entity) {
    spawn_box(app, Vec3::new(0.0, -0.5, 0.0), Vec3::new(60.0, 0.5, 60.0));
    for i in 0..40 {
        let (x, z) = ((i % 8) as f32 * 9.0 - 31.0, (i / 8) as f32 * -11.0 + 5.0);
        let height = 1.0 + (i * 7 % 5) as f32;
        spawn_box(app, Vec3::new(x, height, z), Vec3::new(1.5, height, 1.0));
    }
    let light = spawn_sun(app, fitted);
    let at = Transform::from_xyz(0.0, 1.7, 15.0).looking_at(Vec3::new(3.0, 1.0, 0.0), Vec3::Y);
    let lens = PerspectiveProjection { aspect_ratio: 16.0 / 9.0, fov: 1.0, ..default() };
    let camera = app.world_mut().spawn((Camera3d::default(), Projection::Perspective(lens), at)).id();
    (light, camera)
}

pub fn spawn_sun(app: &mut App, fitted: FittedShadows) -> Entity {
    let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
    let at = Transform::default().looking_to(Vec3::new(0.5, -0.8, 0.2), Vec3::Y);
    app.world_mut().spawn((sun, fitted, at)).id()
}

/// Spawns a mesh that has only a bounding box.
pub fn spawn_box(app: &mut App, centre: Vec3, half: Vec3) -> Entity {
    let aabb = Aabb { center: Vec3::ZERO.into(), half_extents: half.into() };
    app.world_mut().spawn((Mesh3d::default(), aabb, Transform::from_translation(centre))).id()
}

pub fn config(app: &App, light: Entity) -> &CascadeShadowConfig {
    app.world().get(light).unwrap()
}

pub fn config_mut(app: &mut App, light: Entity) -> Mut<'_, CascadeShadowConfig> {
    app.world_mut().get_mut(light).unwrap()
}

pub fn sun_mut(app: &mut App, light: Entity) -> Mut<'_, DirectionalLight> {
    app.world_mut().get_mut(light).unwrap()
}

pub fn cascades(app: &App, light: Entity, camera: Entity) -> Vec<Cascade> {
    app.world().get::<Cascades>(light).unwrap().cascades[&camera].clone()
}

/// Returns the cascades that Bevy alone computes from the light's config.
pub fn bevys_cascades(app: &App, light: Entity, camera: Entity) -> Vec<Cascade> {
    let mut world = World::new();
    world.insert_resource(app.world().resource::<DirectionalLightShadowMap>().clone());
    let copy = |world: &mut World, entity: Entity| {
        let transform = *app.world().get::<GlobalTransform>(entity).unwrap();
        world.spawn(transform).id()
    };
    let sun = copy(&mut world, light);
    let source = app.world().entity(light);
    let (lamp, config) = (source.get::<DirectionalLight>().unwrap(), source.get::<CascadeShadowConfig>().unwrap());
    world.entity_mut(sun).insert((
        *lamp,
        config.clone(),
        Cascades::default(),
        *source.get::<GlobalTransform>().unwrap(),
    ));
    let eye = copy(&mut world, camera);
    let source = app.world().entity(camera);
    let lens = (source.get::<Projection>().unwrap().clone(), source.get::<Camera>().unwrap().clone());
    world.entity_mut(eye).insert((lens, *source.get::<GlobalTransform>().unwrap()));
    world.run_system_cached(bevy::light::cascade::build_directional_light_cascades).unwrap();
    world.get::<Cascades>(sun).unwrap().cascades[&eye].clone()
}

pub fn assert_same(one: &[Cascade], other: &[Cascade]) {
    assert_eq!(format!("{one:?}"), format!("{other:?}"));
}

/// Returns the meshes that Bevy draws into each cascade.
pub fn drawn_into_cascades(app: &App, light: Entity, camera: Entity) -> Vec<Vec<Entity>> {
    let visible = &app.world().get::<CascadesVisibleEntities>(light).unwrap().entities[&camera];
    visible.iter().map(|cascade| cascade.entities.clone()).collect()
}

/// Proves that every mesh's box in view lies inside the cascade that Bevy's shader reads at its depth,
/// including the filter's footprint and the normal offset.
pub fn prove(app: &mut App, light: Entity, camera: Entity) {
    let world = app.world_mut();
    let boxes: Vec<shadowfit::Aabb> =
        world.query::<(&Aabb, &GlobalTransform)>().iter(world).map(|(aabb, at)| world_box(aabb, at)).collect();
    let boxes: Vec<_> = boxes.into_iter().filter(|aabb| aabb.min.is_finite() && aabb.max.is_finite()).collect();
    let config = world.get::<CascadeShadowConfig>(light).unwrap().clone();
    let sun = *world.get::<DirectionalLight>(light).unwrap();
    let forward = world.get::<GlobalTransform>(light).unwrap().forward().to_array();
    let view = frustum(world, camera, *config.bounds.last().unwrap());
    let cascades = cascades(app, light, camera);
    let size = UVec2::splat(app.world().resource::<DirectionalLightShadowMap>().size as u32);
    let mut storage = vec![DVec2::ZERO; Scratch::required(boxes.len(), 1)];
    let mut near = view.near;
    for (cascade, &far) in cascades.iter().zip(&config.bounds) {
        let receivers = Some(Boxes::world(&boxes));
        let views = [view];
        let input = FitInput { receivers, ..FitInput::new(&views, FitVec3::from_array(forward)) };
        let matrix = DMat4::from_cols_array(&cascade.clip_from_world.to_cols_array().map(f64::from));
        let direction = FitVec3::from_array(forward);
        let map =
            LightProjection::from_clip_from_world(&matrix, DepthConvention::Reversed, direction, size, view.origin);
        let query = CoverageQuery {
            near: near.min(far),
            far,
            filter_radius: FilterRadius::from(2.5),
            normal_offset: sun.shadow_normal_bias * std::f32::consts::SQRT_2 * cascade.texel_size,
            is_shared: false,
            casters: CasterPolicy::DepthClamp,
            bias: None,
        };
        let proof = prove_map(&input, &map.unwrap(), &query, &mut Scratch::new(&mut storage)).unwrap();
        assert!(proof.is_proven(), "{near} m to {far} m of {:?}: {proof:?}", config.bounds);
        near = far * (1.0 - config.overlap_proportion);
    }
}

fn frustum(world: &World, camera: Entity, max_distance: f32) -> ViewFrustum {
    let doubles = |matrix: Mat4| DMat4::from_cols_array(&matrix.to_cols_array().map(f64::from));
    let transform = world.get::<GlobalTransform>(camera).unwrap();
    let clip_from_view = doubles(world.get::<Projection>(camera).unwrap().get_clip_from_view());
    let world_from_clip = doubles(transform.to_matrix()) * clip_from_view.inverse();
    let eye = DVec3::from_array(transform.translation().to_array().map(f64::from));
    ViewFrustum::from_world_from_clip_f64(&world_from_clip, eye, DepthConvention::Reversed, max_distance).unwrap()
}

/// Returns the box around the transformed corners of a mesh's own box.
fn world_box(aabb: &Aabb, at: &GlobalTransform) -> shadowfit::Aabb {
    let corners = (0..8).map(|i| {
        let side = |bit: i32| if i & bit == 0 { -1.0 } else { 1.0 };
        let corner = aabb.center + aabb.half_extents * Vec3::new(side(1), side(2), side(4)).to_vec3a();
        FitVec3::from_array(at.transform_point(corner.into()).to_array())
    });
    corners.fold(shadowfit::Aabb::EMPTY, |all, point| all.union(shadowfit::Aabb::new(point, point)))
}
