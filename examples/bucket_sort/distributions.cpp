// SPDX-License-Identifier: MIT
#include "distributions.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace bucket_sort {

std::vector<cl_uint> make_keys(std::size_t distribution, std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0x1p31, 0x1p24);
    const auto uniform = [&] { return static_cast<cl_uint>(random()); };
    // A key is above k with the probability 1 / k: half of all keys are 1, a sixth are 2.
    const auto zipf = [&] { return 0x1p32 / (static_cast<double>(random()) + 1); };
    std::vector<cl_uint> keys(count);
    for (cl_uint& key : keys) switch (distribution) {
            case 1:
                key = static_cast<cl_uint>(std::clamp(normal(random), 0.0, 0x1p32 - 1));
                break;
            case 2:
                key = 0x80000000;
                break;
            case 4:
                key = static_cast<cl_uint>(std::min(zipf(), 0x1p32 - 1));
                break;
            case 5:
                key = uniform() % 2 == 0 ? 0 : 0xFFFFFFFF;
                break;
            default:
                key = uniform();
                break;
        }
    if (distribution == 3) std::sort(keys.begin(), keys.end());
    return keys;
}

}  // namespace bucket_sort
