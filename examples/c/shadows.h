// Shadows of one sun for programs with raylib.

#ifndef SHADOWS_H
#define SHADOWS_H

#include <stdbool.h>

#include "raylib.h"
#include "shadowfit.h"

// The boxes of all objects, of the objects that never move, and of the objects that may move.
typedef struct {
    ShadowfitBoxes all, fixed, moving;
    // Draws an object of fixed or moving with a material, for example with DrawMesh.
    void (*draw)(bool moves, size_t index, Material material);
} ShadowObjects;

typedef struct Shadows Shadows;

// Creates the shadows of a sun. shader_folder has the files shadowfit_*.glsl.
Shadows *shadows_load(const char *shader_folder, size_t max_objects);

// Loads a shader whose fragment shader calls shadowfit_factor(position, normal). The texts have no #version.
Shader shadows_load_shader(const Shadows *shadows, const char *vertex, const char *fragment);

// Draws the shadow maps of a frame. Call it before BeginDrawing and BeginTextureMode. light is the direction of
// travel of the light.
void shadows_draw(Shadows *shadows, Camera3D camera, float aspect, Vector3 light, const ShadowObjects *objects);

// Starts to read the depths of the bound framebuffer, which place the maps of the next frame. Call it after the scene
// was drawn, and before EndTextureMode.
void shadows_read_depths(Shadows *shadows, int width, int height);

void shadows_unload(Shadows *shadows);

#endif  // SHADOWS_H
