//! Settings of a light, and the shadowfit techniques for them.

use std::f32::consts::SQRT_2;

use bevy::light::ShadowFilteringMethod;
use bevy::prelude::*;
use shadowfit::settings::{
    CasterPolicy, FilterKind, FitKind, Hysteresis, MapSelection, MapSettings, Shape, SplitScheme, Stabilise,
};
use shadowfit::{Cascades, DepthConvention, SingleMap, Technique, Windows};

use crate::memory::FitMemory;

/// Settings for a [`DirectionalLight`] with shadow maps. Add this component to the light, and shadowfit fits
/// its cascades for every active [`Camera3d`]. Without it, or after it is removed, the light uses Bevy's
/// cascades.
///
/// The light's [`CascadeShadowConfig`](bevy::light::CascadeShadowConfig) decides the number of cascades, the
/// shadow distance and the overlap of cascades.
/// [`DirectionalLightShadowMap`](bevy::light::DirectionalLightShadowMap) decides the size of the maps.
/// Between `PostUpdate` and the next `First`, the config contains the bounds of this frame's fit (the view
/// depths at which cascades end), as Bevy's renderer requires, and the light contains the biases of the fit.
/// At all other times both contain your values.
///
/// ```
/// use bevy::prelude::*;
/// use bevy_shadowfit::prelude::*;
///
/// fn spawn_sun(mut commands: Commands) {
///     let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
///     let shadows = FittedShadows { fit: Fit::Stable, ..default() };
///     commands.spawn((sun, shadows, Transform::from_xyz(3.0, 8.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y)));
/// }
/// # bevy::ecs::system::assert_is_system(spawn_sun);
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
#[require(FitMemory)]
pub struct FittedShadows {
    /// Fit of the cascades. Default: [`Fit::Windows`].
    pub fit: Fit,
    /// Source of the biases. Default: [`FitBias::Ours`].
    pub bias: FitBias,
    /// Source of the bounds, the view depths at which cascades end. Default: [`FitSplits::Ours`].
    pub splits: FitSplits,
}

/// Fit of the cascades.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum Fit {
    /// Spheres around parts of the view, moved by whole texels like Bevy's own cascades, with bounds up to
    /// the farthest mesh in view. Edges do not crawl.
    Stable,
    /// Smallest rectangles around the meshes in view, held while they are large enough and moved by whole
    /// texels. Nearly as still as [`Self::Stable`], and far sharper. The best fit that Bevy's unmodified
    /// shader can read.
    Calm,
    /// Smallest rectangles around the meshes in view, recomputed in each frame, with bounds from the visible
    /// demand of the previous frame. The sharpest fit that Bevy's unmodified shader can read, but edges crawl
    /// when the camera moves. Use it for single images.
    Histogram,
    /// Windows: square maps perpendicular to the light, on grids that are fixed in the world, each placed
    /// where it improves the most visible pixels. Sharper than [`Self::Histogram`] and nearly as still as
    /// [`Self::Stable`]. A point reads the finest window that covers it. For this, the plugin extends two
    /// functions of Bevy's shader library `shadows.wesl` when it is loaded. All bounds are equal to the last
    /// cascade's bound, and [`FittedShadows::splits`] has no effect. If Bevy's shader differs from the
    /// expected text, this fit behaves like [`Self::Calm`]. The default.
    #[default]
    Windows,
}

/// Source of a light's biases.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum FitBias {
    /// 0.07 m toward the light and 0.8 diagonals of a texel along the normal; with [`Fit::Windows`] 0.02 m and 0.2.
    /// Fewer wrong pixels than with Bevy's defaults. Error of the light is smaller, too, except with [`Fit::Stable`],
    /// where it is a little larger. They suit worlds measured in metres. The default.
    #[default]
    Ours,
    /// Values of [`DirectionalLight::shadow_depth_bias`] and [`DirectionalLight::shadow_normal_bias`]. The shader
    /// of [`Fit::Windows`] also moves the point toward the light by two texels times the tangent of the angle between
    /// the light and the surface's normal, up to a tangent of 3.
    Bevys,
}

/// Source of the bounds of cascades.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum FitSplits {
    /// Bounds that make the coarsest texels on screen as small as possible, over the visible points. With
    /// [`Fit::Stable`], Bevy's spacing up to the farthest mesh in view. The last bound, where shadows end, is
    /// always the config's. The default.
    #[default]
    Ours,
    /// All bounds of the config, unchanged.
    Bevys,
}

/// Distances that the look-up of a light's maps needs, in texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reading {
    /// Greatest distance along an axis from the point of the look-up to a texel that the filter reads.
    pub(crate) reach: f32,
    /// Offset of the point along the surface's normal.
    pub(crate) normal_bias: f32,
}

impl Reading {
    /// Returns the distances for a light and the filters of its views.
    pub(crate) fn new(filters: impl Iterator<Item = ShadowFilteringMethod>, normal_bias: f32) -> Self {
        let reach = filters.map(reach).fold(0.0, f32::max);
        Self { reach, normal_bias: normal_bias.max(0.0) }
    }

    /// Returns the border that a map needs, in texels. Bevy's shader treats points outside it as lit.
    fn border(self) -> f32 {
        // Bevy's renderer scales the bias by the diagonal of a texel, computed from its longer side.
        self.reach + self.normal_bias * SQRT_2 * MAX_WINDOW_RATIO
    }
}

/// Returns the radius of Bevy's filters, in texels.
fn reach(filter: ShadowFilteringMethod) -> f32 {
    match filter {
        ShadowFilteringMethod::Hardware2x2 => FilterKind::Hardware2x2.filter_radius(),
        // The same 6 × 6 texels as in shadowfit's filter.
        ShadowFilteringMethod::Gaussian => FilterKind::Pcf5x5.filter_radius(),
        // The radius of its disc is in metres: 1.5 to 4 texels for texels of 4 to 23 mm, plus one hardware
        // look-up.
        ShadowFilteringMethod::Temporal => 5.0,
    }
}

/// Greatest ratio of a texel's sides. Bevy's biases use only the size of the longer side.
const MAX_TEXEL_RATIO: f32 = 2.0;

/// Ratio of the sides of a window's texel for a sun 15 degrees above the horizon, rounded up.
const MAX_WINDOW_RATIO: f32 = 4.0;

impl Fit {
    fn shape(self) -> Shape {
        match self {
            Self::Stable => Shape::new(FitKind::Sphere),
            Self::Calm | Self::Histogram | Self::Windows => {
                Shape::new(FitKind::Focused).with_max_texel_ratio(MAX_TEXEL_RATIO)
            }
        }
    }

    fn stabilise(self) -> Stabilise {
        match self {
            Self::Stable => Stabilise::Snap { max_oversize: 4.0 },
            Self::Calm | Self::Windows => Stabilise::Hysteresis(Hysteresis::default()),
            Self::Histogram => Stabilise::Off,
        }
    }

    fn scheme(self) -> SplitScheme {
        match self {
            Self::Stable => SplitScheme::FromBoxes,
            Self::Calm | Self::Histogram | Self::Windows => SplitScheme::FromHistogram,
        }
    }

    /// Returns whether the fit uses the histogram of an earlier frame.
    pub(crate) fn uses_histogram(self) -> bool {
        self.scheme() == SplitScheme::FromHistogram
    }

    /// Returns the technique that chooses the bounds of `count` cascades, which end at `max_distance`, in
    /// metres.
    pub(crate) fn for_bounds(self, count: usize, max_distance: f32, resolution: u32, reading: Reading) -> Technique {
        let maps = Cascades {
            count: count as u32,
            shape: self.shape(),
            splits: self.scheme(),
            selection: MapSelection::ViewDepth { overlap: 0.0 },
            stabilise: self.stabilise(),
        };
        technique(resolution, reading).with_maps(maps).with_max_distance(max_distance)
    }

    /// Returns the technique of `count` windows of a view that ends at `max_distance`, in metres.
    pub(crate) fn for_windows(count: usize, max_distance: f32, resolution: u32, reading: Reading) -> Technique {
        let maps = Windows::default().with_count(count as u32);
        technique(resolution, reading).with_maps(maps).with_max_distance(max_distance)
    }

    /// Returns the technique of a single cascade, whose slice of the view is computed beforehand.
    pub(crate) fn for_cascade(self, resolution: u32, reading: Reading) -> Technique {
        technique(resolution, reading).with_maps(SingleMap { shape: self.shape(), stabilise: self.stabilise() })
    }
}

fn technique(resolution: u32, reading: Reading) -> Technique {
    let fit = MapSettings::default()
        .with_depth(DepthConvention::Reversed)
        .with_casters(CasterPolicy::DepthClamp)
        .with_border(reading.border());
    Technique::default().with_fit(fit).with_resolution(resolution, resolution)
}
