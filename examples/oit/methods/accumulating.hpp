// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "methods/method.hpp"

namespace oit {

// The methods that add fragments up in any order: see accumulate.clh.

/// A pass's source after what they share.
[[nodiscard]] std::string accumulating_text(std::string_view source);

/// They know surfaces that cover what is behind them.
[[nodiscard]] std::string accumulating_refusal(const Frame& frame, const FrameFeatures& features);

/// Throws InputError where the device has no atomic addition of 64 bits.
void require_wide_sums(const cellist::Device& device);

/// A method that adds the colours, weights and absorbances of fragments: five sums for each sample.
class AccumulatingMethod : public Method {
public:
    explicit AccumulatingMethod(FragmentSource& source);

    void resolve() override { source_.run_on_screen(resolve_, sums_); }
    [[nodiscard]] std::uint64_t device_bytes() const override { return raster::bytes_of(sums_); }

protected:
    FragmentSource& source_;
    cellist::Buffer<cl_long> sums_;

private:
    cellist::Kernel resolve_;
};

template <class Accumulating>
std::unique_ptr<Method> make_accumulating(FragmentSource& source) {
    require_wide_sums(source.device());
    return std::make_unique<Accumulating>(source);
}

}  // namespace oit
