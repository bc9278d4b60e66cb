// shadowfit_caster.hlsl: The positions of casters, for the shaders that draw the maps.
// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL has the comments.
//
// position: world space, relative to the origin of the constants, metres.
//
// float4 shadowfit_caster_position(float3 position)
//     the clip position in the map, for vertex shaders
// float shadowfit_caster_depth(float3 position)
//     the depth to interpolate, for vertex shaders without depth clamp
// float shadowfit_clamped_depth(float depth)
//     the depth to write, for fragment shaders without depth clamp
//
// Constants: ShadowfitCasterConstants of shadowfit.h, struct shadowfit_Caster below.
// Constant buffer: SHADOWFIT_CASTER_REGISTER (b0), which may name a space as well, such as `b0, space1`.

#ifndef SHADOWFIT_CASTER_HLSL
#define SHADOWFIT_CASTER_HLSL


struct shadowfit_Caster {
    row_major float4x4 clip_from_world;
    uint clamps_in_fragment;
    uint padding_0_;
    uint padding_1_;
    uint padding_2_;
};

#ifndef SHADOWFIT_CASTER_REGISTER
#define SHADOWFIT_CASTER_REGISTER b0
#endif
cbuffer shadowfit_CasterBlock : register(SHADOWFIT_CASTER_REGISTER) { shadowfit_Caster shadowfit_caster; }

float4 shadowfit_caster_position(float3 position)
{
    float4x4 _e3 = shadowfit_caster.clip_from_world;
    float4 clip_ = mul(float4(position, 1.0), _e3);
    uint _e11 = shadowfit_caster.clamps_in_fragment;
    return float4(clip_.xy, ((_e11 == 1u) ? 0.5 : clip_.z), clip_.w);
}

float shadowfit_caster_depth(float3 position)
{
    float4x4 _e3 = shadowfit_caster.clip_from_world;
    return mul(float4(position, 1.0), _e3).z;
}

float shadowfit_clamped_depth(float depth)
{
    return saturate(depth);
}

#endif
