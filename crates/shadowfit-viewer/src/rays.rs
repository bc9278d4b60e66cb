//! A scene's casters as rays see them: the same triangles and cut-outs that the renderer draws
//! into the shadow map.

use glam::{Vec2, Vec3, Vec4};
use shadowfit_scene::{AlphaMode, Image, Instance, Pose, Primitive, Scene, Texture, Triangle, Wrap};
use shadowfit_truth::Tracer;

/// The casters of a scene in one pose. Blended surfaces cast nothing and are left out, as in the
/// shadow pass.
#[derive(Debug)]
pub struct SceneRays {
    /// Answers rays; triangle numbers are those of `triangles`.
    pub tracer: Tracer,
    /// The casters' triangles, world space, in metres.
    pub triangles: Vec<Triangle>,
}

impl SceneRays {
    /// Moves everything to another pose of the same scene.
    pub fn set_pose(&mut self, scene: &Scene, pose: &Pose) {
        *self = Self::new(scene, pose);
    }

    /// Builds the rays' view of a scene in a pose.
    pub fn new(scene: &Scene, pose: &Pose) -> Self {
        let instances = scene.instances();
        let alpha_of = |triangle: &Triangle| material(scene, &instances, triangle).alpha;
        let triangles: Vec<Triangle> =
            pose.triangles(scene).into_iter().filter(|triangle| alpha_of(triangle) != AlphaMode::Blend).collect();
        let mut tracer = Tracer::new(triangles.iter().map(|triangle| triangle.vertices));
        let cut_outs = CutOuts::new(scene, &instances, &triangles);
        if !cut_outs.of_triangle.is_empty() {
            tracer = tracer.with_alpha_test(move |triangle, weights| cut_outs.is_there(triangle, weights));
        }
        Self { tracer, triangles }
    }
}

fn primitive<'a>(scene: &'a Scene, instances: &[Instance], triangle: &Triangle) -> &'a Primitive {
    let instance = &instances[triangle.instance as usize];
    &scene.meshes[instance.mesh].primitives[instance.primitive]
}

fn material<'a>(scene: &'a Scene, instances: &[Instance], triangle: &Triangle) -> &'a shadowfit_scene::Material {
    &scene.materials[primitive(scene, instances, triangle).material]
}

/// What is needed to decide whether a masked triangle is there at a point.
struct CutOut {
    /// Texture coordinates and vertex alpha of the three corners.
    corners: [(Vec2, f32); 3],
    cutoff: f32,
    alpha: f32,
    texture: Option<Texture>,
}

/// The masked triangles of a scene.
struct CutOuts {
    of_triangle: std::collections::HashMap<u32, CutOut>,
    images: Vec<Image>,
}

impl CutOuts {
    fn new(scene: &Scene, instances: &[Instance], triangles: &[Triangle]) -> Self {
        let of_triangle: std::collections::HashMap<_, _> = (0u32..)
            .zip(triangles)
            .filter_map(|(index, triangle)| Some((index, cut_out(scene, instances, triangle)?)))
            .collect();
        let images = if of_triangle.is_empty() { Vec::new() } else { scene.images.clone() };
        Self { of_triangle, images }
    }

    fn is_there(&self, triangle: u32, [second, third]: [f32; 2]) -> bool {
        let Some(cut_out) = self.of_triangle.get(&triangle) else { return true };
        let weights = [1.0 - second - third, second, third];
        let corners = cut_out.corners.iter().zip(weights);
        let (uv, vertex_alpha) = corners.fold((Vec2::ZERO, 0.0), |(uv, alpha), (corner, weight)| {
            (uv + corner.0 * weight, alpha + corner.1 * weight)
        });
        let image_alpha = cut_out
            .texture
            .and_then(|texture| Some(sample_alpha(self.images.get(texture.image)?, &texture, uv)))
            .unwrap_or(1.0);
        cut_out.alpha * vertex_alpha * image_alpha >= cut_out.cutoff
    }
}

fn cut_out(scene: &Scene, instances: &[Instance], triangle: &Triangle) -> Option<CutOut> {
    let primitive = primitive(scene, instances, triangle);
    let material = &scene.materials[primitive.material];
    let AlphaMode::Mask { cutoff } = material.alpha else { return None };
    let corner = |k: usize| {
        let vertex = primitive.indices[triangle.index as usize * 3 + k] as usize;
        let color = primitive.colors.get(vertex).copied().unwrap_or(Vec4::ONE);
        (primitive.uvs.get(vertex).copied().unwrap_or(Vec2::ZERO), color.w)
    };
    Some(CutOut {
        corners: [corner(0), corner(1), corner(2)],
        cutoff,
        alpha: material.base_color.w,
        texture: material.base_color_texture,
    })
}

/// Bilinear alpha, 0..=1, of a texture at a mesh's texture coordinates.
fn sample_alpha(image: &Image, texture: &Texture, uv: Vec2) -> f32 {
    let at = Vec3::new(uv.x, uv.y, 1.0);
    let uv = Vec2::new(texture.uv_from_texcoord[0].dot(at), texture.uv_from_texcoord[1].dot(at));
    let size = [image.width as i64, image.height as i64];
    let position = uv * Vec2::new(size[0] as f32, size[1] as f32) - 0.5;
    let (corner, weight) = (position.floor(), position - position.floor());
    let alpha = |dx: i64, dy: i64| {
        let x = wrapped(corner.x as i64 + dx, size[0], texture.wrap[0]);
        let y = wrapped(corner.y as i64 + dy, size[1], texture.wrap[1]);
        f32::from(image.rgba[((y * size[0] + x) * 4 + 3) as usize]) / 255.0
    };
    if texture.nearest {
        return alpha((weight.x >= 0.5).into(), (weight.y >= 0.5).into());
    }
    let row = |dy| alpha(0, dy) * (1.0 - weight.x) + alpha(1, dy) * weight.x;
    row(0) * (1.0 - weight.y) + row(1) * weight.y
}

fn wrapped(index: i64, size: i64, wrap: Wrap) -> i64 {
    match wrap {
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Clamp => index.clamp(0, size - 1),
        Wrap::Mirror => {
            let folded = index.rem_euclid(size * 2);
            folded.min(size * 2 - 1 - folded)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_repeats_mirrors_and_clamps() {
        let row = |wrap| (-3..6).map(|index| wrapped(index, 3, wrap)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 0, 1, 2, 2, 2, 2]);
        assert_eq!(row(Wrap::Mirror), [2, 1, 0, 0, 1, 2, 2, 1, 0]);
    }

    #[test]
    fn alpha_is_interpolated_between_texel_centres() {
        let alphas = [0u8, 255];
        let image = Image {
            name: String::new(),
            width: 2,
            height: 1,
            rgba: alphas.iter().flat_map(|alpha| [0, 0, 0, *alpha]).collect(),
        };
        let texture =
            Texture { image: 0, wrap: [Wrap::Clamp; 2], nearest: false, uv_from_texcoord: [Vec3::X, Vec3::Y] };
        for (u, expected) in [(0.25, 0.0), (0.5, 0.5), (0.75, 1.0), (9.0, 1.0)] {
            assert!((sample_alpha(&image, &texture, Vec2::new(u, 0.5)) - expected).abs() < 1e-6, "{u}");
        }
    }
}
