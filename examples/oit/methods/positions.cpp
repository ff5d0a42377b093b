// SPDX-License-Identifier: MIT
// Depth of field by brute force: the mean of pinhole pictures from places on the lens (Haeberli,
// Akeley, SIGGRAPH 1990).
#include <array>

#include "methods/view_mean.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

constexpr std::array position_counts{8U, 16U, 32U, 64U, 128U, 256U};
constexpr std::uint32_t default_count = 32;

class Positions : public Method {
public:
    explicit Positions(FragmentSource& source)
        : source_(source),
          count_(source.frame().quality.size.value_or(default_count)),
          mean_(source.device(), source.frame()),
          copy_(
              source.device(),
              cellist::Source{.text = std::string(kernels::cut_out_cl), .file_name = "cut_out.cl"},
              "oit_cut_out") {}

    void store() override {
        mean_.draw(source_.frame().time, count_, views_through_lens(source_.frame(), count_));
    }
    void resolve() override {
        const Frame& frame = source_.frame();
        copy_.run(cellist::Range(frame.width(), frame.height(), frame.views.size()), mean_.image(),
                  source_.image(), cl_int{0});
    }
    [[nodiscard]] std::uint64_t device_bytes() const override { return mean_.device_bytes(); }

private:
    FragmentSource& source_;
    std::uint32_t count_;
    ViewMean mean_;
    cellist::Kernel copy_;
};

std::string positions_refusal(const Frame& frame, const FrameFeatures& features) {
    if (frame.lens && frame.quality.layers)
        return "its pictures show all layers: leave out --layers";
    return refuses_pinholes(frame, features);
}

const MethodRegistration positions_method(
    {.name = "positions",
     .summary = "the mean of pictures from places on the lens, 32 by default (Haeberli, Akeley "
                "1990)",
     .position = 190,
     .exact = false,
     .has_nodes = false,
     .draws_views = true,
     .sizes = position_counts,
     .refusal = positions_refusal,
     .make = [](FragmentSource& source) -> std::unique_ptr<Method> {
         return std::make_unique<Positions>(source);
     },
     .passes = [](const SurveyResult&, const Quality& quality) -> std::uint64_t {
         return quality.size.value_or(default_count);
     }});

}  // namespace
}  // namespace oit
