// SPDX-License-Identifier: MIT
// Generated structs on the device: the host fills them and the device takes them apart, the device
// puts them together and inserts them, and the host takes the download apart. Every scalar is
// compared, byte for byte, through the members' names in both languages.
#include <array>
#include <iostream>
#include <random>
#include <vector>

#include <cellist/cellist.hpp>

namespace cellist::fuzz {

#include "structs.hpp"

namespace {

constexpr std::size_t records = 7;
// Counted lists take the longest to compile.
constexpr std::array storages{Storage::linked, Storage::fixed, Storage::linked, Storage::counted};

// In streams of bytes, each scalar has a slot of 8; the rest of it is 0.
constexpr std::size_t slot = 8;
constexpr auto macros = R"(
#define PUT(type, value)                                                                           \
    *(global type*)bytes = value;                                                                  \
    bytes += 8;
#define TAKE(type, value)                                                                          \
    value = *(global const type*)bytes;                                                            \
    bytes += 8;
)";

using Bytes = std::vector<cl_uchar>;

template <class T>
T random_record(std::mt19937& random) {
    T record{};
    visit(record, [&](auto& scalar) {
        auto* bytes = reinterpret_cast<cl_uchar*>(&scalar);
        for (std::size_t i = 0; i < sizeof scalar; ++i) bytes[i] = static_cast<cl_uchar>(random());
    });
    return record;
}

template <class T>
Bytes apart(const std::vector<T>& all) {
    Bytes stream;
    for (T record : all)
        visit(record, [&](auto& scalar) {
            const auto* bytes = reinterpret_cast<const cl_uchar*>(&scalar);
            stream.insert(stream.end(), bytes, bytes + sizeof scalar);
            stream.resize(stream.size() + slot - sizeof scalar);
        });
    return stream;
}

/// True if random records are the same on the host and the device, in both directions.
template <class T>
bool same_on_device(const Device& device, const std::string& kernels, Storage storage,
                    std::mt19937& random) {
    std::vector<T> host;
    for (std::size_t i = 0; i < records; ++i) host.push_back(random_record<T>(random));
    const Bytes stream = apart(host);
    const Source source{.text = macros + kernels,
                        .options = "-DBYTES=" + std::to_string(stream.size() / records)};

    Lists<T> lists(device, {records}, {.storage = storage});
    Buffer<cl_uchar> taken(device, stream.size());
    taken.fill(0);
    Kernel(device, source, "take_apart", lists).run(records, Buffer<T>(device, host), taken);
    Kernel put_together(device, source, "put_together", lists);
    const BuildReport report = lists.build(put_together, records, Buffer<cl_uchar>(device, stream));
    return taken.download() == stream && report.stored == records &&
           apart(lists.download().records()) == stream;
}

int run() {
    const Device device = Device::choose();
    std::mt19937 random(4);
    std::size_t structs = 0, different = 0;
    const auto count = [&](const char* name, bool same) {
        ++structs;
        if (same) return;
        ++different;
        std::cout << name << " differs between host and device\n";
    };
#define CELLIST_GENERATED(name)                                                                    \
    count(#name, same_on_device<name>(device, source_of_##name,                                    \
                                      storages[structs % storages.size()], random));
    CELLIST_GENERATED_STRUCTS
#undef CELLIST_GENERATED
    std::cout << "fuzz: generated structs: " << structs << " inputs\n";
    return different == 0 ? 0 : 1;
}

}  // namespace
}  // namespace cellist::fuzz

int main() {
    try {
        return cellist::fuzz::run();
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
