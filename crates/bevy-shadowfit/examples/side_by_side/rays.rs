//! The scene's triangles and their holes, ready for rays: those that Bevy draws into its maps.

use shadowfit::glam::{DVec3, Vec2, Vec3};
use shadowfit_scene::{Casting, Image, Instance, Primitive};
use shadowfit_truth::{AlphaImage, CutMaterial, CutOut, CutOuts, Tracer, Wrap};

use crate::content::Content;

/// A tracer of everything that casts shadows.
pub(crate) fn tracer(content: &Content) -> Tracer {
    let mut corners: Vec<[Vec3; 3]> = Vec::new();
    let mut cut_outs = Vec::new();
    for instance in content.scene.instances().iter().filter(|instance| content.casts(instance)) {
        let first = corners.len() as u32;
        cut_outs.extend((first..).zip(holes(content, instance)));
        let deformed = content.pose.deform(&content.scene, instance);
        corners.extend(content.pose.corners_from(&content.scene, instance, deformed.as_ref(), DVec3::ZERO));
    }
    let has_holes = !cut_outs.is_empty();
    let images = content.scene.images.iter().filter(|_| has_holes).map(alpha).collect();
    Tracer::new(corners).with_cut_outs(CutOuts::new(images, cut_outs))
}

/// The alpha of an image; one without texels has no holes.
fn alpha(image: &Image) -> AlphaImage {
    let alpha = image.rgba.chunks_exact(4).map(|texel| texel[3]).collect();
    let opaque = || AlphaImage::new(1, 1, vec![255]).expect("one texel for one by one");
    AlphaImage::new(image.width, image.height, alpha).unwrap_or_else(opaque)
}

/// The cut-outs of all triangles of an instance whose material has holes.
fn holes(content: &Content, instance: &Instance) -> Vec<CutOut> {
    let primitive = content.primitive(instance);
    let Casting::CutOut(cutoff) = content.scene.casting(primitive) else { return Vec::new() };
    let is_mirrored = content.pose.is_mirrored(&content.scene, instance);
    // Triangles of mirrored instances have their corners in this order.
    let in_order = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
    let triangles = primitive.indices.as_chunks::<3>().0.iter();
    triangles.map(|corners| hole(content, primitive, in_order(*corners), cutoff)).collect()
}

fn hole(content: &Content, primitive: &Primitive, corners: [u32; 3], cutoff: f32) -> CutOut {
    let material = &content.scene.materials[primitive.material];
    let texture = material.base_color_texture;
    let vertices = corners.map(|corner| corner as usize);
    let uv = |vertex: usize| {
        let uv = primitive.uvs.get(vertex).copied().unwrap_or(Vec2::ZERO);
        texture.map_or(uv, |texture| texture.in_image(uv))
    };
    CutOut {
        uvs: vertices.map(uv),
        alphas: vertices.map(|vertex| Content::color(primitive, vertex).w),
        material: CutMaterial {
            image: texture.map(|texture| texture.image as u32),
            wrap: texture.map_or_else(Default::default, |texture| texture.wrap.map(wrap)),
            nearest: texture.is_some_and(|texture| texture.nearest),
            base_alpha: material.base_color.w,
            cutoff,
        },
    }
}

fn wrap(wrap: shadowfit_scene::Wrap) -> Wrap {
    match wrap {
        shadowfit_scene::Wrap::Repeat => Wrap::Repeat,
        shadowfit_scene::Wrap::Clamp => Wrap::Clamp,
        shadowfit_scene::Wrap::Mirror => Wrap::Mirror,
    }
}
