// SPDX-License-Identifier: MIT
// The k records nearest to each query, nearest first.
//
//   lists       in any storage
//   queries     count
//   counts      count       out: records that were found, at most k
//   records     count * k   out
//   distances   count * k   out
//
// The order is that of the distances, then that of the records' members. The host defines
// CELLIST_RECORD, cellist_values, CELLIST_QUERY (the type of a query), CELLIST_K_MAX (at least k),
// cellist_distance(record, query, values), cellist_query_position(query, values), and
// CELLIST_DIMENSIONS, of the shape.
//
// On GPUs it also defines CELLIST_TEAM, the work-items that share a query; elsewhere each query has
// a work-item. Barriers stand in uniform control flow.
#include <cellist/lists.clh>

// The position of a query, without components that the shape does not have.
static inline int4 cellist_query_place(const CELLIST_QUERY* query, const cellist_values values) {
    int4 position = cellist_query_position(query, values);
    if (CELLIST_DIMENSIONS < 4) position.w = 0;
    if (CELLIST_DIMENSIONS < 3) position.z = 0;
    if (CELLIST_DIMENSIONS < 2) position.y = 0;
    return position;
}

// Whether the record of node a comes before that of node b.
static inline int cellist_is_nearer(CELLIST_LISTS(CELLIST_RECORD, lists), float distance_a, uint a,
                                    float distance_b, uint b) {
    if (distance_a != distance_b) return distance_a < distance_b;
    return cellist_record_before(&cellist_get(lists, a), &cellist_get(lists, b), 0);
}

#ifdef CELLIST_TEAM

// Records that a work-group collects, at least CELLIST_K_MAX + CELLIST_TEAM.
#define CELLIST_COLLECTED 256u

// The node some steps after `node`, or the end of the list.
static inline uint cellist_skip(global const CELLIST_NODE* nodes, const CELLIST_VIEW view,
                                uint node, uint end, uint steps) {
    if (!cellist_has_mode(view.cellist_untyped, CELLIST_LINKED))
        return node + min(steps, end - node);
    for (uint i = 0; i < steps && node < end; ++i) node = cellist_next(nodes, view, node);
    return node;
}

// Keeps the first k of the records that were collected, in order, and returns how many there are.
// All work-items of the group call it.
static uint cellist_keep_nearest(CELLIST_LISTS(CELLIST_RECORD, lists), uint k, uint collected,
                                 local float* distances, local uint* nodes,
                                 local float* kept_distances, local uint* kept_nodes) {
    const uint item = get_local_id(0);
    for (uint a = item; a < collected; a += CELLIST_TEAM) {
        uint rank = 0;
        for (uint b = 0; b < collected; ++b) {
            if (distances[b] != distances[a])
                rank += distances[b] < distances[a];
            else if (b != a)
                // Equal records stay in the order in which they were collected.
                rank +=
                    cellist_is_nearer(CELLIST_PASS(lists), 0, nodes[b], 0, nodes[a]) ||
                    (b < a && !cellist_is_nearer(CELLIST_PASS(lists), 0, nodes[a], 0, nodes[b]));
        }
        if (rank < k) {
            kept_distances[rank] = distances[a];
            kept_nodes[rank] = nodes[a];
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint kept = min(collected, k);
    for (uint n = item; n < kept; n += CELLIST_TEAM) {
        distances[n] = kept_distances[n];
        nodes[n] = kept_nodes[n];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return kept;
}

// One work-group per query. Its work-items look at neighbouring nodes, and collect the records that
// may be among the nearest. When there is no room for another round, they keep the first k; then
// only records that are no further away are collected.
kernel __attribute__((reqd_work_group_size(CELLIST_TEAM, 1, 1))) void cellist_find_nearest(
    CELLIST_LISTS(CELLIST_RECORD, lists), global const CELLIST_QUERY* queries, uint count, uint k,
    uint radius_cells, float radius, const cellist_values values, global uint* counts,
    global CELLIST_RECORD_TYPE* records, global float* distances) {
    local float nearest[CELLIST_COLLECTED];
    local uint nodes[CELLIST_COLLECTED];
    local float kept_nearest[CELLIST_K_MAX];
    local uint kept_nodes[CELLIST_K_MAX];
    local uint collected;
    const cellist_view lists_view = cellist_view_of(lists);
    const uint item = get_local_id(0);
    const uint i = get_group_id(0);
    const CELLIST_QUERY query = queries[i];
    if (item == 0) collected = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    cellist_around around =
        cellist_begin_around(lists_view, cellist_query_place(&query, values), radius_cells);
    while (k > 0 && cellist_next_span(lists_heads, lists_view, &around)) {
        for (uint first = around.begin; first < around.end;
             first = cellist_skip(lists_nodes, lists_typed, first, around.end, CELLIST_TEAM)) {
            const uint node = cellist_skip(lists_nodes, lists_typed, first, around.end, item);
            if (node < around.end) {
                const CELLIST_RECORD_TYPE record = cellist_get(lists, node);
                const float distance = cellist_distance(&record, &query, values);
                if (distance <= radius) {
                    const uint at = atomic_inc(&collected);
                    nearest[at] = distance;
                    nodes[at] = node;
                }
            }
            barrier(CLK_LOCAL_MEM_FENCE);
            const uint in_use = collected;
            barrier(CLK_LOCAL_MEM_FENCE);
            if (in_use > CELLIST_COLLECTED - CELLIST_TEAM) {
                const uint kept = cellist_keep_nearest(CELLIST_PASS(lists), k, in_use, nearest,
                                                       nodes, kept_nearest, kept_nodes);
                radius = nearest[kept - 1];
                if (item == 0) collected = kept;
                barrier(CLK_LOCAL_MEM_FENCE);
            }
        }
        cellist_end_span(&around);
    }
    const uint found = cellist_keep_nearest(CELLIST_PASS(lists), k, collected, nearest, nodes,
                                            kept_nearest, kept_nodes);
    if (item == 0) counts[i] = found;
    for (uint n = item; n < found; n += CELLIST_TEAM) {
        records[(ulong)i * k + n] = cellist_get(lists, nodes[n]);
        distances[(ulong)i * k + n] = nearest[n];
    }
}

#else

// One work-item per query. It keeps the nearest records so far, in order.
kernel void cellist_find_nearest(CELLIST_LISTS(CELLIST_RECORD, lists),
                                 global const CELLIST_QUERY* queries, uint count, uint k,
                                 uint radius_cells, float radius, const cellist_values values,
                                 global uint* counts, global CELLIST_RECORD_TYPE* records,
                                 global float* distances) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const CELLIST_QUERY query = queries[i];
    float nearest[CELLIST_K_MAX];
    uint nodes[CELLIST_K_MAX];
    uint found = 0;
    cellist_for_each_around(lists, cellist_query_place(&query, values), radius_cells, node) {
        const CELLIST_RECORD_TYPE record = cellist_get(lists, node);
        const float distance = cellist_distance(&record, &query, values);
        if (!(distance <= radius)) continue;
        if (found == k && (k == 0 || !cellist_is_nearer(CELLIST_PASS(lists), distance, node,
                                                        nearest[k - 1], nodes[k - 1])))
            continue;
        uint at = found < k ? found++ : k - 1;
        for (; at > 0 && cellist_is_nearer(CELLIST_PASS(lists), distance, node, nearest[at - 1],
                                           nodes[at - 1]);
             --at) {
            nearest[at] = nearest[at - 1];
            nodes[at] = nodes[at - 1];
        }
        nearest[at] = distance;
        nodes[at] = node;
    }
    counts[i] = found;
    for (uint n = 0; n < found; ++n) {
        records[(ulong)i * k + n] = cellist_get(lists, nodes[n]);
        distances[(ulong)i * k + n] = nearest[n];
    }
}

#endif
