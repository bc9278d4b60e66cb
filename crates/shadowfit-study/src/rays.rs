//! A scene's casters for rays: the same triangles and cut-outs that the renderer draws into the shadow map.

use glam::{DVec3, Vec2, Vec4};
use shadowfit_scene::{AlphaMode, Image, Instance, Pose, Primitive, Scene, Texture, Triangle};
use shadowfit_truth::{AlphaImage, CutOut, CutOuts, Tracer, Wrap};

/// The casters of a scene in one pose. Blended surfaces cast nothing and are left out, as in the
/// shadow pass.
#[derive(Clone, Debug)]
pub struct SceneRays {
    /// Answers rays; triangle numbers are those of `triangles`.
    pub tracer: Tracer,
    /// The casters' triangles, relative to the origin, in metres.
    pub triangles: Vec<Triangle>,
    /// World position that rays and triangles are relative to, in metres.
    pub origin: DVec3,
}

impl SceneRays {
    /// Moves everything to another pose of the same scene.
    pub fn set_pose(&mut self, scene: &Scene, pose: &Pose) {
        let triangles = casters(scene, &scene.instances(), pose, self.origin);
        if self.tracer.set_triangles(triangles.iter().map(|triangle| triangle.vertices)).is_err() {
            // It is another scene.
            *self = Self::from_origin(scene, pose, self.origin);
            return;
        }
        self.triangles = triangles;
    }

    /// Makes a scene's casters in a pose ready for rays. `origin` is the world position, in metres, that everything is
    /// relative to: f32 rays are exact only for scenes near it.
    pub fn from_origin(scene: &Scene, pose: &Pose, origin: DVec3) -> Self {
        let instances = scene.instances();
        let triangles = casters(scene, &instances, pose, origin);
        let tracer = Tracer::new(triangles.iter().map(|triangle| triangle.vertices))
            .with_cut_outs(cut_outs(scene, &instances, &triangles));
        Self { tracer, triangles, origin }
    }
}

/// The triangles that cast, in the order of the renderer's numbers.
fn casters(scene: &Scene, instances: &[Instance], pose: &Pose, origin: DVec3) -> Vec<Triangle> {
    let alpha_of = |triangle: &Triangle| material(scene, instances, triangle).alpha;
    pose.triangles_from(scene, origin).into_iter().filter(|triangle| alpha_of(triangle) != AlphaMode::Blend).collect()
}

fn primitive<'a>(scene: &'a Scene, instances: &[Instance], triangle: &Triangle) -> &'a Primitive {
    let instance = &instances[triangle.instance as usize];
    &scene.meshes[instance.mesh].primitives[instance.primitive]
}

fn material<'a>(scene: &'a Scene, instances: &[Instance], triangle: &Triangle) -> &'a shadowfit_scene::Material {
    &scene.materials[primitive(scene, instances, triangle).material]
}

/// The masked triangles of a scene, and the alpha of the images that they have.
fn cut_outs(scene: &Scene, instances: &[Instance], triangles: &[Triangle]) -> CutOuts {
    let masked: Vec<(u32, CutOut)> = (0u32..)
        .zip(triangles)
        .filter_map(|(index, triangle)| Some((index, cut_out(scene, instances, triangle)?)))
        .collect();
    let images = if masked.is_empty() { Vec::new() } else { scene.images.iter().map(alpha_image).collect() };
    CutOuts::new(images, masked)
}

/// The alpha of an image; one without texels has no holes.
fn alpha_image(image: &Image) -> AlphaImage {
    let alpha = image.rgba.chunks_exact(4).map(|texel| texel[3]).collect();
    let opaque = || AlphaImage::new(1, 1, vec![255]).expect("one texel for one by one");
    AlphaImage::new(image.width, image.height, alpha).unwrap_or_else(opaque)
}

fn cut_out(scene: &Scene, instances: &[Instance], triangle: &Triangle) -> Option<CutOut> {
    let primitive = primitive(scene, instances, triangle);
    let material = &scene.materials[primitive.material];
    let AlphaMode::Mask { cutoff } = material.alpha else { return None };
    let texture = material.base_color_texture;
    let vertices = [0, 1, 2].map(|k| primitive.indices[triangle.index as usize * 3 + k] as usize);
    let uv = |vertex: usize| {
        let uv = primitive.uvs.get(vertex).copied().unwrap_or(Vec2::ZERO);
        texture.map_or(uv, |texture| in_image(&texture, uv))
    };
    Some(CutOut {
        uvs: vertices.map(uv),
        alphas: vertices.map(|vertex| primitive.colors.get(vertex).copied().unwrap_or(Vec4::ONE).w),
        base_alpha: material.base_color.w,
        cutoff,
        image: texture.map(|texture| texture.image as u32),
        wrap: texture.map_or_else(Default::default, |texture| texture.wrap.map(wrap)),
        nearest: texture.is_some_and(|texture| texture.nearest),
    })
}

/// Where a mesh's texture coordinates lie in a texture's image.
fn in_image(texture: &Texture, uv: Vec2) -> Vec2 {
    let at = uv.extend(1.0);
    Vec2::new(texture.uv_from_texcoord[0].dot(at), texture.uv_from_texcoord[1].dot(at))
}

fn wrap(wrap: shadowfit_scene::Wrap) -> Wrap {
    match wrap {
        shadowfit_scene::Wrap::Repeat => Wrap::Repeat,
        shadowfit_scene::Wrap::Clamp => Wrap::Clamp,
        shadowfit_scene::Wrap::Mirror => Wrap::Mirror,
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn texture_coordinates_are_turned_and_moved_as_the_texture_says() {
        let texture = Texture {
            image: 0,
            wrap: [shadowfit_scene::Wrap::Clamp; 2],
            nearest: false,
            uv_from_texcoord: [Vec3::new(0.0, 2.0, 0.25), Vec3::new(-1.0, 0.0, 1.0)],
        };
        assert_eq!(in_image(&texture, Vec2::new(0.5, 0.125)), Vec2::new(0.5, 0.5));
    }

    #[test]
    fn images_keep_their_alpha_and_nothing_else() {
        let rgba = [0u8, 255, 7].iter().flat_map(|alpha| [1, 2, 3, *alpha]).collect();
        let image = alpha_image(&Image { name: String::new(), width: 3, height: 1, rgba });
        assert_eq!((image.size(), image.alpha()), ([3, 1], &[0, 255, 7][..]));
        let none = alpha_image(&Image { name: String::new(), width: 0, height: 0, rgba: Vec::new() });
        assert_eq!((none.size(), none.alpha()), ([1, 1], &[255][..]));
    }
}
