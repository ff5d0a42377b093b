// SPDX-License-Identifier: MIT
// Every scalar type is a key, at the borders of its values: sorted lists are those of a stable sort
// on the host, bit for bit, in every storage and order.
#include <iostream>

#include "support/extremes.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr std::array<cl_uint, 14> short_lengths{0,  1,  2,  3,  15,  16,  17,
                                                31, 32, 33, 65, 129, 256, 0};
constexpr std::array<cl_uint, 5> long_lengths{257, 0, 600, 3000, 1};

/// A way to sort lists, and what it is called.
template <class T>
struct Sort {
    const char* name;
    std::function<void(Lists<T>&, Order)> call;
};
template <class T, class M>
Sort<T> by_member(const char* name, M T::*member) {
    return {name, [member](Lists<T>& lists, Order order) { lists.sort(member, order); }};
}
template <class T>
Sort<T> by_expression(const char* expression) {
    return {expression,
            [expression](Lists<T>& lists, Order order) { lists.sort_by(expression, order); }};
}

/// The same records in every storage.
template <class T>
class Everywhere {
public:
    Everywhere(std::span<const cl_uint> lengths, std::mt19937& random)
        : cells_(lengths.size()), inserts_(extreme_inserts<T>(lengths, random)) {
        for (const Storage storage : all_storages) {
            lists_.emplace_back(device(), Shape{cells_}, ListsOptions{.storage = storage});
            require_complete(Inserter(lists_.back()).build(lists_.back(), inserts_),
                             inserts_.size());
        }
    }

    /// Requires that a sort is one by `key`, a member or a function of the record, in both orders.
    /// Lists in one piece are the same to a sort, counted or fixed: each takes one of the orders,
    /// by turns.
    void require_sorts(const Sort<T>& sort, auto key) {
        for (const Order order : all_orders) {
            const HostLists<T> expected = expect(key, order);
            require_sorts_to(expected, lists_.front(), sort, order);
            require_sorts_to(expected, lists_[1 + turn_++ % 2], sort, order);
        }
        ++turn_;
    }

    /// The same in one storage and one order, others than the last time.
    void require_sorts_once(const Sort<T>& sort, auto key) {
        const Order order = all_orders[turn_ % all_orders.size()];
        require_sorts_to(expect(key, order), lists_[turn_ % lists_.size()], sort, order);
        ++turn_;
    }

    /// Downloads that were compared.
    [[nodiscard]] int count() const { return count_; }

private:
    [[nodiscard]] HostLists<T> expect(auto key, Order order) const {
        return sorted_lists(inserts_, cells_, before<T>(key, order));
    }

    void require_sorts_to(const HostLists<T>& expected, Lists<T>& lists, const Sort<T>& sort,
                          Order order) {
        INFO("by " << sort.name << ", " << name_of(order) << ", storage "
                   << name_of(lists.storage()));
        sort.call(lists, order);
        require_sound(lists, inserts_.size());
        REQUIRE(same_bits(lists.download(), expected));
        REQUIRE(same_bits(lists.pack().records.download(), expected.records()));
        ++count_;
    }

    std::uint64_t cells_;
    Inserts<T> inserts_;
    std::vector<Lists<T>> lists_;
    std::size_t turn_ = 0;
    int count_ = 0;
};

TEST_CASE("lists are sorted by keys at the borders of their types", "[extremes]") {
    CELLIST_RANDOM(random, 80u);
    Everywhere<Numbers> numbers(short_lengths, random);
    const auto sort_by = [&](const char* name, auto member) {
        numbers.require_sorts(by_member(name, member), member);
    };
    sort_by("ulong", &Numbers::ulong_value);
    sort_by("long", &Numbers::long_value);
    sort_by("float", &Numbers::float_value);
    sort_by("uint", &Numbers::uint_value);
    sort_by("int", &Numbers::int_value);
    std::cout << "extremes: " << numbers.count() << " sorted downloads by keys of 5 types"
              << std::endl;
}

TEST_CASE("lists are sorted by short keys at the borders of their types", "[extremes]") {
    CELLIST_RANDOM(random, 81u);
    Everywhere<Narrow> narrow(short_lengths, random);
    const auto sort_by = [&](const char* name, auto member) {
        narrow.require_sorts_once(by_member(name, member), member);
    };
    sort_by("ushort", &Narrow::ushort_value);
    sort_by("short", &Narrow::short_value);
    sort_by("enum", &Narrow::level);
    sort_by("uchar", &Narrow::uchar_value);
    sort_by("char", &Narrow::char_value);
    std::cout << "extremes: " << narrow.count() << " sorted downloads by keys of 5 short types"
              << std::endl;
}

TEST_CASE("lists are sorted by doubles at the borders of the type, where the device has them",
          "[extremes]") {
    CELLIST_RANDOM(random, 83u);
    if (!device().info().fp64) {
        REQUIRE_THROWS_AS(Lists<Wide>(device(), {2}).sort(&Wide::key), Error);
        return;
    }
    Everywhere<Wide> doubles(short_lengths, random);
    doubles.require_sorts(by_member("double", &Wide::key), &Wide::key);
    // 2^53 + 1 is 2^53 in double.
    doubles.require_sorts_once(by_expression<Wide>("(double)record.id"), [](const Wide& record) {
        return static_cast<cl_double>(record.id);
    });
    std::cout << "extremes: " << doubles.count() << " sorted downloads by doubles" << std::endl;
}

TEST_CASE("long lists are sorted by keys at the borders of their types", "[extremes]") {
    CELLIST_RANDOM(random, 88u);
    Everywhere<Numbers> numbers(long_lengths, random);
    const auto sort_by = [&](const char* name, auto member) {
        numbers.require_sorts_once(by_member(name, member), member);
    };
    sort_by("ulong", &Numbers::ulong_value);
    sort_by("int", &Numbers::int_value);
    sort_by("long", &Numbers::long_value);
    sort_by("uint", &Numbers::uint_value);
    std::cout << "extremes: " << numbers.count() << " sorted downloads of long lists" << std::endl;
}

TEST_CASE("lists are sorted by expressions at the borders of their types", "[extremes]") {
    CELLIST_RANDOM(random, 84u);
    Everywhere<Numbers> numbers(short_lengths, random);
    numbers.require_sorts_once(
        by_expression<Numbers>("isnan(record.float_value) ? -INFINITY : record.float_value"),
        [](const Numbers& record) {
            return std::isnan(record.float_value) ? -std::numeric_limits<cl_float>::infinity()
                                                  : record.float_value;
        });
    // 2^24 + 1 is 2^24 in float.
    numbers.require_sorts_once(
        by_expression<Numbers>("(float)record.uint_value"),
        [](const Numbers& record) { return static_cast<cl_float>(record.uint_value); });
    numbers.require_sorts_once(
        by_expression<Numbers>("-(long)record.int_value"),
        [](const Numbers& record) { return -std::int64_t{record.int_value}; });
    numbers.require_sorts_once(by_expression<Numbers>("record.ulong_value + 1"),
                               [](const Numbers& record) { return record.ulong_value + 1; });
    numbers.require_sorts_once(
        by_expression<Numbers>("as_uint(record.float_value)"),
        [](const Numbers& record) { return std::bit_cast<cl_uint>(record.float_value); });
    numbers.require_sorts_once(
        by_expression<Numbers>("record.float_value < 0"),
        [](const Numbers& record) { return record.float_value < 0 ? 1 : 0; });
    // Equal for all records: the members decide.
    numbers.require_sorts_once(by_expression<Numbers>("NAN"), [](const Numbers&) { return 0; });
    std::cout << "extremes: " << numbers.count() << " sorted downloads by 7 expressions"
              << std::endl;
}

}  // namespace
}  // namespace cellist::test
