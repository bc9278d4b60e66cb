// A town square of boxes in the evening, drawn with raylib. shadows.c has the shadows; this file has the town.
//
//     raylib_shadows                                        fly: keys W A S D and the mouse
//     raylib_shadows --frames 90 --picture walk.png         walk along a path, then save a picture
//     raylib_shadows --frames 90 --judge walk.bin           also write shadow factors, for a comparison with rays
//
// --shaders DIR names the folder of shadowfit_lookup.glsl. cargo xtask capi --raylib fetches raylib, and builds and
// runs this program.

#include "shadows.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "raymath.h"
#include "rlgl.h"

enum { WIDTH = 1280, HEIGHT = 720, MAX_OBJECTS = 1000 };

// Planes of the camera, in metres.
static const double NEAR_PLANE = 0.1, FAR_PLANE = 250;

// Direction of travel of the sunlight.
static const Vector3 SUN = {-0.72f, -0.4f, 0.34f};

// An axis-aligned box with a colour.
typedef struct {
    Vector3 min, max;
    Color color;
} Object;

// The static boxes, then the boxes of the tram.
static Object objects[MAX_OBJECTS];
static size_t object_count, static_count;

static Mesh cube;

// ---- The town ----

static const Color STONE = {206, 190, 164, 255}, PALE = {224, 214, 194, 255}, PLASTER = {214, 178, 138, 255},
                   ROSE = {196, 140, 116, 255}, TILE = {156, 92, 68, 255}, WOOD = {112, 84, 62, 255},
                   GLASS = {58, 70, 80, 255}, SHUTTER = {96, 122, 112, 255}, LEAF = {84, 106, 62, 255},
                   DARK_LEAF = {64, 86, 56, 255}, GROUND = {190, 176, 156, 255}, TRAM = {128, 44, 40, 255},
                   CREAM = {232, 220, 192, 255}, IRON = {60, 58, 58, 255}, WATER = {96, 130, 140, 255},
                   SKY = {112, 150, 188, 255}, HORIZON = {248, 222, 186, 255};

// Adds a box. x and z are its centre, y is its bottom.
static void box(float x, float y, float z, float width, float height, float depth, Color color) {
    if (object_count == MAX_OBJECTS) return;
    const Vector3 min = {x - width / 2, y, z - depth / 2}, max = {x + width / 2, y + height, z + depth / 2};
    objects[object_count++] = (Object){min, max, color};
}

// Adds a column with plinth and capital, 4 m high.
static void column(float x, float z, Color color) {
    box(x, 0, z, 0.95f, 0.35f, 0.95f, color);
    box(x, 0.35f, z, 0.62f, 3.2f, 0.62f, color);
    box(x, 3.55f, z, 0.78f, 0.15f, 0.78f, color);
    box(x, 3.7f, z, 0.95f, 0.3f, 0.95f, color);
}

// Adds a window on a wall that faces +x.
static void window_at(float x, float y, float z) {
    box(x + 0.02f, y, z, 0.04f, 1.7f, 1.0f, GLASS);
    box(x + 0.1f, y - 0.14f, z, 0.2f, 0.14f, 1.3f, PALE);
    box(x + 0.08f, y + 1.7f, z, 0.16f, 0.18f, 1.3f, PALE);
    box(x + 0.04f, y, z - 0.78f, 0.08f, 1.7f, 0.5f, SHUTTER);
    box(x + 0.04f, y, z + 0.78f, 0.08f, 1.7f, 0.5f, SHUTTER);
}

// Adds a house over an arcade on the left side, with its front at x = -8.
static void arcade(float z_near, int bays, float storeys, Color wall) {
    const float bay = 3.6f, length = bay * (float)bays, z = z_near - length / 2, top = 4.9f + 3.4f * storeys;
    for (int i = 0; i <= bays; i++) {
        const float at = z_near - bay * (float)i;
        if (i > 0 || z_near > 18) column(-8.5f, at, STONE);
        if (i == bays) break;
        // An arch of corbels.
        for (int side = -1; side <= 1; side += 2) {
            box(-8.5f, 4.0f, at - bay / 2 + 1.45f * (float)side, 0.7f, 0.25f, 0.7f, STONE);
            box(-8.5f, 4.25f, at - bay / 2 + 1.2f * (float)side, 0.7f, 0.25f, 1.2f, STONE);
        }
        box(-13.45f, 0, at - bay / 2, 0.1f, 2.7f, 1.5f, WOOD);
        for (float floor = 0; floor < storeys; floor++) window_at(-8, 5.9f + 3.4f * floor, at - bay / 2);
    }
    box(-17, 0, z, 7, 4.9f, length, wall);
    box(-11, 4.5f, z, 5, 0.4f, length, STONE);
    box(-12.5f - 1.75f, 4.9f, z, 12.5f, top - 4.9f, length, wall);
    box(-14.2f, top, z, 13.2f, 0.3f, length, PALE);
    for (int i = 0; i < 6; i++) {
        box(-14.2f, top + 0.3f + 0.35f * (float)i, z, 12.8f - 1.9f * (float)i, 0.35f, length, TILE);
    }
    box(-11, top + 0.3f, z + length / 4, 0.9f, 2.6f, 0.9f, ROSE);
}

// Adds a pergola on the right side. Its slats cast stripes.
static void pergola(float z_near, int bays) {
    const float bay = 3.6f, length = bay * (float)bays;
    for (int i = 0; i <= bays; i++) {
        column(7.5f, z_near - bay * (float)i, PALE);
        column(11.5f, z_near - bay * (float)i, PALE);
    }
    box(7.5f, 4, z_near - length / 2, 0.35f, 0.4f, length + 1.2f, WOOD);
    box(11.5f, 4, z_near - length / 2, 0.35f, 0.4f, length + 1.2f, WOOD);
    for (int i = 0; i <= 4 * bays; i++) box(9.5f, 4.4f, z_near - bay / 4 * (float)i, 5.6f, 0.25f, 0.18f, WOOD);
}

// Adds a clipped tree in a pot.
static void tree(float x, float z, float size) {
    box(x, 0, z, 1.1f * size, 0.7f * size, 1.1f * size, ROSE);
    box(x, 0.7f * size, z, 0.95f * size, 0.04f, 0.95f * size, WOOD);
    box(x, 0.7f * size + 0.04f, z, 0.16f * size, 1.0f * size, 0.16f * size, WOOD);
    box(x, 1.7f * size, z, 1.5f * size, 1.1f * size, 1.5f * size, LEAF);
    box(x, 2.8f * size, z, 1.0f * size, 0.7f * size, 1.0f * size, DARK_LEAF);
    box(x, 3.5f * size, z, 0.5f * size, 0.4f * size, 0.5f * size, LEAF);
}

static void bench(float x, float z) {
    box(x, 0.42f, z, 0.5f, 0.08f, 2.0f, WOOD);
    for (int side = -1; side <= 1; side += 2) box(x, 0, z + 0.8f * (float)side, 0.4f, 0.42f, 0.12f, IRON);
}

static void fountain(float x, float z) {
    box(x, 0, z, 6.4f, 0.18f, 6.4f, PALE);
    box(x, 0.18f, z, 5.6f, 0.18f, 5.6f, STONE);
    for (int side = -1; side <= 1; side += 2) {
        box(x + 2.2f * (float)side, 0.36f, z, 0.4f, 0.6f, 4.8f, PALE);
        box(x, 0.36f, z + 2.2f * (float)side, 4.0f, 0.6f, 0.4f, PALE);
    }
    box(x, 0.36f, z, 3.99f, 0.4f, 3.99f, WATER);
    box(x, 0.76f, z, 1.0f, 0.9f, 1.0f, STONE);
    box(x, 1.66f, z, 1.5f, 0.2f, 1.5f, PALE);
    box(x, 1.86f, z, 0.5f, 2.4f, 0.5f, STONE);
    box(x, 4.26f, z, 0.8f, 0.2f, 0.8f, PALE);
    box(x, 4.46f, z, 0.4f, 0.5f, 0.4f, TILE);
}

static void cypress(float x, float z, float height) {
    box(x, 0, z, 0.4f, 1, 0.4f, WOOD);
    box(x, 1, z, 1.5f, 0.45f * height, 1.5f, DARK_LEAF);
    box(x, 1 + 0.45f * height, z, 1.1f, 0.3f * height, 1.1f, LEAF);
    box(x, 1 + 0.75f * height, z, 0.6f, 0.25f * height, 0.6f, DARK_LEAF);
}

// Adds a low wall with piers along the right side of the square.
static void garden_wall(float x, float z_near, int bays) {
    const float bay = 9, length = bay * (float)bays;
    box(x, 0, z_near - length / 2, 0.5f, 1.5f, length, PLASTER);
    box(x, 1.5f, z_near - length / 2, 0.7f, 0.15f, length, PALE);
    for (int i = 0; i <= bays; i++) {
        box(x, 0, z_near - bay * (float)i, 1.1f, 2.2f, 1.1f, STONE);
        box(x, 2.2f, z_near - bay * (float)i, 1.4f, 0.2f, 1.4f, PALE);
    }
}

// Adds a tower with battlements, which closes the square.
static void tower(float x, float z) {
    box(x, 0, z, 9, 1.2f, 9, STONE);
    box(x, 1.2f, z, 8, 16, 8, PLASTER);
    for (int i = 0; i < 3; i++) box(x, 5 + 4.5f * (float)i, z, 8.3f, 0.3f, 8.3f, PALE);
    for (int i = 0; i < 3; i++) {
        box(x - 2.2f, 6.5f + 4.5f * (float)i, z + 4, 0.9f, 1.9f, 0.06f, GLASS);
        box(x + 2.2f, 6.5f + 4.5f * (float)i, z + 4, 0.9f, 1.9f, 0.06f, GLASS);
    }
    box(x, 1.2f, z + 4, 2.6f, 3.2f, 0.3f, WOOD);
    box(x, 17.2f, z, 9, 0.7f, 9, STONE);
    for (int i = -2; i <= 2; i++) {
        for (int side = -1; side <= 1; side += 2) {
            box(x + 2.0f * (float)i, 17.9f, z + 4.1f * (float)side, 1, 1.1f, 0.8f, STONE);
            if (abs(i) < 2) box(x + 4.1f * (float)side, 17.9f, z + 2.0f * (float)i, 0.8f, 1.1f, 1, STONE);
        }
    }
    for (int i = 0; i < 7; i++) {
        const float width = 6.6f - 0.9f * (float)i;
        box(x, 17.9f + 0.7f * (float)i, z, width, 0.7f, width, TILE);
    }
}

// Middle of the tram's track.
static const float TRAM_X = -2.9f;

static void add_tram(float z) {
    box(TRAM_X, 0.45f, z, 2.3f, 1.1f, 8.4f, TRAM);
    for (int i = -3; i <= 3; i++) {
        for (int side = -1; side <= 1; side += 2) {
            box(TRAM_X + 1.08f * (float)side, 1.55f, z + 1.36f * (float)i, 0.14f, 1.0f, 0.2f, CREAM);
        }
    }
    box(TRAM_X, 2.55f, z, 2.3f, 0.3f, 8.4f, CREAM);
    box(TRAM_X, 2.85f, z, 1.7f, 0.25f, 6.8f, TRAM);
    for (int i = -1; i <= 1; i += 2) box(TRAM_X, 0.08f, z + 2.6f * (float)i, 1.6f, 0.37f, 1.5f, IRON);
    box(TRAM_X, 3.1f, z, 0.1f, 1.6f, 0.1f, IRON);
    box(TRAM_X, 4.7f, z, 1.5f, 0.08f, 0.1f, IRON);
}

static void build_town(void) {
    box(0, -0.5f, -10, 160, 0.5f, 160, GROUND);
    arcade(26, 6, 2, PLASTER);
    arcade(4.4f, 5, 1, ROSE);
    arcade(-13.6f, 6, 2, PLASTER);
    pergola(14, 9);
    tower(0.5f, -44);
    box(-14, 0, -46, 12, 9, 8, ROSE);
    box(-14, 9, -46, 12.6f, 0.3f, 8.6f, PALE);
    box(14, 0, -44, 18, 8, 8, PLASTER);
    box(14, 8, -44, 18.6f, 0.3f, 8.6f, PALE);
    fountain(2.6f, -13);
    for (int i = 0; i < 6; i++) tree(-5.9f, 17 - 7.2f * (float)i, 0.9f + 0.1f * (float)(i % 3));
    for (int i = 0; i < 5; i++) bench(9.5f, 10 - 7.2f * (float)i);
    for (int i = 0; i < 4; i++) tree(9.5f, 6.4f - 7.2f * (float)i, 0.7f);
    for (int i = 0; i < 6; i++) cypress(23 + (float)(i % 2), 8 - 9.0f * (float)i, 8.5f + (float)(i % 3));
    garden_wall(20, 24, 8);
    // Rails, 3 cm high.
    for (int side = -1; side <= 1; side += 2) box(TRAM_X + 0.72f * (float)side, 0, -8, 0.08f, 0.03f, 62, IRON);
    static_count = object_count;
}

static void move_tram(float time) {
    object_count = static_count;
    add_tram(-8 + 2.4f * time);
}

// ---- Drawing ----

static const char *VERTEX =
    "in vec3 vertexPosition; in vec3 vertexNormal;\n"
    "uniform mat4 mvp; uniform mat4 matModel;\n"
    "out vec3 position; out vec3 normal;\n"
    "void main() {\n"
    "    position = (matModel * vec4(vertexPosition, 1.0)).xyz;\n"
    "    normal = vertexNormal;\n"  // Boxes are not turned.
    "    gl_Position = mvp * vec4(vertexPosition, 1.0);\n"
    "}\n";

static const char *FRAGMENT =
    "in vec3 position; in vec3 normal;\n"
    "uniform vec4 colDiffuse; uniform vec3 toSun; uniform vec3 eye; uniform int showsFactor;\n"
    "out vec4 color;\n"
    "float joint(vec2 at) {\n"  // Joints of the pavement, which fade into the distance.
    "    vec2 cell = abs(fract(at) - 0.5), width = fwidth(at);\n"
    "    vec2 line = smoothstep(0.48 - width, 0.48 + width, cell);\n"
    "    return max(line.x, line.y) * clamp(0.25 / max(width.x, width.y), 0.0, 1.0) * 0.35;\n"
    "}\n"
    "void main() {\n"
    "    vec3 n = normalize(normal);\n"
    "    float cosine = dot(n, toSun);\n"
    "    float factor = cosine > 0.0 ? shadowfit_factor(position, n) : 0.0;\n"
    "    vec3 albedo = pow(colDiffuse.rgb, vec3(2.2));\n"
    "    if (position.y < 0.01 && n.y > 0.5) {\n"
    "        float row = floor(position.z / 0.9);\n"
    "        vec2 slab = vec2(position.x / 1.4 + 0.5 * mod(row, 2.0), position.z / 0.9);\n"
    "        float shade = fract(sin(dot(floor(slab), vec2(12.99, 78.23))) * 43758.5);\n"
    "        albedo *= (0.9 + 0.16 * shade) * (1.0 - joint(slab));\n"
    "    }\n"
    "    float open = mix(0.5, 1.0, smoothstep(-0.5, 4.0, position.y + 3.0 * n.y));\n"
    "    vec3 sky = mix(vec3(0.34, 0.26, 0.19), vec3(0.36, 0.47, 0.66), 0.5 + 0.5 * n.y) * open;\n"
    "    vec3 bounced = vec3(0.34, 0.24, 0.15) * max(-dot(n.xz, toSun.xz), 0.0) * open;\n"
    "    vec3 light = sky * 0.72 + bounced + vec3(3.0, 2.2, 1.4) * max(cosine, 0.0) * factor;\n"
    "    float haze = 1.0 - exp(-distance(position, eye) / 260.0);\n"
    "    vec3 seen = mix(albedo * light, vec3(0.86, 0.74, 0.60), haze);\n"
    "    seen = seen * (1.0 + seen / 6.0) / (1.0 + seen);\n"
    "    color = vec4(showsFactor == 1 ? vec3(factor) : pow(seen * 1.25, vec3(1.0 / 2.2)), 1.0);\n"
    "}\n";

// Numbers of draws into the shadow maps of this frame.
static unsigned int static_draws, moving_draws;

static void draw_object(size_t index, Material material) {
    const Object *object = &objects[index];
    const Vector3 size = Vector3Subtract(object->max, object->min);
    const Vector3 centre = Vector3Scale(Vector3Add(object->min, object->max), 0.5f);
    material.maps[MATERIAL_MAP_DIFFUSE].color = object->color;
    DrawMesh(cube, material, MatrixMultiply(MatrixScale(size.x, size.y, size.z),
                                            MatrixTranslate(centre.x, centre.y, centre.z)));
}

static void draw_caster(bool moves, size_t index, Material material) {
    if (moves) moving_draws++;
    else static_draws++;
    draw_object(moves ? static_count + index : index, material);
}

// Returns the boxes of the objects from first to end.
static ShadowfitBoxes boxes(size_t first, size_t end) {
    return (ShadowfitBoxes){.min_max = &objects[first].min.x, .count = end - first, .stride = sizeof *objects};
}

static void draw_scene(Camera3D camera, Material material, int width, int height, int shows_factor) {
    const Shader shader = material.shader;
    SetShaderValue(shader, GetShaderLocation(shader, "showsFactor"), &shows_factor, SHADER_UNIFORM_INT);
    SetShaderValue(shader, GetShaderLocation(shader, "eye"), &camera.position, SHADER_UNIFORM_VEC3);
    ClearBackground(BLACK);
    DrawRectangleGradientV(0, 0, width, height * 6 / 10, SKY, HORIZON);
    BeginMode3D(camera);
    for (size_t i = 0; i < object_count; i++) draw_object(i, material);
    EndMode3D();
}

// Returns the camera of the fixed path: two thirds of the frames walk, then the camera stands still.
static Camera3D camera_at(int frame, int frames) {
    const float walk = fminf(1.5f * (float)frame / (float)frames, 1), turn = 0.12f * sinf(3 * walk);
    const Vector3 eye = {2.2f + 0.6f * walk, 1.75f, 19 - 4 * walk};
    const Vector3 forward = {sinf(turn) - 0.12f, 0.02f, -cosf(turn)};
    return (Camera3D){eye, Vector3Add(eye, forward), {0, 1, 0}, 52, CAMERA_PERSPECTIVE};
}

// ---- The comparison with rays ----

// Appends a frame: size, number of boxes, camera, light, boxes, and the shadow factors from the top row on.
static void write_factors(FILE *file, Camera3D camera, Image factors) {
    const Vector3 eye = camera.position, forward = Vector3Subtract(camera.target, eye), up = camera.up;
    const float head[] = {(float)factors.width, (float)factors.height, (float)object_count,
                          eye.x, eye.y, eye.z, forward.x, forward.y, forward.z, up.x, up.y, up.z,
                          camera.fovy * DEG2RAD, SUN.x, SUN.y, SUN.z};
    const unsigned char *pixels = factors.data;
    fwrite(head, sizeof head, 1, file);
    for (size_t i = 0; i < object_count; i++) fwrite(&objects[i].min, 2 * sizeof(Vector3), 1, file);
    // A render texture begins with the bottom row.
    for (int y = factors.height - 1; y >= 0; y--) {
        for (int x = 0; x < factors.width; x++) fputc(pixels[4 * (y * factors.width + x)], file);
    }
}

// Least number of frames whose factors are written.
enum { JUDGED_FRAMES = 4 };

typedef struct {
    int frames;
    const char *picture, *judge, *shaders;
} Options;

static Options parse(int count, char **words) {
    Options options = {.shaders = "crates/shadowfit-capi/shaders"};
    for (int i = 1; i + 1 < count; i += 2) {
        if (strcmp(words[i], "--frames") == 0) options.frames = atoi(words[i + 1]);
        if (strcmp(words[i], "--picture") == 0) options.picture = words[i + 1];
        if (strcmp(words[i], "--judge") == 0) options.judge = words[i + 1];
        if (strcmp(words[i], "--shaders") == 0) options.shaders = words[i + 1];
    }
    const bool is_automatic = options.picture != NULL || options.judge != NULL;
    if (is_automatic && options.frames < JUDGED_FRAMES) options.frames = 90;
    return options;
}

// The parts of the program that last. scale is the number of the target's pixels per pixel of the window.
typedef struct {
    int scale;
    RenderTexture2D target;
    Shadows *shadows;
    Material material;
} Stage;

// Opens the window, and loads the town and its shaders.
static Stage load(const Options *options) {
    SetTraceLogLevel(LOG_WARNING);
    InitWindow(WIDTH, HEIGHT, "raylib with shadowfit");
    rlSetClipPlanes(NEAR_PLANE, FAR_PLANE);
    if (options->frames == 0) {
        SetTargetFPS(60);
        DisableCursor();
    }
    build_town();
    cube = GenMeshCube(1, 1, 1);

    // Twice the window's width and height make edges smooth. Judged pixels have one sample.
    Stage stage = {.scale = options->judge != NULL ? 1 : 2};
    stage.target = LoadRenderTexture(stage.scale * WIDTH, stage.scale * HEIGHT);
    SetTextureFilter(stage.target.texture, TEXTURE_FILTER_BILINEAR);
    stage.shadows = shadows_load(options->shaders, MAX_OBJECTS);
    stage.material = LoadMaterialDefault();
    stage.material.shader = shadows_load_shader(stage.shadows, VERTEX, FRAGMENT);
    const Vector3 to_sun = Vector3Normalize(Vector3Negate(SUN));
    const int place = GetShaderLocation(stage.material.shader, "toSun");
    SetShaderValue(stage.material.shader, place, &to_sun, SHADER_UNIFORM_VEC3);
    return stage;
}

// Draws a frame: the shadow maps, then the scene. Saves the window to picture, unless it is null.
static void draw_frame(const Stage *stage, Camera3D camera, const char *picture) {
    const int width = stage->scale * WIDTH, height = stage->scale * HEIGHT;
    const ShadowObjects casters = {boxes(0, object_count), boxes(0, static_count), boxes(static_count, object_count),
                                   draw_caster};
    static_draws = moving_draws = 0;
    shadows_draw(stage->shadows, camera, (float)WIDTH / HEIGHT, SUN, &casters);

    BeginTextureMode(stage->target);
    draw_scene(camera, stage->material, width, height, 0);
    shadows_read_depths(stage->shadows, width, height);
    EndTextureMode();

    BeginDrawing();
    DrawTexturePro(stage->target.texture, (Rectangle){0, 0, (float)width, (float)-height},
                   (Rectangle){0, 0, WIDTH, HEIGHT}, (Vector2){0, 0}, 0, WHITE);
    if (picture != NULL) {
        rlDrawRenderBatchActive();
        Image image = LoadImageFromScreen();
        ExportImage(image, picture);
        UnloadImage(image);
    }
    EndDrawing();
}

static void judge_frame(const Stage *stage, Camera3D camera, FILE *file) {
    BeginTextureMode(stage->target);
    draw_scene(camera, stage->material, stage->scale * WIDTH, stage->scale * HEIGHT, 1);
    EndTextureMode();
    Image factors = LoadImageFromTexture(stage->target.texture);
    write_factors(file, camera, factors);
    UnloadImage(factors);
}

// Walks along the fixed path.
static void walk(const Stage *stage, const Options *options) {
    FILE *judge = options->judge != NULL ? fopen(options->judge, "wb") : NULL;
    for (int frame = 0; frame < options->frames; frame++) {
        const Camera3D camera = camera_at(frame, options->frames);
        move_tram(3 * (float)frame / (float)options->frames);
        draw_frame(stage, camera, frame + 1 == options->frames ? options->picture : NULL);
        printf("frame %3d: %3u draws of static casters, %3u of moving casters\n", frame, static_draws, moving_draws);
        if (judge != NULL && (frame + 1) % (options->frames / JUDGED_FRAMES) == 0) judge_frame(stage, camera, judge);
    }
    if (judge != NULL) fclose(judge);
}

int main(int argument_count, char **arguments) {
    const Options options = parse(argument_count, arguments);
    const Stage stage = load(&options);
    if (options.frames > 0) {
        walk(&stage, &options);
    } else {
        Camera3D camera = camera_at(0, 1);
        while (!WindowShouldClose()) {
            UpdateCamera(&camera, CAMERA_FREE);
            move_tram(fmodf((float)GetTime(), 16));
            draw_frame(&stage, camera, NULL);
        }
    }
    shadows_unload(stage.shadows);
    UnloadMaterial(stage.material);
    UnloadMesh(cube);
    UnloadRenderTexture(stage.target);
    CloseWindow();
    return 0;
}
