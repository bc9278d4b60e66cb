// shadowfit_demand.hlsl: Counts the visible demand of a depth buffer. A whole compute shader.
// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL has the comments.
//
// Constants: ShadowfitDemandConstants of shadowfit.h, struct Demand below.
// Workgroups: the view's counted points, in squares of 32 x 32. Clear `counts` to 0 before. Its first cells are
// the demand grid, the others the depth histogram.
//
// Entry point: count_demand. Constants: SHADOWFIT_DEMAND_REGISTER (b0). Depth texture: SHADOWFIT_DEPTH_REGISTER
// (t0). Counts: SHADOWFIT_COUNTS_REGISTER (u0).

#ifndef SHADOWFIT_DEMAND_REGISTER
#define SHADOWFIT_DEMAND_REGISTER b0
#endif
#ifndef SHADOWFIT_DEPTH_REGISTER
#define SHADOWFIT_DEPTH_REGISTER t0
#endif
#ifndef SHADOWFIT_COUNTS_REGISTER
#define SHADOWFIT_COUNTS_REGISTER u0
#endif

struct Demand {
    row_major float4x4 world_from_pixel;
    float4 view;
    float3 direction;
    float far_depth;
    float3 x;
    float cell;
    float3 y;
    float shape;
    uint2 corner;
    uint2 size;
    uint step_;
    float pixels;
    int exponent;
    float near;
    float far;
    float bins_per_octave;
    float2 pixel_width;
};

struct _atomic_compare_exchange_result_Uint_4_ {
    uint old_value;
    bool exchanged;
};

static const uint CELLS = 16384u;
static const int LEVELS = int(16);
static const uint SIDE = 32u;
static const uint DEPTHS = 128u;
static const uint CLASSES = 6u;
static const float MIN_FACING = 0.05;
static const uint THREADS = 16u;
static const uint PARTS = 2u;
static const uint SLOTS = 256u;
static const uint SLOT_BITS = 8u;
static const float NOTHING = 2.0;

cbuffer shadowfit_DemandBlock : register(SHADOWFIT_DEMAND_REGISTER) { Demand demand; }
Texture2D<float> depths : register(SHADOWFIT_DEPTH_REGISTER);
RWByteAddressBuffer counts : register(SHADOWFIT_COUNTS_REGISTER);
groupshared uint keys[256];
groupshared uint tallies[256];

void count(uint index)
{
    bool local = (bool)0;

    uint slot_1 = ((index * 2654435769u) >> 24u);
    _atomic_compare_exchange_result_Uint_4_ _e10; InterlockedCompareExchange(keys[slot_1], 0u, (index + 1u), _e10.old_value);
    _e10.exchanged = (_e10.old_value == 0u);
    if (!(_e10.exchanged)) {
        local = (_e10.old_value == (index + 1u));
    } else {
        local = true;
    }
    bool _e20 = local;
    if (_e20) {
        uint _e24; InterlockedAdd(tallies[slot_1], 1u, _e24);
        return;
    } else {
        uint _e28; counts.InterlockedAdd(index*4, 1u, _e28);
        return;
    }
}

float depth_at(int2 pixel)
{
    bool local_1 = (bool)0;

    if (!(any((pixel < (int(0)).xx)))) {
        uint2 _e10 = demand.size;
        local_1 = any((pixel >= int2(_e10)));
    } else {
        local_1 = true;
    }
    bool _e15 = local_1;
    if (_e15) {
        return 0.0;
    }
    uint2 _e20 = demand.corner;
    float _e24 = depths.Load(int3(asint(asuint(int2(_e20)) + asuint(pixel)), int(0))).x;
    float _e27 = demand.far_depth;
    return (_e24 - _e27);
}

float change(int2 pixel_1, int2 axis, float depth)
{
    const float _e4 = depth_at(asint(asuint(pixel_1) + asuint(axis)));
    const float _e6 = depth_at(asint(asuint(pixel_1) - asuint(axis)));
    float after = ((_e4 != 0.0) ? (_e4 - depth) : NOTHING);
    float before = ((_e6 != 0.0) ? (depth - _e6) : NOTHING);
    return ((abs(after) <= abs(before)) ? after : before);
}

int exponent(float x)
{
    return int(((asuint(x) >> 23u) & 255u));
}

float power_of_two(int power)
{
    return asfloat((uint(asint(asuint(power) + asuint(int(127)))) << 23u));
}

float needed_texel(float2 a, float2 b)
{
    float half_sum = ((dot(a, a) + dot(b, b)) * 0.5);
    float difference = ((dot(a, a) - dot(b, b)) * 0.5);
    float ab = dot(a, b);
    float greatest = (half_sum + sqrt(((difference * difference) + (ab * ab))));
    if (greatest > 0.0) {
        return (abs(((a.x * b.y) - (a.y * b.x))) / sqrt(greatest));
    }
    return 0.0;
}

int naga_neg(int val) {
    return asint(-asuint(val));
}

uint2 naga_f2u32(float2 value) {
    return uint2(clamp(value, 0.0, 4294967000.0));
}

uint cell_of(float2 place, float texel)
{
    float _e5 = demand.cell;
    float2 cells = (place / (_e5).xx);
    float reach = (max(abs(cells.x), abs(cells.y)) / 16.0);
    const int _e14 = exponent(texel);
    int _e17 = demand.exponent;
    int asked = clamp(asint(asuint(_e14) - asuint(_e17)), int(0), int(15));
    const int _e22 = exponent(reach);
    int level = max(asked, asint(asuint(_e22) - asuint(int(126))));
    if (level >= LEVELS) {
        return CELLS;
    }
    const float _e30 = power_of_two(naga_neg(level));
    uint2 at = min(naga_f2u32(((cells * _e30) + (16.0).xx)), (31u).xx);
    return ((((uint(level) * SIDE) + at.y) * SIDE) + at.x);
}

uint naga_f2u32(float value) {
    return uint(clamp(value, 0.0, 4294967000.0));
}

uint bin_of(float depth_1, float texel_1)
{
    float _e4 = demand.near;
    float _e9 = demand.bins_per_octave;
    uint bin = min(naga_f2u32((log2((depth_1 / _e4)) * _e9)), 127u);
    float _e17 = demand.pixel_width.x;
    float _e21 = demand.pixel_width.y;
    float finer = ((_e17 + (_e21 * depth_1)) / texel_1);
    const int _e27 = exponent((finer * 1.4142135));
    int class_index = clamp(asint(asuint(_e27) - asuint(int(127))), int(0), int(5));
    return ((uint(class_index) * DEPTHS) + bin);
}

void see(int2 pixel_2)
{
    bool local_2 = (bool)0;
    bool local_3 = (bool)0;

    const float _e1 = depth_at(pixel_2);
    if (_e1 == 0.0) {
        return;
    }
    const float _e7 = change(pixel_2, int2(int(1), int(0)), _e1);
    const float _e11 = change(pixel_2, int2(int(0), int(1)), _e1);
    if (!((_e7 == NOTHING))) {
        local_2 = (_e11 == NOTHING);
    } else {
        local_2 = true;
    }
    bool _e20 = local_2;
    if (_e20) {
        return;
    }
    float4x4 m = demand.world_from_pixel;
    float4 homogeneous = mul(float4(float2(pixel_2), _e1, 1.0), m);
    float3 position = (homogeneous.xyz / (homogeneous.w).xxx);
    float4 _e34 = demand.view;
    float _e40 = demand.view.w;
    float view_depth = (dot(_e34.xyz, position) + _e40);
    float _e44 = demand.far;
    if (!((view_depth < _e44))) {
        return;
    }
    float _e49 = demand.pixels;
    float scale = (_e49 / homogeneous.w);
    float4 right_change = (m[0] + (m[2] * _e7));
    float4 down_change = (m[1] + (m[2] * _e11));
    float3 right = ((right_change.xyz - (position * right_change.w)) * scale);
    float3 down = ((down_change.xyz - (position * down_change.w)) * scale);
    float3 ray = ((m[2].xyz - (position * m[2].w)) / (homogeneous.w).xxx);
    float3 perpendicular = cross(right, down);
    float4 _e83 = demand.view;
    bool is_behind = ((dot(perpendicular, ray) * dot(ray, _e83.xyz)) > 0.0);
    float3 _e94 = demand.direction;
    float facing = ((is_behind ? 1.0 : -1.0) * dot(perpendicular, _e94));
    float length_ = length(perpendicular);
    if (!(!((facing > 0.0)))) {
        local_3 = !((length_ > 0.0));
    } else {
        local_3 = true;
    }
    bool _e108 = local_3;
    if (_e108) {
        return;
    }
    float3 _e111 = demand.x;
    float3 _e115 = demand.y;
    float2 a_1 = float2(dot(_e111, right), dot(_e115, right));
    float3 _e120 = demand.x;
    float3 _e124 = demand.y;
    float2 b_1 = float2(dot(_e120, down), dot(_e124, down));
    float _e129 = demand.near;
    if (view_depth >= _e129) {
        float _e133 = demand.shape;
        float2 stretch = float2(1.0, _e133);
        const float _e139 = needed_texel((a_1 * stretch), (b_1 * stretch));
        const uint _e140 = bin_of(view_depth, _e139);
        count((CELLS + _e140));
    }
    if (facing >= (MIN_FACING * length_)) {
        float3 _e147 = demand.x;
        float3 _e151 = demand.y;
        const float _e154 = needed_texel(a_1, b_1);
        const uint _e155 = cell_of(float2(dot(_e147, position), dot(_e151, position)), _e154);
        if (_e155 < CELLS) {
            count(_e155);
            return;
        } else {
            return;
        }
    } else {
        return;
    }
}

uint naga_mod(uint lhs, uint rhs) {
    return lhs % (rhs == 0u ? 1u : rhs);
}

uint naga_div(uint lhs, uint rhs) {
    return lhs / (rhs == 0u ? 1u : rhs);
}

[numthreads(16, 16, 1)]
void count_demand(uint3 square : SV_GroupID, uint3 thread : SV_GroupThreadID, uint slot : SV_GroupIndex)
{
    keys[slot] = 0u;
    tallies[slot] = 0u;
    GroupMemoryBarrierWithGroupSync();
    uint part = 0u;

    bool loop_init = true;
    while(true) {
        if (!loop_init) {
            uint _e40 = part;
            part = (_e40 + 1u);
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
            uint2 within = ((uint2(naga_mod(_e8, PARTS), naga_div(_e11, PARTS)) * THREADS) + thread.xy);
            uint _e25 = demand.step_;
            uint _e29 = demand.step_;
            uint2 pixel_3 = ((((square.xy * 32u) + within) * _e25) + (naga_div(_e29, 2u)).xx);
            uint2 _e36 = demand.size;
            if (all((pixel_3 < _e36))) {
                see(int2(pixel_3));
            }
        }
    }
    GroupMemoryBarrierWithGroupSync();
    uint tally; InterlockedOr(tallies[slot], 0, tally);
    if (tally > 0u) {
        uint _e51; InterlockedOr(keys[slot], 0, _e51);
        uint _e55; counts.InterlockedAdd((_e51 - 1u)*4, tally, _e55);
        return;
    } else {
        return;
    }
}
