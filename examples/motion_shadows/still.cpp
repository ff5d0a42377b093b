// SPDX-License-Identifier: MIT
// A shadow map of the middle of the exposure.
#include "method.hpp"
#include "motion_kernels.hpp"

namespace motion {
namespace {

class Still : public ShadowMethod {
public:
    explicit Still(const Frame& f)
        : keys_(f.device, f.texels()),
          sweep_(f.device, kernels::sweep_still_cl),
          test_(f.device, kernels::test_still_cl) {}

    void mark_shadows(Frame& frame, const Sampling& batch, support::PassTimes* times) override {
        if (batch.first == 0) {
            keys_.fill(no_key);
            sweep_.run(frame.scene, frame.light, keys_, 0.5F, 0.0F, 0.0F);
            if (times != nullptr) times->end("shadow map");
        }
        test_.run(frame, batch, 0, frame.texels(), keys_);
        if (times != nullptr) times->end("test");
    }

    [[nodiscard]] ShadowMapSize size() const override {
        ShadowMapSize size;
        size.bytes = keys_.size() * sizeof(cl_ulong);
        return size;
    }

private:
    cellist::Buffer<cl_ulong> keys_;
    Sweep sweep_;
    ShadowTest test_;
};

}  // namespace

std::unique_ptr<ShadowMethod> make_still(const Frame& frame) {
    return std::make_unique<Still>(frame);
}

}  // namespace motion
