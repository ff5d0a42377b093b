// SPDX-License-Identifier: MIT
#include "grid/exact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include <glm/geometric.hpp>

namespace grid {
namespace {

// A sum of products of three floats, kept as one whole number of units of 2^lowest, which all
// floats allow: no rounding anywhere.
class ExactSum {
public:
    void add(double a, double b, double c, bool minus) {
        int exponent = 0;
        std::int64_t factor[3];
        const double factors[3] = {a, b, c};
        for (int i = 0; i < 3; ++i) {
            int e = 0;
            factor[i] = static_cast<std::int64_t>(std::ldexp(std::frexp(factors[i], &e), 24));
            exponent += e - 24;
        }
        const std::int64_t two = factor[0] * factor[1];
        const bool negative = minus != ((two < 0) != (factor[2] < 0));
        // Of 72 bits: in three digits of 24 bits.
        std::uint64_t rest = static_cast<std::uint64_t>(std::abs(two));
        const auto third = static_cast<std::uint64_t>(std::abs(factor[2]));
        const int shift = exponent - lowest;
        std::uint64_t carry = 0;
        for (int i = 0; i < 4; ++i, rest >>= 24) {
            const std::uint64_t product = (rest & 0xFFFFFF) * third + carry;
            carry = product >> 24;
            add_digit(static_cast<std::int64_t>(product & 0xFFFFFF), shift + 24 * i, negative);
        }
    }

    [[nodiscard]] int sign() const {
        // Digits are between -2^63 and 2^63 and become those of one sign and 32 bits.
        std::int64_t carry = 0;
        bool any = false;
        for (const std::int64_t digit : digits_) {
            const std::int64_t value = digit + carry;
            carry = value >> 32;
            any = any || (value & 0xFFFFFFFF) != 0;
        }
        return carry < 0 ? -1 : (carry > 0 || any ? 1 : 0);
    }

private:
    static constexpr int lowest = 3 * (-149 - 24);

    void add_digit(std::int64_t digit, int shift, bool negative) {
        const std::int64_t low = (digit << (shift % 32)) & 0xFFFFFFFF;
        const std::int64_t high = (digit << (shift % 32)) >> 32;
        digits_[static_cast<std::size_t>(shift / 32)] += negative ? -low : low;
        digits_[static_cast<std::size_t>(shift / 32) + 1] += negative ? -high : high;
    }

    std::array<std::int64_t, 36> digits_{};
};

// The determinant of b - a, c - a, d - a, whose terms are sums of triple products of the points.
int exact_side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    ExactSum sum;
    const auto add_triple = [&](const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& r,
                                bool minus) {
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            sum.add(p[i], q[j], r[k], minus);
            sum.add(p[i], q[k], r[j], !minus);
        }
    };
    add_triple(b, c, d, false);
    add_triple(a, c, d, true);
    add_triple(a, b, d, false);
    add_triple(a, b, c, true);
    return sum.sign();
}

// The sign of six times the volume of the tetrahedron.
int side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    const glm::dvec3 x = b - a, y = c - a, z = d - a;
    double volume = 0;
    double size = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double left = y[j] * z[k], right = y[k] * z[j];
        volume += x[i] * (left - right);
        size += std::abs(x[i]) * (std::abs(left) + std::abs(right));
    }
    if (std::abs(volume) <= 0x1p-49 * size) return exact_side(a, b, c, d);
    return volume > 0 ? 1 : -1;
}

bool meets(const glm::dvec3& from, const glm::dvec3& to, const GridTriangle& triangle) {
    const glm::dvec3 a(triangle.a), b(triangle.b), c(triangle.c);
    // The ends on different sides of the plane, or one of them in it.
    const int start = side(a, b, c, from);
    const int end = side(a, b, c, to);
    if (start == end || (start != 0 && end != 0 && start != -end)) return false;
    // The edges on the same side of the line, or some of them crossing it.
    const auto [least, most] =
        std::minmax({side(a, b, from, to), side(b, c, from, to), side(c, a, from, to)});
    return least >= 0 || most <= 0;
}

// The boxes are apart: most triangles are, and no rounding is involved.
bool are_apart(const glm::vec3& from, const glm::vec3& to, const GridTriangle& triangle) {
    for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({triangle.a[k], triangle.b[k], triangle.c[k]});
        if (std::max(from[k], to[k]) < low) return true;
        if (std::min(from[k], to[k]) > high) return true;
    }
    return false;
}

}  // namespace

bool meets_any(const glm::vec3& from, const glm::vec3& to,
               std::span<const GridTriangle> triangles) {
    const glm::dvec3 exact_from(from), exact_to(to);
    return std::any_of(triangles.begin(), triangles.end(), [&](const auto& triangle) {
        return !are_apart(from, to, triangle) && meets(exact_from, exact_to, triangle);
    });
}

}  // namespace grid
