// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

#include "check.hpp"

namespace scene {

struct Light {
    cl_float4 colour;
    cl_float radius;
};
CELLIST_STRUCT(Light, colour, radius);

struct Entry {
    cl_float distance;
    cl_ushort tags[2];
    Light light;
};
CELLIST_STRUCT(Entry, distance, tags, light);

struct Settings {
    cl_uint copies;
    cl_float spacing;
};
CELLIST_STRUCT(Settings, copies, spacing);

}  // namespace scene

constexpr auto source = R"(
#include <cellist/lists.clh>

// Any number of inserts per work-item, anywhere in the control flow.
kernel void scatter(CELLIST_LISTS(Entry, entries), const Settings settings)
{
    uint i = get_global_id(0);
    for (uint copy = 0; copy < i % (settings.copies + 1); ++copy) {
        if ((i + copy) % 3 == 0) continue;
        Entry entry = { .distance = settings.spacing * copy, .tags = { i, copy } };
        entry.light.radius = i;
        cellist_insert(entries, cellist_cell2(entries, i % 20, copy), entry);
    }
}

// A function declares a container with CELLIST_LISTS; its caller passes it with CELLIST_PASS.
float reach(CELLIST_LISTS(Entry, entries), uint cell)
{
    float reach = 0;
    cellist_for_each(entries, cell, node) {
        if (cellist_get(entries, node).distance > 10.0f) continue;
        reach = fmax(reach, cellist_get(entries, node).light.radius);
    }
    return reach;
}

kernel void summarise(CELLIST_LISTS(Entry, entries), global float* reaches,
                      global float* nearest_sums)
{
    int x = get_global_id(0), y = get_global_id(1);
    uint cell = cellist_cell2(entries, x, y);
    reaches[cell] = reach(CELLIST_PASS(entries), cell);

    Entry nearest[4];
    uint count = cellist_nearest(entries, cell, distance, 4, nearest);
    nearest_sums[cell] = 0;
    for (uint i = 0; i < count; ++i) nearest_sums[cell] += nearest[i].distance;
}
)";

int main() {
    cellist::Device device = cellist::Device::choose();
    cellist::Lists<scene::Entry> entries(device, {20, 8});

    cellist::Kernel scatter(device, {.text = source, .file_name = "scatter.cl"}, "scatter", entries,
                            cellist::type<scene::Settings>);
    entries.build(scatter, 5000, scene::Settings{.copies = 7, .spacing = 0.5f});

    cellist::Kernel summarise(device, source, "summarise", entries, cellist::type<scene::Settings>);
    cellist::Buffer<cl_float> reaches(device, 160), nearest_sums(device, 160);
    cl::Event done = summarise.run({20, 8}, entries, reaches, nearest_sums);
    done.wait();

    std::vector<float> reach(160, 0), nearest_sum(160, 0);
    std::vector<int> counts(160, 0);
    for (unsigned i = 0; i < 5000; ++i)
        for (unsigned copy = 0; copy < i % 8; ++copy) {
            if ((i + copy) % 3 == 0) continue;
            const unsigned cell = i % 20 + 20 * copy;
            reach[cell] = std::max(reach[cell], float(i));
            if (counts[cell]++ < 4) nearest_sum[cell] += 0.5f * float(copy);
        }
    check(reaches.download() == reach, "the reaches");
    check(nearest_sums.download() == nearest_sum, "the sums of the nearest");

    std::cout << "device API: ok\n";
}
