// SPDX-License-Identifier: MIT
// Ranges of time in which triangles cover the centres of texels, and depth from the moving plane.
#include "method.hpp"
#include "motion_kernels.hpp"

namespace motion {
namespace {

class Exact : public ShadowMethod {
public:
    explicit Exact(const Frame& f)
        : ranges_(f.device, {f.texels()},
                  {.storage = f.storage(), .budget_bytes = f.settings.budget_bytes}),
          pieces_(f.device, {f.texels()}, {.storage = f.storage()}),
          sweep_(f.device, kernels::sweep_exact_cl, ranges_),
          test_ranges_(f.device, kernels::test_exact_cl, ranges_),
          compress_(
              moving_kernel(f.device, kernels::compress_cl, "compress_ranges", pieces_, ranges_)),
          test_pieces_(f.device, kernels::test_pieces_cl, pieces_) {}

    void mark_shadows(Frame& frame, const Sampling& batch, support::PassTimes* times) override {
        if (frame.settings.budget_bytes != no_budget) {
            size_.slices = 0;
            size_.pieces = 0;
            report_ = ranges_.build_slices(
                [&] { sweep_.run(frame.scene, frame.light, ranges_, frame.farthest); },
                [&](const cellist::Slice& slice) {
                    ++size_.slices;
                    sort_and_compress(frame, slice.first_cell, slice.cells, nullptr);
                    test(frame, batch, slice.first_cell, slice.cells);
                });
            if (times != nullptr) times->end("slices");
            return;
        }
        if (batch.first == 0) {
            size_.pieces = 0;
            report_ = ranges_.build(
                [&] { sweep_.run(frame.scene, frame.light, ranges_, frame.farthest); });
            if (times != nullptr) times->end("ranges");
            sort_and_compress(frame, 0, frame.texels(), times);
        }
        test(frame, batch, 0, frame.texels());
        if (times != nullptr) times->end("test");
    }

    [[nodiscard]] ShadowMapSize size() const override {
        ShadowMapSize size = size_;
        size.ranges = report_.stored;
        size.refused = report_.rejected;
        size.bytes = ranges_.pool_bytes() + pieces_.pool_bytes();
        return size;
    }

private:
    void sort_and_compress(Frame& frame, std::size_t first, std::size_t texels,
                           support::PassTimes* times) {
        if (!frame.settings.compress) return;
        // On a processor, a work-item sorts each of these lists faster.
        if (frame.device.info().one_thread_per_work_group)
            ranges_.sort_async(&VisibleRange::begin);
        else
            ranges_.sort(&VisibleRange::begin);
        if (times != nullptr) times->end("sort");
        size_.pieces +=
            pieces_
                .build([&] {
                    compress_.run(cellist::Range::padded(texels, 64), pieces_, ranges_,
                                  frame.light.view, frame.light.vertices, frame.scene.indices,
                                  static_cast<cl_uint>(first), static_cast<cl_uint>(texels),
                                  frame.settings.tolerance);
                })
                .stored;
        if (times != nullptr) times->end("compress");
    }

    void test(const Frame& frame, const Sampling& batch, std::size_t first, std::size_t texels) {
        if (frame.settings.compress)
            test_pieces_.run(frame, batch, first, texels, pieces_);
        else
            test_ranges_.run(frame, batch, first, texels, ranges_);
    }

    cellist::Lists<VisibleRange> ranges_;
    cellist::Lists<DepthPiece> pieces_;
    Sweep sweep_;
    ShadowTest test_ranges_;
    cellist::Kernel compress_;
    ShadowTest test_pieces_;
    cellist::BuildReport report_;
    ShadowMapSize size_;
};

}  // namespace

std::unique_ptr<ShadowMethod> make_exact(const Frame& frame) {
    return std::make_unique<Exact>(frame);
}

}  // namespace motion
