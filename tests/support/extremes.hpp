// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>
#include <vector>

#include "support/sorted.hpp"

namespace cellist::test {

/// 0, the borders of the type, and those of every number of bits, float's 24 and double's 53 too.
template <std::integral T>
std::vector<T> extremes() {
    std::vector<T> all{0, std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max()};
    for (int bits = 0; bits < 64; ++bits)
        for (const std::uint64_t border : {~0ull, 0ull, 1ull}) {
            all.push_back(static_cast<T>((std::uint64_t{1} << bits) + border));
            all.push_back(static_cast<T>(0 - (std::uint64_t{1} << bits) + border));
        }
    return all;
}

/// Of either sign: 0, the least normal number, 1, 2^24 (the first integer without a successor in
/// float) and infinity, all with their neighbours, denormals among them, and NaNs, quiet and
/// signalling.
template <std::floating_point T>
std::vector<T> extremes() {
    using Limits = std::numeric_limits<T>;
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    std::vector<T> all;
    for (const T value : {T{0}, Limits::min(), T{1}, T{1 << 24}, Limits::infinity()})
        for (const T toward : {-Limits::infinity(), value, Limits::infinity()})
            all.push_back(std::nextafter(value, toward));
    const Bits infinity = std::bit_cast<Bits>(Limits::infinity());
    const Bits quiet = std::bit_cast<Bits>(Limits::quiet_NaN());
    for (const Bits nan : {infinity + 1, quiet - 1, quiet, quiet + 1, ~Bits{0} >> 1})
        all.push_back(std::bit_cast<T>(nan));
    for (std::size_t i = 0, positive = all.size(); i < positive; ++i) all.push_back(-all[i]);
    return all;
}

/// One of the extremes, or of the first three, which make ties.
template <class T>
T extreme(std::mt19937& random) {
    static const std::vector<T> all = extremes<T>();
    return all[below(random, below(random, 2) == 0 ? static_cast<std::uint32_t>(all.size()) : 3)];
}

/// Keys of the types that are compared as they are.
struct Numbers {
    cl_ulong ulong_value;
    cl_long long_value;
    cl_float float_value;
    cl_uint uint_value;
    cl_int int_value;
    cl_uint last;  ///< in place of padding, which devices do not keep
};
CELLIST_STRUCT(Numbers, ulong_value, long_value, float_value, uint_value, int_value, last);

inline auto members(const Numbers& numbers) {
    return std::tuple(numbers.ulong_value, numbers.long_value, ordered(numbers.float_value),
                      numbers.uint_value, numbers.int_value, numbers.last);
}

inline void draw(Numbers& numbers, std::mt19937& random) {
    // In braces, which are evaluated in order.
    numbers = {extreme<cl_ulong>(random), extreme<cl_long>(random), extreme<cl_float>(random),
               extreme<cl_uint>(random),  extreme<cl_int>(random),  extreme<cl_uint>(random)};
}

enum class Level : cl_short { low = -32'768, none = 0, high = 32'767 };

/// Keys of the types that are ints to a comparison.
struct Narrow {
    cl_ushort ushort_value;
    cl_short short_value;
    Level level;
    cl_uchar uchar_value;
    cl_char char_value;
};
CELLIST_STRUCT(Narrow, ushort_value, short_value, level, uchar_value, char_value);

inline auto members(const Narrow& narrow) {
    return std::tuple(narrow.ushort_value, narrow.short_value, narrow.level, narrow.uchar_value,
                      narrow.char_value);
}

inline void draw(Narrow& narrow, std::mt19937& random) {
    constexpr std::array levels{Level::low, Level::none, Level::high};
    narrow = {extreme<cl_ushort>(random), extreme<cl_short>(random), levels[below(random, 3)],
              extreme<cl_uchar>(random), extreme<cl_char>(random)};
}

/// A key of the type that not all devices have.
struct Wide {
    cl_double key;
    cl_ulong id;
};
CELLIST_STRUCT(Wide, key, id);

inline auto members(const Wide& wide) { return std::tuple(ordered(wide.key), wide.id); }

inline void draw(Wide& wide, std::mt19937& random) {
    wide = {extreme<cl_double>(random), extreme<cl_ulong>(random)};
}

/// Lists of extreme records, one for each length; every tenth record is there twice.
template <class T>
Inserts<T> extreme_inserts(std::span<const cl_uint> lengths, std::mt19937& random) {
    Inserts<T> inserts;
    for (cl_uint cell = 0; cell < lengths.size(); ++cell) {
        T record;
        for (cl_uint i = 0; i < lengths[cell]; ++i) {
            if (i % 10 != 9) draw(record, random);
            inserts.add(cell, record);
        }
    }
    inserts.shuffle(random);
    return inserts;
}

}  // namespace cellist::test
