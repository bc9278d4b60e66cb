//! The only place where a frame for the viewer's renderer is assembled and its haze is chosen.

use shadowfit::{FittedMap, PerspectiveCamera};
use shadowfit_params::tool::CameraSettings;
use shadowfit_render::{Atmosphere, Culling, Frame, Inset, JudgedPicture, Line, Marks, Overlay, Quad};

use crate::View;

/// What a picture shows besides the shaded scene, and through which camera. By default the view's camera shows the
/// scene with its shadows, and nothing else is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameOptions<'a> {
    /// Camera that shows the scene instead of the view's camera. Points still choose their map from the view's eye.
    pub outside: Option<PerspectiveCamera>,
    /// Which casters are drawn into the maps.
    pub culling: Culling,
    /// What the surfaces show instead of their shading.
    pub overlay: Overlay,
    /// A judged picture, for overlays and marks that show how the shadows were judged.
    pub judged: Option<JudgedPicture<'a>>,
    /// Marks of its wrong pixels.
    pub marks: Option<Marks>,
    /// Lines drawn over the scene.
    pub lines: &'a [Line],
    /// Shadow maps shown in the picture.
    pub insets: &'a [Inset],
    /// Coloured quadrilaterals over picture and insets.
    pub quads: &'a [Quad],
    /// Left, top, width and height of the part of the picture that is drawn, in pixels; all of it if `None`.
    pub scissor: Option<[u32; 4]>,
    /// Whether the maps of the last picture are used again instead of drawn.
    pub maps_stay: bool,
    /// Whether shadows are drawn.
    pub shadows: bool,
    /// Distance that the haze suits, in metres: it becomes as dense there as the default haze at the default camera's
    /// far plane. With `None` it is the far plane of the camera that shows the scene.
    pub sight: Option<f32>,
}

impl Default for FrameOptions<'_> {
    fn default() -> Self {
        Self {
            outside: None,
            culling: Culling::default(),
            overlay: Overlay::default(),
            judged: None,
            marks: None,
            lines: &[],
            insets: &[],
            quads: &[],
            scissor: None,
            maps_stay: false,
            shadows: true,
            sight: None,
        }
    }
}

impl FrameOptions<'_> {
    /// Haze that suits the size of the scene: a chair is not lost in it, and a town has some.
    pub(crate) fn atmosphere(&self, view: &View) -> Atmosphere {
        let atmosphere = Atmosphere::default();
        let sight = self.sight.unwrap_or_else(|| self.outside.unwrap_or(view.camera).far);
        let usual = CameraSettings::default().far;
        Atmosphere { haze_per_metre: atmosphere.haze_per_metre * usual / sight.max(1e-3), ..atmosphere }
    }
}

/// The frame of a view. `atmosphere` is that of the options, which the frame borrows.
pub(crate) fn frame<'a>(
    view: &'a View,
    maps: &'a [FittedMap],
    options: &'a FrameOptions<'a>,
    atmosphere: &'a Atmosphere,
) -> Frame<'a> {
    let camera = options.outside.as_ref().unwrap_or(&view.camera);
    Frame {
        choice: options.outside.map(|_| (view.camera.eye, view.camera.forward.normalize())),
        culling: options.culling,
        overlay: options.overlay,
        judged: options.judged,
        marks: options.marks,
        shadows: options.shadows,
        lines: options.lines,
        insets: options.insets,
        quads: options.quads,
        scissor: options.scissor,
        maps_stay: options.maps_stay,
        ..Frame::new(camera, view.direction, maps, atmosphere)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;

    fn camera(far: f32) -> PerspectiveCamera {
        PerspectiveCamera {
            eye: DVec3::ZERO,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.0,
            near: 0.1,
            far,
        }
    }

    #[test]
    fn haze_thins_with_the_distance_that_it_suits() {
        let view = View { camera: camera(10.0), direction: Vec3::NEG_Y, is_first: true };
        let haze = |options: FrameOptions| options.atmosphere(&view).haze_per_metre;
        let own = haze(FrameOptions::default());
        let near = |value: f32, expected: f32| (value - expected).abs() <= 1e-6 * expected;
        assert!(near(haze(FrameOptions { sight: Some(20.0), ..FrameOptions::default() }), own / 2.0));
        assert!(near(haze(FrameOptions { outside: Some(camera(40.0)), ..FrameOptions::default() }), own / 4.0));
        let usual = View { camera: camera(CameraSettings::default().far), ..view };
        let default = Atmosphere::default().haze_per_metre;
        assert!(near(FrameOptions::default().atmosphere(&usual).haze_per_metre, default));
    }

    #[test]
    fn a_frame_seen_from_outside_keeps_the_eye_that_chooses_the_maps() {
        let view = View { camera: camera(10.0), direction: Vec3::NEG_Y, is_first: true };
        let outside = PerspectiveCamera { eye: DVec3::new(5.0, 6.0, 7.0), ..camera(100.0) };
        let options = FrameOptions { outside: Some(outside), ..FrameOptions::default() };
        let atmosphere = options.atmosphere(&view);
        let drawn = frame(&view, &[], &options, &atmosphere);
        assert_eq!((drawn.camera.eye, drawn.choice), (outside.eye, Some((DVec3::ZERO, Vec3::NEG_Z))));
        let inside = FrameOptions::default();
        assert_eq!(frame(&view, &[], &inside, &atmosphere).choice, None);
    }
}
