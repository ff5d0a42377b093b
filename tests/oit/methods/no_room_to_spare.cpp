// SPDX-License-Identifier: MIT
// Lists that fit, but not with room to spare, are drawn in every frame as in the first.
#include <cstring>

#include "camera.hpp"
#include "methods/lists.hpp"
#include "oit/support/procedural.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

std::vector<cl_float4> draw(oit::FragmentSource& source, oit::Method& method) {
    source.projection().transform();
    bool complete = false;
    while (!complete) {
        source.prepare();
        method.store();
        method.resolve();
        complete = source.finish_or_grow();
        complete = method.finish_or_grow() && complete;
    }
    source.average_samples();
    return source.image().download();
}

// What lists take that hold these and no more.
std::uint64_t bytes_of(const oit::FragmentSource& source, const Lengths& lengths, Storage storage) {
    ListsOptions options{.storage = storage};
    if (storage == Storage::fixed)
        options.slots = static_cast<std::uint32_t>(lengths.longest);
    else
        options.capacity_nodes = lengths.total;
    return oit::with_node_type(source.layout().words, [&]<class Node>(const Node*) {
        return Lists<Node>(source.device(), source.shape(), options).pool_bytes();
    });
}

// What a sort keeps even where the budget has no room for more.
std::uint64_t bytes_of_sort(oit::FragmentSource& source) {
    return oit::with_node_type(source.layout().words, [&]<class Node>(const Node*) {
        Lists<Node> lists(source.device(), source.shape(), {.capacity_nodes = 0});
        const std::uint64_t before = lists.pool_bytes();
        lists.sort(&Node::key);
        return lists.pool_bytes() - before;
    });
}

TEST_CASE("frames after the first need no more memory than the first") {
    const oit::Scene scene = oit::scene_of(torus_knot(2, 3, 200, 12), 0.3F);
    const oit::Frame frame{.scene = scene, .views = {support::frame_unit_sphere({30, 10}, 60, 45)}};
    for (const Storage storage : cellist::all_storages) {
        INFO("storage " << static_cast<int>(storage));
        oit::FragmentSource source(device(), frame);
        // Small, so that growing to what the frame needs is more than the lists begin with.
        ListsOptions options{.storage = storage, .capacity_nodes = 10, .slots = 1};
        const auto ample = make_list_method(source, options);
        const std::vector<cl_float4> expected = draw(source, *ample);
        options.budget_bytes = bytes_of(source, *ample->lengths(), storage);
        const auto tight = make_list_method(source, options);
        for (int i = 0; i < 4; ++i) {
            const std::vector<cl_float4> image = draw(source, *tight);
            CHECK(tight->device_bytes() <= options.budget_bytes + bytes_of_sort(source));
            CHECK(std::memcmp(image.data(), expected.data(), image.size() * sizeof(cl_float4)) ==
                  0);
        }
    }
}

}  // namespace
}  // namespace cellist::test
