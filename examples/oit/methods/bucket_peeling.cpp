// SPDX-License-Identifier: MIT
// Each pass takes a layer of each of several ranges of depth.
#include <array>
#include <bit>
#include <limits>

#include "methods/peeling_common.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

constexpr std::array bucket_peeling_sizes{2U, 4U, 8U, 16U, 32U};
constexpr std::uint32_t default_buckets = 8;

// Least and greatest depth, as bits.
struct Range {
    cl_uint least, greatest;
};

std::string bucket_peeling_refusal(const Frame& frame, const FrameFeatures& features) {
    if (frame.quality.layers) return "it takes layers out of order and cannot count them";
    return peeling_refusal(frame, features);
}

std::size_t buckets_of(const FragmentSource& source) {
    return source.frame().quality.size.value_or(default_buckets);
}

std::string bucket_peeling_source(const FragmentSource& source, const std::string& defines = {}) {
    return defines + define("OIT_BUCKETS", buckets_of(source)) +
           peeling_text(kernels::bucket_peeling_cl);
}

class BucketPeeling : public Method {
public:
    explicit BucketPeeling(FragmentSource& source)
        : source_(source),
          find_range_(source.pass(bucket_peeling_source(source, "#define OIT_FIND_RANGE\n"),
                                  "bucket_peeling.cl")),
          find_keys_(source.pass(bucket_peeling_source(source, "#define OIT_FIND_KEYS\n"),
                                 "bucket_peeling.cl")),
          take_(source.pass(bucket_peeling_source(source), "bucket_peeling.cl")),
          peel_(source.screen_kernel(bucket_peeling_source(source), "bucket_peeling.cl",
                                     "oit_peel_buckets")),
          finish_(source.screen_kernel(bucket_peeling_source(source), "bucket_peeling.cl",
                                       "oit_finish_peeling")),
          begin_(source.device(), source.frame().pixels()),
          range_(source.device(), source.frame().pixels()),
          keys_(source.device(), buckets_of(source) * source.frame().pixels()),
          counts_(source.device(), keys_.size()),
          nodes_(source.device(), source.layout().words * keys_.size()),
          state_(source.device(), source.state_floats() * source.frame().pixels()),
          left_(source.device(), 1) {}

    void store() override {
        const auto draw = [&](raster::Pass& pass) {
            source_.draw(pass, begin_, range_.cl(), keys_, counts_, nodes_);
        };
        begin_.fill(first_key);
        range_.fill({std::bit_cast<cl_uint>(std::numeric_limits<float>::max()), 0});
        keys_.fill(last_key);
        counts_.fill(0);
        draw(find_range_);
        for (cl_uint first = 1;; first = 0) {
            left_.fill(0);
            draw(find_keys_);
            draw(take_);
            source_.run_on_screen(peel_, begin_, range_.cl(), keys_, counts_, nodes_, state_, left_,
                                  first);
            if (left_.download().front() == 0) break;
        }
    }

    void resolve() override { source_.run_on_screen(finish_, state_); }

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return raster::bytes_of(begin_, range_, keys_, counts_, nodes_, state_);
    }

private:
    FragmentSource& source_;
    raster::Pass find_range_;
    raster::Pass find_keys_;
    raster::Pass take_;
    cellist::Kernel peel_;
    cellist::Kernel finish_;
    cellist::Buffer<cl_ulong> begin_;
    cellist::Buffer<Range> range_;
    cellist::Buffer<cl_ulong> keys_;
    cellist::Buffer<cl_uint> counts_;
    cellist::Buffer<cl_uint> nodes_;
    cellist::Buffer<cl_float> state_;
    cellist::Buffer<cl_uint> left_;
};

// The range of depth, then keys and layers at least once.
std::uint64_t bucket_peeling_passes(const SurveyResult&, const Quality&) { return 3; }

const MethodRegistration bucket_peeling_method(
    {.name = "bucket_peeling",
     .summary = "a layer of each depth range in a pass, 8 ranges by default (Liu et al. 2009)",
     .position = 60,
     .exact = true,
     .sizes = bucket_peeling_sizes,
     .refusal = bucket_peeling_refusal,
     .make = make_peeling<BucketPeeling>,
     .bound = bound_of_layers,
     .passes = bucket_peeling_passes});

}  // namespace
}  // namespace oit
