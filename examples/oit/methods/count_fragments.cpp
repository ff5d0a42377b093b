// SPDX-License-Identifier: MIT
#include "methods/count_fragments.hpp"

#include "oit_kernels.hpp"

namespace oit {

std::vector<cl_uint> count_fragments(FragmentSource& source) {
    cellist::Buffer<cl_uint> counts(source.device(), source.frame().pixels());
    raster::Pass pass = source.pass(kernels::count_fragments_cl, "count_fragments.cl");
    counts.fill(0);
    source.draw(pass, counts);
    return counts.download();
}

}  // namespace oit
