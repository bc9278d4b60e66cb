//! The casters of a scene for rays on the GPU: the same triangles and cut-outs that are drawn into the shadow
//! maps.

use core::ops::Range;
use std::collections::HashMap;
use std::sync::Arc;

use glam::{Affine3A, DVec3, Mat4, Vec2, Vec3, Vec4};
use shadowfit::Aabb;
use shadowfit_rays::{
    AlphaImage, CutMaterial, CutOut, ImageId, MeshId, RayError, RayInstance, RayMesh, RayScene, VertexBuffer, Wrap,
};
use shadowfit_scene::{Casting, Image, Primitive, Scene};

use crate::Gpu;

/// Bytes of a position in the vertex buffers of parts.
const POSITION_STRIDE: u32 = 12;

/// A scene's casters in the pose that was set last.
#[derive(Debug)]
pub(crate) struct SceneRays {
    pub(crate) scene: RayScene,
    /// The mesh of each part; `None` if it casts no shadow.
    meshes: Vec<Option<MeshId>>,
    instances: Vec<RayInstance>,
    origin: DVec3,
}

/// A part of a scene, for rays.
pub(crate) struct RayPart<'a> {
    pub(crate) primitive: &'a Primitive,
    pub(crate) deforms: bool,
}

impl SceneRays {
    /// Creates the casters from the parts of a scene, in their order. `origin` is the world position that all
    /// positions are relative to, in metres.
    pub(crate) fn new<'a>(
        gpu: &Gpu,
        scene: &Scene,
        origin: DVec3,
        parts: impl Iterator<Item = RayPart<'a>>,
    ) -> Result<Self, RayError> {
        let mut rays = RayScene::new(&gpu.device, &gpu.queue)?;
        let mut images: Vec<Option<ImageId>> = vec![None; scene.images.len()];
        let (mut meshes, mut plain) = (Vec::new(), HashMap::new());
        for part in parts {
            let casting = scene.casting(part.primitive);
            if casting == Casting::Nothing {
                meshes.push(None);
                continue;
            }
            let shared = (casting == Casting::Whole && !part.deforms).then_some(Arc::as_ptr(&part.primitive.geometry));
            if let Some(known) = shared.and_then(|geometry| plain.get(&geometry)) {
                meshes.push(Some(*known));
                continue;
            }
            let mesh = RayMesh::new(&part.primitive.positions, &part.primitive.indices)?;
            let mesh = mesh.with_cut_outs(cut_outs(scene, part.primitive, |image| {
                let known = &mut images[image];
                match known {
                    Some(id) => Ok(*id),
                    None => Ok(*known.insert(add_image(&mut rays, &scene.images[image])?)),
                }
            })?)?;
            // Its instance has the box of its pose.
            let rest = mesh.bounds().unwrap_or_default();
            let id = if part.deforms { rays.add_deforming_mesh(&mesh, rest)? } else { rays.add_mesh(&mesh)? };
            meshes.push(Some(id));
            plain.extend(shared.map(|geometry| (geometry, id)));
        }
        Ok(Self { scene: rays, meshes, instances: Vec::new(), origin })
    }

    /// Moves all instances to a pose, given as the part of each instance, its transform, and its world box if
    /// it deforms.
    pub(crate) fn set_instances(
        &mut self,
        instances: impl Iterator<Item = (usize, Mat4, Option<Aabb>)>,
    ) -> Result<(), RayError> {
        self.instances.clear();
        for (part, world_from_mesh, bounds) in instances {
            let Some(mesh) = self.meshes[part] else { continue };
            let mut relative = Affine3A::from_mat4(world_from_mesh);
            relative.translation = (relative.translation.as_dvec3() - self.origin).as_vec3a();
            let from_origin = |corner: Vec3| (corner.as_dvec3() - self.origin).as_vec3();
            let bounds = bounds.map(|aabb| [aabb.min, aabb.max].map(from_origin));
            self.instances.push(RayInstance { bounds, ..RayInstance::new(mesh, relative) });
        }
        self.scene.set_instances(self.origin, &self.instances)
    }

    /// Refits deforming meshes to the positions in their parts' vertex buffers.
    pub(crate) fn refit<'a>(
        &mut self,
        gpu: &Gpu,
        deformed: impl Iterator<Item = (usize, &'a wgpu::Buffer)>,
    ) -> Result<(), RayError> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for (part, buffer) in deformed {
            let Some(mesh) = self.meshes[part] else { continue };
            let vertices = VertexBuffer { buffer, offset: 0, stride: POSITION_STRIDE };
            self.scene.refit(&mut encoder, mesh, &vertices)?;
        }
        gpu.submit([encoder.finish()]);
        Ok(())
    }
}

/// Adds the alpha of an image. An image without texels becomes opaque.
fn add_image(rays: &mut RayScene, image: &Image) -> Result<ImageId, RayError> {
    let alpha: Vec<u8> = image.rgba.chunks_exact(4).map(|texel| texel[3]).collect();
    match AlphaImage::new(image.width, image.height, &alpha) {
        Ok(image) => rays.add_image(image),
        Err(_) => rays.add_image(AlphaImage::new(1, 1, &[255])?),
    }
}

/// Returns the triangles with holes of a primitive.
fn cut_outs(
    scene: &Scene,
    primitive: &Primitive,
    mut image: impl FnMut(usize) -> Result<ImageId, RayError>,
) -> Result<Vec<(u32, CutOut)>, RayError> {
    let material = &scene.materials[primitive.material];
    let Casting::CutOut(cutoff) = scene.casting(primitive) else { return Ok(Vec::new()) };
    let texture = material.base_color_texture;
    let shared = CutMaterial {
        image: texture.map(|texture| image(texture.image)).transpose()?,
        wrap: texture.map_or_else(Default::default, |texture| texture.wrap.map(wrap)),
        nearest: texture.is_some_and(|texture| texture.nearest),
        base_alpha: material.base_color.w,
        cutoff,
    };
    let cut_out = |corners: &[u32; 3]| {
        let vertices = corners.map(|corner| corner as usize);
        let uv = |vertex: usize| {
            let uv = primitive.uvs.get(vertex).copied().unwrap_or(Vec2::ZERO);
            texture.map_or(uv, |texture| texture.in_image(uv))
        };
        let alpha = |vertex: usize| primitive.colors.get(vertex).copied().unwrap_or(Vec4::ONE).w;
        CutOut { uvs: vertices.map(uv), alphas: vertices.map(alpha), material: shared }
    };
    let triangles: Range<u32> = 0..(primitive.indices.len() / 3) as u32;
    Ok(triangles.zip(primitive.indices.as_chunks::<3>().0.iter().map(cut_out)).collect())
}

fn wrap(wrap: shadowfit_scene::Wrap) -> Wrap {
    match wrap {
        shadowfit_scene::Wrap::Repeat => Wrap::Repeat,
        shadowfit_scene::Wrap::Clamp => Wrap::Clamp,
        shadowfit_scene::Wrap::Mirror => Wrap::Mirror,
    }
}
