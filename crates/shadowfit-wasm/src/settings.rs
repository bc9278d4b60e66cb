//! The caller's settings as a technique, and the parts of them that the core's technique does not hold: the
//! footprint and the bias of the caller's own shader.

use shadowfit::bias::FilterRadius;
use shadowfit::diagnostics::DepthStorage;
use shadowfit::glam::{Vec2, Vec3};
use shadowfit::settings::{FilterKind, MapSelection, SoftRadius, Softness};
use shadowfit::{Bias, Cascades, FitError, LightProjection, Maps, SingleMap, Technique, Windows};

/// Number of settings in the memory, in the order of [`Settings::read`].
pub(crate) const SETTINGS: usize = 15;

/// Form of the bias that the caller's shader can apply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BiasForm {
    ReceiverPlane,
    NormalOffset,
    Constant,
}

/// Settings of a fitter.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    pub(crate) technique: Technique,
    radius: FilterRadius,
    form: BiasForm,
    has_back_faces: bool,
    storage: DepthStorage,
}

impl Settings {
    /// Reads the settings from numbers. Numbers out of range are errors of the fit.
    pub(crate) fn read(numbers: &[f64; SETTINGS]) -> Self {
        let [kind, count, width, height, distance, up_x, up_y, up_z, blend, by_depth, taps, disc, form, faces, storage] =
            numbers.map(|number| number as f32);
        let count = count as u32;
        let selection =
            if by_depth > 0.0 { MapSelection::ViewDepth { overlap: blend } } else { MapSelection::Coverage { blend } };
        let maps: Maps = if kind == 0.0 {
            Windows { count, blend, ..Windows::default() }.into()
        } else if count == 1 {
            SingleMap::default().into()
        } else {
            Cascades { count, selection, ..Cascades::default() }.into()
        };
        let (filter, softness) = filter(taps, disc);
        let mut technique = Technique { filter, softness, ..Technique::default().with_maps(maps) }
            .with_resolution(width as u32, height as u32)
            .with_max_distance(distance.min(f32::MAX));
        technique.fit.up = Vec3::new(up_x, up_y, up_z);
        Self {
            technique,
            radius: FilterRadius { taps, disc: Vec2::splat(disc) },
            form: match form as u32 {
                0 => BiasForm::ReceiverPlane,
                1 => BiasForm::NormalOffset,
                _ => BiasForm::Constant,
            },
            has_back_faces: faces > 0.0,
            storage: match storage as u32 {
                0 => DepthStorage::Float32,
                1 => DepthStorage::Unorm24,
                _ => DepthStorage::Unorm16,
            },
        }
    }

    /// Returns the bias for a map, for shaders that take world positions.
    pub(crate) fn bias(&self, map: &LightProjection) -> Result<Bias, FitError> {
        if self.has_back_faces {
            return Ok(Bias::back_faces(self.storage, map));
        }
        match self.form {
            // Each comparison uses the plane's depth at its own place, so only its own radius counts.
            BiasForm::ReceiverPlane => {
                let one = FilterRadius::taps(self.radius.taps.min(FilterRadius::HARDWARE_2X2.taps));
                Bias::automatic_receiver_plane(one, self.storage, map)
            }
            BiasForm::NormalOffset => Bias::automatic(self.radius, self.storage, map),
            BiasForm::Constant => Bias::automatic_constant(self.radius, self.storage, map, self.technique.fit.up),
        }
    }
}

/// Returns a filter of the core with at least this radius.
fn filter(taps: f32, disc: f32) -> (FilterKind, Softness) {
    let radius = taps + disc;
    let mut hard = FilterKind::ALL.into_iter().filter(|kind| !kind.is_soft());
    if let Some(kind) = hard.find(|kind| kind.filter_radius() >= radius) {
        return (kind, Softness::default());
    }
    // A soft filter whose disc has the same number of texels in every map.
    let texels = radius - FilterKind::Vogel8.filter_radius();
    (FilterKind::Vogel8, Softness { radius: SoftRadius::Metres(0.0), floor: texels, ceiling: texels })
}
