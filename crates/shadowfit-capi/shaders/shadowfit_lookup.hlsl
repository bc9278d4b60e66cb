// shadowfit_lookup.hlsl: The look-up of shadow maps, for the shaders that light receivers.
// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL has the comments.
//
// position: world space, relative to the origin of the constants, metres. normal: unit, geometric.
// pixel: xy of SV_Position.
//
// float shadowfit_factor_at(float3 position, float3 normal, float2 pixel)
//     the share of the light that reaches a point: 1 lit, 0 in shadow
// float shadowfit_factor(float3 position, float3 normal)
//     the same without rotating the discs of Vogel filters
// int shadowfit_map_index(float3 position)
//     the layer of the map that a point reads, for debug colours; -1 for none
// float shadowfit_view_depth(float3 position)
//     the view depth of a point, in metres
//
// Constants: ShadowfitReceiverConstants of shadowfit.h, struct shadowfit_Receiver below.
// Constant buffer: SHADOWFIT_RECEIVER_REGISTER (b0). Texture: SHADOWFIT_TEXTURE_REGISTER (t0). Sampler:
// SHADOWFIT_SAMPLER_REGISTER (s0). Each may name a space as well, such as `b0, space1`.
//
// The sampler compares with "less or equal", or "greater or equal" for reversed depth. It filters linearly
// (SHADOWFIT_POINT: nearest), repeats, and the texture has one mip level.
//
// Settings, to be defined before this text:
// SHADOWFIT_FILTER         one of the names below, as in the technique
// SHADOWFIT_MAPS           number of maps or more, up to 8; fewer make a shorter shader
// SHADOWFIT_BY_VIEW_DEPTH  1 if points select maps by view depth
// SHADOWFIT_REACH          radius of the filter in texels; Vogel and PCSS: 1 + the greatest softness
// SHADOWFIT_BLEND          width of the blend between maps, in texels

#ifndef SHADOWFIT_LOOKUP_HLSL
#define SHADOWFIT_LOOKUP_HLSL

#define SHADOWFIT_POINT 0
#define SHADOWFIT_PCF_2X2 1
#define SHADOWFIT_PCF_3X3 2
#define SHADOWFIT_PCF_5X5 3
#define SHADOWFIT_PCF_7X7 4
#define SHADOWFIT_VOGEL_8 5
#define SHADOWFIT_VOGEL_16 6
#define SHADOWFIT_VOGEL_32 7
#define SHADOWFIT_PCSS 8
#define SHADOWFIT_PCSS_REVERSED 9
#ifndef SHADOWFIT_FILTER
#define SHADOWFIT_FILTER SHADOWFIT_PCF_5X5
#endif
#ifndef SHADOWFIT_MAPS
#define SHADOWFIT_MAPS 4
#endif
#ifndef SHADOWFIT_BY_VIEW_DEPTH
#define SHADOWFIT_BY_VIEW_DEPTH 0
#endif
#if SHADOWFIT_MAPS > 8
#error SHADOWFIT_MAPS is at most 8
#endif


struct shadowfit_Map {
    row_major float4x4 uv_from_world;
    float3 depth_per_texel_u;
    float constant_depth;
    float3 depth_per_texel_v;
    float slope_depth;
    float2 size;
    float normal_offset;
    float receiver_plane;
    float far;
    float blend_near;
    uint layer;
    uint padding_0_;
    float2 texel_offset;
    float2 disc;
    float2 penumbra;
    uint padding_1_;
    uint padding_2_;
};

struct shadowfit_Receiver {
    float3 to_light;
    uint map_count;
    float4 view;
    float fade_near;
    float fade_width;
    float least_disc;
    float greatest_disc;
    float frame_shift;
    uint is_off;
    uint padding_0_;
    uint padding_1_;
    shadowfit_Map maps[8];
};

#ifndef SHADOWFIT_RECEIVER_REGISTER
#define SHADOWFIT_RECEIVER_REGISTER b0
#endif
#ifndef SHADOWFIT_TEXTURE_REGISTER
#define SHADOWFIT_TEXTURE_REGISTER t0
#endif
#ifndef SHADOWFIT_SAMPLER_REGISTER
#define SHADOWFIT_SAMPLER_REGISTER s0
#endif
cbuffer shadowfit_ReceiverBlock : register(SHADOWFIT_RECEIVER_REGISTER) { shadowfit_Receiver shadowfit_receiver; }
Texture2DArray<float> shadowfit_texture : register(SHADOWFIT_TEXTURE_REGISTER);
SamplerComparisonState shadowfit_sampler : register(SHADOWFIT_SAMPLER_REGISTER);

struct shadowfit_Projected {
    float2 texel;
    float surface;
    float depth;
    float2 gradient;
    uint layer;
    int _pad5_0;
    float2 size;
    float2 texel_offset;
    float2 disc;
    float2 penumbra;
    float2 unit;
};

struct shadowfit_Selection {
    int first;
    int second;
    float weight;
    int clamped;
    float far;
};

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
struct shadowfit_Disc {
    float2 at;
    float2 a;
    float2 b;
    float2 rise;
};
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_PCF_5X5
struct shadowfit_Columns {
    float2 u0_;
    float2 u1_;
    float2 u2_;
    int _pad3_0;
    int _pad3_1;
    float3 weights;
    int _end_pad_0;
};
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_7X7
struct shadowfit_Columns {
    float2 u0_;
    float2 u1_;
    float2 u2_;
    float2 u3_;
    float4 weights;
};
#endif
static const float SHADOWFIT_MIN_COSINE = 0.005;

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8
static const uint SHADOWFIT_TAPS = 8u;
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
static const uint SHADOWFIT_TAPS = 16u;
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32
static const uint SHADOWFIT_TAPS = 32u;
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
static const float SHADOWFIT_LOOK_UP_SQUARE = 0.6666667;
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
static const uint SHADOWFIT_SEARCH = 20u;
static const float SHADOWFIT_SEARCH_START = 0.5;
static const float SHADOWFIT_SEARCH_BESIDE = 0.5;
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_POINT
#ifndef SHADOWFIT_REACH
#define SHADOWFIT_REACH 0.5
#endif
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_2X2
#ifndef SHADOWFIT_REACH
#define SHADOWFIT_REACH 1.0
#endif
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_3X3
#ifndef SHADOWFIT_REACH
#define SHADOWFIT_REACH 2.0
#endif
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_5X5
#ifndef SHADOWFIT_REACH
#define SHADOWFIT_REACH 3.0
#endif
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_7X7
#ifndef SHADOWFIT_REACH
#define SHADOWFIT_REACH 4.0
#endif
#else
#ifndef SHADOWFIT_REACH
#define SHADOWFIT_REACH 17.0
#endif
#endif

#if SHADOWFIT_BY_VIEW_DEPTH
#ifndef SHADOWFIT_BLEND
#define SHADOWFIT_BLEND 0.0
#endif
#else
#ifndef SHADOWFIT_BLEND
#define SHADOWFIT_BLEND 8.0
#endif
#endif

bool shadowfit_inside(float3 uv)
{
    bool local = (bool)0;

    if (all((uv >= (0.0).xxx))) {
        local = all((uv <= (1.0).xxx));
    } else {
        local = false;
    }
    bool _e12 = local;
    return _e12;
}

uint2 shadowfit_NagaDepthDimensions2DArray(Texture2DArray<float> tex)
{
    uint4 ret;
    tex.GetDimensions(0, ret.x, ret.y, ret.z, ret.w);
    return ret.xy;
}

float2 shadowfit_unit()
{
    return ((1.0).xx / float2(shadowfit_NagaDepthDimensions2DArray(shadowfit_texture)));
}

shadowfit_Projected Constructshadowfit_Projected(float2 arg0, float arg1, float arg2, float2 arg3, uint arg4, float2 arg5, float2 arg6, float2 arg7, float2 arg8, float2 arg9) {
    shadowfit_Projected ret = (shadowfit_Projected)0;
    ret.texel = arg0;
    ret.surface = arg1;
    ret.depth = arg2;
    ret.gradient = arg3;
    ret.layer = arg4;
    ret.size = arg5;
    ret.texel_offset = arg6;
    ret.disc = arg7;
    ret.penumbra = arg8;
    ret.unit = arg9;
    return ret;
}

shadowfit_Projected shadowfit_project(shadowfit_Map map, float3 position, float3 normal)
{
    float3 _e5 = shadowfit_receiver.to_light;
    float cosine = clamp(dot(normal, _e5), SHADOWFIT_MIN_COSINE, 1.0);
    float sine = sqrt((1.0 - (cosine * cosine)));
    float3 offset = (normal * (map.normal_offset * sine));
    float3 uv = mul(float4((position + offset), 1.0), map.uv_from_world).xyz;
    float2 gradient = (float2(dot(map.depth_per_texel_u, normal), dot(map.depth_per_texel_v, normal)) / (cosine).xx);
    float rise = (map.receiver_plane * (abs(gradient.x) + abs(gradient.y)));
    float depth = (((uv.z + map.constant_depth) + ((map.slope_depth * sine) / cosine)) + rise);
    const float2 _e54 = shadowfit_unit();
    const shadowfit_Projected shadowfit_projected = Constructshadowfit_Projected((uv.xy * map.size), uv.z, depth, gradient, map.layer, map.size, map.texel_offset, map.disc, map.penumbra, _e54);
    return shadowfit_projected;
}

float shadowfit_view_depth(float3 position)
{
    float4 _e3 = shadowfit_receiver.view;
    float _e9 = shadowfit_receiver.view.w;
    return (dot(_e3.xyz, position) + _e9);
}

float shadowfit_free(uint entry, shadowfit_Map map, float3 position)
{
    bool local = (bool)0;

    float3 uv = mul(float4(position, 1.0), map.uv_from_world).xyz;
    float2 free = (min(uv.xy, ((1.0).xx - uv.xy)) * map.size);
    uint _e18 = shadowfit_receiver.map_count;
    if (entry < _e18) {
        const bool _e22 = shadowfit_inside(uv);
        local = _e22;
    } else {
        local = false;
    }
    bool is_held = local;
    return (is_held ? min(free.x, free.y) : -1.0);
}

#if SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
float shadowfit_load(uint layer, int2 texel)
{
    float _e5 = shadowfit_texture.Load(int4(texel, int(layer), int(0))).x;
    return _e5;
}

int2 shadowfit_naga_f2i32(float2 value) {
    return int2(clamp(value, -2147483600.0, 2147483500.0));
}

float shadowfit_stored_texel(float2 texel, shadowfit_Projected projected)
{
    float2 ended = (texel - (projected.size * float2((texel >= projected.size))));
    float2 stored = (ended + (projected.size * float2((texel < (0.0).xx))));
    const float _e17 = shadowfit_load(projected.layer, shadowfit_naga_f2i32(stored));
    return _e17;
}
#endif

float shadowfit_look_up_at(float2 at, float depth, shadowfit_Projected projected)
{
    float _e8 = shadowfit_texture.SampleCmpLevelZero(shadowfit_sampler, float3(at, int(projected.layer)), saturate(depth));
    return _e8;
}

float2 shadowfit_along(float at, float point_, float gradient, float size, float texel_offset, float unit)
{
    float inside = clamp(at, 0.5, (size - 0.5));
    float shifted = (inside + texel_offset);
    return float2((((shifted >= size) ? (shifted - size) : shifted) * unit), (gradient * (inside - point_)));
}

float2 shadowfit_along_u(float at, shadowfit_Projected p)
{
    const float2 _e12 = shadowfit_along(at, p.texel.x, p.gradient.x, p.size.x, p.texel_offset.x, p.unit.x);
    return _e12;
}

float2 shadowfit_along_v(float at, shadowfit_Projected p)
{
    const float2 _e12 = shadowfit_along(at, p.texel.y, p.gradient.y, p.size.y, p.texel_offset.y, p.unit.y);
    return _e12;
}

float shadowfit_tap(float2 u, float2 v, shadowfit_Projected projected)
{
    const float _e11 = shadowfit_look_up_at(float2(u.x, v.x), ((projected.depth + u.y) + v.y), projected);
    return _e11;
}

float shadowfit_look_up(float2 texel, shadowfit_Projected projected)
{
    const float2 _e3 = shadowfit_along_u(texel.x, projected);
    const float2 _e5 = shadowfit_along_v(texel.y, projected);
    const float _e6 = shadowfit_tap(_e3, _e5, projected);
    return _e6;
}

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
float2 shadowfit_golden(float2 direction)
{
    float2 turn = float2(-0.7373689, 0.6754903);
    return float2(((direction.x * turn.x) - (direction.y * turn.y)), ((direction.x * turn.y) + (direction.y * turn.x)));
}

float shadowfit_disc_tap(shadowfit_Disc disc, float2 place, shadowfit_Projected projected)
{
    const float _e16 = shadowfit_look_up_at(((disc.at + (disc.a * place.x)) + (disc.b * place.y)), (projected.depth + dot(disc.rise, place)), projected);
    return _e16;
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8
float shadowfit_disc_taps(shadowfit_Disc disc, shadowfit_Projected projected)
{
    float sum = 0.0;

    float _e4 = sum;
    const float _e8 = shadowfit_disc_tap(disc, float2(0.25, 0.0), projected);
    sum = (_e4 + _e8);
    float _e10 = sum;
    const float _e14 = shadowfit_disc_tap(disc, float2(-0.3192901, 0.29249588), projected);
    sum = (_e10 + _e14);
    float _e16 = sum;
    const float _e20 = shadowfit_disc_tap(disc, float2(0.048872467, -0.55687654), projected);
    sum = (_e16 + _e20);
    float _e22 = sum;
    const float _e26 = shadowfit_disc_tap(disc, float2(0.40244448, 0.52491754), projected);
    sum = (_e22 + _e26);
    float _e28 = sum;
    const float _e32 = shadowfit_disc_tap(disc, float2(-0.7385351, -0.13063647), projected);
    sum = (_e28 + _e32);
    float _e34 = sum;
    const float _e38 = shadowfit_disc_tap(disc, float2(0.6996049, -0.4450314), projected);
    sum = (_e34 + _e38);
    float _e40 = sum;
    const float _e44 = shadowfit_disc_tap(disc, float2(-0.23400415, 0.8704838), projected);
    sum = (_e40 + _e44);
    float _e46 = sum;
    const float _e50 = shadowfit_disc_tap(disc, float2(-0.4462713, -0.85926825), projected);
    sum = (_e46 + _e50);
    float _e52 = sum;
    return _e52;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
float shadowfit_disc_taps(shadowfit_Disc disc, shadowfit_Projected projected)
{
    float sum = 0.0;

    float _e4 = sum;
    const float _e8 = shadowfit_disc_tap(disc, float2(0.17677669, 0.0), projected);
    sum = (_e4 + _e8);
    float _e10 = sum;
    const float _e14 = shadowfit_disc_tap(disc, float2(-0.22577219, 0.20682582), projected);
    sum = (_e10 + _e14);
    float _e16 = sum;
    const float _e20 = shadowfit_disc_tap(disc, float2(0.03455805, -0.39377117), projected);
    sum = (_e16 + _e20);
    float _e22 = sum;
    const float _e26 = shadowfit_disc_tap(disc, float2(0.28457123, 0.37117276), projected);
    sum = (_e22 + _e26);
    float _e28 = sum;
    const float _e32 = shadowfit_disc_tap(disc, float2(-0.5222232, -0.09237393), projected);
    sum = (_e28 + _e32);
    float _e34 = sum;
    const float _e38 = shadowfit_disc_tap(disc, float2(0.4946954, -0.31468472), projected);
    sum = (_e34 + _e38);
    float _e40 = sum;
    const float _e44 = shadowfit_disc_tap(disc, float2(-0.16546592, 0.615525), projected);
    sum = (_e40 + _e44);
    float _e46 = sum;
    const float _e50 = shadowfit_disc_tap(disc, float2(-0.31556147, -0.60759443), projected);
    sum = (_e46 + _e50);
    float _e52 = sum;
    const float _e56 = shadowfit_disc_tap(disc, float2(0.68464214, 0.25003022), projected);
    sum = (_e52 + _e56);
    float _e58 = sum;
    const float _e62 = shadowfit_disc_tap(disc, float2(-0.7122561, 0.29400897), projected);
    sum = (_e58 + _e62);
    float _e64 = sum;
    const float _e68 = shadowfit_disc_tap(disc, float2(0.3433545, -0.73372865), projected);
    sum = (_e64 + _e68);
    float _e70 = sum;
    const float _e74 = shadowfit_disc_tap(disc, float2(0.25373024, 0.808932), projected);
    sum = (_e70 + _e74);
    float _e76 = sum;
    const float _e80 = shadowfit_disc_tap(disc, float2(-0.7647459, -0.44318587), projected);
    sum = (_e76 + _e80);
    float _e82 = sum;
    const float _e86 = shadowfit_disc_tap(disc, float2(0.897134, -0.1972324), projected);
    sum = (_e82 + _e86);
    float _e88 = sum;
    const float _e92 = shadowfit_disc_tap(disc, float2(-0.5475069, 0.77877223), projected);
    sum = (_e88 + _e92);
    float _e94 = sum;
    const float _e98 = shadowfit_disc_tap(disc, float2(-0.12648678, -0.9760897), projected);
    sum = (_e94 + _e98);
    float _e100 = sum;
    return _e100;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32
float shadowfit_disc_taps(shadowfit_Disc disc, shadowfit_Projected projected)
{
    float sum = 0.0;

    float _e4 = sum;
    const float _e8 = shadowfit_disc_tap(disc, float2(0.125, 0.0), projected);
    sum = (_e4 + _e8);
    float _e10 = sum;
    const float _e14 = shadowfit_disc_tap(disc, float2(-0.15964505, 0.14624794), projected);
    sum = (_e10 + _e14);
    float _e16 = sum;
    const float _e20 = shadowfit_disc_tap(disc, float2(0.024436234, -0.27843827), projected);
    sum = (_e16 + _e20);
    float _e22 = sum;
    const float _e26 = shadowfit_disc_tap(disc, float2(0.20122224, 0.26245877), projected);
    sum = (_e22 + _e26);
    float _e28 = sum;
    const float _e32 = shadowfit_disc_tap(disc, float2(-0.36926755, -0.065318234), projected);
    sum = (_e28 + _e32);
    float _e34 = sum;
    const float _e38 = shadowfit_disc_tap(disc, float2(0.34980246, -0.2225157), projected);
    sum = (_e34 + _e38);
    float _e40 = sum;
    const float _e44 = shadowfit_disc_tap(disc, float2(-0.11700208, 0.4352419), projected);
    sum = (_e40 + _e44);
    float _e46 = sum;
    const float _e50 = shadowfit_disc_tap(disc, float2(-0.22313565, -0.42963412), projected);
    sum = (_e46 + _e50);
    float _e52 = sum;
    const float _e56 = shadowfit_disc_tap(disc, float2(0.48411512, 0.17679806), projected);
    sum = (_e52 + _e56);
    float _e58 = sum;
    const float _e62 = shadowfit_disc_tap(disc, float2(-0.5036411, 0.20789573), projected);
    sum = (_e58 + _e62);
    float _e64 = sum;
    const float _e68 = shadowfit_disc_tap(disc, float2(0.2427883, -0.51882446), projected);
    sum = (_e64 + _e68);
    float _e70 = sum;
    const float _e74 = shadowfit_disc_tap(disc, float2(0.17941438, 0.5720013), projected);
    sum = (_e70 + _e74);
    float _e76 = sum;
    const float _e80 = shadowfit_disc_tap(disc, float2(-0.540757, -0.31337973), projected);
    sum = (_e76 + _e80);
    float _e82 = sum;
    const float _e86 = shadowfit_disc_tap(disc, float2(0.63436955, -0.13946436), projected);
    sum = (_e82 + _e86);
    float _e88 = sum;
    const float _e92 = shadowfit_disc_tap(disc, float2(-0.38714585, 0.55067515), projected);
    sum = (_e88 + _e92);
    float _e94 = sum;
    const float _e98 = shadowfit_disc_tap(disc, float2(-0.08943965, -0.6901997), projected);
    sum = (_e94 + _e98);
    float _e100 = sum;
    const float _e104 = shadowfit_disc_tap(disc, float2(0.5490717, 0.46275827), projected);
    sum = (_e100 + _e104);
    float _e106 = sum;
    const float _e110 = shadowfit_disc_tap(disc, float2(-0.7388785, 0.030554945), projected);
    sum = (_e106 + _e110);
    float _e112 = sum;
    const float _e116 = shadowfit_disc_tap(disc, float2(0.53895515, -0.5363323), projected);
    sum = (_e112 + _e116);
    float _e118 = sum;
    const float _e122 = shadowfit_disc_tap(disc, float2(-0.036058187, 0.77979153), projected);
    sum = (_e118 + _e122);
    float _e124 = sum;
    const float _e128 = shadowfit_disc_tap(disc, float2(-0.51281756, -0.6145268), projected);
    sum = (_e124 + _e128);
    float _e130 = sum;
    const float _e134 = shadowfit_disc_tap(disc, float2(0.8123596, 0.109301835), projected);
    sum = (_e130 + _e134);
    float _e136 = sum;
    const float _e140 = shadowfit_disc_tap(disc, float2(-0.6883106, 0.47890863), projected);
    sum = (_e136 + _e140);
    float _e142 = sum;
    const float _e146 = shadowfit_disc_tap(disc, float2(0.18808606, -0.83606136), projected);
    sum = (_e142 + _e146);
    float _e148 = sum;
    const float _e152 = shadowfit_disc_tap(disc, float2(0.43503326, 0.75919104), projected);
    sum = (_e148 + _e152);
    float _e154 = sum;
    const float _e158 = shadowfit_disc_tap(disc, float2(-0.8504484, -0.27131623), projected);
    sum = (_e154 + _e158);
    float _e160 = sum;
    const float _e164 = shadowfit_disc_tap(disc, float2(0.8261024, -0.38168025), projected);
    sum = (_e160 + _e164);
    float _e166 = sum;
    const float _e170 = shadowfit_disc_tap(disc, float2(-0.3578882, 0.8551556), projected);
    sum = (_e166 + _e170);
    float _e172 = sum;
    const float _e176 = shadowfit_disc_tap(disc, float2(-0.31940734, -0.88803375), projected);
    sum = (_e172 + _e176);
    float _e178 = sum;
    const float _e182 = shadowfit_disc_tap(disc, float2(0.84990865, 0.44668815), projected);
    sum = (_e178 + _e182);
    float _e184 = sum;
    const float _e188 = shadowfit_disc_tap(disc, float2(-0.94403464, 0.2488445), projected);
    sum = (_e184 + _e188);
    float _e190 = sum;
    const float _e194 = shadowfit_disc_tap(disc, float2(0.5365958, -0.83452976), projected);
    sum = (_e190 + _e194);
    float _e196 = sum;
    return _e196;
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
shadowfit_Disc Constructshadowfit_Disc(float2 arg0, float2 arg1, float2 arg2, float2 arg3) {
    shadowfit_Disc ret = (shadowfit_Disc)0;
    ret.at = arg0;
    ret.a = arg1;
    ret.b = arg2;
    ret.rise = arg3;
    return ret;
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8
float shadowfit_disc(float2 radii, shadowfit_Projected projected, float turn)
{
    float2 direction = (float2)0;
    float sum = 0.0;
    bool local = (bool)0;
    uint tap = 0u;

    direction = float2(cos(turn), sin(turn));
    float2 least = (radii + (0.5).xx);
    if (all((projected.texel >= least))) {
        local = all((projected.texel <= (projected.size - least)));
    } else {
        local = false;
    }
    bool _e23 = local;
    if (_e23) {
        float2 _e24 = direction;
        float2 a = (radii * _e24);
        float _e27 = direction.y;
        float _e30 = direction.x;
        float2 b = (radii * float2(-(_e27), _e30));
        const float2 _e35 = shadowfit_along_u(projected.texel.x, projected);
        const float2 _e39 = shadowfit_along_v(projected.texel.y, projected);
        float2 at = float2(_e35.x, _e39.x);
        float2 rise = float2(dot(projected.gradient, a), dot(projected.gradient, b));
        shadowfit_Disc disc = Constructshadowfit_Disc(at, (a * projected.unit), (b * projected.unit), rise);
        const float _e52 = shadowfit_disc_taps(disc, projected);
        sum = _e52;
    } else {
        bool loop_init = true;
        while(true) {
            if (!loop_init) {
                uint _e75 = tap;
                tap = (_e75 + 1u);
            }
            loop_init = false;
            uint _e55 = tap;
            if (_e55 < SHADOWFIT_TAPS) {
            } else {
                break;
            }
            {
                uint _e58 = tap;
                float radius = sqrt(((float(_e58) + 0.5) / 8.0));
                float _e65 = sum;
                float2 _e68 = direction;
                const float _e71 = shadowfit_look_up((projected.texel + ((radii * radius) * _e68)), projected);
                sum = (_e65 + _e71);
                float2 _e73 = direction;
                const float2 _e74 = shadowfit_golden(_e73);
                direction = _e74;
            }
        }
    }
    float _e78 = sum;
    return (_e78 / 8.0);
}
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
float shadowfit_disc(float2 radii, shadowfit_Projected projected, float turn)
{
    float2 direction = (float2)0;
    float sum = 0.0;
    bool local = (bool)0;
    uint tap = 0u;

    direction = float2(cos(turn), sin(turn));
    float2 least = (radii + (0.5).xx);
    if (all((projected.texel >= least))) {
        local = all((projected.texel <= (projected.size - least)));
    } else {
        local = false;
    }
    bool _e23 = local;
    if (_e23) {
        float2 _e24 = direction;
        float2 a = (radii * _e24);
        float _e27 = direction.y;
        float _e30 = direction.x;
        float2 b = (radii * float2(-(_e27), _e30));
        const float2 _e35 = shadowfit_along_u(projected.texel.x, projected);
        const float2 _e39 = shadowfit_along_v(projected.texel.y, projected);
        float2 at = float2(_e35.x, _e39.x);
        float2 rise = float2(dot(projected.gradient, a), dot(projected.gradient, b));
        shadowfit_Disc disc = Constructshadowfit_Disc(at, (a * projected.unit), (b * projected.unit), rise);
        const float _e52 = shadowfit_disc_taps(disc, projected);
        sum = _e52;
    } else {
        bool loop_init = true;
        while(true) {
            if (!loop_init) {
                uint _e75 = tap;
                tap = (_e75 + 1u);
            }
            loop_init = false;
            uint _e55 = tap;
            if (_e55 < SHADOWFIT_TAPS) {
            } else {
                break;
            }
            {
                uint _e58 = tap;
                float radius = sqrt(((float(_e58) + 0.5) / 16.0));
                float _e65 = sum;
                float2 _e68 = direction;
                const float _e71 = shadowfit_look_up((projected.texel + ((radii * radius) * _e68)), projected);
                sum = (_e65 + _e71);
                float2 _e73 = direction;
                const float2 _e74 = shadowfit_golden(_e73);
                direction = _e74;
            }
        }
    }
    float _e78 = sum;
    return (_e78 / 16.0);
}
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32
float shadowfit_disc(float2 radii, shadowfit_Projected projected, float turn)
{
    float2 direction = (float2)0;
    float sum = 0.0;
    bool local = (bool)0;
    uint tap = 0u;

    direction = float2(cos(turn), sin(turn));
    float2 least = (radii + (0.5).xx);
    if (all((projected.texel >= least))) {
        local = all((projected.texel <= (projected.size - least)));
    } else {
        local = false;
    }
    bool _e23 = local;
    if (_e23) {
        float2 _e24 = direction;
        float2 a = (radii * _e24);
        float _e27 = direction.y;
        float _e30 = direction.x;
        float2 b = (radii * float2(-(_e27), _e30));
        const float2 _e35 = shadowfit_along_u(projected.texel.x, projected);
        const float2 _e39 = shadowfit_along_v(projected.texel.y, projected);
        float2 at = float2(_e35.x, _e39.x);
        float2 rise = float2(dot(projected.gradient, a), dot(projected.gradient, b));
        shadowfit_Disc disc = Constructshadowfit_Disc(at, (a * projected.unit), (b * projected.unit), rise);
        const float _e52 = shadowfit_disc_taps(disc, projected);
        sum = _e52;
    } else {
        bool loop_init = true;
        while(true) {
            if (!loop_init) {
                uint _e75 = tap;
                tap = (_e75 + 1u);
            }
            loop_init = false;
            uint _e55 = tap;
            if (_e55 < SHADOWFIT_TAPS) {
            } else {
                break;
            }
            {
                uint _e58 = tap;
                float radius = sqrt(((float(_e58) + 0.5) / 32.0));
                float _e65 = sum;
                float2 _e68 = direction;
                const float _e71 = shadowfit_look_up((projected.texel + ((radii * radius) * _e68)), projected);
                sum = (_e65 + _e71);
                float2 _e73 = direction;
                const float2 _e74 = shadowfit_golden(_e73);
                direction = _e74;
            }
        }
    }
    float _e78 = sum;
    return (_e78 / 32.0);
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_PCSS
float2 shadowfit_casters(shadowfit_Projected projected, float turn)
{
    float radius = (float)0;
    float2 direction = (float2)0;
    float2 found = (0.0).xx;
    uint tap = 0u;
    bool local = (bool)0;

    float2 last = (projected.size - (1.0).xx);
    float start = min((SHADOWFIT_SEARCH_START / max(projected.disc.x, projected.disc.y)), 1.0);
    float growth = pow((1.0 / start), 0.05);
    radius = (start * sqrt(growth));
    direction = float2(cos(turn), sin(turn));
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e95 = tap;
            tap = (_e95 + 1u);
        }
        loop_init = false;
        uint _e31 = tap;
        if (_e31 < SHADOWFIT_SEARCH) {
        } else {
            break;
        }
        {
            float _e36 = radius;
            float2 _e38 = direction;
            float2 texel_1 = clamp(floor((projected.texel + ((projected.disc * _e36) * _e38))), (0.0).xx, last);
            float2 offset = ((texel_1 + (0.5).xx) - projected.texel);
            const float _e52 = shadowfit_stored_texel((texel_1 + projected.texel_offset), projected);
            float distance_ = (projected.surface - _e52);
            float _e59 = shadowfit_receiver.least_disc;
            float2 cone = max((distance_ * projected.penumbra), (_e59).xx);
            float2 radii = (cone + (0.5).xx);
            float2 place = (offset * radii.yx);
            bool is_within = (dot(place, place) <= (((radii.x * radii.x) * radii.y) * radii.y));
            bool is_lit = (saturate((projected.depth + dot(projected.gradient, offset))) <= _e52);
            if (is_within) {
                local = !(is_lit);
            } else {
                local = false;
            }
            bool _e86 = local;
            if (_e86) {
                float2 _e87 = found;
                found = (_e87 + float2(distance_, 1.0));
            }
            float _e91 = radius;
            radius = (_e91 * growth);
            float2 _e93 = direction;
            const float2 _e94 = shadowfit_golden(_e93);
            direction = _e94;
        }
    }
    float2 _e98 = found;
    return _e98;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
float2 shadowfit_casters(shadowfit_Projected projected, float turn)
{
    float radius = (float)0;
    float2 direction = (float2)0;
    float2 found = (0.0).xx;
    uint tap = 0u;
    bool local = (bool)0;

    float2 last = (projected.size - (1.0).xx);
    float start = min((SHADOWFIT_SEARCH_START / max(projected.disc.x, projected.disc.y)), 1.0);
    float growth = pow((1.0 / start), 0.05);
    radius = (start * sqrt(growth));
    direction = float2(cos(turn), sin(turn));
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e95 = tap;
            tap = (_e95 + 1u);
        }
        loop_init = false;
        uint _e31 = tap;
        if (_e31 < SHADOWFIT_SEARCH) {
        } else {
            break;
        }
        {
            float _e36 = radius;
            float2 _e38 = direction;
            float2 texel_1 = clamp(floor((projected.texel + ((projected.disc * _e36) * _e38))), (0.0).xx, last);
            float2 offset = ((texel_1 + (0.5).xx) - projected.texel);
            const float _e52 = shadowfit_stored_texel((texel_1 + projected.texel_offset), projected);
            float distance_ = (projected.surface - _e52);
            float _e59 = shadowfit_receiver.least_disc;
            float2 cone = max((distance_ * projected.penumbra), (_e59).xx);
            float2 radii = (cone + (0.5).xx);
            float2 place = (offset * radii.yx);
            bool is_within = (dot(place, place) <= (((radii.x * radii.x) * radii.y) * radii.y));
            bool is_lit = (saturate((projected.depth + dot(projected.gradient, offset))) >= _e52);
            if (is_within) {
                local = !(is_lit);
            } else {
                local = false;
            }
            bool _e86 = local;
            if (_e86) {
                float2 _e87 = found;
                found = (_e87 + float2(distance_, 1.0));
            }
            float _e91 = radius;
            radius = (_e91 * growth);
            float2 _e93 = direction;
            const float2 _e94 = shadowfit_golden(_e93);
            direction = _e94;
        }
    }
    float2 _e98 = found;
    return _e98;
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_PCF_5X5
float shadowfit_tent_row(shadowfit_Columns columns, float y, shadowfit_Projected projected)
{
    const float2 _e3 = shadowfit_along_v(y, projected);
    const float _e7 = shadowfit_tap(columns.u0_, _e3, projected);
    const float _e12 = shadowfit_tap(columns.u1_, _e3, projected);
    const float _e18 = shadowfit_tap(columns.u2_, _e3, projected);
    return (((columns.weights.x * _e7) + (columns.weights.y * _e12)) + (columns.weights.z * _e18));
}

shadowfit_Columns Constructshadowfit_Columns(float2 arg0, float2 arg1, float2 arg2, float3 arg3) {
    shadowfit_Columns ret = (shadowfit_Columns)0;
    ret.u0_ = arg0;
    ret.u1_ = arg1;
    ret.u2_ = arg2;
    ret.weights = arg3;
    return ret;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_7X7
float shadowfit_tent_row(shadowfit_Columns columns, float y, shadowfit_Projected projected)
{
    const float2 _e3 = shadowfit_along_v(y, projected);
    const float _e7 = shadowfit_tap(columns.u0_, _e3, projected);
    const float _e12 = shadowfit_tap(columns.u1_, _e3, projected);
    const float _e18 = shadowfit_tap(columns.u2_, _e3, projected);
    const float _e24 = shadowfit_tap(columns.u3_, _e3, projected);
    return ((((columns.weights.x * _e7) + (columns.weights.y * _e12)) + (columns.weights.z * _e18)) + (columns.weights.w * _e24));
}

shadowfit_Columns Constructshadowfit_Columns(float2 arg0, float2 arg1, float2 arg2, float2 arg3, float4 arg4) {
    shadowfit_Columns ret = (shadowfit_Columns)0;
    ret.u0_ = arg0;
    ret.u1_ = arg1;
    ret.u2_ = arg2;
    ret.u3_ = arg3;
    ret.weights = arg4;
    return ret;
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_POINT || SHADOWFIT_FILTER == SHADOWFIT_PCF_2X2
float shadowfit_compare(shadowfit_Projected projected, float turn)
{
    const float _e3 = shadowfit_look_up(projected.texel, projected);
    return _e3;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_3X3
float shadowfit_compare(shadowfit_Projected projected, float turn)
{
    float2 base = floor((projected.texel - (0.5).xx));
    float2 t = ((projected.texel - (0.5).xx) - base);
    float2 centre = (base + (0.5).xx);
    float2 w0_ = ((3.0).xx - (2.0 * t));
    float2 w1_ = ((1.0).xx + (2.0 * t));
    float2 p0_ = ((centre - (1.0).xx) + (((2.0).xx - t) / w0_));
    float2 p1_ = ((centre + (1.0).xx) + (t / w1_));
    const float2 _e39 = shadowfit_along_u(p0_.x, projected);
    const float2 _e41 = shadowfit_along_u(p1_.x, projected);
    const float2 _e43 = shadowfit_along_v(p0_.y, projected);
    const float2 _e45 = shadowfit_along_v(p1_.y, projected);
    const float _e47 = shadowfit_tap(_e39, _e43, projected);
    const float _e50 = shadowfit_tap(_e41, _e43, projected);
    float top = ((w0_.x * _e47) + (w1_.x * _e50));
    const float _e54 = shadowfit_tap(_e39, _e45, projected);
    const float _e57 = shadowfit_tap(_e41, _e45, projected);
    float bottom = ((w0_.x * _e54) + (w1_.x * _e57));
    return (((w0_.y * top) + (w1_.y * bottom)) / 16.0);
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_5X5
float shadowfit_compare(shadowfit_Projected projected, float turn)
{
    float2 base = floor((projected.texel - (0.5).xx));
    float2 t = ((projected.texel - (0.5).xx) - base);
    float2 centre = (base + (0.5).xx);
    float2 w0_ = ((3.0).xx - (2.0 * t));
    float2 w2_ = ((1.0).xx + (2.0 * t));
    float2 p0_ = ((centre - (2.0).xx) + (((2.0).xx - t) / w0_));
    float2 p1_ = (centre + (((2.0).xx + t) / (5.0).xx));
    float2 p2_ = ((centre + (2.0).xx) + (t / w2_));
    const float2 _e46 = shadowfit_along_u(p0_.x, projected);
    const float2 _e48 = shadowfit_along_u(p1_.x, projected);
    const float2 _e50 = shadowfit_along_u(p2_.x, projected);
    shadowfit_Columns columns = Constructshadowfit_Columns(_e46, _e48, _e50, float3(w0_.x, 5.0, w2_.x));
    const float _e58 = shadowfit_tent_row(columns, p0_.y, projected);
    const float _e61 = shadowfit_tent_row(columns, p1_.y, projected);
    const float _e67 = shadowfit_tent_row(columns, p2_.y, projected);
    return ((((w0_.y * _e58) + (5.0 * _e61)) + (w2_.y * _e67)) / 81.0);
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_7X7
float shadowfit_compare(shadowfit_Projected projected, float turn)
{
    float2 base = floor((projected.texel - (0.5).xx));
    float2 t = ((projected.texel - (0.5).xx) - base);
    float2 centre = (base + (0.5).xx);
    float2 w0_ = ((3.0).xx - (2.0 * t));
    float2 w1_ = ((7.0).xx - (2.0 * t));
    float2 w2_ = ((5.0).xx + (2.0 * t));
    float2 w3_ = ((1.0).xx + (2.0 * t));
    float2 p0_ = ((centre - (3.0).xx) + (((2.0).xx - t) / w0_));
    float2 p1_ = ((centre - (1.0).xx) + (((4.0).xx - t) / w1_));
    float2 p2_ = ((centre + (1.0).xx) + (((2.0).xx + t) / w2_));
    float2 p3_ = ((centre + (3.0).xx) + (t / w3_));
    const float2 _e65 = shadowfit_along_u(p0_.x, projected);
    const float2 _e67 = shadowfit_along_u(p1_.x, projected);
    const float2 _e69 = shadowfit_along_u(p2_.x, projected);
    const float2 _e71 = shadowfit_along_u(p3_.x, projected);
    shadowfit_Columns columns = Constructshadowfit_Columns(_e65, _e67, _e69, _e71, float4(w0_.x, w1_.x, w2_.x, w3_.x));
    const float _e80 = shadowfit_tent_row(columns, p0_.y, projected);
    const float _e84 = shadowfit_tent_row(columns, p1_.y, projected);
    const float _e89 = shadowfit_tent_row(columns, p2_.y, projected);
    const float _e94 = shadowfit_tent_row(columns, p3_.y, projected);
    return (((((w0_.y * _e80) + (w1_.y * _e84)) + (w2_.y * _e89)) + (w3_.y * _e94)) / 256.0);
}
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32
float shadowfit_compare(shadowfit_Projected projected, float turn)
{
    const float _e3 = shadowfit_disc(projected.disc, projected, turn);
    return _e3;
}
#else
float shadowfit_compare(shadowfit_Projected projected, float turn)
{
    const float2 _e2 = shadowfit_casters(projected, turn);
    if (_e2.y == 0.0) {
        return 1.0;
    }
    float2 radius = ((_e2.x / _e2.y) * projected.penumbra);
    float2 own = sqrt(max(((radius * radius) - (0.6666667).xx), (0.0).xx));
    float _e22 = shadowfit_receiver.least_disc;
    float2 least = (_e22).xx;
    float _e26 = shadowfit_receiver.greatest_disc;
    const float _e29 = shadowfit_disc(clamp(own, least, (_e26).xx), projected, turn);
    return _e29;
}
#endif

#if SHADOWFIT_BY_VIEW_DEPTH
bool shadowfit_is_open(shadowfit_Selection selection, int entry, float view_depth, float far, float blend_near)
{
    bool local = (bool)0;
    bool local_1 = (bool)0;

    if (selection.first < int(0)) {
        return (view_depth < far);
    }
    if (asint(asuint(selection.first) + asuint(int(1))) == entry) {
        local = (view_depth > blend_near);
    } else {
        local = false;
    }
    bool _e17 = local;
    if (_e17) {
        local_1 = (blend_near < selection.far);
    } else {
        local_1 = false;
    }
    bool _e23 = local_1;
    return _e23;
}

shadowfit_Selection shadowfit_try(shadowfit_Selection selection, int entry, float view_depth, float far_1, float blend_near, float free)
{
    shadowfit_Selection next = (shadowfit_Selection)0;

    next = selection;
    if (free >= 0.0) {
        if (selection.first < int(0)) {
            next.first = entry;
            next.far = far_1;
        } else {
            next.second = entry;
            next.weight = ((selection.far - view_depth) / (selection.far - blend_near));
        }
    }
    shadowfit_Selection _e21 = next;
    const shadowfit_Selection shadowfit_selection = _e21;
    return shadowfit_selection;
}
#else
bool shadowfit_is_open(shadowfit_Selection selection, int entry, float view_depth, float far, float blend_near)
{
    bool local = (bool)0;
    bool local_1 = (bool)0;

    if (!((selection.first < int(0)))) {
        if (selection.second < int(0)) {
            local_1 = (selection.weight < 1.0);
        } else {
            local_1 = false;
        }
        bool _e20 = local_1;
        local = _e20;
    } else {
        local = true;
    }
    bool _e22 = local;
    return _e22;
}

shadowfit_Selection shadowfit_try(shadowfit_Selection selection, int entry, float view_depth, float far, float blend_near, float free)
{
    shadowfit_Selection next = (shadowfit_Selection)0;
    bool local = (bool)0;

    next = selection;
    if (free >= SHADOWFIT_REACH) {
        if (selection.first < int(0)) {
            next.first = entry;
            float beyond = (free - SHADOWFIT_REACH);
            next.weight = 1.0;
            if (beyond < SHADOWFIT_BLEND) {
                next.weight = (beyond / SHADOWFIT_BLEND);
            }
        } else {
            next.second = entry;
        }
    } else {
        if (free >= 0.0) {
            local = (selection.clamped < int(0));
        } else {
            local = false;
        }
        bool _e31 = local;
        if (_e31) {
            next.clamped = entry;
        }
    }
    shadowfit_Selection _e33 = next;
    const shadowfit_Selection shadowfit_selection = _e33;
    return shadowfit_selection;
}
#endif

float shadowfit_faded(float3 position)
{
    const float _e1 = shadowfit_view_depth(position);
    float _e4 = shadowfit_receiver.fade_near;
    float beyond = (_e1 - _e4);
    if (beyond <= 0.0) {
        return 0.0;
    }
    float _e11 = shadowfit_receiver.fade_width;
    float share = saturate((beyond / max(_e11, 1e-30)));
    return ((share * share) * (3.0 - (2.0 * share)));
}

shadowfit_Selection Constructshadowfit_Selection(int arg0, int arg1, float arg2, int arg3, float arg4) {
    shadowfit_Selection ret = (shadowfit_Selection)0;
    ret.first = arg0;
    ret.second = arg1;
    ret.weight = arg2;
    ret.clamped = arg3;
    ret.far = arg4;
    return ret;
}

#if SHADOWFIT_MAPS <= 1
shadowfit_Selection shadowfit_select(float3 position)
{
    shadowfit_Selection selection = Constructshadowfit_Selection(int(-1), int(-1), 1.0, int(-1), 0.0);

    const float _e1 = shadowfit_view_depth(position);
    shadowfit_Selection _e9 = selection;
    float _e15 = shadowfit_receiver.maps[0].far;
    float _e20 = shadowfit_receiver.maps[0].blend_near;
    const bool _e21 = shadowfit_is_open(_e9, int(0), _e1, _e15, _e20);
    if (_e21) {
        shadowfit_Map _e26 = shadowfit_receiver.maps[0];
        const float _e27 = shadowfit_free(0u, _e26, position);
        shadowfit_Selection _e28 = selection;
        float _e34 = shadowfit_receiver.maps[0].far;
        float _e39 = shadowfit_receiver.maps[0].blend_near;
        const shadowfit_Selection _e40 = shadowfit_try(_e28, int(0), _e1, _e34, _e39, _e27);
        selection = _e40;
    }
    int _e43 = selection.first;
    int _e45 = selection.clamped;
    int _e47 = selection.first;
    selection.first = ((_e47 < int(0)) ? _e45 : _e43);
    const float _e51 = shadowfit_faded(position);
    if (_e51 >= 1.0) {
        const shadowfit_Selection shadowfit_selection = Constructshadowfit_Selection(int(-1), int(-1), 1.0, int(-1), 0.0);
        return shadowfit_selection;
    }
    shadowfit_Selection _e60 = selection;
    const shadowfit_Selection shadowfit_selection_1 = _e60;
    return shadowfit_selection_1;
}

shadowfit_Map shadowfit_entry(int entry)
{
    shadowfit_Map _e4 = shadowfit_receiver.maps[0];
    const shadowfit_Map shadowfit_map = _e4;
    return shadowfit_map;
}
#elif SHADOWFIT_MAPS <= 4
shadowfit_Selection shadowfit_select(float3 position)
{
    shadowfit_Selection selection = Constructshadowfit_Selection(int(-1), int(-1), 1.0, int(-1), 0.0);

    const float _e1 = shadowfit_view_depth(position);
    shadowfit_Selection _e9 = selection;
    float _e15 = shadowfit_receiver.maps[0].far;
    float _e20 = shadowfit_receiver.maps[0].blend_near;
    const bool _e21 = shadowfit_is_open(_e9, int(0), _e1, _e15, _e20);
    if (_e21) {
        shadowfit_Map _e26 = shadowfit_receiver.maps[0];
        const float _e27 = shadowfit_free(0u, _e26, position);
        shadowfit_Selection _e28 = selection;
        float _e34 = shadowfit_receiver.maps[0].far;
        float _e39 = shadowfit_receiver.maps[0].blend_near;
        const shadowfit_Selection _e40 = shadowfit_try(_e28, int(0), _e1, _e34, _e39, _e27);
        selection = _e40;
    }
    shadowfit_Selection _e41 = selection;
    float _e47 = shadowfit_receiver.maps[1].far;
    float _e52 = shadowfit_receiver.maps[1].blend_near;
    const bool _e53 = shadowfit_is_open(_e41, int(1), _e1, _e47, _e52);
    if (_e53) {
        shadowfit_Map _e58 = shadowfit_receiver.maps[1];
        const float _e59 = shadowfit_free(1u, _e58, position);
        shadowfit_Selection _e60 = selection;
        float _e66 = shadowfit_receiver.maps[1].far;
        float _e71 = shadowfit_receiver.maps[1].blend_near;
        const shadowfit_Selection _e72 = shadowfit_try(_e60, int(1), _e1, _e66, _e71, _e59);
        selection = _e72;
    }
    shadowfit_Selection _e73 = selection;
    float _e79 = shadowfit_receiver.maps[2].far;
    float _e84 = shadowfit_receiver.maps[2].blend_near;
    const bool _e85 = shadowfit_is_open(_e73, int(2), _e1, _e79, _e84);
    if (_e85) {
        shadowfit_Map _e90 = shadowfit_receiver.maps[2];
        const float _e91 = shadowfit_free(2u, _e90, position);
        shadowfit_Selection _e92 = selection;
        float _e98 = shadowfit_receiver.maps[2].far;
        float _e103 = shadowfit_receiver.maps[2].blend_near;
        const shadowfit_Selection _e104 = shadowfit_try(_e92, int(2), _e1, _e98, _e103, _e91);
        selection = _e104;
    }
    shadowfit_Selection _e105 = selection;
    float _e111 = shadowfit_receiver.maps[3].far;
    float _e116 = shadowfit_receiver.maps[3].blend_near;
    const bool _e117 = shadowfit_is_open(_e105, int(3), _e1, _e111, _e116);
    if (_e117) {
        shadowfit_Map _e122 = shadowfit_receiver.maps[3];
        const float _e123 = shadowfit_free(3u, _e122, position);
        shadowfit_Selection _e124 = selection;
        float _e130 = shadowfit_receiver.maps[3].far;
        float _e135 = shadowfit_receiver.maps[3].blend_near;
        const shadowfit_Selection _e136 = shadowfit_try(_e124, int(3), _e1, _e130, _e135, _e123);
        selection = _e136;
    }
    int _e139 = selection.first;
    int _e141 = selection.clamped;
    int _e143 = selection.first;
    selection.first = ((_e143 < int(0)) ? _e141 : _e139);
    const float _e147 = shadowfit_faded(position);
    if (_e147 >= 1.0) {
        const shadowfit_Selection shadowfit_selection = Constructshadowfit_Selection(int(-1), int(-1), 1.0, int(-1), 0.0);
        return shadowfit_selection;
    }
    shadowfit_Selection _e156 = selection;
    const shadowfit_Selection shadowfit_selection_1 = _e156;
    return shadowfit_selection_1;
}

shadowfit_Map shadowfit_entry(int entry)
{
    if (entry == int(1)) {
        shadowfit_Map _e6 = shadowfit_receiver.maps[1];
        const shadowfit_Map shadowfit_map = _e6;
        return shadowfit_map;
    }
    if (entry == int(2)) {
        shadowfit_Map _e12 = shadowfit_receiver.maps[2];
        const shadowfit_Map shadowfit_map_1 = _e12;
        return shadowfit_map_1;
    }
    if (entry == int(3)) {
        shadowfit_Map _e18 = shadowfit_receiver.maps[3];
        const shadowfit_Map shadowfit_map_2 = _e18;
        return shadowfit_map_2;
    }
    shadowfit_Map _e22 = shadowfit_receiver.maps[0];
    const shadowfit_Map shadowfit_map_3 = _e22;
    return shadowfit_map_3;
}
#else
shadowfit_Selection shadowfit_select(float3 position)
{
    shadowfit_Selection selection = Constructshadowfit_Selection(int(-1), int(-1), 1.0, int(-1), 0.0);

    const float _e1 = shadowfit_view_depth(position);
    shadowfit_Selection _e9 = selection;
    float _e15 = shadowfit_receiver.maps[0].far;
    float _e20 = shadowfit_receiver.maps[0].blend_near;
    const bool _e21 = shadowfit_is_open(_e9, int(0), _e1, _e15, _e20);
    if (_e21) {
        shadowfit_Map _e26 = shadowfit_receiver.maps[0];
        const float _e27 = shadowfit_free(0u, _e26, position);
        shadowfit_Selection _e28 = selection;
        float _e34 = shadowfit_receiver.maps[0].far;
        float _e39 = shadowfit_receiver.maps[0].blend_near;
        const shadowfit_Selection _e40 = shadowfit_try(_e28, int(0), _e1, _e34, _e39, _e27);
        selection = _e40;
    }
    shadowfit_Selection _e41 = selection;
    float _e47 = shadowfit_receiver.maps[1].far;
    float _e52 = shadowfit_receiver.maps[1].blend_near;
    const bool _e53 = shadowfit_is_open(_e41, int(1), _e1, _e47, _e52);
    if (_e53) {
        shadowfit_Map _e58 = shadowfit_receiver.maps[1];
        const float _e59 = shadowfit_free(1u, _e58, position);
        shadowfit_Selection _e60 = selection;
        float _e66 = shadowfit_receiver.maps[1].far;
        float _e71 = shadowfit_receiver.maps[1].blend_near;
        const shadowfit_Selection _e72 = shadowfit_try(_e60, int(1), _e1, _e66, _e71, _e59);
        selection = _e72;
    }
    shadowfit_Selection _e73 = selection;
    float _e79 = shadowfit_receiver.maps[2].far;
    float _e84 = shadowfit_receiver.maps[2].blend_near;
    const bool _e85 = shadowfit_is_open(_e73, int(2), _e1, _e79, _e84);
    if (_e85) {
        shadowfit_Map _e90 = shadowfit_receiver.maps[2];
        const float _e91 = shadowfit_free(2u, _e90, position);
        shadowfit_Selection _e92 = selection;
        float _e98 = shadowfit_receiver.maps[2].far;
        float _e103 = shadowfit_receiver.maps[2].blend_near;
        const shadowfit_Selection _e104 = shadowfit_try(_e92, int(2), _e1, _e98, _e103, _e91);
        selection = _e104;
    }
    shadowfit_Selection _e105 = selection;
    float _e111 = shadowfit_receiver.maps[3].far;
    float _e116 = shadowfit_receiver.maps[3].blend_near;
    const bool _e117 = shadowfit_is_open(_e105, int(3), _e1, _e111, _e116);
    if (_e117) {
        shadowfit_Map _e122 = shadowfit_receiver.maps[3];
        const float _e123 = shadowfit_free(3u, _e122, position);
        shadowfit_Selection _e124 = selection;
        float _e130 = shadowfit_receiver.maps[3].far;
        float _e135 = shadowfit_receiver.maps[3].blend_near;
        const shadowfit_Selection _e136 = shadowfit_try(_e124, int(3), _e1, _e130, _e135, _e123);
        selection = _e136;
    }
    shadowfit_Selection _e137 = selection;
    float _e143 = shadowfit_receiver.maps[4].far;
    float _e148 = shadowfit_receiver.maps[4].blend_near;
    const bool _e149 = shadowfit_is_open(_e137, int(4), _e1, _e143, _e148);
    if (_e149) {
        shadowfit_Map _e154 = shadowfit_receiver.maps[4];
        const float _e155 = shadowfit_free(4u, _e154, position);
        shadowfit_Selection _e156 = selection;
        float _e162 = shadowfit_receiver.maps[4].far;
        float _e167 = shadowfit_receiver.maps[4].blend_near;
        const shadowfit_Selection _e168 = shadowfit_try(_e156, int(4), _e1, _e162, _e167, _e155);
        selection = _e168;
    }
    shadowfit_Selection _e169 = selection;
    float _e175 = shadowfit_receiver.maps[5].far;
    float _e180 = shadowfit_receiver.maps[5].blend_near;
    const bool _e181 = shadowfit_is_open(_e169, int(5), _e1, _e175, _e180);
    if (_e181) {
        shadowfit_Map _e186 = shadowfit_receiver.maps[5];
        const float _e187 = shadowfit_free(5u, _e186, position);
        shadowfit_Selection _e188 = selection;
        float _e194 = shadowfit_receiver.maps[5].far;
        float _e199 = shadowfit_receiver.maps[5].blend_near;
        const shadowfit_Selection _e200 = shadowfit_try(_e188, int(5), _e1, _e194, _e199, _e187);
        selection = _e200;
    }
    shadowfit_Selection _e201 = selection;
    float _e207 = shadowfit_receiver.maps[6].far;
    float _e212 = shadowfit_receiver.maps[6].blend_near;
    const bool _e213 = shadowfit_is_open(_e201, int(6), _e1, _e207, _e212);
    if (_e213) {
        shadowfit_Map _e218 = shadowfit_receiver.maps[6];
        const float _e219 = shadowfit_free(6u, _e218, position);
        shadowfit_Selection _e220 = selection;
        float _e226 = shadowfit_receiver.maps[6].far;
        float _e231 = shadowfit_receiver.maps[6].blend_near;
        const shadowfit_Selection _e232 = shadowfit_try(_e220, int(6), _e1, _e226, _e231, _e219);
        selection = _e232;
    }
    shadowfit_Selection _e233 = selection;
    float _e239 = shadowfit_receiver.maps[7].far;
    float _e244 = shadowfit_receiver.maps[7].blend_near;
    const bool _e245 = shadowfit_is_open(_e233, int(7), _e1, _e239, _e244);
    if (_e245) {
        shadowfit_Map _e250 = shadowfit_receiver.maps[7];
        const float _e251 = shadowfit_free(7u, _e250, position);
        shadowfit_Selection _e252 = selection;
        float _e258 = shadowfit_receiver.maps[7].far;
        float _e263 = shadowfit_receiver.maps[7].blend_near;
        const shadowfit_Selection _e264 = shadowfit_try(_e252, int(7), _e1, _e258, _e263, _e251);
        selection = _e264;
    }
    int _e267 = selection.first;
    int _e269 = selection.clamped;
    int _e271 = selection.first;
    selection.first = ((_e271 < int(0)) ? _e269 : _e267);
    const float _e275 = shadowfit_faded(position);
    if (_e275 >= 1.0) {
        const shadowfit_Selection shadowfit_selection = Constructshadowfit_Selection(int(-1), int(-1), 1.0, int(-1), 0.0);
        return shadowfit_selection;
    }
    shadowfit_Selection _e284 = selection;
    const shadowfit_Selection shadowfit_selection_1 = _e284;
    return shadowfit_selection_1;
}

shadowfit_Map shadowfit_entry(int entry)
{
    if (entry == int(1)) {
        shadowfit_Map _e6 = shadowfit_receiver.maps[1];
        const shadowfit_Map shadowfit_map = _e6;
        return shadowfit_map;
    }
    if (entry == int(2)) {
        shadowfit_Map _e12 = shadowfit_receiver.maps[2];
        const shadowfit_Map shadowfit_map_1 = _e12;
        return shadowfit_map_1;
    }
    if (entry == int(3)) {
        shadowfit_Map _e18 = shadowfit_receiver.maps[3];
        const shadowfit_Map shadowfit_map_2 = _e18;
        return shadowfit_map_2;
    }
    if (entry == int(4)) {
        shadowfit_Map _e24 = shadowfit_receiver.maps[4];
        const shadowfit_Map shadowfit_map_3 = _e24;
        return shadowfit_map_3;
    }
    if (entry == int(5)) {
        shadowfit_Map _e30 = shadowfit_receiver.maps[5];
        const shadowfit_Map shadowfit_map_4 = _e30;
        return shadowfit_map_4;
    }
    if (entry == int(6)) {
        shadowfit_Map _e36 = shadowfit_receiver.maps[6];
        const shadowfit_Map shadowfit_map_5 = _e36;
        return shadowfit_map_5;
    }
    if (entry == int(7)) {
        shadowfit_Map _e42 = shadowfit_receiver.maps[7];
        const shadowfit_Map shadowfit_map_6 = _e42;
        return shadowfit_map_6;
    }
    shadowfit_Map _e46 = shadowfit_receiver.maps[0];
    const shadowfit_Map shadowfit_map_7 = _e46;
    return shadowfit_map_7;
}
#endif

float shadowfit_turn(float2 pixel)
{
    float _e4 = shadowfit_receiver.frame_shift;
    float2 at = (floor(pixel) + (_e4).xx);
    float noise_ = frac((52.982918 * frac(dot(at, float2(0.06711056, 0.00583715)))));
    return (noise_ * 6.2831855);
}

float shadowfit_read(int entry, float3 position, float3 normal, float turn)
{
    const shadowfit_Map _e4 = shadowfit_entry(entry);
    const shadowfit_Projected _e5 = shadowfit_project(_e4, position, normal);
    const float _e6 = shadowfit_compare(_e5, turn);
    return _e6;
}

float shadowfit_turned(float3 position, float3 normal, float turn)
{
    float factor = (float)0;

    uint _e6 = shadowfit_receiver.is_off;
    float lit_ = float((1u - _e6));
    const float _e9 = shadowfit_faded(position);
    const shadowfit_Selection _e10 = shadowfit_select(position);
    if (_e10.first < int(0)) {
        return lit_;
    }
    const float _e15 = shadowfit_read(_e10.first, position, normal, turn);
    factor = _e15;
    if (_e10.second >= int(0)) {
        const float _e21 = shadowfit_read(_e10.second, position, normal, turn);
        float _e22 = factor;
        factor = lerp(_e21, _e22, _e10.weight);
    }
    float _e25 = factor;
    return (lit_ * lerp(_e25, 1.0, _e9));
}

float shadowfit_factor(float3 position, float3 normal)
{
    const float _e3 = shadowfit_turned(position, normal, 0.0);
    return _e3;
}

float shadowfit_factor_at(float3 position, float3 normal, float2 pixel)
{
    const float _e3 = shadowfit_turn(pixel);
    const float _e4 = shadowfit_turned(position, normal, _e3);
    return _e4;
}

int shadowfit_map_index(float3 position)
{
    bool local = (bool)0;

    const shadowfit_Selection _e1 = shadowfit_select(position);
    if (_e1.first < int(0)) {
        return int(-1);
    }
    if (_e1.second >= int(0)) {
        local = (_e1.weight < 0.5);
    } else {
        local = false;
    }
    bool is_second = local;
    const shadowfit_Map _e19 = shadowfit_entry((is_second ? _e1.second : _e1.first));
    return int(_e19.layer);
}

#endif
