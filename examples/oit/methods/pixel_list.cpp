// SPDX-License-Identifier: MIT
#include "methods/pixel_list.hpp"

#include "oit_kernels.hpp"

namespace oit {

std::vector<PixelFragment> pixel_list(FragmentSource& source, std::size_t pixel) {
    cellist::Lists<PixelFragment> fragments(source.device(), {1});
    raster::Pass pass = source.pass(kernels::pixel_list_cl, "pixel_list.cl", fragments);
    fragments.build([&] { source.draw(pass, fragments, static_cast<cl_uint>(pixel)); });
    fragments.sort(&PixelFragment::depth);
    const cellist::HostLists<PixelFragment> list = fragments.download();
    return {list.records().begin(), list.records().end()};
}

}  // namespace oit
