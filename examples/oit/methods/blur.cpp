// SPDX-License-Identifier: MIT
// Depth of field without layers, from the pinhole picture and the depth of the nearest surface in
// each pixel.
#include "methods/lens_ranges.hpp"
#include "methods/lists.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

class Blur : public Method {
public:
    explicit Blur(FragmentSource& source)
        : source_(source),
          picture_(make_list_method(source, {.storage = cellist::Storage::linked})),
          pass_(source.pass(kernels::blur_cl, "blur.cl")),
          take_(source.screen_kernel(lens_text("", kernels::blur_cl), "blur.cl", "oit_take_sharp")),
          blur_(source.screen_kernel(lens_text("", kernels::blur_cl), "blur.cl", "oit_blur")),
          depth_bits_(source.device(), source.frame().pixels()),
          sharp_(source.device(), source.frame().pixels()),
          ranges_(source) {}

    void store() override {
        picture_->store();
        depth_bits_.fill(infinity_bits);
        source_.draw(pass_, depth_bits_);
    }

    void resolve() override {
        picture_->resolve();
        ranges_.clear();
        source_.run_on_screen(take_, depth_bits_, sharp_, ranges_.ranges());
        ranges_.spread();
        const Frame& frame = source_.frame();
        source_.run_on_screen(blur_, sharp_, ranges_.ranges(), ranges_.scale(), ranges_.focus(),
                              frame.quality.lens_rays, cl_int{frame.margin});
    }

    [[nodiscard]] bool finish_or_grow() override { return picture_->finish_or_grow(); }

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return picture_->device_bytes() + raster::bytes_of(depth_bits_, sharp_) +
               ranges_.device_bytes();
    }

private:
    FragmentSource& source_;
    std::unique_ptr<Method> picture_;
    raster::Pass pass_;
    cellist::Kernel take_;
    cellist::Kernel blur_;
    cellist::Buffer<cl_uint> depth_bits_;
    cellist::Buffer<cl_float4> sharp_;
    LensRanges ranges_;
};

const MethodRegistration blur_method(
    {.name = "blur",
     .summary = "the picture blurred by the depth of its nearest surfaces (Potmesil, Chakravarty "
                "1981)",
     .position = 170,
     .exact = false,
     .refusal = refuses_pinholes,
     .make = [](FragmentSource& source) -> std::unique_ptr<Method> {
         return std::make_unique<Blur>(source);
     },
     .passes = two_passes});

}  // namespace
}  // namespace oit
