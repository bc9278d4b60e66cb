// Compares shadow factors of a scene of boxes with exact rays:
//     judge FILE [LIMIT]
// FILE comes from raylib_shadows --judge. Prints the share of wrong pixels among the pixels that face the light, with
// the pixels at edges. Fails if it is LIMIT percent or more.

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

// Distance of a shadow ray's start from the surface, in metres.
static const double LIFT = 0.001;

typedef struct {
    float min[3], max[3];
} Box;

// A frame of the file: size, number of boxes, camera and light.
typedef struct {
    float width, height, box_count, eye[3], forward[3], up[3], fov_y, light[3];
} Head;

typedef struct {
    double distance;
    // Axis of the normal, and its direction on the axis.
    int axis;
    double sign;
} Hit;

// Returns whether a ray enters a box before hit->distance, and writes the place into hit. A ray that starts in a box
// does not enter this box.
static bool enters(const Box *box, const double *start, const double *direction, Hit *hit) {
    double near = 0, far = hit->distance;
    int axis = -1;
    for (int i = 0; i < 3; i++) {
        if (direction[i] == 0) {
            if (start[i] < box->min[i] || start[i] > box->max[i]) return false;
            continue;
        }
        const bool up = direction[i] > 0;
        const double first = ((up ? box->min[i] : box->max[i]) - start[i]) / direction[i];
        const double last = ((up ? box->max[i] : box->min[i]) - start[i]) / direction[i];
        if (first > near) {
            near = first;
            axis = i;
        }
        if (last < far) far = last;
        if (near > far) return false;
    }
    if (axis < 0) return false;
    *hit = (Hit){near, axis, direction[axis] > 0 ? -1 : 1};
    return true;
}

static void normalize(const double *v, double *unit) {
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) unit[i] = v[i] / length;
}

static void cross(const double *a, const double *b, double *product) {
    for (int i = 0; i < 3; i++) product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

// Numbers of pixels.
typedef struct {
    long facing, shadowed, wrong;
} Sums;

static void judge_pixel(const Head *head, const Box *boxes, const double *direction, int factor, Sums *sums) {
    const double eye[3] = {head->eye[0], head->eye[1], head->eye[2]};
    const double light[3] = {head->light[0], head->light[1], head->light[2]};
    Hit hit = {1e30, -1, 0};
    for (int i = 0; i < (int)head->box_count; i++) enters(&boxes[i], eye, direction, &hit);
    if (hit.axis < 0 || light[hit.axis] * hit.sign >= 0) return;
    double start[3], to_light[3];
    for (int i = 0; i < 3; i++) {
        start[i] = eye[i] + hit.distance * direction[i];
        to_light[i] = -light[i];
    }
    start[hit.axis] += LIFT * hit.sign;
    bool is_lit = true;
    for (int i = 0; i < (int)head->box_count && is_lit; i++) {
        is_lit = !enters(&boxes[i], start, to_light, &(Hit){1e30, -1, 0});
    }
    sums->facing++;
    sums->shadowed += !is_lit;
    sums->wrong += is_lit != (factor >= 128);
}

static void judge_pixels(const Head *head, const Box *boxes, const unsigned char *factors, Sums *sums) {
    const int width = (int)head->width, height = (int)head->height;
    double forward[3], right[3], up[3], product[3];
    normalize((double[]){head->forward[0], head->forward[1], head->forward[2]}, forward);
    cross(forward, (double[]){head->up[0], head->up[1], head->up[2]}, product);
    normalize(product, right);
    cross(right, forward, up);
    const double scale = tan(head->fov_y / 2.0);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            const double across = (2 * (x + 0.5) - width) / height * scale;
            const double above = (1 - 2 * (y + 0.5) / height) * scale;
            double direction[3];
            for (int i = 0; i < 3; i++) direction[i] = forward[i] + across * right[i] + above * up[i];
            judge_pixel(head, boxes, direction, factors[y * width + x], sums);
        }
    }
}

// Judges a frame. Returns whether the file has one more.
static bool judge_frame(FILE *file, Sums *sums) {
    Head head;
    if (fread(&head, sizeof head, 1, file) != 1) return false;
    const size_t box_count = (size_t)head.box_count, pixels = (size_t)head.width * (size_t)head.height;
    Box *boxes = malloc(box_count * sizeof *boxes);
    unsigned char *factors = malloc(pixels);
    const bool is_whole = boxes != NULL && factors != NULL &&
                          fread(boxes, sizeof *boxes, box_count, file) == box_count &&
                          fread(factors, 1, pixels, file) == pixels;
    if (is_whole) judge_pixels(&head, boxes, factors, sums);
    free(boxes);
    free(factors);
    return is_whole;
}

int main(int argument_count, char **arguments) {
    FILE *file = argument_count > 1 ? fopen(arguments[1], "rb") : NULL;
    if (file == NULL) {
        fprintf(stderr, "error: give a file of raylib_shadows --judge\n");
        return 2;
    }
    Sums sums = {0, 0, 0};
    int frames = 0;
    while (judge_frame(file, &sums)) frames++;
    fclose(file);
    const double wrong = 100.0 * (double)sums.wrong / (double)sums.facing;
    printf("%d pictures: %.2f%% of %ld pixels that face the light are wrong; %.0f%% are in shadow\n", frames, wrong,
           sums.facing, 100.0 * (double)sums.shadowed / (double)sums.facing);
    const double limit = argument_count > 2 ? atof(arguments[2]) : 100;
    if (sums.facing > 0 && wrong < limit) return 0;
    fprintf(stderr, "error: the limit is %.2f%%\n", limit);
    return 1;
}
