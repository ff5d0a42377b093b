// SPDX-License-Identifier: MIT
// Sets heads and clears counters before a pass, in one launch: a launch takes longer than clearing
// a small container does.
//
//   heads     first + words   set to `value` from word `first` on
//   counters  counter_words   set to 0
//
// One work-item per word; the range is padded to whole work-groups.
kernel void cellist_clear(global uint* heads, ulong first, ulong words, uint value,
                          global uint* counters, uint counter_words) {
    const ulong i = get_global_id(0);
    if (i < words) heads[first + i] = value;
    if (i < counter_words) counters[i] = 0;
}
