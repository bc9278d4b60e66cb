//! The displayed scene at rest: one mesh per instance, in world space, visible from both sides, as for rays.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use bevy::asset::RenderAssetUsages;
use bevy::camera::visibility::RenderLayers;
use bevy::image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::light::NotShadowCaster;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use shadowfit::glam as fit_glam;
use shadowfit_scene::builtin::default_scene;
use shadowfit_scene::{self as scenes, BlendedCasters, Casting, Instance, Lens, Pose, Primitive, SceneError, Wrap};
use shadowfit_study::SceneRays;

/// Vertical field of view if the scene has no camera, in radians.
const FOV_Y: f32 = 0.785;
/// Direction toward the sun if the scene has none.
const TO_SUN: Vec3 = Vec3::new(0.41, 0.68, 0.6);
/// Least extent of a scene, in metres. A scene without triangles also has a camera.
const MIN_EXTENT: f32 = 1.0;

/// A scene and its pose. World space is right-handed, y up, in metres.
pub(crate) struct Content {
    pub(crate) scene: scenes::Scene,
    pose: Pose,
    bounds: shadowfit::Aabb,
    rays: OnceLock<SceneRays>,
}

/// The displayed scene.
#[derive(Resource, Clone)]
pub(crate) struct Shown(pub(crate) Arc<Content>);

impl Content {
    /// Loads a glTF file, or creates the built-in courtyard.
    ///
    /// # Errors
    ///
    /// If the file is not a valid scene.
    pub(crate) fn load(file: Option<&Path>) -> Result<Self, SceneError> {
        let scene = file.map_or_else(|| Ok(default_scene()), scenes::load_gltf)?;
        file.iter().flat_map(|file| scene.warnings(file)).for_each(|warning| eprintln!("{warning}"));
        let scene = scenes::Scene { blended_casters: BlendedCasters::Never, ..scene };
        let pose = scene.pose(None, 0.0);
        let bounds = scene.bounds(&pose).unwrap_or(shadowfit::Aabb::new(fit_glam::Vec3::ZERO, fit_glam::Vec3::ZERO));
        Ok(Self { scene, pose, bounds, rays: OnceLock::new() })
    }

    /// Returns the diagonal of the scene's bounds, in metres.
    pub(crate) fn extent(&self) -> f32 {
        (self.bounds.max - self.bounds.min).length().max(MIN_EXTENT)
    }

    /// Returns the casters for rays. The first call takes a while.
    pub(crate) fn rays(&self) -> &SceneRays {
        self.rays.get_or_init(|| SceneRays::from_origin(&self.scene, &self.pose, fit_glam::DVec3::ZERO))
    }

    /// Returns the first camera of the scene. A scene without one is viewed from above a corner, toward its
    /// centre.
    pub(crate) fn start(&self) -> Transform {
        let vec3 = |v: fit_glam::Vec3| Vec3::from_array(v.to_array());
        if let Some(placed) = self.scene.cameras.first().and_then(|camera| camera.placement(&self.pose)) {
            return Transform::from_translation(vec3(placed.eye.as_vec3())).looking_to(vec3(placed.forward), Vec3::Y);
        }
        let [min, max] = [self.bounds.min, self.bounds.max].map(vec3);
        let (middle, size) = ((min + max) * 0.5, max - min);
        let eye = Vec3::new(middle.x + 0.3 * size.x, max.y + 0.06 * self.extent(), middle.z + 0.4 * size.z);
        Transform::from_translation(eye).looking_at(middle, Vec3::Y)
    }

    /// Returns the vertical field of view, in radians.
    pub(crate) fn fov_y(&self) -> f32 {
        match self.scene.cameras.first().map(|camera| camera.lens) {
            Some(Lens::Perspective { fov_y, .. }) => fov_y,
            _ => FOV_Y,
        }
    }

    /// Returns the unit direction toward the sun.
    pub(crate) fn to_sun(&self) -> Vec3 {
        let to_sun = self.scene.sun.map_or(TO_SUN, |sun| -Vec3::from_array(sun.direction.to_array()));
        to_sun.normalize_or(Vec3::Y)
    }

    fn primitive(&self, instance: &Instance) -> &Primitive {
        &self.scene.meshes[instance.mesh].primitives[instance.primitive]
    }
}

/// Spawns the scene for both halves.
pub(crate) fn spawn(
    shown: Res<Shown>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    let content = &shown.0;
    let mut add = |of: &scenes::Material| {
        let texture = of.base_color_texture.map(|texture| images.add(image(content, &texture)));
        materials.add(material(of, texture))
    };
    let made: Vec<_> = content.scene.materials.iter().map(&mut add).collect();
    for instance in content.scene.instances() {
        let primitive = content.primitive(&instance);
        let parts = (Mesh3d(meshes.add(mesh(content, &instance))), MeshMaterial3d(made[primitive.material].clone()));
        let mut object = commands.spawn((parts, RenderLayers::from_layers(&[1, 2])));
        if content.scene.casting(primitive) == Casting::Nothing {
            object.insert(NotShadowCaster);
        }
    }
}

fn mesh(content: &Content, instance: &Instance) -> Mesh {
    let (scene, pose) = (&content.scene, &content.pose);
    let primitive = content.primitive(instance);
    let texture = scene.materials[primitive.material].base_color_texture;
    let deformed = pose.deform(scene, instance).unwrap_or_else(|| scenes::Deformed {
        positions: primitive.positions.clone(),
        normals: primitive.normals.clone(),
        ..default()
    });
    let world_from_local = pose.world_from_instance(scene, instance);
    let normal_matrix = fit_glam::Mat3::from_mat4(world_from_local).inverse().transpose();
    let position = |position: &fit_glam::Vec3| world_from_local.transform_point3(*position).to_array();
    let normal = |normal: &fit_glam::Vec3| (normal_matrix * *normal).normalize_or(fit_glam::Vec3::Y).to_array();
    let uv = |vertex: usize| {
        let uv = primitive.uvs.get(vertex).copied().unwrap_or_default();
        texture.map_or(uv, |texture| texture.in_image(uv)).to_array()
    };
    let mut indices = primitive.indices.clone();
    if pose.is_mirrored(scene, instance) {
        indices.as_chunks_mut::<3>().0.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    let uvs: Vec<[f32; 2]> = (0..deformed.positions.len()).map(uv).collect();
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, deformed.positions.iter().map(position).collect::<Vec<_>>())
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, deformed.normals.iter().map(normal).collect::<Vec<_>>())
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
        .with_inserted_indices(Indices::U32(indices));
    if !primitive.colors.is_empty() {
        let colors: Vec<[f32; 4]> = primitive.colors.iter().map(fit_glam::Vec4::to_array).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    }
    mesh
}

fn material(of: &scenes::Material, base_color_texture: Option<Handle<Image>>) -> StandardMaterial {
    let [emitted_red, emitted_green, emitted_blue] = of.emissive.to_array();
    StandardMaterial {
        base_color: LinearRgba::from_f32_array(of.base_color.to_array()).into(),
        base_color_texture,
        emissive: LinearRgba::rgb(emitted_red, emitted_green, emitted_blue),
        metallic: of.metallic,
        perceptual_roughness: of.roughness,
        alpha_mode: match of.alpha {
            scenes::AlphaMode::Opaque => AlphaMode::Opaque,
            scenes::AlphaMode::Mask { cutoff } => AlphaMode::Mask(of.alpha.least_opaque().unwrap_or(cutoff)),
            scenes::AlphaMode::Blend => AlphaMode::Blend,
        },
        // Rays hit both sides of a triangle. A single-sided triangle would transmit light in the maps, but
        // not for rays.
        cull_mode: None,
        double_sided: true,
        ..default()
    }
}

fn image(content: &Content, texture: &scenes::Texture) -> Image {
    let scenes::Image { width, height, rgba, .. } = &content.scene.images[texture.image];
    let size = Extent3d { width: *width, height: *height, depth_or_array_layers: 1 };
    let [address_mode_u, address_mode_v] = texture.wrap.map(|wrap| match wrap {
        Wrap::Repeat => ImageAddressMode::Repeat,
        Wrap::Mirror => ImageAddressMode::MirrorRepeat,
        Wrap::Clamp => ImageAddressMode::ClampToEdge,
    });
    let mag_filter = if texture.nearest { ImageFilterMode::Nearest } else { ImageFilterMode::Linear };
    let min_filter = ImageFilterMode::Linear;
    let format = TextureFormat::Rgba8UnormSrgb;
    let mut image = Image::new(size, TextureDimension::D2, rgba.clone(), format, RenderAssetUsages::RENDER_WORLD);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u,
        address_mode_v,
        mag_filter,
        min_filter,
        ..default()
    });
    image
}
