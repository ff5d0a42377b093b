// SPDX-License-Identifier: MIT
// Depth-time ranges as in the paper: Hong and Oh, "Motion-Blurred Shadows Utilizing a Depth-Time
// Ranges Shadow Map", Journal of Information Processing Systems 14(4), 2018.
#include "method.hpp"
#include "motion_kernels.hpp"

namespace motion {
namespace {

class Ranges : public ShadowMethod {
public:
    explicit Ranges(const Frame& f)
        : fragments_(f.device, {f.texels()}, {.storage = f.storage()}),
          ranges_(f.device, {f.texels()}, {.storage = f.storage()}),
          sweep_(f.device, kernels::sweep_prism_cl, fragments_),
          pair_(moving_kernel(f.device, kernels::pair_ranges_cl, "pair_fragments", ranges_,
                              fragments_)),
          test_(f.device, kernels::test_ranges_cl, ranges_) {}

    void mark_shadows(Frame& frame, const Sampling& batch, support::PassTimes* times) override {
        const auto end = [&](const char* pass) {
            if (times != nullptr) times->end(pass);
        };
        if (batch.first == 0) {
            const cellist::BuildReport fragments = fragments_.build(
                [&] { sweep_.run(frame.scene, frame.light, fragments_, frame.farthest); });
            end("fragments");
            const cellist::BuildReport ranges = pair(frame);
            end("ranges");
            size_.fragments = fragments.stored;
            size_.refused = fragments.rejected;
            size_.ranges = ranges.stored;
            size_.unpaired = ranges.rejected;
        }
        test_.run(frame, batch, 0, frame.texels(), ranges_);
        end("test");
    }

    [[nodiscard]] ShadowMapSize size() const override {
        ShadowMapSize size = size_;
        size.bytes = fragments_.pool_bytes() + ranges_.pool_bytes();
        return size;
    }

private:
    cellist::BuildReport pair(const Frame& frame) {
        // On a processor, a work-item sorts each of these lists faster.
        if (frame.device.info().one_thread_per_work_group)
            fragments_.sort_async(&PrismFragment::triangle);
        else
            fragments_.sort(&PrismFragment::triangle);
        return ranges_.build(pair_, cellist::Range::padded(frame.texels(), 64), fragments_,
                             static_cast<cl_uint>(frame.texels()));
    }

    cellist::Lists<PrismFragment> fragments_;
    cellist::Lists<DepthTimeRange> ranges_;
    Sweep sweep_;
    cellist::Kernel pair_;
    ShadowTest test_;
    ShadowMapSize size_;
};

}  // namespace

std::unique_ptr<ShadowMethod> make_ranges(const Frame& frame) {
    return std::make_unique<Ranges>(frame);
}

}  // namespace motion
