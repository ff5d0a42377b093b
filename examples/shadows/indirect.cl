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

// One work-item a sample: the texel in the middle of its part of the map. It stands for all that the
// part receives.
kernel void make_emitters(global const Surface* lit, const LightSource light, const Gather gather,
                          global Emitter* emitters) {
    const int sample = (int)get_global_id(0);
    const int side = gather.rsm_side, part = side / gather.samples;
    if (sample >= gather.samples * gather.samples) return;
    const int x = sample % gather.samples * part + part / 2;
    const int y = sample / gather.samples * part + part / 2;
    const Surface surface = lit[y * side + x];
    Emitter emitter;
    emitter.position = surface.position;
    emitter.normal = surface.normal;
    emitter.power = (float4)(0.0f);
    if (surface.position.w > 0.0f) {
        const float2 image = ((float2)(x, y) + 0.5f) / (float)side;
        const float2 across = (image - 0.5f) * light.side;
        // The solid angle of the texel, or its area across the light.
        const float texel = light.side / (float)side;
        const float slope = light.is_spot ? rsqrt(1.0f + dot(across, across)) : 1.0f;
        const float received = texel * texel * slope * slope * slope * light_fade(light, image);
        const float texels = (float)(part * part);
        emitter.power = surface.albedo * light.intensity * (received * texels);
        emitter.power.w = texel * texel * texels *
                          light_spread(light, surface.position.xyz, slope, surface.normal.xyz) /
                          M_PI_F;
    }
    emitters[sample] = emitter;
}

// ---- buffer A: all indirect light

// One work-item a pixel: the irradiance from all samples, blocked or not.
kernel void gather_unblocked(global const Surface* seen, global const Emitter* emitters,
                             const Gather gather, global float4* a) {
    const int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= gather.width || y >= gather.height) return;
    const int pixel = y * gather.width + x;
    const Surface surface = seen[pixel];
    float3 sum = 0.0f;
    if (surface.position.w > 0.0f)
        for (int sample = 0; sample < gather.samples * gather.samples; ++sample)
            sum += light_from(emitters[sample], surface.position.xyz, surface.normal.xyz);
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

// The sample of ray number `ray` of a pixel of B. Neighbours in a square of interleave * interleave
// take different samples, and all of them together take each sample once (Keller, Heidrich:
// "Interleaved Sampling", EGWR 2001).
static int b_sample(const Gather gather, int x, int y, int ray) {
    const int rays = gather.samples / gather.interleave;  // along each axis
    const int u = (ray % rays) * gather.interleave + (x + ray / rays) % gather.interleave;
    const int v = (ray / rays) * gather.interleave + (y + ray % rays) % gather.interleave;
    return v * gather.samples + u;
}

// Whether a sample lights a pixel of B at all.
static int b_is_lit(const Surface surface, const Emitter emitter, const Gather gather) {
    const float3 light = light_from(emitter, surface.position.xyz, surface.normal.xyz);
    return surface.position.w > 0.0f && light.x + light.y + light.z > 0.0f;
}

// One work-item a ray: from a pixel of B to a sample. Rays without light have length 0. Rays of a
// batch begin at row first_row of B.
kernel void make_rays(global const Surface* seen, global const Emitter* emitters,
                      const Gather gather, global GridSegment* rays) {
    const int2 size = b_size(gather);
    const int per_pixel =
        (gather.samples / gather.interleave) * (gather.samples / gather.interleave);
    const int i = (int)get_global_id(0);
    if (i >= size.x * gather.rows * per_pixel) return;
    // Rays of neighbouring pixels to the same sample follow one another.
    const int place = i % (size.x * gather.rows), ray = i / (size.x * gather.rows);
    const int x = place % size.x, y = gather.first_row + place / size.x;
    const Surface surface = seen[b_pixel(gather, x, y)];
    const Emitter emitter = emitters[b_sample(gather, x, y, ray)];
    GridSegment segment;
    segment.from = surface.position + gather.bias * surface.normal;
    segment.to = b_is_lit(surface, emitter, gather)
                     ? emitter.position + gather.bias * emitter.normal
                     : segment.from;
    rays[i] = segment;
}

// One work-item a pixel of B: the light of its samples that are blocked, and of all its samples.
kernel void gather_blocked(global const Surface* seen, global const Emitter* emitters,
                           const Gather gather, global const uint* blocked, global float4* b,
                           global float4* b_all, volatile global uint* counts) {
    const int2 size = b_size(gather);
    const int rays = (gather.samples / gather.interleave) * (gather.samples / gather.interleave);
    const int place = (int)get_global_id(0);
    if (place >= size.x * gather.rows) return;
    const int x = place % size.x, y = gather.first_row + place / size.x;
    const Surface surface = seen[b_pixel(gather, x, y)];
    float3 sum = 0.0f, all_light = 0.0f;
    uint lit = 0, hidden = 0;
    for (int ray = 0; ray < rays; ++ray) {
        const Emitter emitter = emitters[b_sample(gather, x, y, ray)];
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
// sample equally often, from surfaces like this one only. The part is 1 where all is blocked, and
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
