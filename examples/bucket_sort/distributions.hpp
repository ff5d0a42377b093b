// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <cellist/opencl.hpp>

namespace bucket_sort {

inline constexpr std::array<std::string_view, 6> distributions{"uniform", "gaussian", "equal",
                                                               "sorted",  "zipf",     "two values"};

/// Keys of a distribution, by its index in `distributions`.
[[nodiscard]] std::vector<cl_uint> make_keys(std::size_t distribution, std::size_t count,
                                             std::uint32_t seed);

}  // namespace bucket_sort
