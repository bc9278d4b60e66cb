//! A scene's casters for rays: the same triangles and cut-outs that the renderer draws into the shadow map.

use glam::{DVec3, Vec2, Vec3, Vec4};
use shadowfit_scene::{Casting, Deformed, Image, Instance, Pose, Primitive, Scene};
use shadowfit_truth::{AlphaImage, CutMaterial, CutOut, CutOuts, Tracer, Wrap};

/// The casters of a scene in one pose, as in the shadow pass. Surfaces that cast no shadow are left out.
#[derive(Clone, Debug)]
pub struct SceneRays {
    /// Tracer of the casters' triangles, relative to the origin, in metres. Triangles have the renderer's
    /// numbers.
    pub tracer: Tracer,
    /// World position that rays and triangles are relative to, in metres.
    pub origin: DVec3,
    /// Number of the first triangle of each instance, followed by the total. An instance that casts no shadow
    /// has no triangles.
    firsts: Vec<u32>,
    /// Whether each instance is mirrored. If so, the order of its cut-outs' corners differs.
    mirrored: Vec<bool>,
}

impl SceneRays {
    /// Moves all triangles to another pose of the same scene.
    pub fn set_pose(&mut self, scene: &Scene, pose: &Pose) {
        let casters = Casters::new(scene, pose, self.origin);
        let keeps_cut_outs = casters.firsts == self.firsts && casters.mirrored == self.mirrored;
        if keeps_cut_outs && self.tracer.set_triangles(casters.corners()).is_ok() {
            return;
        }
        // This is another scene.
        *self = Self::from_origin(scene, pose, self.origin);
    }

    /// Prepares a scene's casters in a pose for rays. All positions are relative to `origin`, a world
    /// position in metres. Rays are in f32, exact only for scenes near it.
    pub fn from_origin(scene: &Scene, pose: &Pose, origin: DVec3) -> Self {
        let casters = Casters::new(scene, pose, origin);
        let tracer = Tracer::new(casters.corners()).with_cut_outs(casters.cut_outs());
        Self { tracer, origin, firsts: casters.firsts, mirrored: casters.mirrored }
    }

    /// Returns the instance of a triangle, an index into [`Scene::instances`]; `None` beyond the last
    /// triangle.
    pub fn instance(&self, triangle: u32) -> Option<u32> {
        let instances = self.firsts.len() - 1;
        // An instance without triangles has the same first number as the next one.
        let after = self.firsts.partition_point(|first| *first <= triangle);
        (after <= instances).then(|| after as u32 - 1)
    }
}

/// The casters of a pose, instance by instance.
struct Casters<'a> {
    scene: &'a Scene,
    pose: &'a Pose,
    origin: DVec3,
    instances: Vec<Instance>,
    deformed: Vec<Option<Deformed>>,
    firsts: Vec<u32>,
    mirrored: Vec<bool>,
}

impl<'a> Casters<'a> {
    fn new(scene: &'a Scene, pose: &'a Pose, origin: DVec3) -> Self {
        let instances = scene.instances();
        let mut firsts = vec![0];
        let mut triangles = 0;
        for instance in &instances {
            let primitive = primitive(scene, instance);
            if scene.casting(primitive) != Casting::Nothing {
                triangles += primitive.indices.len() as u32 / 3;
            }
            firsts.push(triangles);
        }
        let deformed = instances.iter().map(|instance| pose.deform(scene, instance)).collect();
        let mirrored = instances.iter().map(|instance| pose.is_mirrored(scene, instance)).collect();
        Self { scene, pose, origin, instances, deformed, firsts, mirrored }
    }

    /// Returns the instances that have triangles, each with its index.
    fn casting(&self) -> impl Iterator<Item = (usize, &Instance)> {
        let casts = |(index, _): &(usize, _)| self.firsts[*index] < self.firsts[*index + 1];
        self.instances.iter().enumerate().filter(casts)
    }

    /// Returns all triangles, in the order of the renderer's numbers.
    fn corners(&self) -> impl Iterator<Item = [Vec3; 3]> {
        let of_instance = |(index, instance): (usize, &Instance)| {
            self.pose.corners_from(self.scene, instance, self.deformed[index].as_ref(), self.origin)
        };
        Counted { left: self.firsts.last().map_or(0, |all| *all as usize), all: self.casting().flat_map(of_instance) }
    }

    /// Returns the masked triangles, and the alpha of their images.
    fn cut_outs(&self) -> CutOuts {
        let masked: Vec<(u32, CutOut)> = self
            .casting()
            .flat_map(|(index, instance)| {
                let primitive = primitive(self.scene, instance);
                let corners = primitive.indices.as_chunks::<3>().0;
                let has_holes = matches!(self.scene.casting(primitive), Casting::CutOut(_));
                let corners = if has_holes { corners } else { &[] };
                // The triangles of mirrored instances have this order.
                let is_mirrored = self.mirrored[index];
                let in_order = move |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
                let cut_out = move |corners: &[u32; 3]| cut_out(self.scene, primitive, in_order(*corners));
                (self.firsts[index]..)
                    .zip(corners)
                    .filter_map(move |(number, corners)| Some((number, cut_out(corners)?)))
            })
            .collect();
        let images = if masked.is_empty() { Vec::new() } else { self.scene.images.iter().map(alpha_image).collect() };
        CutOuts::new(images, masked)
    }
}

/// An iterator that knows its length, so that a list needs only one allocation.
struct Counted<I> {
    all: I,
    left: usize,
}

impl<I: Iterator> Iterator for Counted<I> {
    type Item = I::Item;

    fn next(&mut self) -> Option<I::Item> {
        self.left = self.left.saturating_sub(1);
        self.all.next()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

fn primitive<'a>(scene: &'a Scene, instance: &Instance) -> &'a Primitive {
    &scene.meshes[instance.mesh].primitives[instance.primitive]
}

/// Returns the alpha of an image. An image without texels becomes opaque.
fn alpha_image(image: &Image) -> AlphaImage {
    let alpha = image.rgba.chunks_exact(4).map(|texel| texel[3]).collect();
    let opaque = || AlphaImage::new(1, 1, vec![255]).expect("one texel for one by one");
    AlphaImage::new(image.width, image.height, alpha).unwrap_or_else(opaque)
}

fn cut_out(scene: &Scene, primitive: &Primitive, corners: [u32; 3]) -> Option<CutOut> {
    let material = &scene.materials[primitive.material];
    let Casting::CutOut(cutoff) = scene.casting(primitive) else { return None };
    let texture = material.base_color_texture;
    let vertices = corners.map(|corner| corner as usize);
    let uv = |vertex: usize| {
        let uv = primitive.uvs.get(vertex).copied().unwrap_or(Vec2::ZERO);
        texture.map_or(uv, |texture| texture.in_image(uv))
    };
    Some(CutOut {
        uvs: vertices.map(uv),
        alphas: vertices.map(|vertex| primitive.colors.get(vertex).copied().unwrap_or(Vec4::ONE).w),
        material: CutMaterial {
            image: texture.map(|texture| texture.image as u32),
            wrap: texture.map_or_else(Default::default, |texture| texture.wrap.map(wrap)),
            nearest: texture.is_some_and(|texture| texture.nearest),
            base_alpha: material.base_color.w,
            cutoff,
        },
    })
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
    use glam::DMat4;
    use shadowfit_scene::builtin::default_scene;
    use shadowfit_scene::{AlphaMode, BlendedCasters, Texture};

    use super::*;

    #[test]
    fn each_triangle_is_that_of_the_scene_and_knows_its_instance() {
        let mut scene = Scene { blended_casters: BlendedCasters::Never, ..default_scene() };
        // The surfaces of every second material cast no shadow.
        for material in scene.materials.iter_mut().skip(1).step_by(2) {
            material.alpha = AlphaMode::Blend;
        }
        let (instances, pose, origin) = (scene.instances(), scene.pose(Some(0), 0.8), DVec3::new(3.0, -2.0, 1e3));
        let rays = SceneRays::from_origin(&scene, &pose, origin);
        let casts = |triangle: &shadowfit_scene::Triangle| {
            let instance = &instances[triangle.instance as usize];
            scene.casting(primitive(&scene, instance)) != Casting::Nothing
        };
        let all = pose.triangles_from(&scene, origin);
        let casting: Vec<_> = all.iter().filter(|triangle| casts(triangle)).collect();
        assert!(casting.len() < all.len() && casting.len() == rays.tracer.len());
        for (number, triangle) in (0..).zip(casting) {
            assert_eq!(
                (rays.tracer.corners(number), rays.instance(number)),
                (triangle.vertices, Some(triangle.instance))
            );
        }
        assert_eq!(rays.instance(rays.tracer.len() as u32), None);
    }

    #[test]
    fn holes_stay_where_they_are_in_a_triangle_that_is_mirrored() {
        let scene = shadowfit_scene::builtin::BuiltinScene::Forest.build();
        let mut mirrored = scene.clone();
        for node in mirrored.nodes.iter_mut().filter(|node| node.parent.is_none()) {
            let turned = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * node.rest.matrix();
            node.rest.matrix = Some(turned);
        }
        // Texture coordinates at the corners of each masked triangle, with the corners in any order.
        let places = |rays: &SceneRays, mirror: f32| -> Vec<Vec<[u32; 5]>> {
            let cut_outs = rays.tracer.cut_outs();
            let of_triangle = |triangle: u32| {
                let cut_out = &cut_outs.cut_outs()[cut_outs.index_of(triangle)? as usize];
                let at = rays.tracer.corners(triangle).map(|corner| corner * Vec3::new(mirror, 1.0, 1.0));
                let mut corners: Vec<[u32; 5]> = at
                    .iter()
                    .zip(cut_out.uvs)
                    .map(|(at, uv)| [at.x, at.y, at.z, uv.x, uv.y].map(|number| (number + 0.0).to_bits()))
                    .collect();
                corners.sort_unstable();
                Some(corners)
            };
            (0..rays.tracer.len() as u32).filter_map(of_triangle).collect()
        };
        let pose = scene.pose(None, 0.0);
        let mut rays = SceneRays::from_origin(&scene, &pose, DVec3::ZERO);
        let wanted = places(&rays, 1.0);
        assert!(wanted.len() > 1000, "{}", wanted.len());
        rays.set_pose(&mirrored, &mirrored.pose(None, 0.0));
        let found = places(&rays, -1.0);
        assert!(
            found == wanted,
            "{} of {} differ",
            found.iter().zip(&wanted).filter(|(a, b)| a != b).count(),
            wanted.len()
        );
    }

    #[test]
    fn texture_coordinates_are_turned_and_moved_as_the_texture_says() {
        let texture = Texture {
            image: 0,
            wrap: [shadowfit_scene::Wrap::Clamp; 2],
            nearest: false,
            uv_from_texcoord: [Vec3::new(0.0, 2.0, 0.25), Vec3::new(-1.0, 0.0, 1.0)],
        };
        assert_eq!(texture.in_image(Vec2::new(0.5, 0.125)), Vec2::new(0.5, 0.5));
    }

    #[test]
    fn alpha_that_equals_the_cutoff_blocks_rays_and_blended_surfaces_do_as_masked_ones() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Z];
        let mut scene = Scene::from_objects("sheet", &[vec![corners]]);
        scene.meshes[0].primitives[0].uvs = vec![Vec2::ZERO, Vec2::new(3.7, 0.4), Vec2::new(-0.3, 5.1)];
        let blocks = |scene: &Scene| -> Vec<bool> {
            let rays = SceneRays::from_origin(scene, &scene.pose(None, 0.0), DVec3::ZERO);
            let inside = (1..20).flat_map(|u| (1..20 - u).map(move |v| [u, v].map(|weight| weight as f32 / 20.0)));
            inside.map(|weights| !rays.tracer.is_empty() && rays.tracer.cut_outs().is_opaque(0, weights)).collect()
        };
        for (texel, is_opaque) in [(128, true), (127, false)] {
            let rgba = [255, 255, 255, texel].repeat(9);
            scene.images = vec![Image { name: String::new(), width: 3, height: 3, rgba }];
            let uv_from_texcoord = [Vec3::X, Vec3::Y];
            let wrap = [shadowfit_scene::Wrap::Mirror; 2];
            scene.materials[0].base_color_texture = Some(Texture { image: 0, wrap, nearest: false, uv_from_texcoord });
            for alpha in [AlphaMode::Mask { cutoff: 0.5 }, AlphaMode::Mask { cutoff: 128.0 / 255.0 }, AlphaMode::Blend]
            {
                scene.materials[0].alpha = alpha;
                let found = blocks(&scene);
                assert!(found.iter().all(|blocks| *blocks == is_opaque), "{texel} {alpha:?}: {found:?}");
            }
        }
        scene.materials[0].base_color.w = 0.49;
        assert_eq!(SceneRays::from_origin(&scene, &scene.pose(None, 0.0), DVec3::ZERO).tracer.len(), 0);
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
