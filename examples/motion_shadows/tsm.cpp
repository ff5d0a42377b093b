// SPDX-License-Identifier: MIT
// Time-dependent shadow maps: a depth for each sample of a texel, at the sample's own time.
#include <algorithm>

#include "method.hpp"
#include "motion_kernels.hpp"

namespace motion {
namespace {

constexpr cl_uint no_depth = 0x7F800000;  // infinity

class Tsm : public ShadowMethod {
public:
    explicit Tsm(const Frame& f)
        : depths_(f.device,
                  f.texels() * std::clamp<std::size_t>(f.settings.samples, 1, batch_samples)),
          sweep_(f.device, kernels::sweep_samples_cl),
          test_(f.device, kernels::test_samples_cl) {}

    void mark_shadows(Frame& frame, const Sampling& batch, support::PassTimes* times) override {
        depths_.fill(no_depth);
        sweep_.run(frame.scene, frame.light, depths_, frame.farthest, batch);
        if (times != nullptr) times->end("shadow map");
        test_.run(frame, batch, 0, frame.texels(), depths_);
        if (times != nullptr) times->end("test");
    }

    [[nodiscard]] ShadowMapSize size() const override {
        ShadowMapSize size;
        size.bytes = depths_.size() * sizeof(cl_uint);
        return size;
    }

private:
    cellist::Buffer<cl_uint> depths_;
    Sweep sweep_;
    ShadowTest test_;
};

}  // namespace

std::unique_ptr<ShadowMethod> make_tsm(const Frame& frame) { return std::make_unique<Tsm>(frame); }

}  // namespace motion
