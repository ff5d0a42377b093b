// SPDX-License-Identifier: MIT
// A weighted mean of all fragments, in one pass.
#include "methods/accumulating.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

class Weighted : public AccumulatingMethod {
public:
    explicit Weighted(FragmentSource& source)
        : AccumulatingMethod(source),
          pass_(source.pass(accumulating_text(kernels::weighted_cl), "weighted.cl")) {}

    void store() override {
        sums_.fill(0);
        source_.draw(pass_, sums_);
    }

private:
    raster::Pass pass_;
};

const MethodRegistration weighted_method(
    {.name = "weighted",
     .summary = "a mean weighted by opacity and nearness, one pass (McGuire, Bavoil 2013)",
     .position = 80,
     .exact = false,
     .has_nodes = false,
     .refusal = accumulating_refusal,
     .make = make_accumulating<Weighted>});

}  // namespace
}  // namespace oit
