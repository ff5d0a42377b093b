// SPDX-License-Identifier: MIT
#include "methods/lens_gather.hpp"

#include <utility>

namespace oit {

LensGather::LensGather(FragmentSource& source, cellist::Kernel find, cellist::Kernel gather)
    : source_(source),
      ranges_(source),
      find_(std::move(find)),
      gather_(std::move(gather)),
      spans_(source.device(), source.frame().pixels()),
      planes_(source.device(), 1),
      used_(source.device(), 1) {}

bool LensGather::finish_or_grow() {
    const std::uint64_t used = used_read_.get().front();
    if (used <= planes_.size()) return true;
    planes_ = cellist::Buffer<cl_float4>(source_.device(), 1);  // gives the memory back first
    planes_ = cellist::Buffer<cl_float4>(source_.device(), used + used / 4);
    return false;
}

std::uint64_t LensGather::device_bytes() const {
    return ranges_.device_bytes() + raster::bytes_of(spans_, planes_, used_);
}

}  // namespace oit
