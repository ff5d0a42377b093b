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

// One work-item a query. It keeps the nearest records so far, in order.
kernel void cellist_find_nearest(CELLIST_LISTS(CELLIST_RECORD, lists),
                                 global const CELLIST_QUERY* queries, uint count, uint k,
                                 uint radius_cells, float radius, const cellist_values values,
                                 global uint* counts, global struct CELLIST_RECORD* records,
                                 global float* distances) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const CELLIST_QUERY query = queries[i];
    float nearest[CELLIST_K_MAX];
    uint nodes[CELLIST_K_MAX];
    uint found = 0;
    cellist_for_each_around(lists, cellist_query_place(&query, values), radius_cells, node) {
        const struct CELLIST_RECORD record = cellist_get(lists, node);
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
