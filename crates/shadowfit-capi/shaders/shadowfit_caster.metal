// shadowfit_caster.metal: The positions of casters, for the shaders that draw the maps.
// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL has the comments.
//
// position: world space, relative to the origin of the constants, metres.
//
// float4 shadowfit_caster_position(float3 position, constants)
//     the clip position in the map, for vertex shaders
// float shadowfit_caster_depth(float3 position, constants)
//     the depth to interpolate, for vertex shaders without depth clamp
// float shadowfit_clamped_depth(float depth)
//     the depth to write, for fragment shaders without depth clamp
//
// Constants: ShadowfitCasterConstants of shadowfit.h, struct shadowfit_Caster below.
// `constants` is a constant buffer of the engine's entry point.

#ifndef SHADOWFIT_CASTER_METAL
#define SHADOWFIT_CASTER_METAL

#include <metal_stdlib>
#include <simd/simd.h>
using metal::uint;

struct shadowfit_Caster {
    metal::float4x4 clip_from_world;
    uint clamps_in_fragment;
    uint padding_0_;
    uint padding_1_;
    uint padding_2_;
};

metal::float4 shadowfit_caster_position(
    metal::float3 position,
    constant shadowfit_Caster& shadowfit_caster
) {
    metal::float4x4 _e3 = shadowfit_caster.clip_from_world;
    metal::float4 clip = _e3 * metal::float4(position, 1.0);
    uint _e11 = shadowfit_caster.clamps_in_fragment;
    return metal::float4(clip.xy, (_e11 == 1u) ? 0.5 : clip.z, clip.w);
}

float shadowfit_caster_depth(
    metal::float3 position,
    constant shadowfit_Caster& shadowfit_caster
) {
    metal::float4x4 _e3 = shadowfit_caster.clip_from_world;
    return (_e3 * metal::float4(position, 1.0)).z;
}

float shadowfit_clamped_depth(
    float depth
) {
    return metal::saturate(depth);
}

#endif
