// SPDX-License-Identifier: MIT
// Shape against arithmetic in 128 bits.
//
// Input: the number of extents, the extents, the number of coordinates, the coordinates.
#include <limits>
#include <optional>
#include <vector>

#include <cellist/error.hpp>
#include <cellist/shape.hpp>

#include "input.hpp"

namespace cellist::fuzz {
namespace {

__extension__ using Wide = unsigned __int128;
using Numbers = std::vector<std::uint64_t>;

/// An extent or a coordinate: any, or one close to a limit.
std::uint64_t take_number(Input& input) {
    constexpr std::uint64_t limits[] = {0,           1,           0x7FFF'FFFF, 0x8000'0000,
                                        0xFFFF'FFFE, 0xFFFF'FFFF, 0x10000,     ~std::uint64_t{0}};
    switch (input.below(5)) {
        case 0:
            return input.number<std::uint8_t>();
        case 1:
            return input.number<std::uint16_t>();
        case 2:
            return input.number<std::uint32_t>();
        case 3:
            return input.number<std::uint64_t>();
        default:
            return limits[input.below(std::size(limits))] + input.below(3) - 1;
    }
}

Numbers take_numbers(Input& input) {
    Numbers numbers(input.below(7));
    for (std::uint64_t& number : numbers) number = take_number(input);
    return numbers;
}

/// Calls with the numbers as an initializer list, which is all that a Shape takes.
template <class Call>
auto with_list(const Numbers& n, Call&& call) {
    using List = std::initializer_list<detail::Extent>;
    switch (n.size()) {
        case 0:
            return call(List{});
        case 1:
            return call(List{n[0]});
        case 2:
            return call(List{n[0], n[1]});
        case 3:
            return call(List{n[0], n[1], n[2]});
        case 4:
            return call(List{n[0], n[1], n[2], n[3]});
        case 5:
            return call(List{n[0], n[1], n[2], n[3], n[4]});
        default:
            return call(List{n[0], n[1], n[2], n[3], n[4], n[5]});
    }
}

/// What `call` returns; nothing if it throws the library's error.
template <class Call>
auto result_of(Call&& call) -> std::optional<decltype(call())> {
    try {
        return call();
    } catch (const Error& error) {
        CELLIST_FUZZ_REQUIRE(error.what()[0] != '\0');
        return {};
    }
}

/// The number of cells; nothing if there is no such shape.
std::optional<Wide> cells_of(const Numbers& extents) {
    if (extents.empty() || extents.size() > 4) return {};
    Wide cells = 1;
    for (const std::uint64_t extent : extents) {
        if (extent > 2'147'483'647) return {};
        cells *= extent;
    }
    if (cells > 4'294'967'294) return {};
    return cells;
}

/// The index of a cell; nothing if it is outside.
std::optional<Wide> index_of(const Numbers& extents, const Numbers& position) {
    if (position.size() > extents.size()) return {};
    Wide index = 0, stride = 1;
    for (std::size_t i = 0; i < extents.size(); ++i) {
        const std::uint64_t coordinate = i < position.size() ? position[i] : 0;
        if (coordinate >= extents[i]) return {};
        index += coordinate * stride;
        stride *= extents[i];
    }
    return index;
}

void run(Input& input) {
    const Numbers extents = take_numbers(input);
    const auto expected = cells_of(extents);
    const auto shape =
        result_of([&] { return with_list(extents, [](auto list) { return Shape(list); }); });
    CELLIST_FUZZ_REQUIRE(shape.has_value() == expected.has_value());
    if (!shape) return;

    CELLIST_FUZZ_REQUIRE(shape->cells() == *expected);
    CELLIST_FUZZ_REQUIRE(shape->dimensions() == extents.size());
    CELLIST_FUZZ_REQUIRE(*shape == with_list(extents, [](auto list) { return Shape(list); }));
    std::string text;
    for (const std::uint64_t extent : extents)
        text += (text.empty() ? "" : "x") + std::to_string(extent);
    CELLIST_FUZZ_REQUIRE(shape->to_string() == text);
    for (std::size_t i = 0; i < 9; ++i)
        CELLIST_FUZZ_REQUIRE(shape->extent(i) == (i < extents.size() ? extents[i] : 1));
    CELLIST_FUZZ_REQUIRE(shape->extent(std::numeric_limits<std::size_t>::max()) == 1);

    Numbers position = take_numbers(input);
    // Often a cell of the shape, or one next to it.
    for (std::size_t i = 0; i < position.size() && i < extents.size(); ++i)
        if (input.below(4) != 0) position[i] = extents[i] + input.below(3) - 2;
    const auto cell = result_of(
        [&] { return with_list(position, [&](auto list) { return shape->cell(list); }); });
    const auto index = index_of(extents, position);
    CELLIST_FUZZ_REQUIRE(cell.has_value() == index.has_value());
    CELLIST_FUZZ_REQUIRE(!cell || *cell == *index);
    CELLIST_FUZZ_REQUIRE(!cell || *cell < shape->cells());
}

}  // namespace
}  // namespace cellist::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    cellist::fuzz::Input input(data, size);
    cellist::fuzz::run(input);
    return 0;
}
