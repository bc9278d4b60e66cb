//! Attachments of the renderer's passes, and the part of a picture that a frame draws.

use glam::{Mat4, Vec2, Vec3};

/// Returns a cleared colour attachment, resolved if there is a resolve target.
pub fn cleared<'a>(
    view: &'a wgpu::TextureView,
    resolve_target: Option<&'a wgpu::TextureView>,
    clear: wgpu::Color,
) -> wgpu::RenderPassColorAttachment<'a> {
    let store = if resolve_target.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target, ops }
}

/// Returns a colour attachment that keeps its content.
pub fn drawn_over(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

/// Returns the camera's depth attachment, reversed: cleared to the far value 0, and stored.
pub fn depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store };
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: Some(ops), stencil_ops: None }
}

/// Returns the camera's depth attachment with its earlier content.
pub(crate) fn kept_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: Some(ops), stencil_ops: None }
}

/// Clamps a scissor rectangle (left, top, width, height, in pixels) to a picture.
pub fn part([x, y, width, height]: [u32; 4], size: [u32; 2]) -> [u32; 4] {
    let [x, y] = [x.min(size[0]), y.min(size[1])];
    [x, y, width.min(size[0] - x), height.min(size[1] - y)]
}

/// Returns the matrix from the clip space of a whole picture to the clip space of a part that fills the
/// screen, with a margin of one pixel.
pub(crate) fn part_from_whole([x, y, width, height]: [u32; 4], size: [u32; 2]) -> Mat4 {
    let [x, y, width, height] = [x, y, width, height].map(|side| side as f32);
    let size = Vec2::from(size.map(|side| side as f32));
    let half = (Vec2::new(width, height) * 0.5 + 1.0) / size;
    let middle = Vec2::new(x + width * 0.5, y + height * 0.5) / size;
    // The middle of the part in clip space, y up.
    let at = Vec2::new(middle.x * 2.0 - 1.0, 1.0 - middle.y * 2.0);
    let scale = Vec3::new(0.5 / half.x, 0.5 / half.y, 1.0);
    Mat4::from_scale(scale) * Mat4::from_translation(-at.extend(0.0))
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;

    #[test]
    fn a_part_ends_with_its_picture() {
        assert_eq!(part([60, 8, 64, u32::MAX], [64, 32]), [60, 8, 4, 24]);
        assert_eq!(part([99, 99, 4, 4], [64, 32]), [64, 32, 0, 0]);
    }

    #[test]
    fn the_corners_of_a_part_lie_just_inside_its_clip_space() {
        let (size, part) = ([64, 32], [16, 4, 8, 10]);
        let matrix = part_from_whole(part, size);
        let ndc = |x: f32, y: f32| matrix * Vec4::new(x / 32.0 - 1.0, 1.0 - y / 16.0, 0.5, 1.0);
        let [inside, edge] = [ndc(16.0, 4.0), ndc(15.0, 3.0)];
        assert!(inside.x > -1.0 && inside.x < -0.7 && inside.y < 1.0 && inside.y > 0.7, "{inside}");
        assert!((edge.x + 1.0).abs() < 1e-6 && (edge.y - 1.0).abs() < 1e-6, "{edge}");
        assert_eq!(ndc(20.0, 9.0).truncate().truncate(), Vec2::ZERO);
    }
}
