//! Random techniques within the ranges of the parameter table.

use proptest::option;
use proptest::prelude::*;
use proptest::sample::select;
use shadowfit::glam::{UVec2, Vec3};
use shadowfit::settings::{
    BiasSettings, CasterPolicy, FilterKind, FitKind, FitSettings, HoldSettings, MAX_MAPS, MapChoice, MapFormat,
    NeedSource, ReceiverSource, RectangleKind, SoftRadius, Softness, SplitScheme, Stabilise,
};
use shadowfit::{DepthConvention, Technique};

/// Any variant of an enum without payloads. Does not compile until a new variant is listed.
macro_rules! any {
    ($name:ident: $($variant:ident),+) => {{
        const _: fn($name) = |value| match value { $($name::$variant => ()),+ };
        select(vec![$($name::$variant),+])
    }};
}

fn any_kind() -> impl Strategy<Value = FitKind> {
    any!(FitKind: XnaSample, FrustumAabb, Oriented, Sphere, Focused, Windows)
}

fn any_resolution() -> impl Strategy<Value = UVec2> {
    let side = || 256_u32..=8192;
    prop_oneof![side().prop_map(UVec2::splat), (side(), side()).prop_map(UVec2::from)]
}

fn any_splits() -> impl Strategy<Value = SplitScheme> {
    const _: fn(SplitScheme) = |value| match value {
        SplitScheme::Uniform
        | SplitScheme::Logarithmic
        | SplitScheme::Practical(_)
        | SplitScheme::Manual(_)
        | SplitScheme::FromBoxes
        | SplitScheme::FromHistogram => (),
    };
    prop_oneof![
        Just(SplitScheme::Uniform),
        Just(SplitScheme::Logarithmic),
        (0.0_f32..=1.0).prop_map(SplitScheme::Practical),
        prop::array::uniform7(0.0_f32..=1e5).prop_map(SplitScheme::Manual),
        Just(SplitScheme::FromBoxes),
        Just(SplitScheme::FromHistogram),
    ]
}

fn any_fit() -> impl Strategy<Value = FitSettings> {
    let rule = (
        any_kind(),
        any!(RectangleKind: AxisAligned, MinimumArea, MinimumSquare),
        any!(CasterPolicy: None, Extend, SceneBounds, List, DepthClamp),
        any!(DepthConvention: ZeroToOne, Reversed, NegativeOneToOne),
    );
    let sizes = (
        prop_oneof![Just(f32::MAX), 1.0_f32..=1e5],
        0.0_f32..=1e3,
        option::of(0.0_f32..=32.0),
        0.0_f32..=1e4,
        prop::array::uniform3(-1.0_f32..=1.0).prop_map(Vec3::from),
        (prop_oneof![Just(f32::MAX), 1.0_f32..=64.0], prop_oneof![Just(0.0), 0.0_f32..=10.0]),
        any_resolution(),
    );
    (rule, sizes).prop_map(
        |(
            (kind, rectangle, casters, depth),
            (max_distance, margin, border, caster_extension, up, (max_texel_ratio, least_texel), resolution),
        )| {
            FitSettings {
                kind,
                rectangle,
                max_distance,
                margin,
                border,
                casters,
                caster_extension,
                up,
                max_texel_ratio,
                least_texel,
                resolution,
                depth,
            }
        },
    )
}

fn any_hold() -> impl Strategy<Value = HoldSettings> {
    (0.0_f32..=10.0, 1.0_f32..=100.0, 1.0_f32..=100.0, 0_u32..=1000)
        .prop_map(|(margin, growth, waste, horizon)| HoldSettings { margin, growth, waste, horizon })
}

fn any_bias() -> impl Strategy<Value = BiasSettings> {
    // Down to a millionth of a texel.
    let texels = || (-20.0_f32..=4.0).prop_map(f32::exp2);
    (texels(), texels(), texels(), texels(), 0.0_f32..=16.0).prop_map(
        |(constant, slope, normal_offset, receiver_plane, depth_steps)| BiasSettings {
            constant,
            slope,
            normal_offset,
            receiver_plane,
            depth_steps,
        },
    )
}

fn any_softness() -> impl Strategy<Value = Softness> {
    const _: fn(SoftRadius) = |value| match value {
        SoftRadius::Metres(_) | SoftRadius::SunAngle(_) => (),
    };
    let radius =
        prop_oneof![(0.0_f32..=10.0).prop_map(SoftRadius::Metres), (0.0_f32..=0.5).prop_map(SoftRadius::SunAngle),];
    (radius, 1.0_f32..=32.0, 0.0_f32..=1.0).prop_map(|(radius, ceiling, share)| Softness {
        radius,
        floor: share * ceiling,
        ceiling,
    })
}

/// Any technique that the parameter table has a value for.
pub(crate) fn any_technique() -> impl Strategy<Value = Technique> {
    let maps = (
        1..=MAX_MAPS as u32,
        any_fit(),
        any_splits(),
        any!(MapChoice: Coverage, ViewDepth),
        (0.0_f32..=64.0, 0.0_f32..=1.0),
        any!(Stabilise: Off, Snap, Hysteresis),
        any_hold(),
    );
    let look_up = (
        any!(ReceiverSource: Objects, Clusters),
        any!(FilterKind: Point, Hardware2x2, Pcf3x3, Pcf5x5, Pcf7x7, Vogel8, Vogel16, Vogel32, Pcss),
        (any_softness(), 0.0_f32..=1.0),
        any_bias(),
        any!(NeedSource: LastFrame, Boxes),
        any!(MapFormat: Depth32Float, Depth16Unorm, R32Float, R16Float, Rgba8Packed, R8Grey),
    );
    (maps, look_up).prop_map(
        |(
            (count, fit, splits, choice, (blend, overlap), stabilise, hold),
            (receivers, filter, (softness, fade), bias, need, format),
        )| Technique {
            count,
            fit,
            splits,
            choice,
            blend,
            overlap,
            stabilise,
            hold,
            receivers,
            filter,
            softness,
            fade,
            bias,
            need,
            format,
        },
    )
}
