// shadowfit_demand.glsl: Counts the visible demand of a depth buffer. A whole compute shader.
// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL has the comments.
//
// Constants: ShadowfitDemandConstants of shadowfit.h, struct Demand below.
// Workgroups: the view's counted points, in squares of 32 x 32. Clear `counts` to 0 before. Its first cells are
// the demand grid, the others the depth histogram.
//
// OpenGL 4.3. Uniform block: SHADOWFIT_DEMAND_BINDING (0). Depth texture without comparison: SHADOWFIT_DEPTH_BINDING
// (0). Counts: SHADOWFIT_COUNTS_BINDING (0). Row 0 of OpenGL's depth buffers is the bottom: fill the constants for a
// negative row stride.
#version 430 core

#ifndef SHADOWFIT_DEMAND_BINDING
#define SHADOWFIT_DEMAND_BINDING 0
#endif
#ifndef SHADOWFIT_DEPTH_BINDING
#define SHADOWFIT_DEPTH_BINDING 0
#endif
#ifndef SHADOWFIT_COUNTS_BINDING
#define SHADOWFIT_COUNTS_BINDING 0
#endif
#ifdef GL_ES
precision highp float;
precision highp int;
#endif

layout(local_size_x = 16, local_size_y = 16, local_size_z = 1) in;

struct Demand {
    mat4x4 world_from_pixel;
    vec4 view;
    vec3 direction;
    float far_depth;
    vec3 x;
    float cell;
    vec3 y;
    float shape;
    uvec2 corner;
    uvec2 size;
    uint step_;
    float pixels;
    int exponent;
    float near;
    float far;
    float bins_per_octave;
    vec2 pixel_width;
};
struct _atomic_compare_exchange_result_Uint_4_ {
    uint old_value;
    bool exchanged;
};
const uint CELLS = 16384u;
const int LEVELS = 16;
const uint SIDE = 32u;
const uint DEPTHS = 128u;
const uint CLASSES = 6u;
const float MIN_FACING = 0.05;
const uint THREADS = 16u;
const uint PARTS = 2u;
const uint SLOTS = 256u;
const uint SLOT_BITS = 8u;
const float NOTHING = 2.0;

layout(std140, binding = SHADOWFIT_DEMAND_BINDING) uniform shadowfit_DemandBlock { Demand demand; };

layout(binding = SHADOWFIT_DEPTH_BINDING) uniform sampler2D depths;

layout(std430, binding = SHADOWFIT_COUNTS_BINDING) buffer shadowfit_CountsBlock { uint counts[17152]; };

shared uint keys[256];

shared uint tallies[256];


void count(uint index) {
    bool local = false;
    uint slot_1 = ((index * 2654435769u) >> 24u);
    _atomic_compare_exchange_result_Uint_4_ _e10; _e10.old_value = atomicCompSwap(keys[slot_1], 0u, (index + 1u));
    _e10.exchanged = (_e10.old_value == 0u);
    if (!(_e10.exchanged)) {
        local = (_e10.old_value == (index + 1u));
    } else {
        local = true;
    }
    bool _e20 = local;
    if (_e20) {
        uint _e24 = atomicAdd(tallies[slot_1], 1u);
        return;
    } else {
        uint _e28 = atomicAdd(counts[index], 1u);
        return;
    }
}

float depth_at(ivec2 pixel) {
    bool local_1 = false;
    if (!(any(lessThan(pixel, ivec2(0))))) {
        uvec2 _e10 = demand.size;
        local_1 = any(greaterThanEqual(pixel, ivec2(_e10)));
    } else {
        local_1 = true;
    }
    bool _e15 = local_1;
    if (_e15) {
        return 0.0;
    }
    uvec2 _e20 = demand.corner;
    vec4 _e24 = texelFetch(depths, (ivec2(_e20) + pixel), 0);
    float _e28 = demand.far_depth;
    return (_e24.x - _e28);
}

float change(ivec2 pixel_1, ivec2 axis, float depth) {
    float _e4 = depth_at((pixel_1 + axis));
    float _e6 = depth_at((pixel_1 - axis));
    float after = ((_e4 != 0.0) ? (_e4 - depth) : NOTHING);
    float before = ((_e6 != 0.0) ? (depth - _e6) : NOTHING);
    return ((abs(after) <= abs(before)) ? after : before);
}

int exponent(float x) {
    return int(((floatBitsToUint(x) >> 23u) & 255u));
}

float power_of_two(int power) {
    return uintBitsToFloat((uint((power + 127)) << 23u));
}

float needed_texel(vec2 a, vec2 b) {
    float half_sum = ((dot(a, a) + dot(b, b)) * 0.5);
    float difference = ((dot(a, a) - dot(b, b)) * 0.5);
    float ab = dot(a, b);
    float greatest = (half_sum + sqrt(((difference * difference) + (ab * ab))));
    if (greatest > 0.0) {
        return (abs(((a.x * b.y) - (a.y * b.x))) / sqrt(greatest));
    }
    return 0.0;
}

uint cell_of(vec2 place, float texel) {
    float _e5 = demand.cell;
    vec2 cells = (place / vec2(_e5));
    float reach = (max(abs(cells.x), abs(cells.y)) / 16.0);
    int _e14 = exponent(texel);
    int _e17 = demand.exponent;
    int asked = min(max((_e14 - _e17), 0), 15);
    int _e22 = exponent(reach);
    int level = max(asked, (_e22 - 126));
    if (level >= LEVELS) {
        return CELLS;
    }
    float _e30 = power_of_two(-(level));
    uvec2 at = min(uvec2(((cells * _e30) + vec2(16.0))), uvec2(31u));
    return ((((uint(level) * SIDE) + at.y) * SIDE) + at.x);
}

uint bin_of(float depth_1, float texel_1) {
    float _e4 = demand.near;
    float _e9 = demand.bins_per_octave;
    uint bin = min(uint((log2((depth_1 / _e4)) * _e9)), 127u);
    float _e17 = demand.pixel_width.x;
    float _e21 = demand.pixel_width.y;
    float finer = ((_e17 + (_e21 * depth_1)) / texel_1);
    int _e27 = exponent((finer * 1.4142135));
    int class_index = min(max((_e27 - 127), 0), 5);
    return ((uint(class_index) * DEPTHS) + bin);
}

void see(ivec2 pixel_2) {
    bool local_2 = false;
    bool local_3 = false;
    float _e1 = depth_at(pixel_2);
    if (_e1 == 0.0) {
        return;
    }
    float _e7 = change(pixel_2, ivec2(1, 0), _e1);
    float _e11 = change(pixel_2, ivec2(0, 1), _e1);
    if (!((_e7 == NOTHING))) {
        local_2 = (_e11 == NOTHING);
    } else {
        local_2 = true;
    }
    bool _e20 = local_2;
    if (_e20) {
        return;
    }
    mat4x4 m = demand.world_from_pixel;
    vec4 homogeneous = (m * vec4(vec2(pixel_2), _e1, 1.0));
    vec3 position = (homogeneous.xyz / vec3(homogeneous.w));
    vec4 _e34 = demand.view;
    float _e40 = demand.view.w;
    float view_depth = (dot(_e34.xyz, position) + _e40);
    float _e44 = demand.far;
    if (!((view_depth < _e44))) {
        return;
    }
    float _e49 = demand.pixels;
    float scale = (_e49 / homogeneous.w);
    vec4 right_change = (m[0] + (m[2] * _e7));
    vec4 down_change = (m[1] + (m[2] * _e11));
    vec3 right = ((right_change.xyz - (position * right_change.w)) * scale);
    vec3 down = ((down_change.xyz - (position * down_change.w)) * scale);
    vec3 ray = ((m[2].xyz - (position * m[2].w)) / vec3(homogeneous.w));
    vec3 perpendicular = cross(right, down);
    vec4 _e83 = demand.view;
    bool is_behind = ((dot(perpendicular, ray) * dot(ray, _e83.xyz)) > 0.0);
    vec3 _e94 = demand.direction;
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
    vec3 _e111 = demand.x;
    vec3 _e115 = demand.y;
    vec2 a_1 = vec2(dot(_e111, right), dot(_e115, right));
    vec3 _e120 = demand.x;
    vec3 _e124 = demand.y;
    vec2 b_1 = vec2(dot(_e120, down), dot(_e124, down));
    float _e129 = demand.near;
    if (view_depth >= _e129) {
        float _e133 = demand.shape;
        vec2 stretch = vec2(1.0, _e133);
        float _e139 = needed_texel((a_1 * stretch), (b_1 * stretch));
        uint _e140 = bin_of(view_depth, _e139);
        count((CELLS + _e140));
    }
    if (facing >= (MIN_FACING * length_)) {
        vec3 _e147 = demand.x;
        vec3 _e151 = demand.y;
        float _e154 = needed_texel(a_1, b_1);
        uint _e155 = cell_of(vec2(dot(_e147, position), dot(_e151, position)), _e154);
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

void main() {
    if (gl_LocalInvocationID == uvec3(0u)) {
        keys = uint[256](0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
        tallies = uint[256](0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    }
    memoryBarrierShared();
    barrier();
    uvec3 square = gl_WorkGroupID;
    uvec3 thread = gl_LocalInvocationID;
    uint slot = gl_LocalInvocationIndex;
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
            uvec2 within = ((uvec2((_e8 % PARTS), (_e11 / PARTS)) * THREADS) + thread.xy);
            uint _e25 = demand.step_;
            uint _e29 = demand.step_;
            uvec2 pixel_3 = ((((square.xy * 32u) + within) * _e25) + uvec2((_e29 / 2u)));
            uvec2 _e36 = demand.size;
            if (all(lessThan(pixel_3, _e36))) {
                see(ivec2(pixel_3));
            }
        }
    }
    memoryBarrierShared();
    barrier();
    uint tally = atomicOr(tallies[slot], 0u);
    if (tally > 0u) {
        uint _e51 = atomicOr(keys[slot], 0u);
        uint _e55 = atomicAdd(counts[(_e51 - 1u)], tally);
        return;
    } else {
        return;
    }
}
