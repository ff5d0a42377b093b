// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <cellist/device.hpp>

/// A fuzzer's target: one input. Defined by each target, called by libFuzzer or by replay.cpp.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Ends the program with a signal, which fuzzers keep the input of, where a target finds a mistake.
#define CELLIST_FUZZ_REQUIRE(condition)                                                            \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);           \
            std::abort();                                                                          \
        }                                                                                          \
    } while (false)

namespace cellist::fuzz {

/// Takes values from an input, front to back; zeros when it is used up.
class Input {
public:
    Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    template <class T>
    T number() {
        T value{};
        const std::size_t taken = sizeof(T) < size_ ? sizeof(T) : size_;
        if (taken > 0) std::memcpy(&value, data_, taken);
        data_ += taken;
        size_ -= taken;
        return value;
    }

    /// In 0 ... end - 1, from one byte.
    std::size_t below(std::size_t end) { return number<std::uint8_t>() % end; }

    [[nodiscard]] bool empty() const { return size_ == 0; }

    /// All that is left.
    std::string rest() {
        std::string text(reinterpret_cast<const char*>(data_), size_);
        size_ = 0;
        return text;
    }

private:
    const std::uint8_t* data_;
    std::size_t size_;
};

/// The device of the inputs to come. Every 64th call makes a new one, so that its cache of programs
/// does not grow without end; true in `is_new` then. Never destroyed at the end of the program,
/// when the driver may be gone already.
inline const Device& device(bool& is_new) {
    static Device* shared = nullptr;
    static unsigned calls = 0;
    is_new = calls++ % 64 == 0;
    if (is_new) {
        delete shared;
        shared = new Device(Device::choose());
    }
    return *shared;
}

}  // namespace cellist::fuzz
