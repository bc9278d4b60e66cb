// Tests of the C interface. The arguments are the two files that reference.rs writes: a walk that must be equal bit
// for bit, and the cases of the XNA sample.

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shadowfit.h"

#define CHECK(condition)                                                              \
    do {                                                                              \
        if (!(condition)) {                                                           \
            fprintf(stderr, "%s:%d: %s is false\n", __FILE__, __LINE__, #condition);  \
            exit(1);                                                                  \
        }                                                                             \
    } while (0)

#define MAX_BOXES 256
#define CHECK_OK(state, call) CHECK_RESULT(state, call, SHADOWFIT_OK)
#define CHECK_RESULT(state, call, expected)                                                                     \
    do {                                                                                                        \
        ShadowfitResult result = (call);                                                                        \
        if (result != (expected)) {                                                                             \
            fprintf(stderr, "%s:%d: %s is %d: %s\n", __FILE__, __LINE__, #call, (int)result,                    \
                    shadowfit_error(state));                                                                    \
            exit(1);                                                                                            \
        }                                                                                                       \
    } while (0)

static ShadowfitState *new_state(size_t max_boxes) {
    size_t size = shadowfit_state_size(max_boxes);
    ShadowfitState *state = malloc(size);
    CHECK(state != NULL);
    CHECK(shadowfit_init(state, &size, max_boxes, SHADOWFIT_VERSION) == SHADOWFIT_OK);
    return state;
}

static void read_bytes(FILE *file, void *into, size_t size) {
    CHECK(fread(into, 1, size, file) == size);
}

static uint32_t read_int(FILE *file) {
    uint32_t number;
    read_bytes(file, &number, sizeof number);
    return number;
}

// Compares the next bytes of a file with computed ones.
static void check_bytes(FILE *file, const void *computed, size_t size, const char *what) {
    unsigned char *expected = malloc(size > 0 ? size : 1);
    CHECK(expected != NULL);
    read_bytes(file, expected, size);
    if (memcmp(expected, computed, size) != 0) {
        fprintf(stderr, "%s differs from Rust\n", what);
        exit(1);
    }
    free(expected);
}

static void check_casters(FILE *file, ShadowfitState *state, uint32_t map, uint32_t which,
                          const ShadowfitBoxes *boxes) {
    uint32_t indices[MAX_BOXES];
    size_t count;
    CHECK_OK(state, shadowfit_casters(state, map, NULL, which, boxes, indices, MAX_BOXES, &count));
    CHECK(read_int(file) == count);
    check_bytes(file, indices, count * sizeof *indices, "a list of casters");
}

// The viewports of a map that wraps around begin at its offset, and one map's size to the left and above.
static void check_viewports(const ShadowfitUpdate *update, int32_t size) {
    const int32_t x = (int32_t)update->texel_offset[0], y = (int32_t)update->texel_offset[1];
    CHECK(update->viewport_count == (x > 0 ? 2u : 1u) * (y > 0 ? 2u : 1u));
    for (uint32_t i = 0; i < update->viewport_count; i++) {
        const int32_t *corner = update->viewports[i];
        CHECK((corner[0] == x || corner[0] == x - size) && (corner[1] == y || corner[1] == y - size));
        for (uint32_t j = 0; j < i; j++) CHECK(memcmp(corner, update->viewports[j], sizeof update->viewports[j]) != 0);
    }
}

static void check_maps(FILE *file, ShadowfitState *state, const ShadowfitMaps *maps, const ShadowfitBoxes *boxes) {
    CHECK(read_int(file) == maps->count);
    for (uint32_t i = 0; i < maps->count; i++) {
        const ShadowfitMap *map = &maps->maps[i];
        check_bytes(file, map->clip_from_world, sizeof map->clip_from_world, "clip_from_world");
        check_bytes(file, map->uv_from_world, sizeof map->uv_from_world, "uv_from_world");
        check_bytes(file, map->light_from_world, sizeof map->light_from_world, "light_from_world");
        check_bytes(file, &map->bias, sizeof map->bias, "the bias");
        check_bytes(file, map->texel_size, sizeof map->texel_size, "the texel size");
        check_bytes(file, &map->depth_range, sizeof map->depth_range, "the depth range");
        check_bytes(file, &map->end_depth, sizeof map->end_depth, "the end");
        check_casters(file, state, i, SHADOWFIT_CASTERS_VISIBLE, boxes);
        check_casters(file, state, i, SHADOWFIT_CASTERS_ALL, boxes);
        ShadowfitUpdate update = {.size = sizeof update};
        CHECK_OK(state, shadowfit_update(state, i, NULL, &update));
        CHECK(read_int(file) == update.kind);
        check_bytes(file, update.texel_offset, sizeof update.texel_offset, "the texel offset");
        check_viewports(&update, (int32_t)map->resolution[0]);
        CHECK(read_int(file) == update.rect_count);
        check_bytes(file, update.rects, update.rect_count * sizeof *update.rects, "the rectangles");
        ShadowfitCasterConstants caster;
        CHECK_OK(state, shadowfit_caster_constants(state, i, &caster));
        check_bytes(file, caster.clip_from_world, sizeof caster.clip_from_world, "the caster block");
    }
    ShadowfitReceiverConstants receiver;
    CHECK_OK(state, shadowfit_receiver_constants(state, &receiver));
    check_bytes(file, &receiver, sizeof receiver, "the receiver block");
}

static ShadowfitCamera read_camera(FILE *file) {
    ShadowfitCamera camera = {.size = sizeof camera, .depth = SHADOWFIT_DEPTH_REVERSED};
    read_bytes(file, camera.eye, sizeof camera.eye);
    read_bytes(file, camera.forward, sizeof camera.forward);
    read_bytes(file, camera.up, sizeof camera.up);
    read_bytes(file, &camera.fov_y, sizeof camera.fov_y);
    read_bytes(file, &camera.aspect, sizeof camera.aspect);
    read_bytes(file, &camera.near_plane, sizeof camera.near_plane);
    read_bytes(file, &camera.far_plane, sizeof camera.far_plane);
    return camera;
}

// Gives each box a name, so that the boxes have gaps and are misaligned.
typedef struct {
    char name[3];
    unsigned char min_max[6 * sizeof(float)];
} Object;

static void a_walk_is_equal_bit_for_bit_to_rust(const char *path) {
    FILE *file = fopen(path, "rb");
    CHECK(file != NULL);
    uint32_t frames = read_int(file), box_count = read_int(file), width = read_int(file), height = read_int(file);
    CHECK(frames == 60 && box_count <= MAX_BOXES);
    ShadowfitBoxes boxes = {.count = box_count};
    read_bytes(file, boxes.origin, sizeof boxes.origin);
    float numbers[MAX_BOXES][6];
    read_bytes(file, numbers, box_count * sizeof *numbers);
    Object *objects = malloc(box_count * sizeof *objects);
    CHECK(objects != NULL && sizeof *objects == 27);
    for (uint32_t i = 0; i < box_count; i++) memcpy(objects[i].min_max, numbers[i], sizeof *numbers);
    ShadowfitState *state = new_state(box_count);
    const char *text = "[fit]\nmax_distance = 300\n";
    CHECK_OK(state, shadowfit_set_technique(state, text, strlen(text)));
    ShadowfitView view = {.size = sizeof view}, before = {.size = sizeof before};
    float *depths = malloc(width * height * sizeof *depths), *flipped = malloc(width * height * sizeof *depths);
    CHECK(depths != NULL && flipped != NULL);
    for (uint32_t number = 0; number < frames; number++) {
        ShadowfitCamera camera = read_camera(file);
        before = view;
        CHECK_OK(state, shadowfit_view_from_camera(state, &camera, &view));
        ShadowfitFrame frame = {.size = sizeof frame, .view_count = 1, .views = &view, .number = number};
        read_bytes(file, frame.light_direction, sizeof frame.light_direction);
        if (read_int(file)) {
            read_bytes(file, depths, width * height * sizeof *depths);
            // As OpenGL reads it: the bottom row first.
            for (uint32_t y = 0; y < height; y++)
                memcpy(flipped + y * width, depths + (height - 1 - y) * width, width * sizeof *depths);
            ShadowfitDepths seen = {.size = sizeof seen, .width = width, .height = height, .step = 3, .view = &before};
            seen.depths = number % 8 == 1 ? depths : flipped + (height - 1) * width;
            seen.row_stride = number % 8 == 1 ? 0 : -(ptrdiff_t)(width * sizeof *depths);
            memcpy(seen.light_direction, frame.light_direction, sizeof seen.light_direction);
            CHECK_OK(state, shadowfit_set_visible_depths(state, &seen));
        }
        memcpy(frame.origin, camera.eye, sizeof frame.origin);
        boxes.min_max = number % 2 == 0 ? numbers[0] : (const float *)(const void *)objects[0].min_max;
        boxes.stride = number % 2 == 0 ? 0 : sizeof *objects;
        frame.receivers = frame.casters = boxes;
        ShadowfitMaps maps = {.size = sizeof maps};
        CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
        CHECK(maps.count == 4 && maps.from_visible_depths == (number > 0));
        check_maps(file, state, &maps, &boxes);
        ShadowfitProof proof = {.size = sizeof proof};
        for (uint32_t i = 0; i < maps.count; i++) {
            CHECK_OK(state, shadowfit_prove(state, &frame, i, &proof));
            CHECK(proof.result == SHADOWFIT_PROVEN);
        }
    }
    CHECK(fgetc(file) == EOF);
    free(flipped);
    free(depths);
    free(objects);
    free(state);
    fclose(file);
}

static void the_fit_of_the_xna_sample_is_reproduced(const char *path) {
    FILE *file = fopen(path, "rb");
    CHECK(file != NULL);
    ShadowfitState *state = new_state(0);
    CHECK_OK(state, shadowfit_set_preset(state, "xna-1"));
    uint32_t cases = read_int(file);
    CHECK(cases == 24);
    for (uint32_t i = 0; i < cases; i++) {
        double forward[3], lens[4], to_light[3], expected[16];
        ShadowfitCamera camera = {.size = sizeof camera, .up = {0, 1, 0}};
        read_bytes(file, camera.eye, sizeof camera.eye);
        read_bytes(file, forward, sizeof forward);
        read_bytes(file, lens, sizeof lens);
        read_bytes(file, to_light, sizeof to_light);
        read_bytes(file, expected, sizeof expected);
        for (int j = 0; j < 3; j++) camera.forward[j] = (float)forward[j];
        camera.fov_y = (float)lens[0];
        camera.aspect = (float)lens[1];
        camera.near_plane = (float)lens[2];
        camera.far_plane = (float)lens[3];
        ShadowfitView view = {.size = sizeof view};
        CHECK_OK(state, shadowfit_view_from_camera(state, &camera, &view));
        ShadowfitFrame frame = {.size = sizeof frame, .view_count = 1, .views = &view};
        for (int j = 0; j < 3; j++) frame.light_direction[j] = (float)-to_light[j];
        ShadowfitMaps maps = {.size = sizeof maps};
        CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
        CHECK(maps.count == 1);
        double largest = 0, error = 0;
        for (int j = 0; j < 16; j++) {
            largest = fmax(largest, fabs(expected[j]));
            error = fmax(error, fabs(expected[j] - maps.maps[0].clip_from_world[j]));
        }
        CHECK(error <= 1e-5 * largest);
    }
    free(state);
    fclose(file);
}

static ShadowfitView usual_view(ShadowfitState *state) {
    ShadowfitCamera camera = {.size = sizeof camera, .eye = {0, 1.7, 20}, .forward = {0, 0, -1}, .up = {0, 1, 0},
                              .fov_y = 0.8f, .aspect = 1.6f, .near_plane = 0.1f, .far_plane = 200};
    ShadowfitView view = {.size = sizeof view};
    CHECK_OK(state, shadowfit_view_from_camera(state, &camera, &view));
    return view;
}

static void a_matrix_makes_the_same_view_as_a_camera(void) {
    ShadowfitState *state = new_state(0);
    ShadowfitView view = usual_view(state), same = {.size = sizeof same};
    // The camera looks along -z, so the matrix from the world only adds a translation.
    double matrix[16], eye[3] = {0, 1.7, 20};
    for (int i = 0; i < 16; i++) matrix[i] = view.clip_from_eye[i];
    for (int row = 0; row < 4; row++)
        for (int i = 0; i < 3; i++) matrix[12 + row] -= matrix[4 * i + row] * eye[i];
    CHECK_OK(state, shadowfit_view_from_matrix(state, matrix, eye, SHADOWFIT_DEPTH_ZERO_TO_ONE, &same));
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 3; j++) CHECK(fabsf(view.corners[i][j] - same.corners[i][j]) < 0.05f);
    CHECK(fabsf(same.forward[2] + 1) < 1e-6f);
    CHECK_RESULT(state, shadowfit_view_from_matrix(state, matrix, eye, SHADOWFIT_DEPTH_REVERSED, &same),
                 SHADOWFIT_BAD_INPUT);
    CHECK_RESULT(state, shadowfit_view_from_matrix(state, matrix, eye, 9, &same), SHADOWFIT_BAD_INPUT);
    CHECK_RESULT(state, shadowfit_view_from_matrix(state, NULL, eye, 0, &same), SHADOWFIT_NULL_POINTER);
    free(state);
}

static void states_are_checked(void) {
    size_t size = 16, needed = shadowfit_state_size(10);
    void *memory = calloc(1, needed + 16);
    ShadowfitState *state = memory;
    CHECK(memory != NULL && needed > shadowfit_state_size(9));
    CHECK(shadowfit_init(state, &size, 10, SHADOWFIT_VERSION) == SHADOWFIT_TOO_SMALL);
    CHECK(size == needed);
    CHECK(shadowfit_init(state, &size, 10, SHADOWFIT_VERSION + 1) == SHADOWFIT_OTHER_VERSION);
    CHECK(shadowfit_init(NULL, &size, 10, SHADOWFIT_VERSION) == SHADOWFIT_NULL_POINTER);
    CHECK(shadowfit_init(state, NULL, 10, SHADOWFIT_VERSION) == SHADOWFIT_NULL_POINTER);
    void *odd = (char *)memory + 1;
    CHECK(shadowfit_init(odd, &size, 10, SHADOWFIT_VERSION) == SHADOWFIT_MISALIGNED);
    CHECK(shadowfit_reset(odd) == SHADOWFIT_MISALIGNED);
    CHECK(shadowfit_reset(state) == SHADOWFIT_CALL_INIT_FIRST);
    CHECK(shadowfit_reset(NULL) == SHADOWFIT_NULL_POINTER);
    CHECK(strstr(shadowfit_error(state), "shadowfit_init") != NULL);
    CHECK(strstr(shadowfit_error(NULL), "null") != NULL);
    CHECK(shadowfit_init(state, &size, 10, SHADOWFIT_VERSION) == SHADOWFIT_OK);
    CHECK(strcmp(shadowfit_error(state), "") == 0);
    // A state of another version, as a saved file may hold it.
    ((uint32_t *)memory)[1] += 1;
    CHECK(shadowfit_reset(state) == SHADOWFIT_OTHER_VERSION);
    size = SIZE_MAX - 8;
    CHECK(shadowfit_state_size(SIZE_MAX / 2) == SIZE_MAX);
    CHECK(shadowfit_init(state, &size, SIZE_MAX / 2, SHADOWFIT_VERSION) == SHADOWFIT_TOO_SMALL);
    size = SIZE_MAX;
    CHECK(shadowfit_init(state, &size, SIZE_MAX, SHADOWFIT_VERSION) == SHADOWFIT_TOO_SMALL);
    for (uint32_t result = 0; result < 12; result++) CHECK(strlen(shadowfit_result_text(result)) > 5);
    free(memory);
}

static void calls_out_of_order_name_the_missing_call(void) {
    ShadowfitState *state = new_state(4);
    float box[6] = {-1, 0, -1, 1, 2, 1};
    ShadowfitBoxes boxes = {.min_max = box, .count = 1};
    ShadowfitView view = usual_view(state);
    ShadowfitFrame frame = {.size = sizeof frame, .view_count = 1, .views = &view, .light_direction = {0.3f, -0.8f, 0.2f},
                            .receivers = boxes, .casters = boxes};
    ShadowfitMaps maps = {.size = sizeof maps};
    ShadowfitUpdate update = {.size = sizeof update};
    ShadowfitProof proof = {.size = sizeof proof};
    ShadowfitFilter filter = {.size = sizeof filter, .taps = 1};
    ShadowfitReceiverConstants receiver;
    ShadowfitCasterConstants caster;
    ShadowfitBias bias;
    uint32_t index;
    size_t count;
    CHECK_RESULT(state, shadowfit_casters(state, 0, NULL, 0, &boxes, &index, 1, &count), SHADOWFIT_CALL_FIT_FIRST);
    CHECK_RESULT(state, shadowfit_update(state, 0, NULL, &update), SHADOWFIT_CALL_FIT_FIRST);
    CHECK_RESULT(state, shadowfit_receiver_constants(state, &receiver), SHADOWFIT_CALL_FIT_FIRST);
    CHECK_RESULT(state, shadowfit_caster_constants(state, 0, &caster), SHADOWFIT_CALL_FIT_FIRST);
    CHECK_RESULT(state, shadowfit_bias(state, 0, &filter, &bias), SHADOWFIT_CALL_FIT_FIRST);
    CHECK_RESULT(state, shadowfit_prove(state, &frame, 0, &proof), SHADOWFIT_CALL_FIT_FIRST);
    CHECK(strstr(shadowfit_error(state), "shadowfit_fit") != NULL);
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    CHECK_RESULT(state, shadowfit_update(state, 4, NULL, &update), SHADOWFIT_BAD_INPUT);
    CHECK_OK(state, shadowfit_receiver_constants(state, &receiver));
    CHECK_OK(state, shadowfit_update(state, 0, NULL, &update));
    CHECK(update.kind == SHADOWFIT_UPDATE_WHOLE && update.rect_count == 1 && update.rects[0].width == 2048);
    CHECK_RESULT(state, shadowfit_receiver_constants(state, &receiver), SHADOWFIT_CALL_UPDATE_FIRST);
    CHECK(strstr(shadowfit_error(state), "shadowfit_update") != NULL);
    for (uint32_t i = 1; i < maps.count; i++) CHECK_OK(state, shadowfit_update(state, i, NULL, &update));
    CHECK_OK(state, shadowfit_receiver_constants(state, &receiver));
    // A frame without movement draws no texel, until a caster changes or the texture is lost.
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    CHECK_OK(state, shadowfit_update(state, 0, NULL, &update));
    CHECK(update.kind == SHADOWFIT_UPDATE_NOTHING && update.rect_count == 0);
    CHECK_OK(state, shadowfit_update(state, 0, &boxes, &update));
    CHECK(update.kind == SHADOWFIT_UPDATE_RECTS && update.rect_count >= 1);
    CHECK_OK(state, shadowfit_casters(state, 0, &update.rects[0], SHADOWFIT_CASTERS_ALL, &boxes, &index, 1, &count));
    CHECK(count == 1 && index == 0);
    CHECK_OK(state, shadowfit_invalidate(state));
    CHECK_OK(state, shadowfit_update(state, 0, NULL, &update));
    CHECK(update.kind == SHADOWFIT_UPDATE_WHOLE);
    // Lost texels are still read with their offset.
    CHECK_OK(state, shadowfit_invalidate(state));
    for (uint32_t i = 1; i < maps.count; i++) CHECK_OK(state, shadowfit_update(state, i, NULL, &update));
    CHECK_OK(state, shadowfit_receiver_constants(state, &receiver));
    // Changed boxes must be finite. Otherwise their old shadows would stay.
    float endless[6] = {-1, 0, -1, 1, INFINITY, 1};
    ShadowfitBoxes changed = {.min_max = endless, .count = 1};
    CHECK_RESULT(state, shadowfit_update(state, 0, &changed, &update), SHADOWFIT_BAD_INPUT);
    CHECK_RESULT(state, shadowfit_casters(state, 0, NULL, 0, &changed, &index, 1, &count), SHADOWFIT_BAD_INPUT);
    changed = boxes;
    changed.origin[0] = 1e300;
    CHECK_RESULT(state, shadowfit_update(state, 0, &changed, &update), SHADOWFIT_BAD_INPUT);
    // A failed fit leaves no maps.
    frame.light_direction[1] = NAN;
    CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
    CHECK_RESULT(state, shadowfit_caster_constants(state, 0, &caster), SHADOWFIT_CALL_FIT_FIRST);
    // Changes of casters may have been missed in that frame, so maps are drawn whole.
    frame.light_direction[1] = -0.8f;
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    CHECK_OK(state, shadowfit_update(state, 0, NULL, &update));
    CHECK(update.kind == SHADOWFIT_UPDATE_WHOLE);
    // Likewise after a frame without maps, whose view begins beyond the shadow distance.
    const char *distance = "[fit]\nmax_distance = 50\n";
    CHECK_OK(state, shadowfit_set_technique(state, distance, strlen(distance)));
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    CHECK_OK(state, shadowfit_receiver_constants(state, &receiver));
    for (uint32_t i = 0; i < maps.count; i++) CHECK_OK(state, shadowfit_update(state, i, NULL, &update));
    ShadowfitCamera beyond = {.size = sizeof beyond, .eye = {0, 1.7, 20}, .forward = {0, 0, -1}, .up = {0, 1, 0},
                              .fov_y = 0.8f, .aspect = 1.6f, .near_plane = 100, .far_plane = 200};
    ShadowfitView far_view = {.size = sizeof far_view};
    CHECK_OK(state, shadowfit_view_from_camera(state, &beyond, &far_view));
    frame.views = &far_view;
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    CHECK(maps.count == 0);
    frame.views = &view;
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    CHECK_OK(state, shadowfit_update(state, 0, NULL, &update));
    CHECK(update.kind == SHADOWFIT_UPDATE_WHOLE);
    // A reset also ends the keeping of maps.
    CHECK_OK(state, shadowfit_reset(state));
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    CHECK_OK(state, shadowfit_receiver_constants(state, &receiver));
    free(state);
}

static void bad_input_returns_codes_and_sentences(void) {
    ShadowfitState *state = new_state(2);
    float box[24] = {-1, 0, -1, 1, 2, 1};
    ShadowfitBoxes boxes = {.min_max = box, .count = 1};
    ShadowfitView view = usual_view(state);
    const ShadowfitFrame good = {.size = sizeof good, .view_count = 1, .views = &view,
                                 .light_direction = {0.3f, -0.8f, 0.2f}, .receivers = boxes, .casters = boxes};
    ShadowfitMaps maps = {.size = sizeof maps};
    CHECK_RESULT(state, shadowfit_fit(state, NULL, &maps), SHADOWFIT_NULL_POINTER);
    CHECK_RESULT(state, shadowfit_fit(state, &good, NULL), SHADOWFIT_NULL_POINTER);
    maps.size = 0;
    CHECK_RESULT(state, shadowfit_fit(state, &good, &maps), SHADOWFIT_OTHER_VERSION);
    maps.size = sizeof maps;
    ShadowfitFrame frame = good;
    frame.size = 8;
    CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_OTHER_VERSION);
    frame = good;
    frame.views = NULL;
    CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_NULL_POINTER);
    const uint32_t counts[] = {0, 5, UINT32_MAX};
    for (int i = 0; i < 3; i++) {
        frame = good;
        frame.view_count = counts[i];
        CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
        CHECK(strstr(shadowfit_error(state), "view_count") != NULL);
    }
    frame = good;
    frame.casters.count = 3;
    CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_TOO_SMALL);
    char needed[32];
    snprintf(needed, sizeof needed, "%zu", shadowfit_state_size(3));
    CHECK(strstr(shadowfit_error(state), needed) != NULL);
    frame = good;
    frame.receivers.stride = 8;
    CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
    CHECK(strstr(shadowfit_error(state), "stride") != NULL);
    frame = good;
    frame.receivers.count = SIZE_MAX / 2;
    CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
    frame = good;
    frame.receivers.min_max = NULL;
    CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_NULL_POINTER);
    frame.receivers.count = 0;
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    frame.receivers = boxes;
    frame.receivers.count = 0;
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    // Each number of the view, the light and the origins, as NaN and as infinity.
    const float bad[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        ShadowfitView wrong;
        for (size_t at = 0; at < 8 * 3; at++) {
            wrong = view;
            (&wrong.corners[0][0])[at] = bad[i];
            frame = good;
            frame.views = &wrong;
            CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
        }
        for (int axis = 0; axis < 3; axis++) {
            wrong = view;
            wrong.eye[axis] = bad[i];
            CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
            wrong = view;
            wrong.forward[axis] = bad[i];
            CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
            frame = good;
            frame.light_direction[axis] = bad[i];
            CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
            frame = good;
            frame.origin[axis] = i == 0 ? 1e60 : (double)bad[i];
            CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
            frame = good;
            frame.casters.origin[axis] = bad[i];
            CHECK_RESULT(state, shadowfit_fit(state, &frame, &maps), SHADOWFIT_BAD_INPUT);
            frame.views = &wrong;
        }
        // Boxes with NaN are empty, and boxes without an end are an error or reach to the end of the view.
        for (int at = 0; at < 6; at++) {
            float changed[6];
            memcpy(changed, box, sizeof changed);
            changed[at] = bad[i];
            frame = good;
            frame.casters.min_max = frame.receivers.min_max = changed;
            ShadowfitResult result = shadowfit_fit(state, &frame, &maps);
            CHECK(result == SHADOWFIT_OK || result == SHADOWFIT_BAD_INPUT);
        }
    }
    free(state);
}

static void cameras_techniques_and_depths_are_checked(void) {
    ShadowfitState *state = new_state(2);
    ShadowfitView view = usual_view(state);
    ShadowfitCamera camera = {.size = sizeof camera, .forward = {0, 0, -1}, .up = {0, 1, 0}, .aspect = 1, .near_plane = 1,
                              .far_plane = 10};
    CHECK_RESULT(state, shadowfit_view_from_camera(state, &camera, &view), SHADOWFIT_BAD_INPUT);
    camera.half_height = 5;
    CHECK_OK(state, shadowfit_view_from_camera(state, &camera, &view));
    camera.depth = 3;
    CHECK_RESULT(state, shadowfit_view_from_camera(state, &camera, &view), SHADOWFIT_BAD_INPUT);
    CHECK_RESULT(state, shadowfit_view_from_camera(state, NULL, &view), SHADOWFIT_NULL_POINTER);
    CHECK_RESULT(state, shadowfit_set_preset(state, "none"), SHADOWFIT_UNKNOWN_PRESET);
    CHECK_RESULT(state, shadowfit_set_preset(state, NULL), SHADOWFIT_NULL_POINTER);
    CHECK_RESULT(state, shadowfit_set_preset(state, "\xff"), SHADOWFIT_UNKNOWN_PRESET);
    size_t presets = 0;
    for (; shadowfit_preset(presets) != NULL; presets++)
        CHECK_OK(state, shadowfit_set_preset(state, shadowfit_preset(presets)));
    CHECK(presets == 10);
    const char *text = "[map]\nfilter = \"pcf_3x3\"\nblur = 1\n";
    CHECK_RESULT(state, shadowfit_set_technique(state, text, strlen(text)), SHADOWFIT_BAD_TECHNIQUE);
    CHECK(strstr(shadowfit_error(state), "line 3") != NULL && strstr(shadowfit_error(state), "map.blur") != NULL);
    CHECK_RESULT(state, shadowfit_set_technique(state, "\xff", 1), SHADOWFIT_BAD_TECHNIQUE);
    CHECK_RESULT(state, shadowfit_set_technique(state, NULL, 0), SHADOWFIT_NULL_POINTER);
    CHECK_OK(state, shadowfit_set_technique(state, "", 0));
    CHECK_OK(state, shadowfit_set_technique(state, text, strlen(text) - strlen("blur = 1\n")));
    ShadowfitTechnique technique = {.size = sizeof technique};
    CHECK_OK(state, shadowfit_technique(state, &technique));
    CHECK(strcmp(technique.filter, "pcf_3x3") == 0 && strcmp(technique.format, "depth32float") == 0);
    CHECK(technique.map_count == 4 && technique.resolution[0] == 2048 && technique.by_view_depth == 0);
    float depths[9] = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
    const ShadowfitDepths good = {.size = sizeof good, .width = 3, .height = 3, .step = 1, .depths = depths, .view = &view,
                                  .light_direction = {0, -1, 0}};
    CHECK_OK(state, shadowfit_set_visible_depths(state, &good));
    CHECK_OK(state, shadowfit_set_visible_depths(state, NULL));
    ShadowfitDepths wrong = good;
    wrong.width = 2;
    CHECK_RESULT(state, shadowfit_set_visible_depths(state, &wrong), SHADOWFIT_BAD_INPUT);
    wrong = good;
    wrong.step = 0;
    CHECK_RESULT(state, shadowfit_set_visible_depths(state, &wrong), SHADOWFIT_BAD_INPUT);
    wrong = good;
    wrong.row_stride = 4;
    CHECK_RESULT(state, shadowfit_set_visible_depths(state, &wrong), SHADOWFIT_BAD_INPUT);
    wrong = good;
    wrong.depths = NULL;
    CHECK_RESULT(state, shadowfit_set_visible_depths(state, &wrong), SHADOWFIT_NULL_POINTER);
    wrong = good;
    wrong.view = NULL;
    CHECK_RESULT(state, shadowfit_set_visible_depths(state, &wrong), SHADOWFIT_NULL_POINTER);
    wrong = good;
    wrong.light_direction[1] = NAN;
    CHECK_RESULT(state, shadowfit_set_visible_depths(state, &wrong), SHADOWFIT_BAD_INPUT);
    depths[4] = NAN;
    CHECK_OK(state, shadowfit_set_visible_depths(state, &good));
    uint32_t *counts = calloc(SHADOWFIT_COUNTS + 1, sizeof *counts);
    ShadowfitDemandConstants block, turned;
    wrong = good;
    wrong.depths = NULL;
    CHECK_OK(state, shadowfit_demand_constants(state, &wrong, &block));
    wrong.row_stride = -1;
    CHECK_OK(state, shadowfit_demand_constants(state, &wrong, &turned));
    CHECK(memcmp(&block, &turned, sizeof block) != 0);
    CHECK_RESULT(state, shadowfit_demand_constants(state, &wrong, NULL), SHADOWFIT_NULL_POINTER);
    CHECK_RESULT(state, shadowfit_demand_constants(state, NULL, &block), SHADOWFIT_NULL_POINTER);
    CHECK_OK(state, shadowfit_set_visible_counts(state, &wrong, counts));
    CHECK_OK(state, shadowfit_set_visible_counts(state, &wrong, (const void *)((const char *)counts + 1)));
    CHECK_RESULT(state, shadowfit_set_visible_counts(state, &wrong, NULL), SHADOWFIT_NULL_POINTER);
    CHECK_RESULT(state, shadowfit_set_visible_counts(state, NULL, counts), SHADOWFIT_NULL_POINTER);
    free(counts);
    free(state);
}

static void lists_of_casters_fit_into_what_is_given(void) {
    ShadowfitState *state = new_state(3);
    float boxes_of_three[18] = {-1, 0, -1, 1, 2, 1, -5, 0, -5, -4, 3, -4, 3, 0, 3, 5, 1, 5};
    ShadowfitBoxes boxes = {.min_max = boxes_of_three, .count = 3};
    ShadowfitView view = usual_view(state);
    ShadowfitFrame frame = {.size = sizeof frame, .view_count = 1, .views = &view, .light_direction = {0.3f, -0.8f, 0.2f},
                            .receivers = boxes, .casters = boxes};
    ShadowfitMaps maps = {.size = sizeof maps};
    CHECK_OK(state, shadowfit_fit(state, &frame, &maps));
    uint32_t last = maps.count - 1, indices[3] = {7, 7, 7};
    size_t count;
    CHECK_OK(state, shadowfit_casters(state, last, NULL, 1, &boxes, indices, 3, &count));
    CHECK(count == 3 && indices[0] == 0 && indices[2] == 2);
    indices[2] = 7;
    CHECK_RESULT(state, shadowfit_casters(state, last, NULL, 1, &boxes, indices, 2, &count), SHADOWFIT_TOO_SMALL);
    CHECK(count == 3 && indices[1] == 1 && indices[2] == 7);
    CHECK_RESULT(state, shadowfit_casters(state, last, NULL, 1, &boxes, NULL, 0, &count), SHADOWFIT_TOO_SMALL);
    CHECK_RESULT(state, shadowfit_casters(state, last, NULL, 1, &boxes, NULL, 3, &count), SHADOWFIT_NULL_POINTER);
    CHECK_RESULT(state, shadowfit_casters(state, last, NULL, 1, NULL, indices, 3, &count), SHADOWFIT_NULL_POINTER);
    CHECK_RESULT(state, shadowfit_casters(state, last, NULL, 1, &boxes, indices, 3, NULL), SHADOWFIT_NULL_POINTER);
    CHECK_RESULT(state, shadowfit_casters(state, last, NULL, 5, &boxes, indices, 3, &count), SHADOWFIT_BAD_INPUT);
    CHECK_RESULT(state, shadowfit_casters(state, 9, NULL, 1, &boxes, indices, 3, &count), SHADOWFIT_BAD_INPUT);
    ShadowfitRect outside = {.x = 0, .viewport_x = 5, .width = 1, .height = 1};
    CHECK_RESULT(state, shadowfit_casters(state, last, &outside, 1, &boxes, indices, 3, &count), SHADOWFIT_BAD_INPUT);
    ShadowfitRect huge = {.width = UINT32_MAX, .height = UINT32_MAX, .viewport_x = INT32_MIN};
    CHECK_OK(state, shadowfit_casters(state, last, &huge, 1, &boxes, indices, 3, &count));
    boxes.count = 0;
    CHECK_OK(state, shadowfit_casters(state, last, NULL, 1, &boxes, NULL, 0, &count));
    CHECK(count == 0);
    ShadowfitFilter filter = {.size = sizeof filter, .bias = SHADOWFIT_BIAS_CONSTANT, .taps = 1};
    ShadowfitBias bias = {0, 0, 0, 0};
    CHECK_OK(state, shadowfit_bias(state, last, &filter, &bias));
    CHECK(bias.constant_depth > 0);
    filter.taps = NAN;
    for (filter.bias = 0; filter.bias < 3; filter.bias++)
        CHECK_RESULT(state, shadowfit_bias(state, last, &filter, &bias), SHADOWFIT_BAD_INPUT);
    filter.bias = SHADOWFIT_BIAS_CONSTANT;
    filter.taps = 1;
    filter.format = 8;
    CHECK_RESULT(state, shadowfit_bias(state, last, &filter, &bias), SHADOWFIT_BAD_INPUT);
    CHECK_RESULT(state, shadowfit_bias(state, last, &filter, NULL), SHADOWFIT_BAD_INPUT);
    free(state);
}

static void *walk_in_a_thread(void *path) {
    a_walk_is_equal_bit_for_bit_to_rust(path);
    return NULL;
}

static void threads_with_states_of_their_own_compute_the_same(const char *path) {
    pthread_t threads[4];
    for (int i = 0; i < 4; i++) CHECK(pthread_create(&threads[i], NULL, walk_in_a_thread, (void *)(size_t)path) == 0);
    for (int i = 0; i < 4; i++) CHECK(pthread_join(threads[i], NULL) == 0);
}

int main(int count, char **arguments) {
    CHECK(count == 3);
    states_are_checked();
    a_matrix_makes_the_same_view_as_a_camera();
    calls_out_of_order_name_the_missing_call();
    bad_input_returns_codes_and_sentences();
    cameras_techniques_and_depths_are_checked();
    lists_of_casters_fit_into_what_is_given();
    the_fit_of_the_xna_sample_is_reproduced(arguments[2]);
    a_walk_is_equal_bit_for_bit_to_rust(arguments[1]);
    threads_with_states_of_their_own_compute_the_same(arguments[1]);
    puts("all tests of the C interface passed");
    return 0;
}
