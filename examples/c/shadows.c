// Shadows of one sun: four windows of shadowfit, drawn with raylib and OpenGL 3.3.
//
// Each map has two layers of a depth texture. The first layer keeps the static casters from frame to frame, so that
// only new strips are drawn. If moving casters reach the map, the first layer is copied to the second one, and the
// moving casters are drawn on top.

#include "shadows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "external/glad.h"
#include "raymath.h"
#include "rlgl.h"

// Buffers. The first two are also the binding points of uniform blocks.
enum { CASTER_BUFFER, RECEIVER_BUFFER, DEPTH_BUFFER, BUFFERS };

// A texture unit that raylib's materials leave alone, and the pixels across and down per counted point of the depth
// buffer.
enum { TEXTURE_UNIT = 15, DEPTH_STEP = 16 };

struct Shadows {
    ShadowfitState *state;
    ShadowfitTechnique technique;
    const char *shader_folder;
    Material caster;
    unsigned int texture, framebuffers[2 * SHADOWFIT_MAX_MAPS], buffers[BUFFERS];
    // View and light of the last frame.
    ShadowfitView view;
    Vector3 light;
    // Depths that are being read back. Their size is 0 if there are none.
    ShadowfitDepths depths;
    // Indices of the casters to draw.
    uint32_t *casters;
    size_t max_objects;
};

static void check(const Shadows *s, ShadowfitResult result) {
    if (result != SHADOWFIT_OK) TraceLog(LOG_FATAL, "shadowfit: %s", shadowfit_error(s->state));
}

// Returns a new text: a file of the shader folder and a text. The look-up's settings have their defaults, which fit
// windows-4.
static char *shader_text(const Shadows *s, const char *file, const char *text) {
    char *functions = LoadFileText(TextFormat("%s/%s", s->shader_folder, file));
    if (functions == NULL) TraceLog(LOG_FATAL, "%s has no %s", s->shader_folder, file);
    const size_t size = strlen(functions) + strlen(text) + 32;
    char *joined = malloc(size);
    snprintf(joined, size, "#version 330\n%s%s", functions, text);
    UnloadFileText(functions);
    return joined;
}

Shader shadows_load_shader(const Shadows *s, const char *vertex, const char *fragment) {
    const char *blocks[] = {"shadowfit_CasterBlock", "shadowfit_ReceiverBlock"};
    char *vertex_text = shader_text(s, "shadowfit_caster.glsl", vertex);
    char *fragment_text = shader_text(s, "shadowfit_lookup.glsl", fragment);
    Shader shader = LoadShaderFromMemory(vertex_text, fragment_text);
    free(vertex_text);
    free(fragment_text);
    for (unsigned int buffer = CASTER_BUFFER; buffer <= RECEIVER_BUFFER; buffer++) {
        const unsigned int block = glGetUniformBlockIndex(shader.id, blocks[buffer]);
        if (block != GL_INVALID_INDEX) glUniformBlockBinding(shader.id, block, buffer);
    }
    SetShaderValue(shader, GetShaderLocation(shader, "shadowfit_texture"), &(int){TEXTURE_UNIT}, SHADER_UNIFORM_INT);
    return shader;
}

// Creates the depth texture, with a framebuffer for each layer. It stays bound to its unit.
static void load_texture(Shadows *s) {
    const int layers = 2 * (int)s->technique.map_count;
    const int width = (int)s->technique.resolution[0], height = (int)s->technique.resolution[1];
    glGenTextures(1, &s->texture);
    glActiveTexture(GL_TEXTURE0 + TEXTURE_UNIT);
    glBindTexture(GL_TEXTURE_2D_ARRAY, s->texture);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, width, height, layers, 0, GL_DEPTH_COMPONENT,
                 GL_FLOAT, NULL);
    // A new texture repeats, magnifies linearly and compares with "less or equal".
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glActiveTexture(GL_TEXTURE0);
    glGenFramebuffers(layers, s->framebuffers);
    for (int layer = 0; layer < layers; layer++) {
        glBindFramebuffer(GL_FRAMEBUFFER, s->framebuffers[layer]);
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, s->texture, 0, layer);
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

static const char *CASTER_VERTEX =
    "in vec3 vertexPosition; uniform mat4 matModel;\n"
    "void main() { gl_Position = shadowfit_caster_position_gl((matModel * vec4(vertexPosition, 1.0)).xyz); }\n";

Shadows *shadows_load(const char *shader_folder, size_t max_objects) {
    Shadows *s = calloc(1, sizeof *s);
    size_t size = shadowfit_state_size(max_objects);
    s->state = malloc(size);
    s->casters = malloc(max_objects * sizeof *s->casters);
    s->max_objects = max_objects;
    s->shader_folder = shader_folder;
    check(s, shadowfit_init(s->state, &size, max_objects, SHADOWFIT_VERSION));
    const char *opengl = "[map]\ndepth = \"negative_one_to_one\"\n";
    check(s, shadowfit_set_technique(s->state, opengl, strlen(opengl)));
    s->technique.size = sizeof s->technique;
    check(s, shadowfit_technique(s->state, &s->technique));
    load_texture(s);
    s->caster = LoadMaterialDefault();
    s->caster.shader = shadows_load_shader(s, CASTER_VERTEX, "void main() {}\n");
    glGenBuffers(BUFFERS, s->buffers);
    return s;
}

// Passes on the depths of the frame before, which are drawn by now.
static void set_visible_depths(Shadows *s) {
    if (s->depths.size == 0) return;
    const size_t width = s->depths.width, height = s->depths.height;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, s->buffers[DEPTH_BUFFER]);
    const float *rows = glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, width * height * sizeof *rows, GL_MAP_READ_BIT);
    // OpenGL's first row is the bottom one.
    s->depths.depths = rows + (height - 1) * width;
    s->depths.row_stride = -(ptrdiff_t)(width * sizeof *rows);
    check(s, shadowfit_set_visible_depths(s->state, &s->depths));
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    s->depths.size = 0;
}

static void upload(const Shadows *s, unsigned int buffer, const void *constants, size_t size) {
    glBindBufferBase(GL_UNIFORM_BUFFER, buffer, s->buffers[buffer]);
    glBufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)size, constants, GL_DYNAMIC_DRAW);
}

static void draw_casters(const Shadows *s, const ShadowObjects *objects, bool moves, size_t count, int x, int y) {
    glViewport(x, y, (int)s->technique.resolution[0], (int)s->technique.resolution[1]);
    for (size_t i = 0; i < count; i++) objects->draw(moves, s->casters[i], s->caster);
}

// Draws a map. Returns the layer to read.
static uint32_t draw_map(Shadows *s, uint32_t map, const ShadowObjects *objects) {
    const int width = (int)s->technique.resolution[0], height = (int)s->technique.resolution[1];
    size_t count;
    ShadowfitCasterConstants constants;
    check(s, shadowfit_caster_constants(s->state, map, &constants));
    upload(s, CASTER_BUFFER, &constants, sizeof constants);

    // Static casters, where the layer has none yet.
    ShadowfitUpdate update = {.size = sizeof update};
    check(s, shadowfit_update(s->state, map, NULL, &update));
    glBindFramebuffer(GL_FRAMEBUFFER, s->framebuffers[map]);
    for (uint32_t i = 0; i < update.rect_count; i++) {
        const ShadowfitRect *rect = &update.rects[i];
        check(s, shadowfit_casters(s->state, map, rect, SHADOWFIT_CASTERS_ALL, &objects->fixed, s->casters,
                                   s->max_objects, &count));
        glScissor((int)rect->x, (int)rect->y, (int)rect->width, (int)rect->height);
        glClear(GL_DEPTH_BUFFER_BIT);
        draw_casters(s, objects, false, count, rect->viewport_x, rect->viewport_y);
    }

    // Moving casters, over a copy.
    check(s, shadowfit_casters(s->state, map, NULL, SHADOWFIT_CASTERS_VISIBLE, &objects->moving, s->casters,
                               s->max_objects, &count));
    if (count == 0) return map;
    const uint32_t layer = map + s->technique.map_count;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, s->framebuffers[layer]);
    glScissor(0, 0, width, height);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    for (uint32_t i = 0; i < update.viewport_count; i++) {
        draw_casters(s, objects, true, count, update.viewports[i][0], update.viewports[i][1]);
    }
    return layer;
}

// Draws all maps. Writes the layer of each.
static void draw_maps(Shadows *s, const ShadowfitMaps *maps, const ShadowObjects *objects, uint32_t *layers) {
    rlEnableDepthTest();
    rlEnableScissorTest();
    rlDisableBackfaceCulling();
    if (s->technique.clamps_depth) glEnable(GL_DEPTH_CLAMP);
    for (uint32_t map = 0; map < maps->count; map++) layers[map] = draw_map(s, map, objects);
    glDisable(GL_DEPTH_CLAMP);
    rlEnableBackfaceCulling();
    rlDisableScissorTest();
    rlDisableDepthTest();
    rlDisableFramebuffer();
}

void shadows_draw(Shadows *s, Camera3D camera, float aspect, Vector3 light, const ShadowObjects *objects) {
    set_visible_depths(s);

    const Vector3 eye = camera.position, forward = Vector3Normalize(Vector3Subtract(camera.target, eye));
    const ShadowfitCamera lens = {
        .size = sizeof lens, .depth = SHADOWFIT_DEPTH_NEGATIVE_ONE_TO_ONE, .eye = {eye.x, eye.y, eye.z},
        .forward = {forward.x, forward.y, forward.z}, .up = {camera.up.x, camera.up.y, camera.up.z},
        .fov_y = camera.fovy * DEG2RAD, .aspect = aspect,
        .near_plane = (float)rlGetCullDistanceNear(), .far_plane = (float)rlGetCullDistanceFar()};
    s->view.size = sizeof s->view;
    check(s, shadowfit_view_from_camera(s->state, &lens, &s->view));

    const ShadowfitFrame frame = {.size = sizeof frame, .view_count = 1, .views = &s->view,
                                  .light_direction = {light.x, light.y, light.z}, .receivers = objects->all,
                                  .casters = objects->all};
    s->light = light;
    ShadowfitMaps maps = {.size = sizeof maps};
    ShadowfitReceiverConstants constants = {0};
    if (shadowfit_fit(s->state, &frame, &maps) == SHADOWFIT_OK) {
        uint32_t layers[SHADOWFIT_MAX_MAPS];
        draw_maps(s, &maps, objects, layers);
        check(s, shadowfit_receiver_constants(s->state, &constants));
        for (uint32_t i = 0; i < maps.count; i++) constants.maps[i].layer = layers[constants.maps[i].layer];
    } else {
        TraceLog(LOG_WARNING, "shadowfit: no shadows in this frame: %s", shadowfit_error(s->state));
    }
    upload(s, RECEIVER_BUFFER, &constants, sizeof constants);
}

void shadows_read_depths(Shadows *s, int width, int height) {
    s->depths = (ShadowfitDepths){.size = sizeof s->depths, .width = (uint32_t)width, .height = (uint32_t)height,
                                  .step = DEPTH_STEP, .view = &s->view,
                                  .light_direction = {s->light.x, s->light.y, s->light.z}};
    glBindBuffer(GL_PIXEL_PACK_BUFFER, s->buffers[DEPTH_BUFFER]);
    glBufferData(GL_PIXEL_PACK_BUFFER, (GLsizeiptr)sizeof(float) * width * height, NULL, GL_STREAM_READ);
    glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void shadows_unload(Shadows *s) {
    glDeleteFramebuffers(2 * (int)s->technique.map_count, s->framebuffers);
    glDeleteTextures(1, &s->texture);
    glDeleteBuffers(BUFFERS, s->buffers);
    UnloadMaterial(s->caster);
    free(s->casters);
    free(s->state);
    free(s);
}
