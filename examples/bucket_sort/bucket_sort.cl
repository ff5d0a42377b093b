// SPDX-License-Identifier: MIT
// Bucket sort: every record goes to the list of its bucket, every list is sorted, and the lists are
// packed behind one another.
//
// The buckets follow the data. A sample of the records is sorted and cut into parts of equal size;
// each part is divided evenly into BUCKETS_A_PART buckets. Where many keys are equal, the payloads
// tell the records apart, so that no distribution of keys makes a bucket long.
//
// keys      a number each, and its payload
// bounds    where the parts begin: one more than there are parts, ascending
// bucket    of each record
#include <cellist/lists.clh>

// Both in one number, in the same order. Payloads are below payload_limit; without gaps between
// them, equal keys are spread evenly.
static ulong joined(uint key, uint payload, ulong payload_limit) {
    return key * payload_limit + payload;
}

// The part of a number: the last that does not begin behind it. A binary search in which all
// work-items take the same steps, so that compilers can run several of them as one vector.
static uint part_of(ulong number, global const ulong* bounds, uint parts, uint parts_half) {
    uint part = 0;
    for (uint step = parts_half; step > 0; step /= 2) {
        const uint probe = min(part + step, parts - 1u);
        part = bounds[probe] <= number ? probe : part;
    }
    return part;
}

// The bucket of a number. Every operation keeps the order, rounding included: a larger number is
// never in an earlier bucket.
static uint bucket_of(ulong number, global const ulong* bounds, uint parts, uint parts_half) {
    const uint part = part_of(number, bounds, parts, parts_half);
    const ulong begin = bounds[part];
    const float share = (float)BUCKETS_A_PART / (float)(bounds[part + 1] - begin);
    const uint within = number > begin ? convert_uint_sat((float)(number - begin) * share) : 0;
    return part * BUCKETS_A_PART + min(within, BUCKETS_A_PART - 1u);
}

// One work-item a sampled number: the records are cut into `size` pieces, and each gives one.
kernel void take_sample(global const uint* keys, global const uint* payloads, ulong payload_limit,
                        uint count, uint size, global ulong* sample) {
    const uint i = get_global_id(0);
    const uint begin = (uint)((ulong)i * count / size);
    const uint end = (uint)((i + 1ul) * count / size);
    const uint random = (i ^ (i >> 15)) * 0x2C1B3C6Du;
    const uint at = begin + (random ^ (random >> 12)) % (end - begin);
    sample[i] = joined(keys[at], payloads[at], payload_limit);
}

// One work-item a record. parts_half: the largest power of two below the number of parts, or 0.
kernel void find_buckets(global const uint* keys, global const uint* payloads, uint count,
                         ulong payload_limit, global const ulong* bounds, uint parts,
                         uint parts_half, global uint* bucket) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    bucket[i] = bucket_of(joined(keys[i], payloads[i], payload_limit), bounds, parts, parts_half);
}

// One work-item a record. Its bucket is known, as this may run more than once.
kernel void insert_records(CELLIST_LISTS(Record, buckets), global const uint* keys,
                           global const uint* payloads, global const uint* bucket, uint count) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const Record record = {keys[i], payloads[i]};
    cellist_insert(buckets, bucket[i], record);
}
