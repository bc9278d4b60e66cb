// shadowfit_demand.metal: Counts the visible demand of a depth buffer. A whole compute shader.
// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL has the comments.
//
// Constants: ShadowfitDemandConstants of shadowfit.h, struct Demand below.
// Workgroups: the view's counted points, in squares of 32 x 32. Clear `counts` to 0 before. Its first cells are
// the demand grid, the others the depth histogram.
//
// Kernel: count_demand, Metal 2.0. Constants: buffer 0. Depth texture: texture 1. Counts: buffer 2. Threadgroup
// memory: 1024 bytes at indices 0 and 1 each.

#include <metal_stdlib>
#include <simd/simd.h>
using metal::uint;

struct Demand {
    metal::float4x4 world_from_pixel;
    metal::float4 view;
    metal::packed_float3 direction;
    float far_depth;
    metal::packed_float3 x;
    float cell;
    metal::packed_float3 y;
    float shape;
    metal::uint2 corner;
    metal::uint2 size;
    uint step;
    float pixels;
    int exponent;
    float near;
    float far;
    float bins_per_octave;
    metal::float2 pixel_width;
};
struct Counts {
    metal::atomic_uint inner[17152];
};
struct Slots {
    metal::atomic_uint inner[256];
};
struct _atomic_compare_exchange_result_Uint_4_ {
    uint old_value;
    bool exchanged;
    char _pad2[3];
};

template <typename A>
_atomic_compare_exchange_result_Uint_4_ naga_atomic_compare_exchange_weak_explicit(
    device A *atomic_ptr,
    uint cmp,
    uint v
) {
    bool swapped = metal::atomic_compare_exchange_weak_explicit(
        atomic_ptr, &cmp, v,
        metal::memory_order_relaxed, metal::memory_order_relaxed
    );
    return _atomic_compare_exchange_result_Uint_4_{cmp, swapped};
}
template <typename A>
_atomic_compare_exchange_result_Uint_4_ naga_atomic_compare_exchange_weak_explicit(
    threadgroup A *atomic_ptr,
    uint cmp,
    uint v
) {
    bool swapped = metal::atomic_compare_exchange_weak_explicit(
        atomic_ptr, &cmp, v,
        metal::memory_order_relaxed, metal::memory_order_relaxed
    );
    return _atomic_compare_exchange_result_Uint_4_{cmp, swapped};
}
constant uint CELLS = 16384u;
constant int LEVELS = 16;
constant uint SIDE = 32u;
constant uint DEPTHS = 128u;
constant uint CLASSES = 6u;
constant float MIN_FACING = 0.05;
constant uint THREADS = 16u;
constant uint PARTS = 2u;
constant uint SLOTS = 256u;
constant uint SLOT_BITS = 8u;
constant float NOTHING = 2.0;

void count(
    uint index,
    device Counts& counts,
    threadgroup Slots& keys,
    threadgroup Slots& tallies
) {
    bool local = {};
    uint slot_1 = (index * 2654435769u) >> 24u;
    _atomic_compare_exchange_result_Uint_4_ _e10 = naga_atomic_compare_exchange_weak_explicit(&keys.inner[slot_1], 0u, index + 1u);
    if (!(_e10.exchanged)) {
        local = _e10.old_value == (index + 1u);
    } else {
        local = true;
    }
    bool _e20 = local;
    if (_e20) {
        uint _e24 = metal::atomic_fetch_add_explicit(&tallies.inner[slot_1], 1u, metal::memory_order_relaxed);
        return;
    } else {
        uint _e28 = metal::atomic_fetch_add_explicit(&counts.inner[index], 1u, metal::memory_order_relaxed);
        return;
    }
}

float depth_at(
    metal::int2 pixel,
    constant Demand& demand,
    metal::depth2d<float, metal::access::sample> depths
) {
    bool local_1 = {};
    if (!(metal::any(pixel < metal::int2(0)))) {
        metal::uint2 _e10 = demand.size;
        local_1 = metal::any(pixel >= static_cast<metal::int2>(_e10));
    } else {
        local_1 = true;
    }
    bool _e15 = local_1;
    if (_e15) {
        return 0.0;
    }
    metal::uint2 _e20 = demand.corner;
    float _e24 = depths.read(metal::uint2(as_type<metal::int2>(as_type<metal::uint2>(static_cast<metal::int2>(_e20)) + as_type<metal::uint2>(pixel))), 0);
    float _e27 = demand.far_depth;
    return _e24 - _e27;
}

float change(
    metal::int2 pixel_1,
    metal::int2 axis,
    float depth,
    constant Demand& demand,
    metal::depth2d<float, metal::access::sample> depths
) {
    float _e4 = depth_at(as_type<metal::int2>(as_type<metal::uint2>(pixel_1) + as_type<metal::uint2>(axis)), demand, depths);
    float _e6 = depth_at(as_type<metal::int2>(as_type<metal::uint2>(pixel_1) - as_type<metal::uint2>(axis)), demand, depths);
    float after = (_e4 != 0.0) ? (_e4 - depth) : NOTHING;
    float before = (_e6 != 0.0) ? (depth - _e6) : NOTHING;
    return (metal::abs(after) <= metal::abs(before)) ? after : before;
}

int exponent(
    float x
) {
    return static_cast<int>((as_type<uint>(x) >> 23u) & 255u);
}

float power_of_two(
    int power
) {
    return as_type<float>(static_cast<uint>(as_type<int>(as_type<uint>(power) + as_type<uint>(127))) << 23u);
}

float needed_texel(
    metal::float2 a,
    metal::float2 b
) {
    float half_sum = (metal::dot(a, a) + metal::dot(b, b)) * 0.5;
    float difference = (metal::dot(a, a) - metal::dot(b, b)) * 0.5;
    float ab = metal::dot(a, b);
    float greatest = half_sum + metal::sqrt((difference * difference) + (ab * ab));
    if (greatest > 0.0) {
        return metal::abs((a.x * b.y) - (a.y * b.x)) / metal::sqrt(greatest);
    }
    return 0.0;
}

int naga_neg(int val) {
    return as_type<int>(-as_type<uint>(val));
}

metal::uint2 naga_f2u32(metal::float2 value) {
    return static_cast<metal::uint2>(metal::clamp(value, 0.0, 4294967000.0));
}

uint cell_of(
    metal::float2 place,
    float texel,
    constant Demand& demand
) {
    float _e5 = demand.cell;
    metal::float2 cells = place / metal::float2(_e5);
    float reach = metal::max(metal::abs(cells.x), metal::abs(cells.y)) / 16.0;
    int _e14 = exponent(texel);
    int _e17 = demand.exponent;
    int asked = metal::clamp(as_type<int>(as_type<uint>(_e14) - as_type<uint>(_e17)), 0, 15);
    int _e22 = exponent(reach);
    int level = metal::max(asked, as_type<int>(as_type<uint>(_e22) - as_type<uint>(126)));
    if (level >= LEVELS) {
        return CELLS;
    }
    float _e30 = power_of_two(naga_neg(level));
    metal::uint2 at = metal::min(naga_f2u32((cells * _e30) + metal::float2(16.0)), metal::uint2(31u));
    return (((static_cast<uint>(level) * SIDE) + at.y) * SIDE) + at.x;
}

uint naga_f2u32(float value) {
    return static_cast<uint>(metal::clamp(value, 0.0, 4294967000.0));
}

uint bin_of(
    float depth_1,
    float texel_1,
    constant Demand& demand
) {
    float _e4 = demand.near;
    float _e9 = demand.bins_per_octave;
    uint bin = metal::min(naga_f2u32(metal::log2(depth_1 / _e4) * _e9), 127u);
    float _e17 = demand.pixel_width.x;
    float _e21 = demand.pixel_width.y;
    float finer = (_e17 + (_e21 * depth_1)) / texel_1;
    int _e27 = exponent(finer * 1.4142135);
    int class_index = metal::clamp(as_type<int>(as_type<uint>(_e27) - as_type<uint>(127)), 0, 5);
    return (static_cast<uint>(class_index) * DEPTHS) + bin;
}

void see(
    metal::int2 pixel_2,
    constant Demand& demand,
    metal::depth2d<float, metal::access::sample> depths,
    device Counts& counts,
    threadgroup Slots& keys,
    threadgroup Slots& tallies
) {
    bool local_2 = {};
    bool local_3 = {};
    float _e1 = depth_at(pixel_2, demand, depths);
    if (_e1 == 0.0) {
        return;
    }
    float _e7 = change(pixel_2, metal::int2(1, 0), _e1, demand, depths);
    float _e11 = change(pixel_2, metal::int2(0, 1), _e1, demand, depths);
    if (!((_e7 == NOTHING))) {
        local_2 = _e11 == NOTHING;
    } else {
        local_2 = true;
    }
    bool _e20 = local_2;
    if (_e20) {
        return;
    }
    metal::float4x4 m = demand.world_from_pixel;
    metal::float4 homogeneous = m * metal::float4(static_cast<metal::float2>(pixel_2), _e1, 1.0);
    metal::float3 position = homogeneous.xyz / metal::float3(homogeneous.w);
    metal::float4 _e34 = demand.view;
    float _e40 = demand.view.w;
    float view_depth = metal::dot(_e34.xyz, position) + _e40;
    float _e44 = demand.far;
    if (!((view_depth < _e44))) {
        return;
    }
    float _e49 = demand.pixels;
    float scale = _e49 / homogeneous.w;
    metal::float4 right_change = m[0] + (m[2] * _e7);
    metal::float4 down_change = m[1] + (m[2] * _e11);
    metal::float3 right = (right_change.xyz - (position * right_change.w)) * scale;
    metal::float3 down = (down_change.xyz - (position * down_change.w)) * scale;
    metal::float3 ray = (m[2].xyz - (position * m[2].w)) / metal::float3(homogeneous.w);
    metal::float3 perpendicular = metal::cross(right, down);
    metal::float4 _e83 = demand.view;
    bool is_behind = (metal::dot(perpendicular, ray) * metal::dot(ray, _e83.xyz)) > 0.0;
    metal::float3 _e94 = demand.direction;
    float facing = (is_behind ? 1.0 : -1.0) * metal::dot(perpendicular, _e94);
    float length = metal::length(perpendicular);
    if (!(!((facing > 0.0)))) {
        local_3 = !((length > 0.0));
    } else {
        local_3 = true;
    }
    bool _e108 = local_3;
    if (_e108) {
        return;
    }
    metal::float3 _e111 = demand.x;
    metal::float3 _e115 = demand.y;
    metal::float2 a_1 = metal::float2(metal::dot(_e111, right), metal::dot(_e115, right));
    metal::float3 _e120 = demand.x;
    metal::float3 _e124 = demand.y;
    metal::float2 b_1 = metal::float2(metal::dot(_e120, down), metal::dot(_e124, down));
    float _e129 = demand.near;
    if (view_depth >= _e129) {
        float _e133 = demand.shape;
        metal::float2 stretch = metal::float2(1.0, _e133);
        float _e139 = needed_texel(a_1 * stretch, b_1 * stretch);
        uint _e140 = bin_of(view_depth, _e139, demand);
        count(CELLS + _e140, counts, keys, tallies);
    }
    if (facing >= (MIN_FACING * length)) {
        metal::float3 _e147 = demand.x;
        metal::float3 _e151 = demand.y;
        float _e154 = needed_texel(a_1, b_1);
        uint _e155 = cell_of(metal::float2(metal::dot(_e147, position), metal::dot(_e151, position)), _e154, demand);
        if (_e155 < CELLS) {
            count(_e155, counts, keys, tallies);
            return;
        } else {
            return;
        }
    } else {
        return;
    }
}
uint naga_mod(uint lhs, uint rhs) {
    return lhs % metal::select(rhs, 1u, rhs == 0u);
}

uint naga_div(uint lhs, uint rhs) {
    return lhs / metal::select(rhs, 1u, rhs == 0u);
}


kernel void count_demand(
  metal::uint3 square [[threadgroup_position_in_grid]]
, metal::uint3 thread_ [[thread_position_in_threadgroup]]
, uint slot [[thread_index_in_threadgroup]]
, constant Demand& demand [[buffer(0)]]
, metal::depth2d<float, metal::access::sample> depths [[buffer(1)]]
, device Counts& counts [[buffer(2)]]
, threadgroup Slots& keys
, threadgroup Slots& tallies
) {
    if (slot == 0u) {
        for (int __i0 = 0; __i0 < 256; __i0++) {
            metal::atomic_store_explicit(&keys.inner[__i0], 0, metal::memory_order_relaxed);
        }
        for (int __i0 = 0; __i0 < 256; __i0++) {
            metal::atomic_store_explicit(&tallies.inner[__i0], 0, metal::memory_order_relaxed);
        }
    }
    metal::threadgroup_barrier(metal::mem_flags::mem_threadgroup);
    uint part = 0u;
    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e40 = part;
            part = _e40 + 1u;
        }
        loop_init = false;
        uint _e5 = part;
        if (_e5 < 4u) {
        } else {
            break;
        }
        {
            uint _e8 = part;
            uint _e11 = part;
            metal::uint2 within = (metal::uint2(naga_mod(_e8, PARTS), naga_div(_e11, PARTS)) * THREADS) + thread_.xy;
            uint _e25 = demand.step;
            uint _e29 = demand.step;
            metal::uint2 pixel_3 = (((square.xy * 32u) + within) * _e25) + metal::uint2(naga_div(_e29, 2u));
            metal::uint2 _e36 = demand.size;
            if (metal::all(pixel_3 < _e36)) {
                see(static_cast<metal::int2>(pixel_3), demand, depths, counts, keys, tallies);
            }
        }
    }
    metal::threadgroup_barrier(metal::mem_flags::mem_threadgroup);
    uint tally = metal::atomic_load_explicit(&tallies.inner[slot], metal::memory_order_relaxed);
    if (tally > 0u) {
        uint _e51 = metal::atomic_load_explicit(&keys.inner[slot], metal::memory_order_relaxed);
        uint _e55 = metal::atomic_fetch_add_explicit(&counts.inner[_e51 - 1u], tally, metal::memory_order_relaxed);
        return;
    } else {
        return;
    }
}
