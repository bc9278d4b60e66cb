//! The scene as Bevy draws it: a mesh for each object, in world space, seen from both sides, as rays see it.

use std::sync::Arc;

use bevy::asset::RenderAssetUsages;
use bevy::camera::visibility::RenderLayers;
use bevy::image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::light::NotShadowCaster;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use shadowfit::glam as fit_glam;
use shadowfit_scene::{AlphaMode as SceneAlpha, Instance, Material, Texture, Wrap};

use crate::content::Content;
use crate::halves::Side;

/// Spawns the scene.
pub(crate) fn plugin(app: &mut App, content: Arc<Content>) {
    let spawn = move |mut commands: Commands,
                      mut meshes: ResMut<Assets<Mesh>>,
                      mut materials: ResMut<Assets<StandardMaterial>>,
                      mut images: ResMut<Assets<Image>>| {
        let made: Vec<_> = content
            .scene
            .materials
            .iter()
            .map(|made_of| {
                let texture = made_of.base_color_texture.map(|texture| images.add(image(&content, &texture)));
                materials.add(material(made_of, texture))
            })
            .collect();
        let layers = RenderLayers::from_layers(&Side::BOTH.map(Side::layer));
        for instance in content.scene.instances() {
            let material = made[content.primitive(&instance).material].clone();
            let mesh = meshes.add(mesh(&content, &instance));
            let mut object = commands.spawn((Mesh3d(mesh), MeshMaterial3d(material), layers.clone()));
            if !content.casts(&instance) {
                object.insert(NotShadowCaster);
            }
        }
    };
    app.add_systems(Startup, spawn);
}

fn mesh(content: &Content, instance: &Instance) -> Mesh {
    let (scene, pose) = (&content.scene, &content.pose);
    let primitive = content.primitive(instance);
    let texture = scene.materials[primitive.material].base_color_texture;
    let deformed = pose.deform(scene, instance);
    let (positions, normals) = deformed
        .as_ref()
        .map_or((&primitive.positions, &primitive.normals), |deformed| (&deformed.positions, &deformed.normals));
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
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions.iter().map(position).collect::<Vec<_>>())
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals.iter().map(normal).collect::<Vec<_>>())
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, (0..positions.len()).map(uv).collect::<Vec<_>>())
        .with_inserted_indices(Indices::U32(indices));
    if !primitive.colors.is_empty() {
        let colors: Vec<[f32; 4]> = primitive.colors.iter().map(fit_glam::Vec4::to_array).collect();
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    }
    mesh
}

fn material(made_of: &Material, base_color_texture: Option<Handle<Image>>) -> StandardMaterial {
    let [red, green, blue, alpha] = made_of.base_color.to_array();
    let [emitted_red, emitted_green, emitted_blue] = made_of.emissive.to_array();
    StandardMaterial {
        base_color: Color::linear_rgba(red, green, blue, alpha),
        base_color_texture,
        emissive: LinearRgba::rgb(emitted_red, emitted_green, emitted_blue),
        metallic: made_of.metallic,
        perceptual_roughness: made_of.roughness,
        alpha_mode: match made_of.alpha {
            SceneAlpha::Opaque => AlphaMode::Opaque,
            SceneAlpha::Mask { cutoff } => AlphaMode::Mask(made_of.alpha.least_opaque().unwrap_or(cutoff)),
            SceneAlpha::Blend => AlphaMode::Blend,
        },
        // Truth knows no sides: what has a front and no back would let light through in the maps alone.
        cull_mode: None,
        double_sided: true,
        ..default()
    }
}

fn image(content: &Content, texture: &Texture) -> Image {
    let image = &content.scene.images[texture.image];
    let size = Extent3d { width: image.width, height: image.height, depth_or_array_layers: 1 };
    let address = |wrap: Wrap| match wrap {
        Wrap::Repeat => ImageAddressMode::Repeat,
        Wrap::Mirror => ImageAddressMode::MirrorRepeat,
        Wrap::Clamp => ImageAddressMode::ClampToEdge,
    };
    let filter = if texture.nearest { ImageFilterMode::Nearest } else { ImageFilterMode::Linear };
    let format = TextureFormat::Rgba8UnormSrgb;
    let mut made = Image::new(size, TextureDimension::D2, image.rgba.clone(), format, RenderAssetUsages::RENDER_WORLD);
    made.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: address(texture.wrap[0]),
        address_mode_v: address(texture.wrap[1]),
        mag_filter: filter,
        min_filter: ImageFilterMode::Linear,
        ..default()
    });
    made
}
