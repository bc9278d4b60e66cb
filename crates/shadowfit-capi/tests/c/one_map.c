// The shadows of raylib's own example shaders_shadowmap_rendering, to compare with: one map of 1024 x 1024 around the
// scene, with the same bias and filter of 3 x 3 taps. Has the functions of shadows.h for raylib_shadows.c.

#include "shadows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "raymath.h"
#include "rlgl.h"

enum { RESOLUTION = 1024, TEXTURE_UNIT = 15 };

// Height of the map in metres, and the place of its camera. All casters of the town are in it.
static const float HEIGHT_OF_MAP = 96;
static const Vector3 CENTRE = {0, 0, -10};
static const float DISTANCE = 100;

struct Shadows {
    Material caster;
    unsigned int framebuffer, depth;
    Shader receiver;
};

static const char *LOOKUP =
    "#version 330\n"
    "uniform sampler2D shadowMap; uniform mat4 lightVP; uniform vec3 lightDir;\n"
    "float shadowfit_factor(vec3 position, vec3 normal) {\n"
    "    vec4 clip = lightVP * vec4(position, 1.0);\n"
    "    vec3 at = 0.5 * clip.xyz / clip.w + 0.5;\n"
    "    float bias = max(0.0002 * (1.0 + dot(normal, lightDir)), 0.00002) + 0.00001;\n"
    "    float lit = 0.0;\n"
    "    for (int x = -1; x <= 1; x++) {\n"
    "        for (int y = -1; y <= 1; y++) {\n"
    "            float depth = texture(shadowMap, at.xy + vec2(x, y) / vec2(textureSize(shadowMap, 0))).r;\n"
    "            lit += at.z - bias > depth ? 0.0 : 1.0;\n"
    "        }\n"
    "    }\n"
    "    return lit / 9.0;\n"
    "}\n";

Shadows *shadows_load(const char *shader_folder, size_t max_objects) {
    (void)shader_folder, (void)max_objects;
    Shadows *s = calloc(1, sizeof *s);
    s->caster = LoadMaterialDefault();
    s->depth = rlLoadTextureDepth(RESOLUTION, RESOLUTION, false);
    s->framebuffer = rlLoadFramebuffer();
    rlFramebufferAttach(s->framebuffer, s->depth, RL_ATTACHMENT_DEPTH, RL_ATTACHMENT_TEXTURE2D, 0);
    return s;
}

Shader shadows_load_shader(const Shadows *s, const char *vertex, const char *fragment) {
    char *vertex_text = malloc(strlen(vertex) + 32), *fragment_text = malloc(strlen(LOOKUP) + strlen(fragment) + 1);
    sprintf(vertex_text, "#version 330\n%s", vertex);
    sprintf(fragment_text, "%s%s", LOOKUP, fragment);
    Shader shader = LoadShaderFromMemory(vertex_text, fragment_text);
    free(vertex_text);
    free(fragment_text);
    ((Shadows *)s)->receiver = shader;
    return shader;
}

void shadows_draw(Shadows *s, Camera3D camera, float aspect, Vector3 light, const ShadowObjects *objects) {
    (void)camera, (void)aspect;
    const Vector3 direction = Vector3Normalize(light);
    const Camera3D sun = {Vector3Subtract(CENTRE, Vector3Scale(direction, DISTANCE)), CENTRE, {0, 1, 0},
                          HEIGHT_OF_MAP, CAMERA_ORTHOGRAPHIC};
    const RenderTexture2D target = {.id = s->framebuffer, .texture = {.width = RESOLUTION, .height = RESOLUTION}};
    const double near_plane = rlGetCullDistanceNear(), far_plane = rlGetCullDistanceFar();
    // The example's bias is for raylib's own planes.
    rlSetClipPlanes(RL_CULL_DISTANCE_NEAR, RL_CULL_DISTANCE_FAR);
    BeginTextureMode(target);
    ClearBackground(WHITE);
    BeginMode3D(sun);
    const Matrix clip_from_world = MatrixMultiply(rlGetMatrixModelview(), rlGetMatrixProjection());
    for (size_t i = 0; i < objects->fixed.count; i++) objects->draw(false, i, s->caster);
    for (size_t i = 0; i < objects->moving.count; i++) objects->draw(true, i, s->caster);
    EndMode3D();
    EndTextureMode();
    rlSetClipPlanes(near_plane, far_plane);

    const Shader shader = s->receiver;
    SetShaderValueMatrix(shader, GetShaderLocation(shader, "lightVP"), clip_from_world);
    SetShaderValue(shader, GetShaderLocation(shader, "lightDir"), &direction, SHADER_UNIFORM_VEC3);
    SetShaderValue(shader, GetShaderLocation(shader, "shadowMap"), &(int){TEXTURE_UNIT}, SHADER_UNIFORM_INT);
    rlActiveTextureSlot(TEXTURE_UNIT);
    rlEnableTexture(s->depth);
    rlActiveTextureSlot(0);
}

void shadows_read_depths(Shadows *s, int width, int height) { (void)s, (void)width, (void)height; }

void shadows_unload(Shadows *s) {
    rlUnloadFramebuffer(s->framebuffer);
    rlUnloadTexture(s->depth);
    UnloadMaterial(s->caster);
    free(s);
}
