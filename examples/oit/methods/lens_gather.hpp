// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "methods/lens_ranges.hpp"
#include "oit_kernels.hpp"

namespace oit {

/// Draws the picture through a lens from the fragments of each pixel: see lens.cl. The frame is one
/// of a LensFrame.
class LensGather {
public:
    /// `defines` is the text that defines OIT_NODES and so on; `uses` are the types and containers
    /// of OIT_NODES. Refers to the source, which must outlive it.
    template <class... Uses>
    LensGather(FragmentSource& source, const std::string& defines, const Uses&... uses)
        : LensGather(source, kernel(source, defines, "oit_find_planes", uses...),
                     kernel(source, defines, "oit_gather", uses...)) {}

    /// Enqueues everything; `nodes` are the arguments for OIT_NODES. Does not block.
    template <class... Nodes>
    void run(const Nodes&... nodes) {
        used_.fill(0);
        ranges_.clear();
        source_.run_on_screen(find_, nodes..., spans_, planes_,
                              static_cast<cl_uint>(planes_.size()), used_, ranges_.ranges());
        used_read_ = used_.download_async();
        ranges_.spread();
        const Frame& frame = source_.frame();
        source_.run_on_screen(gather_, nodes..., spans_, planes_, ranges_.ranges(), ranges_.scale(),
                              ranges_.focus(), frame.quality.lens_rays, cl_int{frame.margin});
    }

    /// Waits for the number of planes. False if they did not fit: the buffer has grown, and the
    /// frame must be drawn again.
    [[nodiscard]] bool finish_or_grow();

    [[nodiscard]] std::uint64_t device_bytes() const;

private:
    LensGather(FragmentSource& source, cellist::Kernel find, cellist::Kernel gather);
    template <class... Uses>
    [[nodiscard]] static cellist::Kernel kernel(const FragmentSource& source,
                                                const std::string& defines, const std::string& name,
                                                const Uses&... uses) {
        return source.screen_kernel(lens_text(defines, kernels::lens_cl), "lens.cl", name, uses...);
    }

    FragmentSource& source_;
    LensRanges ranges_;
    cellist::Kernel find_;
    cellist::Kernel gather_;
    cellist::Buffer<cl_uint4> spans_;
    cellist::Buffer<cl_float4> planes_;
    cellist::Buffer<cl_uint> used_;
    cellist::Pending<std::vector<cl_uint>> used_read_;
};

}  // namespace oit
