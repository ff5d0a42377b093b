// SPDX-License-Identifier: MIT
#include "budget/budget.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "input_error.hpp"

namespace oit {
namespace {

using support::InputError;

// The whole text as a finite number, or nothing.
std::optional<double> number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return {};
    return value;
}

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
    throw InputError("--budget " + std::string(text) + ": " + why);
}

std::string formatted(const char* format, double value) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
}

// A part, such as 1/255, or a decimal.
std::optional<double> fraction(std::string_view text) {
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) return number(text);
    const auto numerator = number(text.substr(0, slash));
    const auto denominator = number(text.substr(slash + 1));
    if (!numerator || !denominator || *denominator == 0) return {};
    return *numerator / *denominator;
}

// The text before "dB", which may be in upper or lower case and after spaces.
std::optional<std::string_view> before_unit(std::string_view text) {
    if (text.size() < 2) return {};
    const std::string_view unit = text.substr(text.size() - 2);
    if ((unit[0] != 'd' && unit[0] != 'D') || (unit[1] != 'b' && unit[1] != 'B')) return {};
    text.remove_suffix(2);
    while (text.ends_with(' ')) text.remove_suffix(1);
    return text;
}

}  // namespace

double PictureError::psnr_db() const { return -10 * std::log10(mean_square); }

bool Budget::met_by(const PictureError& error) const {
    // False where the error is no number.
    return kind == Kind::largest ? error.largest <= limit : error.psnr_db() >= limit;
}

bool Budget::better(const PictureError& a, const PictureError& b) const {
    return kind == Kind::largest ? a.largest < b.largest : a.mean_square < b.mean_square;
}

std::string Budget::text_of(const PictureError& error) const {
    if (kind == Kind::psnr) return formatted("%.1f dB", error.psnr_db());
    return formatted(error.largest < 1.0 / 255 ? "%.4f/255" : "%.2f/255", 255 * error.largest);
}

std::string Budget::text() const {
    if (kind == Kind::psnr) return formatted("%.6g", limit) + "dB";
    return formatted("%.6g", 255 * limit) + "/255";
}

Budget parse_budget(std::string_view text) {
    constexpr std::string_view expected =
        "expected a PSNR such as 40dB, or a largest error such as 1/255 or 0.004";
    constexpr double most_db = 200;
    if (const auto decibels = before_unit(text)) {
        const auto psnr = number(*decibels);
        if (!psnr) refuse(text, std::string(expected));
        if (!(*psnr > 0 && *psnr <= most_db))
            refuse(text, "a PSNR must be above 0 dB and at most 200 dB");
        return {Budget::Kind::psnr, *psnr};
    }
    const auto largest = fraction(text);
    if (!largest) refuse(text, std::string(expected));
    if (*largest >= 1)
        refuse(
            text,
            "every picture meets this, because no error is larger than 1: expected less, such as "
            "1/255, or a PSNR such as 40dB");
    if (!(*largest > 0)) refuse(text, "expected an error above 0: pictures of floats have errors");
    return {Budget::Kind::largest, *largest};
}

}  // namespace oit
