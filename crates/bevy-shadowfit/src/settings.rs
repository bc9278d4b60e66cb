//! What a user sets on a light, and the techniques of shadowfit that follow from it.

use std::f32::consts::SQRT_2;

use bevy::light::ShadowFilteringMethod;
use bevy::prelude::*;
use shadowfit::settings::{
    CasterPolicy, FilterKind, FitKind, Hysteresis, MapSelection, MapSettings, Shape, SplitScheme, Stabilise,
};
use shadowfit::{Cascades, DepthConvention, SingleMap, Technique, Windows};

use crate::memory::FitMemory;

/// Put it beside a [`DirectionalLight`] with shadow maps: its cascades are then fitted by shadowfit, for every active
/// [`Camera3d`]. A light without it stays Bevy's, and so does one from which it is removed.
///
/// How many cascades there are, where shadows end and how far cascades overlap is taken from the light's
/// [`CascadeShadowConfig`](bevy::light::CascadeShadowConfig), how large the maps are from
/// [`DirectionalLightShadowMap`](bevy::light::DirectionalLightShadowMap). Between `PostUpdate` and the next `First`,
/// the config holds the bounds of this frame's fit, as Bevy's renderer needs them, and the light the biases; in between
/// both hold what you set.
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
    /// How the cascades are fitted. Default: [`Fit::Windows`].
    pub fit: Fit,
    /// Whose biases the light has. Default: [`FitBias::Ours`].
    pub bias: FitBias,
    /// Whose bounds the cascades have. Default: [`FitSplits::Ours`].
    pub splits: FitSplits,
}

/// How cascades are fitted.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum Fit {
    /// Spheres around parts of the view, moved by whole texels, as Bevy's own cascades are, with bounds up to the farthest
    /// mesh in view: edges stand still.
    Stable,
    /// Least rectangles around the meshes in view, kept while they serve and moved by whole texels: nearly as still,
    /// and far sharper. The best that Bevy's shader reads by itself.
    Calm,
    /// Least rectangles around the meshes in view, in each frame anew, with bounds by what the frame before showed: the
    /// sharpest of those that Bevy's shader reads by itself, and edges crawl when the camera moves. For pictures that
    /// stand alone.
    Histogram,
    /// Squares of the plane across the light that stand still in the world, each where it helps most of what the frame
    /// before showed: sharper than [`Self::Histogram`] and nearly as still as [`Self::Stable`]. They are read by
    /// coverage: a point reads the finest one that holds it, for which two functions of Bevy's shader library
    /// `shadows.wesl` are extended when it is loaded. All bounds are those of the last cascade, and
    /// [`FittedShadows::splits`] has no effect. Where Bevy's shader is another one, it is [`Self::Calm`]. The default.
    #[default]
    Windows,
}

/// Whose biases a light has.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum FitBias {
    /// 0.05 m toward the light and 0.3 diagonals of a texel along the normal, which have far fewer wrong pixels
    /// than Bevy's defaults with every fit. For worlds in metres. The default.
    #[default]
    Ours,
    /// [`DirectionalLight::shadow_depth_bias`] and [`DirectionalLight::shadow_normal_bias`] as they are set.
    Bevys,
}

/// Whose bounds cascades have.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, Clone, PartialEq)]
pub enum FitSplits {
    /// Those that make the coarsest texels on screen as fine as can be, for what is in view; with [`Fit::Stable`] Bevy's
    /// spacing, up to the farthest mesh in view. The last bound, where shadows end, stays that of the config. The
    /// default.
    #[default]
    Ours,
    /// All bounds of the config as they are set.
    Bevys,
}

/// What a light's maps are read with, in texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reading {
    /// Greatest distance along an axis from the point that is looked up to a texel that the filter reads.
    pub(crate) reach: f32,
    /// Offset of the point along the surface's normal.
    pub(crate) normal_bias: f32,
}

impl Reading {
    /// The reading of a light by the filters of its views.
    pub(crate) fn new(filters: impl Iterator<Item = ShadowFilteringMethod>, normal_bias: f32) -> Self {
        let reach = filters.map(reach).fold(0.0, f32::max);
        Self { reach, normal_bias: normal_bias.max(0.0) }
    }

    /// Free texels that a map needs at its border: beyond it Bevy's shader finds light.
    fn border(self) -> f32 {
        // Bevy's renderer takes the bias in diagonals of texels, and of their longer side.
        self.reach + self.normal_bias * SQRT_2 * MAX_WINDOW_RATIO
    }
}

/// Radius of Bevy's filters, in texels.
fn reach(filter: ShadowFilteringMethod) -> f32 {
    match filter {
        ShadowFilteringMethod::Hardware2x2 => FilterKind::Hardware2x2.filter_radius(),
        // The same 6 × 6 texels as ours.
        ShadowFilteringMethod::Gaussian => FilterKind::Pcf5x5.filter_radius(),
        // Its disc is given in metres: from 1.5 to 4 texels for texels of 4 to 23 mm, one hardware look-up each.
        ShadowFilteringMethod::Temporal => 5.0,
    }
}

/// Greatest ratio of a texel's sides: Bevy's biases know one size only, that of the longer side.
const MAX_TEXEL_RATIO: f32 = 2.0;

/// Ratio of the sides of a window's texel where the sun stands 15 degrees high, rounded up.
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

    /// Whether what an earlier frame showed is of use.
    pub(crate) fn uses_histogram(self) -> bool {
        self.scheme() == SplitScheme::FromHistogram
    }

    /// The technique that chooses the bounds of `count` cascades, which end at `max_distance`, in metres.
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

    /// The technique of `count` windows of a view that ends at `max_distance`, in metres.
    pub(crate) fn for_windows(count: usize, max_distance: f32, resolution: u32, reading: Reading) -> Technique {
        let maps = Windows::default().with_count(count as u32);
        technique(resolution, reading).with_maps(maps).with_max_distance(max_distance)
    }

    /// The technique of a single cascade, whose part of the view is cut out beforehand.
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
