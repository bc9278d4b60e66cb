//! What a map is required to hold.

use crate::base::{FitError, checks};
use crate::bias::Reach;
use crate::map::FittedMap;
use crate::technique::Technique;
use crate::technique::settings::{CasterPolicy, FitSettings, MapChoice};
use crate::view::Range;

/// What a map is required to hold: which receivers read it, how far around them, and whether
/// casters before the near plane are clipped.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CoverageQuery {
    /// View depth from which receivers read the map, in metres.
    pub near: f32,
    /// View depth up to which receivers read the map, in metres.
    pub far: f32,
    /// Reach of the filter: of all texels that it reads, the centres must lie in the map. A sampler's
    /// [rounding of texture coordinates](crate::bias::HARDWARE_SNAP) only shifts weights by as much, so it
    /// counts only where [`Reach::on_hardware`] has included it.
    pub reach: Reach,
    /// How far across the light the looked-up point may lie off the receiver, in metres:
    /// [`Bias::normal_offset`](crate::Bias::normal_offset). Along the light it needs no room: what
    /// is looked up before the near plane is lit, as it should be where no caster is lost.
    pub normal_offset: f32,
    /// Which receivers read the map besides those between the view depths. By
    /// [coverage](MapChoice::Coverage) all that lies inside the map may read it, at any depth and in later
    /// frames, so that no caster over any part of it may lie before the near plane; by
    /// [view depth](MapChoice::ViewDepth) only those over the receivers.
    pub choice: MapChoice,
    /// How casters before the near plane are treated: [`CasterPolicy::DepthClamp`] loses none. The
    /// other policies make no difference here.
    pub casters: CasterPolicy,
}

impl CoverageQuery {
    /// What a single map of [`fit_scene`](crate::fits::fit_scene) is made for: all receivers up to the
    /// shadow distance.
    pub const fn of_fit(settings: &FitSettings, reach: Reach) -> Self {
        let (near, far) = (f32::MIN, settings.max_distance);
        let choice = MapChoice::ViewDepth;
        Self { near, far, reach, normal_offset: 0.0, choice, casters: settings.casters }
    }

    /// What one of several maps is made for: the receivers from [`FittedMap::covered_near`] to
    /// [`FittedMap::far`] or the shadow distance. Where maps are read by coverage, proofs for each map of
    /// a frame are a proof for all: every receiver is held by the map of its own depth, and whichever finer
    /// map it reads has all of its casters.
    pub const fn of_map(map: &FittedMap, settings: &Technique, reach: Reach) -> Self {
        let far = map.far.min(settings.fit.max_distance);
        let choice = if settings.shares_maps() { MapChoice::Coverage } else { MapChoice::ViewDepth };
        let near = map.covered_near.min(far);
        Self { near, far, reach, normal_offset: 0.0, choice, casters: settings.fit.casters }
    }

    /// This query with another [`normal_offset`](Self::normal_offset).
    #[must_use]
    pub const fn with_normal_offset(mut self, normal_offset: f32) -> Self {
        self.normal_offset = normal_offset;
        self
    }

    pub(super) fn checked(&self) -> Result<Range, FitError> {
        checks::finite("the query's near distance", f64::from(self.near))?;
        checks::finite("the query's far distance", f64::from(self.far))?;
        checks::within("the query's normal offset", f64::from(self.normal_offset), 0.0, checks::MAX_LENGTH)?;
        self.reach.checked()?;
        if self.near > self.far {
            return Err(FitError::NearNotBelowFar { near: self.near, far: self.far });
        }
        Ok(Range { near: self.near, far: self.far })
    }
}

/// A side of the box that a map stores, in light space: -x, +x, -y, +y, far, near.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MapPlane {
    /// Texture coordinate u = 0.
    Left,
    /// Texture coordinate u = 1.
    Right,
    /// Texture coordinate v = 1.
    Bottom,
    /// Texture coordinate v = 0.
    Top,
    /// Away from the light.
    Far,
    /// Toward the light.
    Near,
}

impl MapPlane {
    /// All planes, in the order of [`LightFit::set_by`](crate::LightFit::set_by).
    pub const ALL: [Self; 6] = [Self::Left, Self::Right, Self::Bottom, Self::Top, Self::Far, Self::Near];
}
