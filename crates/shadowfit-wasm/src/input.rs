//! The caller's numbers for one frame: the light and the views.

use shadowfit::glam::{DMat4, DVec3, Vec3};
use shadowfit::{DepthConvention, FitError, ViewFrustum};

/// Greatest number of views: two eyes of a headset, and two more.
pub(crate) const MAX_VIEWS: usize = 4;
/// Numbers of a view: the eye, the depth convention, and the matrix from clip space to the world.
const VIEW: usize = 20;
/// Numbers of a frame: the number of views, the direction of the light, and the views.
pub(crate) const INPUT: usize = 4 + MAX_VIEWS * VIEW;

/// The light and the views of a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) direction: Vec3,
    views: [Option<View>; MAX_VIEWS],
}

/// A view as the caller describes it.
#[derive(Clone, Copy, Debug)]
struct View {
    eye: DVec3,
    depth: DepthConvention,
    world_from_clip: DMat4,
}

impl Frame {
    pub(crate) fn read(numbers: &[f64; INPUT]) -> Self {
        let [count, x, y, z, views @ ..] = numbers;
        let mut frame = Self { direction: DVec3::new(*x, *y, *z).as_vec3(), views: [None; MAX_VIEWS] };
        let (views, _) = views.as_chunks::<VIEW>();
        for (view, numbers) in frame.views.iter_mut().zip(views).take(*count as usize) {
            *view = Some(View::read(numbers));
        }
        frame
    }

    /// Computes the frusta up to a view depth. The number of views comes with them.
    pub(crate) fn frusta(&self, distance: f32) -> Result<([ViewFrustum; MAX_VIEWS], usize), FitError> {
        let first = self.views[0].ok_or(FitError::NoView)?.frustum(distance)?;
        let (mut frusta, mut count) = ([first; MAX_VIEWS], 1);
        for (frustum, view) in frusta.iter_mut().zip(self.views.iter().flatten()).skip(1) {
            *frustum = view.frustum(distance)?;
            count += 1;
        }
        Ok((frusta, count))
    }

    /// Returns the first view's matrix to clip space, for positions relative to the eye, and its depth.
    pub(crate) fn clip_from_eye(&self) -> Result<(DMat4, DepthConvention), FitError> {
        let view = self.views[0].ok_or(FitError::NoView)?;
        let eye_from_clip = DMat4::from_translation(-view.eye) * view.world_from_clip;
        Ok((eye_from_clip.inverse(), view.depth))
    }
}

impl View {
    fn read(numbers: &[f64; VIEW]) -> Self {
        let [x, y, z, depth, matrix @ ..] = numbers;
        Self {
            eye: DVec3::new(*x, *y, *z),
            depth: match *depth as u32 {
                0 => DepthConvention::ZeroToOne,
                1 => DepthConvention::NegativeOneToOne,
                _ => DepthConvention::Reversed,
            },
            world_from_clip: DMat4::from_cols_array(matrix),
        }
    }

    fn frustum(&self, distance: f32) -> Result<ViewFrustum, FitError> {
        ViewFrustum::from_world_from_clip_f64(&self.world_from_clip, self.eye, self.depth, distance)
    }
}
