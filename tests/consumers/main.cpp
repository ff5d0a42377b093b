// SPDX-License-Identifier: MIT
// Inserts the numbers 0 ... 999 into 10 cells by their last digit, and reads them back.
#include <cstdio>
#include <exception>

#include <cellist/cellist.hpp>

struct Number {
    cl_uint value;
};
CELLIST_STRUCT(Number, value);

namespace {

constexpr cl_uint digits = 10;
constexpr cl_uint count = 1000;

constexpr const char* source = R"(
#include <cellist/lists.clh>
kernel void sort_by_digit(CELLIST_LISTS(Number, numbers)) {
    Number number = {(uint)get_global_id(0)};
    cellist_insert(numbers, cellist_cell1(numbers, number.value % 10), number);
}
)";

bool digits_are_right() {
    cellist::Device device = cellist::Device::choose();
    cellist::Lists<Number> numbers(device, {digits});
    cellist::Kernel kernel(device, source, "sort_by_digit", numbers);
    numbers.build(kernel, count);
    numbers.sort(&Number::value);

    const auto lists = numbers.download();
    for (cl_uint digit = 0; digit < digits; ++digit) {
        cl_uint expected = digit;
        for (const Number& number : lists[{digit}]) {
            if (number.value != expected) return false;
            expected += digits;
        }
        if (expected != count + digit) return false;
    }
    return true;
}

}  // namespace

int main() {
    try {
        if (digits_are_right()) return 0;
        std::fputs("the lists differ from what was inserted\n", stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
    return 1;
}
