// Fits four shadow maps to a camera for three frames, and prints an engine's steps. Compile it with
//     cc fit_once.c -Iinclude lib/libshadowfit.a -lm
// in the folder of the archive.

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shadowfit.h"

// Your objects: any struct that holds a box will do.
typedef struct {
    const char *name;
    float min[3], max[3];
} Object;

static const Object OBJECTS[] = {
    {"ground", {-80, -0.1f, -80}, {80, 0, 80}},
    {"house", {-4, 0, -12}, {4, 6, -6}},
    {"tree", {7, 0, 2}, {9, 5, 4}},
};
enum { OBJECT_COUNT = sizeof OBJECTS / sizeof *OBJECTS };

static void check(const ShadowfitState *state, ShadowfitResult result) {
    if (result != SHADOWFIT_OK) {
        fprintf(stderr, "error: %s\n", shadowfit_error(state));
        exit(1);
    }
}

// Draws the casters of a map. In your engine: bind layer `map` of the depth texture, set the viewport to the map's
// resolution, clear the depth, and draw each object with map->clip_from_world.
static void draw_map(ShadowfitState *state, uint32_t index, const ShadowfitMap *map, const ShadowfitBoxes *boxes) {
    uint32_t drawn[OBJECT_COUNT];
    size_t count;
    check(state, shadowfit_casters(state, index, NULL, SHADOWFIT_CASTERS_VISIBLE, boxes, drawn, OBJECT_COUNT, &count));
    printf("  map %u, texels of %.4f m, draws", index, map->texel_size[0]);
    for (size_t i = 0; i < count; i++) printf(" %s", OBJECTS[drawn[i]].name);
    printf("\n");
}

int main(void) {
    // 1. The state: one buffer per light, made once. It holds lists of up to 100 boxes.
    size_t size = shadowfit_state_size(100);
    ShadowfitState *state = malloc(size);
    if (state == NULL) return 1;
    check(state, shadowfit_init(state, &size, 100, SHADOWFIT_VERSION));

    // 2. The technique. The default is "windows-4": four maps of 2048 x 2048 texels. Create one depth texture with
    // technique.map_count layers of technique.resolution, and a sampler that compares, filters and repeats.
    // OpenGL also needs depth = "negative_one_to_one" here.
    const char *changes = "[map]\nresolution = 1024\nfilter = \"pcf_5x5\"\n";
    check(state, shadowfit_set_technique(state, changes, strlen(changes)));
    ShadowfitTechnique technique = {.size = sizeof technique};
    check(state, shadowfit_technique(state, &technique));
    printf("%u maps of %u x %u texels, read with the filter %s\n", technique.map_count, technique.resolution[0],
           technique.resolution[1], technique.filter);

    for (uint32_t number = 0; number < 3; number++) {
        // 3. The view of your camera. shadowfit_view_from_matrix makes one from a view-projection matrix.
        ShadowfitCamera camera = {.size = sizeof camera, .eye = {0, 1.7, 20 - 0.1 * number}, .forward = {0, 0, -1},
                                  .up = {0, 1, 0}, .fov_y = 0.8f, .aspect = 16.0f / 9, .near_plane = 0.1f,
                                  .far_plane = 200};
        ShadowfitView view = {.size = sizeof view};
        check(state, shadowfit_view_from_camera(state, &camera, &view));

        // 4. The frame: the view, the light and your objects' boxes.
        ShadowfitBoxes boxes = {.min_max = OBJECTS[0].min, .count = OBJECT_COUNT, .stride = sizeof *OBJECTS};
        ShadowfitFrame frame = {.size = sizeof frame, .view_count = 1, .views = &view, .number = number,
                                .light_direction = {0.3f, -0.8f, 0.2f}, .receivers = boxes, .casters = boxes};

        // 5. The fit.
        ShadowfitMaps maps = {.size = sizeof maps};
        check(state, shadowfit_fit(state, &frame, &maps));

        // 6. The shadow passes.
        printf("frame %u\n", number);
        for (uint32_t i = 0; i < maps.count; i++) draw_map(state, i, &maps.maps[i], &boxes);

        // 7. The look-up. Copy the block to the uniform buffer of the shader, which calls shadowfit_factor_at.
        ShadowfitReceiverConstants constants;
        check(state, shadowfit_receiver_constants(state, &constants));
        printf("  %zu bytes of constants for the look-up\n", sizeof constants);

        // 8. In debug builds: prove that no map has a hole.
        for (uint32_t i = 0; i < maps.count; i++) {
            ShadowfitProof proof = {.size = sizeof proof};
            check(state, shadowfit_prove(state, &frame, i, &proof));
            if (proof.result != SHADOWFIT_PROVEN) printf("  map %u has a hole\n", i);
        }
    }
    free(state);
    return 0;
}
