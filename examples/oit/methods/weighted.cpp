// A weighted mean of all fragments, in one pass.
#include "methods/accumulating.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

class Weighted : public Method {
public:
    explicit Weighted(FragmentSource& source)
        : source_(source),
          pass_(source.pass(accumulating_text(kernels::weighted_cl), "weighted.cl")),
          resolve_(source.screen_kernel(accumulating_text(kernels::weighted_cl), "weighted.cl",
                                        "oit_resolve_weighted")),
          sums_(source.device(), 5 * source.samples()) {}

    void store() override {
        sums_.fill(0);
        source_.draw(pass_, sums_);
    }
    void resolve() override { source_.run_on_screen(resolve_, sums_); }
    [[nodiscard]] std::uint64_t device_bytes() const override {
        return sums_.size() * sizeof(cl_long);
    }

private:
    FragmentSource& source_;
    raster::Pass pass_;
    cellist::Kernel resolve_;
    cellist::Buffer<cl_long> sums_;
};

const MethodRegistration weighted(
    {.name = "weighted",
     .summary = "a mean weighted by opacity and nearness, one pass (McGuire, Bavoil 2013)",
     .position = 80,
     .exact = false,
     .has_nodes = false,
     .refusal = accumulating_refusal,
     .make = make_accumulating<Weighted>});

}  // namespace
}  // namespace oit
