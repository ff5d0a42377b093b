// SPDX-License-Identifier: MIT
// A picture of a mesh on a floor: sunlight with soft shadows, and light from the sky where the sky
// is seen (ambient occlusion). All visibility comes from segments through the grid. One work-item a
// pixel.
//
// normals   three a triangle
// image     linear colour, row by row from the top

// Beyond everything that is drawn: the mesh fits into a sphere of radius 1.
#define FAR_AWAY 100.0f
// Segments that start on a surface start this far above it.
#define LIFT 1e-3f

typedef struct {
    float3 position, normal, colour;
    int seen;
} Surface;

// Evenly distributed numbers in [0, 1), from a counter (PCG hash).
static float next_random(uint* state) {
    *state = *state * 747796405u + 2891336453u;
    const uint word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (float)((word ^ (word >> 22)) >> 8) * 0x1p-24f;
}

// A direction around the normal, more likely the closer to it: as a matt surface receives light.
static float3 random_direction(float3 normal, uint* state) {
    const float height = 1.0f - 2.0f * next_random(state);
    const float angle = 2.0f * M_PI_F * next_random(state);
    const float radius = sqrt(fmax(0.0f, 1.0f - height * height));
    const float3 ball = (float3)(radius * cos(angle), radius * sin(angle), height);
    return normalize(normal + 0.999f * ball);
}

static float3 sky(float3 direction) {
    return mix((float3)(0.92f, 0.94f, 0.97f), (float3)(0.42f, 0.58f, 0.85f),
               clamp(direction.y, 0.0f, 1.0f));
}

static Surface find_surface(GRID_SCENE(scene), global const float4* normals, const Camera camera,
                            float3 direction) {
    const float3 eye = (float3)(camera.eye[0], camera.eye[1], camera.eye[2]);
    const float3 to = eye + FAR_AWAY * direction;
    Surface surface;
    surface.seen = 0;
    float at;
    const uint number = grid_closest_hit(GRID_PASS(scene), eye, to, &at);
    const float floor_at = (camera.floor - eye.y) / (FAR_AWAY * direction.y);
    if (number != GRID_NO_TRIANGLE && !(floor_at > 0.0f && floor_at < at)) {
        const GridTriangle triangle = scene_triangles[number];
        const float3 a = cellist_float3(triangle.a);
        const float3 ab = cellist_float3(triangle.b) - a;
        const float3 ac = cellist_float3(triangle.c) - a;
        const float3 flat_normal = cross(ab, ac);
        const float area = dot(flat_normal, flat_normal);
        surface.position = mix(eye, to, at);
        const float3 p = surface.position - a;
        const float v = dot(cross(p, ac), flat_normal) / area;
        const float w = dot(cross(ab, p), flat_normal) / area;
        surface.normal =
            normalize((1.0f - v - w) * normals[3 * number].xyz + v * normals[3 * number + 1].xyz +
                      w * normals[3 * number + 2].xyz);
        // Both sides are seen.
        if (dot(surface.normal, direction) > 0.0f) surface.normal = -surface.normal;
        surface.colour = (float3)(0.80f, 0.62f, 0.42f);
        surface.seen = 1;
    } else if (floor_at > 0.0f && floor_at < 1.0f) {
        surface.position = mix(eye, to, floor_at);
        surface.normal = (float3)(0.0f, 1.0f, 0.0f);
        surface.colour = (float3)(0.55f, 0.56f, 0.58f);
        surface.seen = 1;
    }
    return surface;
}

static float3 light_on(GRID_SCENE(scene), const Surface surface, const Camera camera, uint* state) {
    const float3 start = surface.position + LIFT * surface.normal;
    const float3 sun = normalize((float3)(camera.sun[0], camera.sun[1], camera.sun[2]));
    const float3 to_sun = normalize(sun + 0.03f * random_direction(sun, state));
    float3 light = (float3)(0.0f);
    const float facing = dot(surface.normal, to_sun);
    if (facing > 0.0f && !grid_any_hit(GRID_PASS(scene), start, start + FAR_AWAY * to_sun))
        light += 1.35f * facing * (float3)(1.0f, 0.93f, 0.82f);
    const float3 up = random_direction(surface.normal, state);
    if (up.y > 0.0f) {
        if (!grid_any_hit(GRID_PASS(scene), start, start + FAR_AWAY * up)) light += 0.75f * sky(up);
    } else if (!grid_any_hit(GRID_PASS(scene), start,
                             start + (camera.floor - start.y) / fmin(up.y, -1e-3f) * up)) {
        light += (float3)(0.18f);  // from the floor
    }
    return light;
}

kernel void draw(GRID_SCENE(scene), global const float4* normals, const Camera camera,
                 global float4* image) {
    const int x = get_global_id(0);
    const int y = get_global_id(1);
    if (x >= camera.width || y >= camera.height) return;
    uint state = (uint)(y * camera.width + x) * 9781u + 17u;
    next_random(&state);
    float3 sum = (float3)(0.0f);
    for (int sample = 0; sample < camera.samples; ++sample) {
        const float px = (float)x - 0.5f + next_random(&state);
        const float py = (float)y - 0.5f + next_random(&state);
        float3 ray;
        ray.x = camera.ray_origin[0] + px * camera.ray_x[0] + py * camera.ray_y[0];
        ray.y = camera.ray_origin[1] + px * camera.ray_x[1] + py * camera.ray_y[1];
        ray.z = camera.ray_origin[2] + px * camera.ray_x[2] + py * camera.ray_y[2];
        ray = normalize(ray);
        const Surface surface = find_surface(GRID_PASS(scene), normals, camera, ray);
        const float3 background = sky(ray + (float3)(0.0f, 0.25f, 0.0f));
        if (!surface.seen) {
            sum += background;
            continue;
        }
        const float3 colour = surface.colour * light_on(GRID_PASS(scene), surface, camera, &state);
        // The floor fades into the background.
        const float away = length(surface.position.xz);
        sum += mix(background, colour, smoothstep(9.0f, 3.0f, away));
    }
    image[y * camera.width + x] = (float4)(sum / (float)camera.samples, 1.0f);
}
