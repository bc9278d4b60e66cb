// shadowfit_caster.glsl: The positions of casters, for the shaders that draw the maps.
// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL has the comments.
//
// position: world space, relative to the origin of the constants, metres.
//
// vec4 shadowfit_caster_position(vec3 position)
//     the clip position in the map, for vertex shaders
// float shadowfit_caster_depth(vec3 position)
//     the depth to interpolate, for vertex shaders without depth clamp
// float shadowfit_clamped_depth(float depth)
//     the depth to write, for fragment shaders without depth clamp
//
// Constants: ShadowfitCasterConstants of shadowfit.h, struct shadowfit_Caster below.
// Uniform block: shadowfit_CasterBlock. Layout: SHADOWFIT_CASTER_LAYOUT, such as `std140, binding = 0`.
//
// OpenGL: use shadowfit_caster_position_gl, which turns the map over. Front faces are then clockwise. Viewports and
// scissor rectangles stay as the library gives them. Clip depth is -1 to 1 (SHADOWFIT_DEPTH_NEGATIVE_ONE_TO_ONE) unless
// glClipControl makes it 0 to 1. With -1 to 1, pass depth * 0.5 + 0.5 to shadowfit_clamped_depth.

#ifndef SHADOWFIT_CASTER_GLSL
#define SHADOWFIT_CASTER_GLSL

#ifdef GL_ES
precision highp float;
precision highp int;
#endif

struct shadowfit_Caster {
    mat4x4 clip_from_world;
    uint clamps_in_fragment;
    uint padding_0_;
    uint padding_1_;
    uint padding_2_;
};

#ifndef SHADOWFIT_CASTER_LAYOUT
#define SHADOWFIT_CASTER_LAYOUT std140
#endif
layout(SHADOWFIT_CASTER_LAYOUT) uniform shadowfit_CasterBlock { shadowfit_Caster shadowfit_caster; };

vec4 shadowfit_caster_position(vec3 position) {
    mat4x4 _e3 = shadowfit_caster.clip_from_world;
    vec4 clip = (_e3 * vec4(position, 1.0));
    uint _e11 = shadowfit_caster.clamps_in_fragment;
    return vec4(clip.xy, ((_e11 == 1u) ? 0.5 : clip.z), clip.w);
}

float shadowfit_caster_depth(vec3 position) {
    mat4x4 _e3 = shadowfit_caster.clip_from_world;
    return (_e3 * vec4(position, 1.0)).z;
}

float shadowfit_clamped_depth(float depth) {
    return clamp(depth, 0.0, 1.0);
}

// Returns gl_Position, with y turned over: OpenGL's first row of texels is at the bottom.
vec4 shadowfit_caster_position_gl(vec3 position) {
    vec4 clip = shadowfit_caster_position(position);
    return vec4(clip.x, -clip.y, clip.zw);
}

#endif
