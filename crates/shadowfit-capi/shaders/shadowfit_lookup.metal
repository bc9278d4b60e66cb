// shadowfit_lookup.metal: The look-up of shadow maps, for the shaders that light receivers.
// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL has the comments.
//
// position: world space, relative to the origin of the constants, metres. normal: unit, geometric.
// pixel: xy of [[position]].
//
// float shadowfit_factor_at(float3 position, float3 normal, float2 pixel, constants, texture, sampler)
//     the share of the light that reaches a point: 1 lit, 0 in shadow
// float shadowfit_factor(float3 position, float3 normal, constants, texture, sampler)
//     the same without rotating the discs of Vogel filters
// int shadowfit_map_index(float3 position, constants)
//     the layer of the map that a point reads, for debug colours; -1 for none
// float shadowfit_view_depth(float3 position, constants)
//     the view depth of a point, in metres
//
// Constants: ShadowfitReceiverConstants of shadowfit.h, struct shadowfit_Receiver below.
// From the engine's entry point: `constants`, a constant buffer; `texture`, a depth2d_array<float>; `sampler`.
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

#ifndef SHADOWFIT_LOOKUP_METAL
#define SHADOWFIT_LOOKUP_METAL

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

#include <metal_stdlib>
#include <simd/simd.h>
using metal::uint;

struct shadowfit_Map {
    metal::float4x4 uv_from_world;
    metal::packed_float3 depth_per_texel_u;
    float constant_depth;
    metal::packed_float3 depth_per_texel_v;
    float slope_depth;
    metal::float2 size;
    float normal_offset;
    float receiver_plane;
    float far;
    float blend_near;
    uint layer;
    uint padding_0_;
    metal::float2 texel_offset;
    metal::float2 disc;
    metal::float2 penumbra;
    uint padding_1_;
    uint padding_2_;
};

struct shadowfit_Maps {
    shadowfit_Map inner[8];
};

struct shadowfit_Receiver {
    metal::packed_float3 to_light;
    uint map_count;
    metal::float4 view;
    float fade_near;
    float fade_width;
    float least_disc;
    float greatest_disc;
    float frame_shift;
    uint is_off;
    uint padding_0_;
    uint padding_1_;
    shadowfit_Maps maps;
};

struct shadowfit_Projected {
    metal::float2 texel;
    float surface;
    float depth;
    metal::float2 gradient;
    uint layer;
    char _pad5[4];
    metal::float2 size;
    metal::float2 texel_offset;
    metal::float2 disc;
    metal::float2 penumbra;
    metal::float2 unit;
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
    metal::float2 at;
    metal::float2 a;
    metal::float2 b;
    metal::float2 rise;
};
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_PCF_5X5
struct shadowfit_Columns {
    metal::float2 u0_;
    metal::float2 u1_;
    metal::float2 u2_;
    char _pad3[8];
    metal::float3 weights;
};
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_7X7
struct shadowfit_Columns {
    metal::float2 u0_;
    metal::float2 u1_;
    metal::float2 u2_;
    metal::float2 u3_;
    metal::float4 weights;
};
#endif
constant float SHADOWFIT_MIN_COSINE = 0.005;

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8
constant uint SHADOWFIT_TAPS = 8u;
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
constant uint SHADOWFIT_TAPS = 16u;
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32
constant uint SHADOWFIT_TAPS = 32u;
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
constant float SHADOWFIT_LOOK_UP_SQUARE = 0.6666667;
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
constant uint SHADOWFIT_SEARCH = 20u;
constant float SHADOWFIT_SEARCH_START = 0.5;
constant float SHADOWFIT_SEARCH_BESIDE = 0.5;
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

bool shadowfit_inside(
    metal::float3 uv
) {
    bool local = {};
    if (metal::all(uv >= metal::float3(0.0))) {
        local = metal::all(uv <= metal::float3(1.0));
    } else {
        local = false;
    }
    bool _e12 = local;
    return _e12;
}

metal::float2 shadowfit_unit(
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture
) {
    return metal::float2(1.0) / static_cast<metal::float2>(metal::uint2(shadowfit_texture.get_width(), shadowfit_texture.get_height()));
}

shadowfit_Projected shadowfit_project(
    shadowfit_Map map,
    metal::float3 position,
    metal::float3 normal,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture
) {
    metal::float3 _e5 = shadowfit_receiver.to_light;
    float cosine = metal::clamp(metal::dot(normal, _e5), SHADOWFIT_MIN_COSINE, 1.0);
    float sine = metal::sqrt(1.0 - (cosine * cosine));
    metal::float3 offset = normal * (map.normal_offset * sine);
    metal::float3 uv = (map.uv_from_world * metal::float4(position + offset, 1.0)).xyz;
    metal::float2 gradient = metal::float2(metal::dot(map.depth_per_texel_u, normal), metal::dot(map.depth_per_texel_v, normal)) / metal::float2(cosine);
    float rise = map.receiver_plane * (metal::abs(gradient.x) + metal::abs(gradient.y));
    float depth = ((uv.z + map.constant_depth) + ((map.slope_depth * sine) / cosine)) + rise;
    metal::float2 _e54 = shadowfit_unit(shadowfit_texture);
    return shadowfit_Projected {uv.xy * map.size, uv.z, depth, gradient, map.layer, {}, map.size, map.texel_offset, map.disc, map.penumbra, _e54};
}

float shadowfit_view_depth(
    metal::float3 position,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    metal::float4 _e3 = shadowfit_receiver.view;
    float _e9 = shadowfit_receiver.view.w;
    return metal::dot(_e3.xyz, position) + _e9;
}

float shadowfit_free(
    uint entry,
    shadowfit_Map map,
    metal::float3 position,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    bool local = {};
    metal::float3 uv = (map.uv_from_world * metal::float4(position, 1.0)).xyz;
    metal::float2 free = metal::min(uv.xy, metal::float2(1.0) - uv.xy) * map.size;
    uint _e18 = shadowfit_receiver.map_count;
    if (entry < _e18) {
        bool _e22 = shadowfit_inside(uv);
        local = _e22;
    } else {
        local = false;
    }
    bool is_held = local;
    return is_held ? metal::min(free.x, free.y) : -1.0;
}

#if SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
float shadowfit_load(
    uint layer,
    metal::int2 texel,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture
) {
    float _e5 = shadowfit_texture.read(metal::uint2(texel), static_cast<int>(layer), 0);
    return _e5;
}

metal::int2 shadowfit_naga_f2i32(metal::float2 value) {
    return static_cast<metal::int2>(metal::clamp(value, -2147483600.0, 2147483500.0));
}

float shadowfit_stored_texel(
    metal::float2 texel,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture
) {
    metal::float2 ended = texel - (projected.size * static_cast<metal::float2>(texel >= projected.size));
    metal::float2 stored = ended + (projected.size * static_cast<metal::float2>(texel < metal::float2(0.0)));
    float _e17 = shadowfit_load(projected.layer, shadowfit_naga_f2i32(stored), shadowfit_texture);
    return _e17;
}
#endif

float shadowfit_look_up_at(
    metal::float2 at,
    float depth,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float _e8 = shadowfit_texture.sample_compare(shadowfit_sampler, at, static_cast<int>(projected.layer), metal::saturate(depth));
    return _e8;
}

metal::float2 shadowfit_along(
    float at,
    float point,
    float gradient,
    float size,
    float texel_offset,
    float unit
) {
    float inside = metal::clamp(at, 0.5, size - 0.5);
    float shifted = inside + texel_offset;
    return metal::float2(((shifted >= size) ? (shifted - size) : shifted) * unit, gradient * (inside - point));
}

metal::float2 shadowfit_along_u(
    float at,
    shadowfit_Projected p
) {
    metal::float2 _e12 = shadowfit_along(at, p.texel.x, p.gradient.x, p.size.x, p.texel_offset.x, p.unit.x);
    return _e12;
}

metal::float2 shadowfit_along_v(
    float at,
    shadowfit_Projected p
) {
    metal::float2 _e12 = shadowfit_along(at, p.texel.y, p.gradient.y, p.size.y, p.texel_offset.y, p.unit.y);
    return _e12;
}

float shadowfit_tap(
    metal::float2 u,
    metal::float2 v,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float _e11 = shadowfit_look_up_at(metal::float2(u.x, v.x), (projected.depth + u.y) + v.y, projected, shadowfit_texture, shadowfit_sampler);
    return _e11;
}

float shadowfit_look_up(
    metal::float2 texel,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 _e3 = shadowfit_along_u(texel.x, projected);
    metal::float2 _e5 = shadowfit_along_v(texel.y, projected);
    float _e6 = shadowfit_tap(_e3, _e5, projected, shadowfit_texture, shadowfit_sampler);
    return _e6;
}

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
metal::float2 shadowfit_golden(
    metal::float2 direction
) {
    metal::float2 turn = metal::float2(-0.7373689, 0.6754903);
    return metal::float2((direction.x * turn.x) - (direction.y * turn.y), (direction.x * turn.y) + (direction.y * turn.x));
}

float shadowfit_disc_tap(
    shadowfit_Disc disc,
    metal::float2 place,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float _e16 = shadowfit_look_up_at((disc.at + (disc.a * place.x)) + (disc.b * place.y), projected.depth + metal::dot(disc.rise, place), projected, shadowfit_texture, shadowfit_sampler);
    return _e16;
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8
float shadowfit_disc_taps(
    shadowfit_Disc disc,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float sum = 0.0;
    float _e4 = sum;
    float _e8 = shadowfit_disc_tap(disc, metal::float2(0.25, 0.0), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e4 + _e8;
    float _e10 = sum;
    float _e14 = shadowfit_disc_tap(disc, metal::float2(-0.3192901, 0.29249588), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e10 + _e14;
    float _e16 = sum;
    float _e20 = shadowfit_disc_tap(disc, metal::float2(0.048872467, -0.55687654), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e16 + _e20;
    float _e22 = sum;
    float _e26 = shadowfit_disc_tap(disc, metal::float2(0.40244448, 0.52491754), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e22 + _e26;
    float _e28 = sum;
    float _e32 = shadowfit_disc_tap(disc, metal::float2(-0.7385351, -0.13063647), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e28 + _e32;
    float _e34 = sum;
    float _e38 = shadowfit_disc_tap(disc, metal::float2(0.6996049, -0.4450314), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e34 + _e38;
    float _e40 = sum;
    float _e44 = shadowfit_disc_tap(disc, metal::float2(-0.23400415, 0.8704838), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e40 + _e44;
    float _e46 = sum;
    float _e50 = shadowfit_disc_tap(disc, metal::float2(-0.4462713, -0.85926825), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e46 + _e50;
    float _e52 = sum;
    return _e52;
}

float shadowfit_disc(
    metal::float2 radii,
    shadowfit_Projected projected,
    float turn,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 direction = {};
    float sum = 0.0;
    bool local = {};
    uint tap = 0u;
    direction = metal::float2(metal::cos(turn), metal::sin(turn));
    metal::float2 least = radii + metal::float2(0.5);
    if (metal::all(projected.texel >= least)) {
        local = metal::all(projected.texel <= (projected.size - least));
    } else {
        local = false;
    }
    bool _e23 = local;
    if (_e23) {
        metal::float2 _e24 = direction;
        metal::float2 a = radii * _e24;
        float _e27 = direction.y;
        float _e30 = direction.x;
        metal::float2 b = radii * metal::float2(-(_e27), _e30);
        metal::float2 _e35 = shadowfit_along_u(projected.texel.x, projected);
        metal::float2 _e39 = shadowfit_along_v(projected.texel.y, projected);
        metal::float2 at = metal::float2(_e35.x, _e39.x);
        metal::float2 rise = metal::float2(metal::dot(projected.gradient, a), metal::dot(projected.gradient, b));
        shadowfit_Disc disc = shadowfit_Disc {at, a * projected.unit, b * projected.unit, rise};
        float _e52 = shadowfit_disc_taps(disc, projected, shadowfit_texture, shadowfit_sampler);
        sum = _e52;
    } else {
        bool loop_init = true;
        while(true) {
            if (!loop_init) {
                uint _e75 = tap;
                tap = _e75 + 1u;
            }
            loop_init = false;
            uint _e55 = tap;
            if (_e55 < SHADOWFIT_TAPS) {
            } else {
                break;
            }
            {
                uint _e58 = tap;
                float radius = metal::sqrt((static_cast<float>(_e58) + 0.5) / 8.0);
                float _e65 = sum;
                metal::float2 _e68 = direction;
                float _e71 = shadowfit_look_up(projected.texel + ((radii * radius) * _e68), projected, shadowfit_texture, shadowfit_sampler);
                sum = _e65 + _e71;
                metal::float2 _e73 = direction;
                metal::float2 _e74 = shadowfit_golden(_e73);
                direction = _e74;
            }
        }
    }
    float _e78 = sum;
    return _e78 / 8.0;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_PCSS || SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
float shadowfit_disc_taps(
    shadowfit_Disc disc,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float sum = 0.0;
    float _e4 = sum;
    float _e8 = shadowfit_disc_tap(disc, metal::float2(0.17677669, 0.0), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e4 + _e8;
    float _e10 = sum;
    float _e14 = shadowfit_disc_tap(disc, metal::float2(-0.22577219, 0.20682582), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e10 + _e14;
    float _e16 = sum;
    float _e20 = shadowfit_disc_tap(disc, metal::float2(0.03455805, -0.39377117), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e16 + _e20;
    float _e22 = sum;
    float _e26 = shadowfit_disc_tap(disc, metal::float2(0.28457123, 0.37117276), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e22 + _e26;
    float _e28 = sum;
    float _e32 = shadowfit_disc_tap(disc, metal::float2(-0.5222232, -0.09237393), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e28 + _e32;
    float _e34 = sum;
    float _e38 = shadowfit_disc_tap(disc, metal::float2(0.4946954, -0.31468472), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e34 + _e38;
    float _e40 = sum;
    float _e44 = shadowfit_disc_tap(disc, metal::float2(-0.16546592, 0.615525), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e40 + _e44;
    float _e46 = sum;
    float _e50 = shadowfit_disc_tap(disc, metal::float2(-0.31556147, -0.60759443), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e46 + _e50;
    float _e52 = sum;
    float _e56 = shadowfit_disc_tap(disc, metal::float2(0.68464214, 0.25003022), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e52 + _e56;
    float _e58 = sum;
    float _e62 = shadowfit_disc_tap(disc, metal::float2(-0.7122561, 0.29400897), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e58 + _e62;
    float _e64 = sum;
    float _e68 = shadowfit_disc_tap(disc, metal::float2(0.3433545, -0.73372865), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e64 + _e68;
    float _e70 = sum;
    float _e74 = shadowfit_disc_tap(disc, metal::float2(0.25373024, 0.808932), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e70 + _e74;
    float _e76 = sum;
    float _e80 = shadowfit_disc_tap(disc, metal::float2(-0.7647459, -0.44318587), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e76 + _e80;
    float _e82 = sum;
    float _e86 = shadowfit_disc_tap(disc, metal::float2(0.897134, -0.1972324), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e82 + _e86;
    float _e88 = sum;
    float _e92 = shadowfit_disc_tap(disc, metal::float2(-0.5475069, 0.77877223), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e88 + _e92;
    float _e94 = sum;
    float _e98 = shadowfit_disc_tap(disc, metal::float2(-0.12648678, -0.9760897), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e94 + _e98;
    float _e100 = sum;
    return _e100;
}

float shadowfit_disc(
    metal::float2 radii,
    shadowfit_Projected projected,
    float turn,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 direction = {};
    float sum = 0.0;
    bool local = {};
    uint tap = 0u;
    direction = metal::float2(metal::cos(turn), metal::sin(turn));
    metal::float2 least = radii + metal::float2(0.5);
    if (metal::all(projected.texel >= least)) {
        local = metal::all(projected.texel <= (projected.size - least));
    } else {
        local = false;
    }
    bool _e23 = local;
    if (_e23) {
        metal::float2 _e24 = direction;
        metal::float2 a = radii * _e24;
        float _e27 = direction.y;
        float _e30 = direction.x;
        metal::float2 b = radii * metal::float2(-(_e27), _e30);
        metal::float2 _e35 = shadowfit_along_u(projected.texel.x, projected);
        metal::float2 _e39 = shadowfit_along_v(projected.texel.y, projected);
        metal::float2 at = metal::float2(_e35.x, _e39.x);
        metal::float2 rise = metal::float2(metal::dot(projected.gradient, a), metal::dot(projected.gradient, b));
        shadowfit_Disc disc = shadowfit_Disc {at, a * projected.unit, b * projected.unit, rise};
        float _e52 = shadowfit_disc_taps(disc, projected, shadowfit_texture, shadowfit_sampler);
        sum = _e52;
    } else {
        bool loop_init = true;
        while(true) {
            if (!loop_init) {
                uint _e75 = tap;
                tap = _e75 + 1u;
            }
            loop_init = false;
            uint _e55 = tap;
            if (_e55 < SHADOWFIT_TAPS) {
            } else {
                break;
            }
            {
                uint _e58 = tap;
                float radius = metal::sqrt((static_cast<float>(_e58) + 0.5) / 16.0);
                float _e65 = sum;
                metal::float2 _e68 = direction;
                float _e71 = shadowfit_look_up(projected.texel + ((radii * radius) * _e68), projected, shadowfit_texture, shadowfit_sampler);
                sum = _e65 + _e71;
                metal::float2 _e73 = direction;
                metal::float2 _e74 = shadowfit_golden(_e73);
                direction = _e74;
            }
        }
    }
    float _e78 = sum;
    return _e78 / 16.0;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32
float shadowfit_disc_taps(
    shadowfit_Disc disc,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float sum = 0.0;
    float _e4 = sum;
    float _e8 = shadowfit_disc_tap(disc, metal::float2(0.125, 0.0), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e4 + _e8;
    float _e10 = sum;
    float _e14 = shadowfit_disc_tap(disc, metal::float2(-0.15964505, 0.14624794), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e10 + _e14;
    float _e16 = sum;
    float _e20 = shadowfit_disc_tap(disc, metal::float2(0.024436234, -0.27843827), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e16 + _e20;
    float _e22 = sum;
    float _e26 = shadowfit_disc_tap(disc, metal::float2(0.20122224, 0.26245877), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e22 + _e26;
    float _e28 = sum;
    float _e32 = shadowfit_disc_tap(disc, metal::float2(-0.36926755, -0.065318234), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e28 + _e32;
    float _e34 = sum;
    float _e38 = shadowfit_disc_tap(disc, metal::float2(0.34980246, -0.2225157), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e34 + _e38;
    float _e40 = sum;
    float _e44 = shadowfit_disc_tap(disc, metal::float2(-0.11700208, 0.4352419), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e40 + _e44;
    float _e46 = sum;
    float _e50 = shadowfit_disc_tap(disc, metal::float2(-0.22313565, -0.42963412), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e46 + _e50;
    float _e52 = sum;
    float _e56 = shadowfit_disc_tap(disc, metal::float2(0.48411512, 0.17679806), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e52 + _e56;
    float _e58 = sum;
    float _e62 = shadowfit_disc_tap(disc, metal::float2(-0.5036411, 0.20789573), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e58 + _e62;
    float _e64 = sum;
    float _e68 = shadowfit_disc_tap(disc, metal::float2(0.2427883, -0.51882446), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e64 + _e68;
    float _e70 = sum;
    float _e74 = shadowfit_disc_tap(disc, metal::float2(0.17941438, 0.5720013), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e70 + _e74;
    float _e76 = sum;
    float _e80 = shadowfit_disc_tap(disc, metal::float2(-0.540757, -0.31337973), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e76 + _e80;
    float _e82 = sum;
    float _e86 = shadowfit_disc_tap(disc, metal::float2(0.63436955, -0.13946436), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e82 + _e86;
    float _e88 = sum;
    float _e92 = shadowfit_disc_tap(disc, metal::float2(-0.38714585, 0.55067515), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e88 + _e92;
    float _e94 = sum;
    float _e98 = shadowfit_disc_tap(disc, metal::float2(-0.08943965, -0.6901997), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e94 + _e98;
    float _e100 = sum;
    float _e104 = shadowfit_disc_tap(disc, metal::float2(0.5490717, 0.46275827), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e100 + _e104;
    float _e106 = sum;
    float _e110 = shadowfit_disc_tap(disc, metal::float2(-0.7388785, 0.030554945), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e106 + _e110;
    float _e112 = sum;
    float _e116 = shadowfit_disc_tap(disc, metal::float2(0.53895515, -0.5363323), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e112 + _e116;
    float _e118 = sum;
    float _e122 = shadowfit_disc_tap(disc, metal::float2(-0.036058187, 0.77979153), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e118 + _e122;
    float _e124 = sum;
    float _e128 = shadowfit_disc_tap(disc, metal::float2(-0.51281756, -0.6145268), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e124 + _e128;
    float _e130 = sum;
    float _e134 = shadowfit_disc_tap(disc, metal::float2(0.8123596, 0.109301835), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e130 + _e134;
    float _e136 = sum;
    float _e140 = shadowfit_disc_tap(disc, metal::float2(-0.6883106, 0.47890863), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e136 + _e140;
    float _e142 = sum;
    float _e146 = shadowfit_disc_tap(disc, metal::float2(0.18808606, -0.83606136), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e142 + _e146;
    float _e148 = sum;
    float _e152 = shadowfit_disc_tap(disc, metal::float2(0.43503326, 0.75919104), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e148 + _e152;
    float _e154 = sum;
    float _e158 = shadowfit_disc_tap(disc, metal::float2(-0.8504484, -0.27131623), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e154 + _e158;
    float _e160 = sum;
    float _e164 = shadowfit_disc_tap(disc, metal::float2(0.8261024, -0.38168025), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e160 + _e164;
    float _e166 = sum;
    float _e170 = shadowfit_disc_tap(disc, metal::float2(-0.3578882, 0.8551556), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e166 + _e170;
    float _e172 = sum;
    float _e176 = shadowfit_disc_tap(disc, metal::float2(-0.31940734, -0.88803375), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e172 + _e176;
    float _e178 = sum;
    float _e182 = shadowfit_disc_tap(disc, metal::float2(0.84990865, 0.44668815), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e178 + _e182;
    float _e184 = sum;
    float _e188 = shadowfit_disc_tap(disc, metal::float2(-0.94403464, 0.2488445), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e184 + _e188;
    float _e190 = sum;
    float _e194 = shadowfit_disc_tap(disc, metal::float2(0.5365958, -0.83452976), projected, shadowfit_texture, shadowfit_sampler);
    sum = _e190 + _e194;
    float _e196 = sum;
    return _e196;
}

float shadowfit_disc(
    metal::float2 radii,
    shadowfit_Projected projected,
    float turn,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 direction = {};
    float sum = 0.0;
    bool local = {};
    uint tap = 0u;
    direction = metal::float2(metal::cos(turn), metal::sin(turn));
    metal::float2 least = radii + metal::float2(0.5);
    if (metal::all(projected.texel >= least)) {
        local = metal::all(projected.texel <= (projected.size - least));
    } else {
        local = false;
    }
    bool _e23 = local;
    if (_e23) {
        metal::float2 _e24 = direction;
        metal::float2 a = radii * _e24;
        float _e27 = direction.y;
        float _e30 = direction.x;
        metal::float2 b = radii * metal::float2(-(_e27), _e30);
        metal::float2 _e35 = shadowfit_along_u(projected.texel.x, projected);
        metal::float2 _e39 = shadowfit_along_v(projected.texel.y, projected);
        metal::float2 at = metal::float2(_e35.x, _e39.x);
        metal::float2 rise = metal::float2(metal::dot(projected.gradient, a), metal::dot(projected.gradient, b));
        shadowfit_Disc disc = shadowfit_Disc {at, a * projected.unit, b * projected.unit, rise};
        float _e52 = shadowfit_disc_taps(disc, projected, shadowfit_texture, shadowfit_sampler);
        sum = _e52;
    } else {
        bool loop_init = true;
        while(true) {
            if (!loop_init) {
                uint _e75 = tap;
                tap = _e75 + 1u;
            }
            loop_init = false;
            uint _e55 = tap;
            if (_e55 < SHADOWFIT_TAPS) {
            } else {
                break;
            }
            {
                uint _e58 = tap;
                float radius = metal::sqrt((static_cast<float>(_e58) + 0.5) / 32.0);
                float _e65 = sum;
                metal::float2 _e68 = direction;
                float _e71 = shadowfit_look_up(projected.texel + ((radii * radius) * _e68), projected, shadowfit_texture, shadowfit_sampler);
                sum = _e65 + _e71;
                metal::float2 _e73 = direction;
                metal::float2 _e74 = shadowfit_golden(_e73);
                direction = _e74;
            }
        }
    }
    float _e78 = sum;
    return _e78 / 32.0;
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_PCSS
metal::float2 shadowfit_casters(
    shadowfit_Projected projected,
    float turn,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture
) {
    float radius = {};
    metal::float2 direction = {};
    metal::float2 found = metal::float2(0.0);
    uint tap = 0u;
    bool local = {};
    metal::float2 last = projected.size - metal::float2(1.0);
    float start = metal::min(SHADOWFIT_SEARCH_START / metal::max(projected.disc.x, projected.disc.y), 1.0);
    float growth = metal::pow(1.0 / start, 0.05);
    radius = start * metal::sqrt(growth);
    direction = metal::float2(metal::cos(turn), metal::sin(turn));
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e95 = tap;
            tap = _e95 + 1u;
        }
        loop_init = false;
        uint _e31 = tap;
        if (_e31 < SHADOWFIT_SEARCH) {
        } else {
            break;
        }
        {
            float _e36 = radius;
            metal::float2 _e38 = direction;
            metal::float2 texel_1 = metal::clamp(metal::floor(projected.texel + ((projected.disc * _e36) * _e38)), metal::float2(0.0), last);
            metal::float2 offset = (texel_1 + metal::float2(0.5)) - projected.texel;
            float _e52 = shadowfit_stored_texel(texel_1 + projected.texel_offset, projected, shadowfit_texture);
            float distance = projected.surface - _e52;
            float _e59 = shadowfit_receiver.least_disc;
            metal::float2 cone = metal::max(distance * projected.penumbra, metal::float2(_e59));
            metal::float2 radii = cone + metal::float2(0.5);
            metal::float2 place = offset * radii.yx;
            bool is_within = metal::dot(place, place) <= (((radii.x * radii.x) * radii.y) * radii.y);
            bool is_lit = metal::saturate(projected.depth + metal::dot(projected.gradient, offset)) <= _e52;
            if (is_within) {
                local = !(is_lit);
            } else {
                local = false;
            }
            bool _e86 = local;
            if (_e86) {
                metal::float2 _e87 = found;
                found = _e87 + metal::float2(distance, 1.0);
            }
            float _e91 = radius;
            radius = _e91 * growth;
            metal::float2 _e93 = direction;
            metal::float2 _e94 = shadowfit_golden(_e93);
            direction = _e94;
        }
    }
    metal::float2 _e98 = found;
    return _e98;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCSS_REVERSED
metal::float2 shadowfit_casters(
    shadowfit_Projected projected,
    float turn,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture
) {
    float radius = {};
    metal::float2 direction = {};
    metal::float2 found = metal::float2(0.0);
    uint tap = 0u;
    bool local = {};
    metal::float2 last = projected.size - metal::float2(1.0);
    float start = metal::min(SHADOWFIT_SEARCH_START / metal::max(projected.disc.x, projected.disc.y), 1.0);
    float growth = metal::pow(1.0 / start, 0.05);
    radius = start * metal::sqrt(growth);
    direction = metal::float2(metal::cos(turn), metal::sin(turn));
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e95 = tap;
            tap = _e95 + 1u;
        }
        loop_init = false;
        uint _e31 = tap;
        if (_e31 < SHADOWFIT_SEARCH) {
        } else {
            break;
        }
        {
            float _e36 = radius;
            metal::float2 _e38 = direction;
            metal::float2 texel_1 = metal::clamp(metal::floor(projected.texel + ((projected.disc * _e36) * _e38)), metal::float2(0.0), last);
            metal::float2 offset = (texel_1 + metal::float2(0.5)) - projected.texel;
            float _e52 = shadowfit_stored_texel(texel_1 + projected.texel_offset, projected, shadowfit_texture);
            float distance = projected.surface - _e52;
            float _e59 = shadowfit_receiver.least_disc;
            metal::float2 cone = metal::max(distance * projected.penumbra, metal::float2(_e59));
            metal::float2 radii = cone + metal::float2(0.5);
            metal::float2 place = offset * radii.yx;
            bool is_within = metal::dot(place, place) <= (((radii.x * radii.x) * radii.y) * radii.y);
            bool is_lit = metal::saturate(projected.depth + metal::dot(projected.gradient, offset)) >= _e52;
            if (is_within) {
                local = !(is_lit);
            } else {
                local = false;
            }
            bool _e86 = local;
            if (_e86) {
                metal::float2 _e87 = found;
                found = _e87 + metal::float2(distance, 1.0);
            }
            float _e91 = radius;
            radius = _e91 * growth;
            metal::float2 _e93 = direction;
            metal::float2 _e94 = shadowfit_golden(_e93);
            direction = _e94;
        }
    }
    metal::float2 _e98 = found;
    return _e98;
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_PCF_5X5
float shadowfit_tent_row(
    shadowfit_Columns columns,
    float y,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 _e3 = shadowfit_along_v(y, projected);
    float _e7 = shadowfit_tap(columns.u0_, _e3, projected, shadowfit_texture, shadowfit_sampler);
    float _e12 = shadowfit_tap(columns.u1_, _e3, projected, shadowfit_texture, shadowfit_sampler);
    float _e18 = shadowfit_tap(columns.u2_, _e3, projected, shadowfit_texture, shadowfit_sampler);
    return ((columns.weights.x * _e7) + (columns.weights.y * _e12)) + (columns.weights.z * _e18);
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_7X7
float shadowfit_tent_row(
    shadowfit_Columns columns,
    float y,
    shadowfit_Projected projected,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 _e3 = shadowfit_along_v(y, projected);
    float _e7 = shadowfit_tap(columns.u0_, _e3, projected, shadowfit_texture, shadowfit_sampler);
    float _e12 = shadowfit_tap(columns.u1_, _e3, projected, shadowfit_texture, shadowfit_sampler);
    float _e18 = shadowfit_tap(columns.u2_, _e3, projected, shadowfit_texture, shadowfit_sampler);
    float _e24 = shadowfit_tap(columns.u3_, _e3, projected, shadowfit_texture, shadowfit_sampler);
    return (((columns.weights.x * _e7) + (columns.weights.y * _e12)) + (columns.weights.z * _e18)) + (columns.weights.w * _e24);
}
#endif

#if SHADOWFIT_FILTER == SHADOWFIT_POINT || SHADOWFIT_FILTER == SHADOWFIT_PCF_2X2
float shadowfit_compare(
    shadowfit_Projected projected,
    float turn,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float _e3 = shadowfit_look_up(projected.texel, projected, shadowfit_texture, shadowfit_sampler);
    return _e3;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_3X3
float shadowfit_compare(
    shadowfit_Projected projected,
    float turn,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 base = metal::floor(projected.texel - metal::float2(0.5));
    metal::float2 t = (projected.texel - metal::float2(0.5)) - base;
    metal::float2 centre = base + metal::float2(0.5);
    metal::float2 w0_ = metal::float2(3.0) - (2.0 * t);
    metal::float2 w1_ = metal::float2(1.0) + (2.0 * t);
    metal::float2 p0_ = (centre - metal::float2(1.0)) + ((metal::float2(2.0) - t) / w0_);
    metal::float2 p1_ = (centre + metal::float2(1.0)) + (t / w1_);
    metal::float2 _e39 = shadowfit_along_u(p0_.x, projected);
    metal::float2 _e41 = shadowfit_along_u(p1_.x, projected);
    metal::float2 _e43 = shadowfit_along_v(p0_.y, projected);
    metal::float2 _e45 = shadowfit_along_v(p1_.y, projected);
    float _e47 = shadowfit_tap(_e39, _e43, projected, shadowfit_texture, shadowfit_sampler);
    float _e50 = shadowfit_tap(_e41, _e43, projected, shadowfit_texture, shadowfit_sampler);
    float top = (w0_.x * _e47) + (w1_.x * _e50);
    float _e54 = shadowfit_tap(_e39, _e45, projected, shadowfit_texture, shadowfit_sampler);
    float _e57 = shadowfit_tap(_e41, _e45, projected, shadowfit_texture, shadowfit_sampler);
    float bottom = (w0_.x * _e54) + (w1_.x * _e57);
    return ((w0_.y * top) + (w1_.y * bottom)) / 16.0;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_5X5
float shadowfit_compare(
    shadowfit_Projected projected,
    float turn,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 base = metal::floor(projected.texel - metal::float2(0.5));
    metal::float2 t = (projected.texel - metal::float2(0.5)) - base;
    metal::float2 centre = base + metal::float2(0.5);
    metal::float2 w0_ = metal::float2(3.0) - (2.0 * t);
    metal::float2 w2_ = metal::float2(1.0) + (2.0 * t);
    metal::float2 p0_ = (centre - metal::float2(2.0)) + ((metal::float2(2.0) - t) / w0_);
    metal::float2 p1_ = centre + ((metal::float2(2.0) + t) / metal::float2(5.0));
    metal::float2 p2_ = (centre + metal::float2(2.0)) + (t / w2_);
    metal::float2 _e46 = shadowfit_along_u(p0_.x, projected);
    metal::float2 _e48 = shadowfit_along_u(p1_.x, projected);
    metal::float2 _e50 = shadowfit_along_u(p2_.x, projected);
    shadowfit_Columns columns = shadowfit_Columns {_e46, _e48, _e50, {}, metal::float3(w0_.x, 5.0, w2_.x)};
    float _e58 = shadowfit_tent_row(columns, p0_.y, projected, shadowfit_texture, shadowfit_sampler);
    float _e61 = shadowfit_tent_row(columns, p1_.y, projected, shadowfit_texture, shadowfit_sampler);
    float _e67 = shadowfit_tent_row(columns, p2_.y, projected, shadowfit_texture, shadowfit_sampler);
    return (((w0_.y * _e58) + (5.0 * _e61)) + (w2_.y * _e67)) / 81.0;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_PCF_7X7
float shadowfit_compare(
    shadowfit_Projected projected,
    float turn,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 base = metal::floor(projected.texel - metal::float2(0.5));
    metal::float2 t = (projected.texel - metal::float2(0.5)) - base;
    metal::float2 centre = base + metal::float2(0.5);
    metal::float2 w0_ = metal::float2(3.0) - (2.0 * t);
    metal::float2 w1_ = metal::float2(7.0) - (2.0 * t);
    metal::float2 w2_ = metal::float2(5.0) + (2.0 * t);
    metal::float2 w3_ = metal::float2(1.0) + (2.0 * t);
    metal::float2 p0_ = (centre - metal::float2(3.0)) + ((metal::float2(2.0) - t) / w0_);
    metal::float2 p1_ = (centre - metal::float2(1.0)) + ((metal::float2(4.0) - t) / w1_);
    metal::float2 p2_ = (centre + metal::float2(1.0)) + ((metal::float2(2.0) + t) / w2_);
    metal::float2 p3_ = (centre + metal::float2(3.0)) + (t / w3_);
    metal::float2 _e65 = shadowfit_along_u(p0_.x, projected);
    metal::float2 _e67 = shadowfit_along_u(p1_.x, projected);
    metal::float2 _e69 = shadowfit_along_u(p2_.x, projected);
    metal::float2 _e71 = shadowfit_along_u(p3_.x, projected);
    shadowfit_Columns columns = shadowfit_Columns {_e65, _e67, _e69, _e71, metal::float4(w0_.x, w1_.x, w2_.x, w3_.x)};
    float _e80 = shadowfit_tent_row(columns, p0_.y, projected, shadowfit_texture, shadowfit_sampler);
    float _e84 = shadowfit_tent_row(columns, p1_.y, projected, shadowfit_texture, shadowfit_sampler);
    float _e89 = shadowfit_tent_row(columns, p2_.y, projected, shadowfit_texture, shadowfit_sampler);
    float _e94 = shadowfit_tent_row(columns, p3_.y, projected, shadowfit_texture, shadowfit_sampler);
    return ((((w0_.y * _e80) + (w1_.y * _e84)) + (w2_.y * _e89)) + (w3_.y * _e94)) / 256.0;
}
#elif SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32
float shadowfit_compare(
    shadowfit_Projected projected,
    float turn,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float _e3 = shadowfit_disc(projected.disc, projected, turn, shadowfit_texture, shadowfit_sampler);
    return _e3;
}
#else
float shadowfit_compare(
    shadowfit_Projected projected,
    float turn,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    metal::float2 _e2 = shadowfit_casters(projected, turn, shadowfit_receiver, shadowfit_texture);
    if (_e2.y == 0.0) {
        return 1.0;
    }
    metal::float2 radius = (_e2.x / _e2.y) * projected.penumbra;
    metal::float2 own = metal::sqrt(metal::max((radius * radius) - metal::float2(0.6666667), metal::float2(0.0)));
    float _e22 = shadowfit_receiver.least_disc;
    metal::float2 least = metal::float2(_e22);
    float _e26 = shadowfit_receiver.greatest_disc;
    float _e29 = shadowfit_disc(metal::clamp(own, least, metal::float2(_e26)), projected, turn, shadowfit_texture, shadowfit_sampler);
    return _e29;
}
#endif

#if SHADOWFIT_BY_VIEW_DEPTH
bool shadowfit_is_open(
    shadowfit_Selection selection,
    int entry,
    float view_depth,
    float far,
    float blend_near
) {
    bool local = {};
    bool local_1 = {};
    if (selection.first < 0) {
        return view_depth < far;
    }
    if (as_type<int>(as_type<uint>(selection.first) + as_type<uint>(1)) == entry) {
        local = view_depth > blend_near;
    } else {
        local = false;
    }
    bool _e17 = local;
    if (_e17) {
        local_1 = blend_near < selection.far;
    } else {
        local_1 = false;
    }
    bool _e23 = local_1;
    return _e23;
}

shadowfit_Selection shadowfit_try(
    shadowfit_Selection selection,
    int entry,
    float view_depth,
    float far_1,
    float blend_near,
    float free
) {
    shadowfit_Selection next = {};
    next = selection;
    if (free >= 0.0) {
        if (selection.first < 0) {
            next.first = entry;
            next.far = far_1;
        } else {
            next.second = entry;
            next.weight = (selection.far - view_depth) / (selection.far - blend_near);
        }
    }
    shadowfit_Selection _e21 = next;
    return _e21;
}
#else
bool shadowfit_is_open(
    shadowfit_Selection selection,
    int entry,
    float view_depth,
    float far,
    float blend_near
) {
    bool local = {};
    bool local_1 = {};
    if (!((selection.first < 0))) {
        if (selection.second < 0) {
            local_1 = selection.weight < 1.0;
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

shadowfit_Selection shadowfit_try(
    shadowfit_Selection selection,
    int entry,
    float view_depth,
    float far,
    float blend_near,
    float free
) {
    shadowfit_Selection next = {};
    bool local = {};
    next = selection;
    if (free >= SHADOWFIT_REACH) {
        if (selection.first < 0) {
            next.first = entry;
            float beyond = free - SHADOWFIT_REACH;
            next.weight = 1.0;
            if (beyond < SHADOWFIT_BLEND) {
                next.weight = beyond / SHADOWFIT_BLEND;
            }
        } else {
            next.second = entry;
        }
    } else {
        if (free >= 0.0) {
            local = selection.clamped < 0;
        } else {
            local = false;
        }
        bool _e31 = local;
        if (_e31) {
            next.clamped = entry;
        }
    }
    shadowfit_Selection _e33 = next;
    return _e33;
}
#endif

float shadowfit_faded(
    metal::float3 position,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    float _e1 = shadowfit_view_depth(position, shadowfit_receiver);
    float _e4 = shadowfit_receiver.fade_near;
    float beyond = _e1 - _e4;
    if (beyond <= 0.0) {
        return 0.0;
    }
    float _e11 = shadowfit_receiver.fade_width;
    float share = metal::saturate(beyond / metal::max(_e11, 0.000000000000000000000000000001));
    return (share * share) * (3.0 - (2.0 * share));
}

#if SHADOWFIT_MAPS <= 1
shadowfit_Selection shadowfit_select(
    metal::float3 position,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    shadowfit_Selection selection = shadowfit_Selection {-1, -1, 1.0, -1, 0.0};
    float _e1 = shadowfit_view_depth(position, shadowfit_receiver);
    shadowfit_Selection _e9 = selection;
    float _e15 = shadowfit_receiver.maps.inner[0].far;
    float _e20 = shadowfit_receiver.maps.inner[0].blend_near;
    bool _e21 = shadowfit_is_open(_e9, 0, _e1, _e15, _e20);
    if (_e21) {
        shadowfit_Map _e26 = shadowfit_receiver.maps.inner[0];
        float _e27 = shadowfit_free(0u, _e26, position, shadowfit_receiver);
        shadowfit_Selection _e28 = selection;
        float _e34 = shadowfit_receiver.maps.inner[0].far;
        float _e39 = shadowfit_receiver.maps.inner[0].blend_near;
        shadowfit_Selection _e40 = shadowfit_try(_e28, 0, _e1, _e34, _e39, _e27);
        selection = _e40;
    }
    int _e43 = selection.first;
    int _e45 = selection.clamped;
    int _e47 = selection.first;
    selection.first = (_e47 < 0) ? _e45 : _e43;
    float _e51 = shadowfit_faded(position, shadowfit_receiver);
    if (_e51 >= 1.0) {
        return shadowfit_Selection {-1, -1, 1.0, -1, 0.0};
    }
    shadowfit_Selection _e60 = selection;
    return _e60;
}

shadowfit_Map shadowfit_entry(
    int entry,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    shadowfit_Map _e4 = shadowfit_receiver.maps.inner[0];
    return _e4;
}
#elif SHADOWFIT_MAPS <= 4
shadowfit_Selection shadowfit_select(
    metal::float3 position,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    shadowfit_Selection selection = shadowfit_Selection {-1, -1, 1.0, -1, 0.0};
    float _e1 = shadowfit_view_depth(position, shadowfit_receiver);
    shadowfit_Selection _e9 = selection;
    float _e15 = shadowfit_receiver.maps.inner[0].far;
    float _e20 = shadowfit_receiver.maps.inner[0].blend_near;
    bool _e21 = shadowfit_is_open(_e9, 0, _e1, _e15, _e20);
    if (_e21) {
        shadowfit_Map _e26 = shadowfit_receiver.maps.inner[0];
        float _e27 = shadowfit_free(0u, _e26, position, shadowfit_receiver);
        shadowfit_Selection _e28 = selection;
        float _e34 = shadowfit_receiver.maps.inner[0].far;
        float _e39 = shadowfit_receiver.maps.inner[0].blend_near;
        shadowfit_Selection _e40 = shadowfit_try(_e28, 0, _e1, _e34, _e39, _e27);
        selection = _e40;
    }
    shadowfit_Selection _e41 = selection;
    float _e47 = shadowfit_receiver.maps.inner[1].far;
    float _e52 = shadowfit_receiver.maps.inner[1].blend_near;
    bool _e53 = shadowfit_is_open(_e41, 1, _e1, _e47, _e52);
    if (_e53) {
        shadowfit_Map _e58 = shadowfit_receiver.maps.inner[1];
        float _e59 = shadowfit_free(1u, _e58, position, shadowfit_receiver);
        shadowfit_Selection _e60 = selection;
        float _e66 = shadowfit_receiver.maps.inner[1].far;
        float _e71 = shadowfit_receiver.maps.inner[1].blend_near;
        shadowfit_Selection _e72 = shadowfit_try(_e60, 1, _e1, _e66, _e71, _e59);
        selection = _e72;
    }
    shadowfit_Selection _e73 = selection;
    float _e79 = shadowfit_receiver.maps.inner[2].far;
    float _e84 = shadowfit_receiver.maps.inner[2].blend_near;
    bool _e85 = shadowfit_is_open(_e73, 2, _e1, _e79, _e84);
    if (_e85) {
        shadowfit_Map _e90 = shadowfit_receiver.maps.inner[2];
        float _e91 = shadowfit_free(2u, _e90, position, shadowfit_receiver);
        shadowfit_Selection _e92 = selection;
        float _e98 = shadowfit_receiver.maps.inner[2].far;
        float _e103 = shadowfit_receiver.maps.inner[2].blend_near;
        shadowfit_Selection _e104 = shadowfit_try(_e92, 2, _e1, _e98, _e103, _e91);
        selection = _e104;
    }
    shadowfit_Selection _e105 = selection;
    float _e111 = shadowfit_receiver.maps.inner[3].far;
    float _e116 = shadowfit_receiver.maps.inner[3].blend_near;
    bool _e117 = shadowfit_is_open(_e105, 3, _e1, _e111, _e116);
    if (_e117) {
        shadowfit_Map _e122 = shadowfit_receiver.maps.inner[3];
        float _e123 = shadowfit_free(3u, _e122, position, shadowfit_receiver);
        shadowfit_Selection _e124 = selection;
        float _e130 = shadowfit_receiver.maps.inner[3].far;
        float _e135 = shadowfit_receiver.maps.inner[3].blend_near;
        shadowfit_Selection _e136 = shadowfit_try(_e124, 3, _e1, _e130, _e135, _e123);
        selection = _e136;
    }
    int _e139 = selection.first;
    int _e141 = selection.clamped;
    int _e143 = selection.first;
    selection.first = (_e143 < 0) ? _e141 : _e139;
    float _e147 = shadowfit_faded(position, shadowfit_receiver);
    if (_e147 >= 1.0) {
        return shadowfit_Selection {-1, -1, 1.0, -1, 0.0};
    }
    shadowfit_Selection _e156 = selection;
    return _e156;
}

shadowfit_Map shadowfit_entry(
    int entry,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    if (entry == 1) {
        shadowfit_Map _e6 = shadowfit_receiver.maps.inner[1];
        return _e6;
    }
    if (entry == 2) {
        shadowfit_Map _e12 = shadowfit_receiver.maps.inner[2];
        return _e12;
    }
    if (entry == 3) {
        shadowfit_Map _e18 = shadowfit_receiver.maps.inner[3];
        return _e18;
    }
    shadowfit_Map _e22 = shadowfit_receiver.maps.inner[0];
    return _e22;
}
#else
shadowfit_Selection shadowfit_select(
    metal::float3 position,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    shadowfit_Selection selection = shadowfit_Selection {-1, -1, 1.0, -1, 0.0};
    float _e1 = shadowfit_view_depth(position, shadowfit_receiver);
    shadowfit_Selection _e9 = selection;
    float _e15 = shadowfit_receiver.maps.inner[0].far;
    float _e20 = shadowfit_receiver.maps.inner[0].blend_near;
    bool _e21 = shadowfit_is_open(_e9, 0, _e1, _e15, _e20);
    if (_e21) {
        shadowfit_Map _e26 = shadowfit_receiver.maps.inner[0];
        float _e27 = shadowfit_free(0u, _e26, position, shadowfit_receiver);
        shadowfit_Selection _e28 = selection;
        float _e34 = shadowfit_receiver.maps.inner[0].far;
        float _e39 = shadowfit_receiver.maps.inner[0].blend_near;
        shadowfit_Selection _e40 = shadowfit_try(_e28, 0, _e1, _e34, _e39, _e27);
        selection = _e40;
    }
    shadowfit_Selection _e41 = selection;
    float _e47 = shadowfit_receiver.maps.inner[1].far;
    float _e52 = shadowfit_receiver.maps.inner[1].blend_near;
    bool _e53 = shadowfit_is_open(_e41, 1, _e1, _e47, _e52);
    if (_e53) {
        shadowfit_Map _e58 = shadowfit_receiver.maps.inner[1];
        float _e59 = shadowfit_free(1u, _e58, position, shadowfit_receiver);
        shadowfit_Selection _e60 = selection;
        float _e66 = shadowfit_receiver.maps.inner[1].far;
        float _e71 = shadowfit_receiver.maps.inner[1].blend_near;
        shadowfit_Selection _e72 = shadowfit_try(_e60, 1, _e1, _e66, _e71, _e59);
        selection = _e72;
    }
    shadowfit_Selection _e73 = selection;
    float _e79 = shadowfit_receiver.maps.inner[2].far;
    float _e84 = shadowfit_receiver.maps.inner[2].blend_near;
    bool _e85 = shadowfit_is_open(_e73, 2, _e1, _e79, _e84);
    if (_e85) {
        shadowfit_Map _e90 = shadowfit_receiver.maps.inner[2];
        float _e91 = shadowfit_free(2u, _e90, position, shadowfit_receiver);
        shadowfit_Selection _e92 = selection;
        float _e98 = shadowfit_receiver.maps.inner[2].far;
        float _e103 = shadowfit_receiver.maps.inner[2].blend_near;
        shadowfit_Selection _e104 = shadowfit_try(_e92, 2, _e1, _e98, _e103, _e91);
        selection = _e104;
    }
    shadowfit_Selection _e105 = selection;
    float _e111 = shadowfit_receiver.maps.inner[3].far;
    float _e116 = shadowfit_receiver.maps.inner[3].blend_near;
    bool _e117 = shadowfit_is_open(_e105, 3, _e1, _e111, _e116);
    if (_e117) {
        shadowfit_Map _e122 = shadowfit_receiver.maps.inner[3];
        float _e123 = shadowfit_free(3u, _e122, position, shadowfit_receiver);
        shadowfit_Selection _e124 = selection;
        float _e130 = shadowfit_receiver.maps.inner[3].far;
        float _e135 = shadowfit_receiver.maps.inner[3].blend_near;
        shadowfit_Selection _e136 = shadowfit_try(_e124, 3, _e1, _e130, _e135, _e123);
        selection = _e136;
    }
    shadowfit_Selection _e137 = selection;
    float _e143 = shadowfit_receiver.maps.inner[4].far;
    float _e148 = shadowfit_receiver.maps.inner[4].blend_near;
    bool _e149 = shadowfit_is_open(_e137, 4, _e1, _e143, _e148);
    if (_e149) {
        shadowfit_Map _e154 = shadowfit_receiver.maps.inner[4];
        float _e155 = shadowfit_free(4u, _e154, position, shadowfit_receiver);
        shadowfit_Selection _e156 = selection;
        float _e162 = shadowfit_receiver.maps.inner[4].far;
        float _e167 = shadowfit_receiver.maps.inner[4].blend_near;
        shadowfit_Selection _e168 = shadowfit_try(_e156, 4, _e1, _e162, _e167, _e155);
        selection = _e168;
    }
    shadowfit_Selection _e169 = selection;
    float _e175 = shadowfit_receiver.maps.inner[5].far;
    float _e180 = shadowfit_receiver.maps.inner[5].blend_near;
    bool _e181 = shadowfit_is_open(_e169, 5, _e1, _e175, _e180);
    if (_e181) {
        shadowfit_Map _e186 = shadowfit_receiver.maps.inner[5];
        float _e187 = shadowfit_free(5u, _e186, position, shadowfit_receiver);
        shadowfit_Selection _e188 = selection;
        float _e194 = shadowfit_receiver.maps.inner[5].far;
        float _e199 = shadowfit_receiver.maps.inner[5].blend_near;
        shadowfit_Selection _e200 = shadowfit_try(_e188, 5, _e1, _e194, _e199, _e187);
        selection = _e200;
    }
    shadowfit_Selection _e201 = selection;
    float _e207 = shadowfit_receiver.maps.inner[6].far;
    float _e212 = shadowfit_receiver.maps.inner[6].blend_near;
    bool _e213 = shadowfit_is_open(_e201, 6, _e1, _e207, _e212);
    if (_e213) {
        shadowfit_Map _e218 = shadowfit_receiver.maps.inner[6];
        float _e219 = shadowfit_free(6u, _e218, position, shadowfit_receiver);
        shadowfit_Selection _e220 = selection;
        float _e226 = shadowfit_receiver.maps.inner[6].far;
        float _e231 = shadowfit_receiver.maps.inner[6].blend_near;
        shadowfit_Selection _e232 = shadowfit_try(_e220, 6, _e1, _e226, _e231, _e219);
        selection = _e232;
    }
    shadowfit_Selection _e233 = selection;
    float _e239 = shadowfit_receiver.maps.inner[7].far;
    float _e244 = shadowfit_receiver.maps.inner[7].blend_near;
    bool _e245 = shadowfit_is_open(_e233, 7, _e1, _e239, _e244);
    if (_e245) {
        shadowfit_Map _e250 = shadowfit_receiver.maps.inner[7];
        float _e251 = shadowfit_free(7u, _e250, position, shadowfit_receiver);
        shadowfit_Selection _e252 = selection;
        float _e258 = shadowfit_receiver.maps.inner[7].far;
        float _e263 = shadowfit_receiver.maps.inner[7].blend_near;
        shadowfit_Selection _e264 = shadowfit_try(_e252, 7, _e1, _e258, _e263, _e251);
        selection = _e264;
    }
    int _e267 = selection.first;
    int _e269 = selection.clamped;
    int _e271 = selection.first;
    selection.first = (_e271 < 0) ? _e269 : _e267;
    float _e275 = shadowfit_faded(position, shadowfit_receiver);
    if (_e275 >= 1.0) {
        return shadowfit_Selection {-1, -1, 1.0, -1, 0.0};
    }
    shadowfit_Selection _e284 = selection;
    return _e284;
}

shadowfit_Map shadowfit_entry(
    int entry,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    if (entry == 1) {
        shadowfit_Map _e6 = shadowfit_receiver.maps.inner[1];
        return _e6;
    }
    if (entry == 2) {
        shadowfit_Map _e12 = shadowfit_receiver.maps.inner[2];
        return _e12;
    }
    if (entry == 3) {
        shadowfit_Map _e18 = shadowfit_receiver.maps.inner[3];
        return _e18;
    }
    if (entry == 4) {
        shadowfit_Map _e24 = shadowfit_receiver.maps.inner[4];
        return _e24;
    }
    if (entry == 5) {
        shadowfit_Map _e30 = shadowfit_receiver.maps.inner[5];
        return _e30;
    }
    if (entry == 6) {
        shadowfit_Map _e36 = shadowfit_receiver.maps.inner[6];
        return _e36;
    }
    if (entry == 7) {
        shadowfit_Map _e42 = shadowfit_receiver.maps.inner[7];
        return _e42;
    }
    shadowfit_Map _e46 = shadowfit_receiver.maps.inner[0];
    return _e46;
}
#endif

float shadowfit_turn(
    metal::float2 pixel,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    float _e4 = shadowfit_receiver.frame_shift;
    metal::float2 at = metal::floor(pixel) + metal::float2(_e4);
    float noise = metal::fract(52.982918 * metal::fract(metal::dot(at, metal::float2(0.06711056, 0.00583715))));
    return noise * 6.2831855;
}

#if SHADOWFIT_FILTER == SHADOWFIT_POINT || SHADOWFIT_FILTER == SHADOWFIT_PCF_2X2 || SHADOWFIT_FILTER == SHADOWFIT_PCF_3X3 || SHADOWFIT_FILTER == SHADOWFIT_PCF_5X5 || SHADOWFIT_FILTER == SHADOWFIT_PCF_7X7 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_8 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_16 || SHADOWFIT_FILTER == SHADOWFIT_VOGEL_32
float shadowfit_read(
    int entry,
    metal::float3 position,
    metal::float3 normal,
    float turn,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    shadowfit_Map _e4 = shadowfit_entry(entry, shadowfit_receiver);
    shadowfit_Projected _e5 = shadowfit_project(_e4, position, normal, shadowfit_receiver, shadowfit_texture);
    float _e6 = shadowfit_compare(_e5, turn, shadowfit_texture, shadowfit_sampler);
    return _e6;
}
#else
float shadowfit_read(
    int entry,
    metal::float3 position,
    metal::float3 normal,
    float turn,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    shadowfit_Map _e4 = shadowfit_entry(entry, shadowfit_receiver);
    shadowfit_Projected _e5 = shadowfit_project(_e4, position, normal, shadowfit_receiver, shadowfit_texture);
    float _e6 = shadowfit_compare(_e5, turn, shadowfit_receiver, shadowfit_texture, shadowfit_sampler);
    return _e6;
}
#endif

float shadowfit_turned(
    metal::float3 position,
    metal::float3 normal,
    float turn,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float factor = {};
    uint _e6 = shadowfit_receiver.is_off;
    float lit = static_cast<float>(1u - _e6);
    float _e9 = shadowfit_faded(position, shadowfit_receiver);
    shadowfit_Selection _e10 = shadowfit_select(position, shadowfit_receiver);
    if (_e10.first < 0) {
        return lit;
    }
    float _e15 = shadowfit_read(_e10.first, position, normal, turn, shadowfit_receiver, shadowfit_texture, shadowfit_sampler);
    factor = _e15;
    if (_e10.second >= 0) {
        float _e21 = shadowfit_read(_e10.second, position, normal, turn, shadowfit_receiver, shadowfit_texture, shadowfit_sampler);
        float _e22 = factor;
        factor = metal::mix(_e21, _e22, _e10.weight);
    }
    float _e25 = factor;
    return lit * metal::mix(_e25, 1.0, _e9);
}

float shadowfit_factor(
    metal::float3 position,
    metal::float3 normal,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float _e3 = shadowfit_turned(position, normal, 0.0, shadowfit_receiver, shadowfit_texture, shadowfit_sampler);
    return _e3;
}

float shadowfit_factor_at(
    metal::float3 position,
    metal::float3 normal,
    metal::float2 pixel,
    constant shadowfit_Receiver& shadowfit_receiver,
    metal::depth2d_array<float, metal::access::sample> shadowfit_texture,
    metal::sampler shadowfit_sampler
) {
    float _e3 = shadowfit_turn(pixel, shadowfit_receiver);
    float _e4 = shadowfit_turned(position, normal, _e3, shadowfit_receiver, shadowfit_texture, shadowfit_sampler);
    return _e4;
}

int shadowfit_map_index(
    metal::float3 position,
    constant shadowfit_Receiver& shadowfit_receiver
) {
    bool local = {};
    shadowfit_Selection _e1 = shadowfit_select(position, shadowfit_receiver);
    if (_e1.first < 0) {
        return -1;
    }
    if (_e1.second >= 0) {
        local = _e1.weight < 0.5;
    } else {
        local = false;
    }
    bool is_second = local;
    shadowfit_Map _e19 = shadowfit_entry(is_second ? _e1.second : _e1.first, shadowfit_receiver);
    return static_cast<int>(_e19.layer);
}

#endif
