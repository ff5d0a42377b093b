#include "list_slices.hpp"

#include <algorithm>
#include <vector>

#include "input_error.hpp"
#include "oit_kernels.hpp"

namespace oit {

cellist::ListsOptions sliced(cellist::ListsOptions options, const std::optional<Slices>& slices) {
    if (!slices) return options;
    // Empty lists can be made under any budget; that it is too small is said when lists are built.
    options.budget_bytes =
        std::max(slices->budget_bytes, slices->head_bytes + slices->count_bytes) -
        slices->count_bytes;
    return options;
}

void refuse_budget(FragmentSource& source, const Slices& slices) {
    cellist::Buffer<cl_uint> counts(source.device(), source.frame().pixels());
    raster::Pass pass = source.pass(kernels::count_cl, "count.cl");
    counts.fill(0);
    source.draw(pass, counts);
    const std::vector<cl_uint> lengths = counts.download();
    const std::uint64_t longest = *std::max_element(lengths.begin(), lengths.end());
    const std::uint64_t least =
        slices.head_bytes + slices.count_bytes + longest * slices.node_bytes;
    throw support::InputError("a budget of " + std::to_string(slices.budget_bytes) +
                              " bytes is too small for this frame: the least that works is " +
                              std::to_string(least) + " bytes, for " +
                              std::to_string(source.frame().pixels()) + " pixels and a list of " +
                              std::to_string(longest) + " fragments");
}

}  // namespace oit
