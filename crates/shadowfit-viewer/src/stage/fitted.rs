//! The maps of a view, and the map that a point reads.

use glam::DVec3;
use shadowfit::{Camera, FittedMaps, Technique, ViewFrustum};

/// The maps of a view.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fitted {
    /// The camera of the view, whose view depths select among maps that are read by view depth; `None` if
    /// nothing was fitted.
    pub(crate) camera: Option<Camera>,
    /// The technique that reads the maps.
    pub(crate) technique: Technique,
    /// View depth at which shadows end, in metres.
    pub(crate) end: f32,
    /// The maps, the nearest first.
    pub(crate) maps: FittedMaps,
}

impl Fitted {
    pub(crate) fn new(camera: impl Into<Camera>, technique: &Technique, maps: &FittedMaps) -> Self {
        let camera = camera.into();
        let end = camera.far.min(technique.fit.max_distance);
        Self { camera: Some(camera), technique: *technique, end, maps: *maps }
    }

    /// Returns the part of the view with shadows.
    pub(crate) fn frustum(&self) -> Option<ViewFrustum> {
        self.between(f32::MIN, f32::MAX)
    }

    /// Returns the part of the view that a map serves. By view depth, points in it read this map first.
    /// `None` for a map without a range.
    pub(crate) fn slice(&self, map: usize) -> Option<ViewFrustum> {
        let depths = self.maps.get(map)?.depths?;
        self.between(depths.near as f32, depths.far.map_or(f32::MAX, |far| far as f32))
    }

    fn between(&self, near: f32, far: f32) -> Option<ViewFrustum> {
        let camera = self.camera?;
        camera.frustum().and_then(|frustum| frustum.slice(near.max(camera.near), far.min(self.end))).ok()
    }

    /// Returns the index of the map that a point (world space, metres) reads. If two are blended, returns the
    /// one with the greater weight; `None` if no map covers the point.
    pub(crate) fn read_at(&self, point: DVec3) -> Option<usize> {
        let camera = self.camera?;
        let depth = (point - camera.eye).dot(camera.forward.as_dvec3().normalize());
        self.maps.read(&self.technique, point, depth).map(|read| read.main())
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, Vec3};
    use shadowfit::settings::{MapSelection, SplitScheme};
    use shadowfit::{FitInput, FitState, PerspectiveCamera, Scratch};

    use shadowfit::Cascades;

    use super::*;

    #[test]
    fn points_read_the_map_of_their_view_depth_and_slices_end_with_the_shadows() {
        let camera = PerspectiveCamera {
            eye: DVec3::new(3.0, 2.0, 1.0),
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.5,
            near: 0.5,
            far: 300.0,
        };
        let manual = SplitScheme::Manual([10.0, 30.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let selection = MapSelection::ViewDepth { overlap: 0.0 };
        let cascades = Cascades { count: 3, splits: manual, selection, ..Cascades::default() };
        let technique = Technique::default().with_maps(cascades).with_max_distance(80.0);
        let frustum = [camera.frustum().expect("a frustum")];
        let mut storage = vec![DVec2::ZERO; Scratch::required(0, 3)];
        let input = FitInput::new(&frustum, Vec3::new(0.3, -0.8, 0.2).normalize());
        let maps = FitState::new().fit(&input, &technique, &mut Scratch::new(&mut storage)).expect("maps");
        let fitted = Fitted::new(camera, &technique, &maps);
        let at = |depth: f64| fitted.read_at(camera.eye + DVec3::NEG_Z * depth);
        // By coverage, the first map is read wherever it covers the point, also outside its slice.
        let by_coverage = Fitted {
            technique: technique.with_maps(cascades.with_selection(MapSelection::default())),
            ..fitted.clone()
        };
        let finest = |depth: f64| by_coverage.read_at(camera.eye + DVec3::NEG_Z * depth);
        assert!((10..30).any(|depth| finest(f64::from(depth)) == Some(0)));
        assert_eq!([at(5.0), at(20.0), at(50.0), at(500.0)], [Some(0), Some(1), Some(2), None]);
        let ends = [0, 1, 2, 3].map(|map| fitted.slice(map).map(|slice| [slice.near, slice.far]));
        assert_eq!(ends, [Some([0.5, 10.0]), Some([10.0, 30.0]), Some([30.0, 80.0]), None]);
        assert_eq!(fitted.frustum().map(|frustum| [frustum.near, frustum.far]), Some([0.5, 80.0]));
        assert_eq!(Fitted::default().read_at(camera.eye), None);
    }
}
