// SPDX-License-Identifier: MIT
// Indirect light of one bounce, and what of it is blocked (Yang, Hensley, Gruen, Thibieroz:
// "Real-Time Concurrent Linked List Construction on the GPU", EGSR 2010, section 4.2).

// ---- blockers

// One work-item a triangle: its corners in the world.
kernel void place_blockers(global const Blocker* blockers, uint count,
                           global const PlacedMesh* placed_meshes, global const float* positions,
                           global const uint* indices, global GridTriangle* triangles) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const PlacedMesh placed = placed_meshes[blockers[i].instance];
    cellist_vec3 corner[3];
    for (int k = 0; k < 3; ++k) {
        const float4 p = (float4)(vload3(indices[3 * blockers[i].triangle + k], positions), 1.0f);
        corner[k] =
            (cellist_vec3){dot(placed.row_x, p), dot(placed.row_y, p), dot(placed.row_z, p)};
    }
    const GridTriangle triangle = {corner[0], corner[1], corner[2]};
    triangles[i] = triangle;
}

// ---- the reflective shadow map

// Work-items that share the texels of an emitter.
#define EMITTER_GROUP 64

// The sum of a value over the work-group, in the same order each time.
static float4 group_sum(local float4* sums, float4 value) {
    const uint item = get_local_id(0);
    sums[item] = value;
    for (uint count = EMITTER_GROUP / 2; count > 0; count /= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item < count) sums[item] += sums[item + count];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const float4 sum = sums[0];
    barrier(CLK_LOCAL_MEM_FENCE);
    return sum;
}

// Emitters of all samples: first those of walls, then those of blockers.
static int emitter_count(const Gather gather) { return 2 * gather.samples * gather.samples; }

// A texel as an emitter. Its power is 0 if it is not of this kind.
static Emitter texel_emitter(global const Surface* lit, const LightSource light,
                             const Gather gather, int2 texel, bool of_blockers) {
    const Surface surface = lit[texel.y * gather.rsm_side + texel.x];
    Emitter emitter = {surface.position, surface.normal, (float4)(0.0f)};
    if (!(surface.position.w > 0.0f) || (surface.albedo.w > 0.0f) != of_blockers) return emitter;
    const float2 image = (convert_float2(texel) + 0.5f) / (float)gather.rsm_side;
    const float2 across = (image - 0.5f) * light.side;
    // The solid angle of the texel, or its area across the light.
    const float side = light.side / (float)gather.rsm_side;
    const float slope = light.is_spot ? rsqrt(1.0f + dot(across, across)) : 1.0f;
    const float received = side * side * slope * slope * slope * light_fade(light, image);
    emitter.power = surface.albedo * light.intensity * received;
    emitter.power.w =
        side * side * light_spread(light, surface.position.xyz, slope, surface.normal.xyz) / M_PI_F;
    return emitter;
}

// A work-group an emitter: the mean, by power, of the texels of one kind in a sample's part of the
// map. Its disc has the second moment of the texels' discs.
kernel __attribute__((reqd_work_group_size(EMITTER_GROUP, 1, 1))) void make_emitters(
    global const Surface* lit, const LightSource light, const Gather gather,
    global Emitter* emitters) {
    local float4 sums[EMITTER_GROUP];
    const int item = (int)get_local_id(0), part = gather.rsm_side / gather.samples;
    const int sample = (int)get_group_id(0) % (gather.samples * gather.samples);
    const bool of_blockers = (int)get_group_id(0) != sample;
    const int2 first = (int2)(sample % gather.samples, sample / gather.samples) * part;
    float4 power = 0.0f, position = 0.0f, normal = 0.0f, squares = 0.0f;
    for (int i = item; i < part * part; i += EMITTER_GROUP) {
        const Emitter texel =
            texel_emitter(lit, light, gather, first + (int2)(i % part, i / part), of_blockers);
        const float weight = texel.power.x + texel.power.y + texel.power.z;
        power += (float4)(texel.power.xyz, weight);
        position += weight * texel.position;
        normal += weight * texel.normal;
    }
    power = group_sum(sums, power);
    const float all_weight = fmax(power.w, 1e-30f);
    position = group_sum(sums, position) / all_weight;
    normal = group_sum(sums, normal);
    normal *= rsqrt(fmax(dot(normal, normal), 1e-30f));
    for (int i = item; i < part * part; i += EMITTER_GROUP) {
        const Emitter texel =
            texel_emitter(lit, light, gather, first + (int2)(i % part, i / part), of_blockers);
        const float weight = texel.power.x + texel.power.y + texel.power.z;
        const float3 off = texel.position.xyz - position.xyz;
        const float height = dot(off, normal.xyz);
        squares += weight * (float4)(height * height, dot(off, off), texel.power.w, 0.0f);
    }
    squares = group_sum(sums, squares) / all_weight;
    if (item != 0) return;
    Emitter emitter = {position, normal, power};
    emitter.normal.w = gather.bias + 2.0f * sqrt(squares.x);
    emitter.power.w = 2.0f * squares.y + squares.z;
    emitters[get_group_id(0)] = emitter;
}

// ---- buffer A: all indirect light

// One work-item a pixel: the irradiance from all emitters, blocked or not.
kernel void gather_unblocked(global const Surface* seen, global const Emitter* emitters,
                             const Gather gather, global float4* a) {
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= gather.width || y >= gather.height) return;
    const int pixel = y * gather.width + x;
    const Surface surface = seen[pixel];
    float3 sum = 0.0f;
    if (surface.position.w > 0.0f)
        for (int i = 0; i < emitter_count(gather); ++i)
            sum += light_from(emitters[i], surface.position.xyz, surface.normal.xyz);
    a[pixel] = (float4)(sum, 1.0f);
}

// ---- buffer B: blocked indirect light, at a lower resolution

static int2 b_size(const Gather gather) {
    return ((int2)(gather.width, gather.height) + gather.reduce - 1) / gather.reduce;
}

// The pixel of the picture in the middle of one of B.
static int b_pixel(const Gather gather, int x, int y) {
    const int2 p = min((int2)(x, y) * gather.reduce + gather.reduce / 2,
                       (int2)(gather.width, gather.height) - 1);
    return p.y * gather.width + p.x;
}

// Rays from a pixel of B to emitters of one kind, along each axis.
static int b_rays(const Gather gather) { return gather.samples / gather.interleave; }
// All of them.
static int b_rays_per_pixel(const Gather gather) { return 2 * b_rays(gather) * b_rays(gather); }

// The emitter of ray number `ray` of a pixel of B. Neighbours in a square of interleave *
// interleave take different emitters, and all of them together take each emitter once (Keller,
// Heidrich: "Interleaved Sampling", EGWR 2001).
static int b_emitter(const Gather gather, int x, int y, int ray) {
    const int rays = b_rays(gather), i = ray % rays, j = ray / rays % rays;
    const int u = i * gather.interleave + (x + j) % gather.interleave;
    const int v = j * gather.interleave + (y + i) % gather.interleave;
    return (ray / (rays * rays) * gather.samples + v) * gather.samples + u;
}

// Whether an emitter lights a pixel of B at all.
static int b_is_lit(const Surface surface, const Emitter emitter, const Gather gather) {
    const float3 light = light_from(emitter, surface.position.xyz, surface.normal.xyz);
    return surface.position.w > 0.0f && light.x + light.y + light.z > 0.0f;
}

// One work-item a ray: from a pixel of B to an emitter. Rays without light have length 0. Rays of a
// batch begin at row first_row of B.
kernel void make_rays(global const Surface* seen, global const Emitter* emitters,
                      const Gather gather, global GridSegment* rays) {
    const int2 size = b_size(gather);
    const int i = (int)get_global_id(0);
    if (i >= size.x * gather.rows * b_rays_per_pixel(gather)) return;
    // Rays of neighbouring pixels to the same emitter follow one another.
    const int place = i % (size.x * gather.rows), ray = i / (size.x * gather.rows);
    const int x = place % size.x, y = gather.first_row + place / size.x;
    const Surface surface = seen[b_pixel(gather, x, y)];
    const Emitter emitter = emitters[b_emitter(gather, x, y, ray)];
    GridSegment segment;
    segment.from = surface.position + gather.bias * surface.normal;
    segment.to = b_is_lit(surface, emitter, gather)
                     ? emitter.position + emitter.normal.w * emitter.normal
                     : segment.from;
    rays[i] = segment;
}

// One work-item a pixel of B: the light of its emitters that are blocked, and of all its emitters.
kernel void gather_blocked(global const Surface* seen, global const Emitter* emitters,
                           const Gather gather, global const uint* blocked, global float4* b,
                           global float4* b_all, volatile global uint* counts) {
    const int2 size = b_size(gather);
    const int rays = b_rays_per_pixel(gather);
    const int place = (int)get_global_id(0);
    if (place >= size.x * gather.rows) return;
    const int x = place % size.x, y = gather.first_row + place / size.x;
    const Surface surface = seen[b_pixel(gather, x, y)];
    float3 sum = 0.0f, all_light = 0.0f;
    uint lit = 0, hidden = 0;
    for (int ray = 0; ray < rays; ++ray) {
        const Emitter emitter = emitters[b_emitter(gather, x, y, ray)];
        if (!b_is_lit(surface, emitter, gather)) continue;
        const float3 light = light_from(emitter, surface.position.xyz, surface.normal.xyz);
        ++lit;
        all_light += light;
        if (!blocked[ray * size.x * gather.rows + place]) continue;
        ++hidden;
        sum += light;
    }
    const float shares = (float)(gather.interleave * gather.interleave);
    b[y * size.x + x] = (float4)(sum * shares, 1.0f);
    b_all[y * size.x + x] = (float4)(all_light * shares, 1.0f);
    if (lit) atomic_add(&counts[0], lit);
    if (hidden) atomic_add(&counts[1], hidden);
}

// ---- the picture

// The part of the light that is blocked between the pixels of B: over a square that holds every
// emitter equally often, from surfaces like this one only. The part is 1 where all is blocked, and
// changes less than the light across curved surfaces.
static float3 blocked_part(global const Surface* seen, global const float4* b,
                           global const float4* b_all, const Gather gather, const Surface surface,
                           int x, int y) {
    const int2 size = b_size(gather);
    const float2 place = ((float2)(x, y) + 0.5f) / (float)gather.reduce - 0.5f;
    const int reach = gather.interleave;
    const int2 first = convert_int2(floor(place)) - reach + 1;
    float3 sum = 0.0f, all_light = 1e-20f;
    for (int j = 0; j < 2 * reach; ++j)
        for (int i = 0; i < 2 * reach; ++i) {
            const int2 at = first + (int2)(i, j);
            if (at.x < 0 || at.y < 0 || at.x >= size.x || at.y >= size.y) continue;
            const Surface other = seen[b_pixel(gather, at.x, at.y)];
            if (!(other.position.w > 0.0f)) continue;
            const float2 d = fabs(convert_float2(at) - place) / (float)reach;
            const float3 apart = other.position.xyz - surface.position.xyz;
            const float along = fmax(dot(other.normal.xyz, surface.normal.xyz), 0.0f);
            const float along_2 = along * along, along_4 = along_2 * along_2;
            const float off = dot(apart, surface.normal.xyz);
            const float square = dot(apart, apart) + 1e-8f;
            const float flat = square / (square + 200.0f * off * off);
            const float weight =
                fmax(1.0f - d.x, 0.0f) * fmax(1.0f - d.y, 0.0f) * along_4 * along_4 * flat * flat +
                1e-9f;
            sum += weight * b[at.y * size.x + at.x].xyz;
            all_light += weight * b_all[at.y * size.x + at.x].xyz;
        }
    return sum / all_light;
}

// The part of 3 x 3 texels of the shadow map around a point that the light reaches. The point is
// lifted by the size of these texels, and moved towards the light, so that a surface shades neither
// itself nor another one where they meet.
static float light_reaches(global const ulong* depths, int side, const LightSource light,
                           float3 point, float3 normal, float bias) {
    const float distance = light.is_spot ? dot(point - light.position.xyz, light.axis.xyz) : 1.0f;
    const float texel = light.side * distance / (float)side;
    point += normal * (bias + 2.5f * texel);
    const float2 image = light_image(light, point) * (float)side - 0.5f;
    const float depth = dot(point - light.position.xyz, light.axis.xyz) - bias - 2.0f * texel;
    const int2 first = convert_int2(floor(image + 0.5f)) - 1;
    int reached = 0;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            const int2 at = first + (int2)(i, j);
            if (at.x < 0 || at.y < 0 || at.x >= side || at.y >= side) continue;
            reached += depth <= as_float((uint)(depths[at.y * side + at.x] >> 32));
        }
    return (float)reached / 9.0f;
}

// One work-item a pixel: direct light with a shadow map, and indirect light A - B.
kernel void compose(global const Surface* seen, global const float4* a, global const float4* b,
                    global const float4* b_all, global const ulong* shadow_map, int shadow_side,
                    const LightSource light, const Gather gather, global float4* picture,
                    global float4* unblocked, global float4* blurred) {
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= gather.width || y >= gather.height) return;
    const int pixel = y * gather.width + x;
    const Surface surface = seen[pixel];
    float3 with = 0.0f, without = 0.0f, hidden = 0.0f;
    if (surface.position.w > 0.0f) {
        const float3 point = surface.position.xyz, normal = surface.normal.xyz;
        float3 towards;
        float3 direct = light_arriving(light, point, &towards);
        const float facing = dot(normal, towards);
        const float2 image = light_image(light, point);
        const int is_lit = facing > 0.0f && all(image > 0.0f) && all(image < 1.0f);
        direct *=
            is_lit ? facing * light_fade(light, image) *
                         light_reaches(shadow_map, shadow_side, light, point, normal, gather.bias)
                   : 0.0f;
        const float3 all_light = a[pixel].xyz;
        hidden = all_light * blocked_part(seen, b, b_all, gather, surface, x, y);
        const float3 reflected = surface.albedo.xyz / M_PI_F;
        with = reflected * (direct + fmax(all_light - hidden, 0.0f));
        without = reflected * (direct + all_light);
    }
    picture[pixel] = (float4)(with, 1.0f);
    unblocked[pixel] = (float4)(without, 1.0f);
    blurred[pixel] = (float4)(hidden, 1.0f);
}
