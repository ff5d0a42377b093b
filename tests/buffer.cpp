// SPDX-License-Identifier: MIT
// Buffers hold, fill and return elements of any size.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

template <class T>
void fill(const T& value) {
    INFO(sizeof(T) << " bytes");
    for (const std::size_t size : {0u, 1u, 7u, 1000u}) {
        Buffer<T> buffer(device(), size);
        buffer.fill(value);
        const std::vector<T> found = buffer.download();
        REQUIRE(found.size() == size);
        REQUIRE(std::count(found.begin(), found.end(), value) == static_cast<std::ptrdiff_t>(size));
    }
}

TEST_CASE("a buffer returns what was copied into it") {
    for (const std::size_t size : {0u, 1u, 7u, 93u, 144u, 4096u, 1'000'000u}) {
        std::vector<cl_uint> elements(size);
        for (std::size_t i = 0; i < size; ++i) elements[i] = static_cast<cl_uint>(i * 2654435761u);
        const Buffer<cl_uint> from_vector(device(), elements);
        REQUIRE(from_vector.size() == size);
        REQUIRE(from_vector.download() == elements);
        const Buffer<cl_uint> from_span(device(), std::span<const cl_uint>(elements));
        REQUIRE(from_span.download() == elements);
    }
}

TEST_CASE("buffers are filled with values of any size") {
    fill<cl_uchar>(200);
    fill<cl_uint>(0x12345678u);
    fill<cl_ulong>(0x123456789ABCDEF0u);
    fill<std::array<cl_uchar, 3>>({1, 2, 3});
    fill<std::array<cl_float, 3>>({1.0f, 2.0f, 3.0f});
    fill<std::array<cl_ulong, 3>>({1, 2, ~cl_ulong{0}});
    fill<std::array<cl_ulong, 16>>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16});
    fill<std::array<cl_ulong, 32>>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16});
}

TEST_CASE("reads of one buffer at several moments are kept apart, whoever asks for them first") {
    // Up to 16 KiB go through memory of the device's, which is used again; more do not.
    for (const std::size_t size : {1u, 4096u, 4097u}) {
        INFO("size " << size);
        Buffer<cl_uint> buffer(device(), size);
        std::vector<Pending<std::vector<cl_uint>>> reads;
        for (cl_uint value = 0; value < 20; ++value) {
            buffer.fill(value);
            reads.push_back(buffer.download_async());
            // A read that nobody asks for.
            if (value % 3 == 0) (void)buffer.download_async();
        }
        for (cl_uint i = 0; i < 20; ++i) {
            const cl_uint value = i * 7 % 20;
            REQUIRE(reads[value].get() == std::vector<cl_uint>(size, value));
        }
    }
}

TEST_CASE("a part of a buffer is written and read, blocking and not") {
    constexpr std::size_t size = 10'000;
    std::vector<cl_uint> expected(size);
    for (std::size_t i = 0; i < size; ++i) expected[i] = static_cast<cl_uint>(i);
    Buffer<cl_uint> buffer(device(), size);
    buffer.upload(expected);
    REQUIRE(buffer.download() == expected);
    for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{77}, size - 7})
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{7}}) {
            const std::vector<cl_uint> part(count, static_cast<cl_uint>(first * 31 + count));
            if (count % 2 == 0)
                buffer.upload_async(part, first).wait();
            else
                buffer.upload(part, first);
            std::copy(part.begin(), part.end(),
                      expected.begin() + static_cast<std::ptrdiff_t>(first));
            REQUIRE(buffer.download(first, count) == part);
            REQUIRE(buffer.download_async(first, count).get() == part);
            REQUIRE(buffer.download() == expected);
        }
    // More than one block of the memory through which small reads go.
    const auto most = expected.begin() + 9;
    REQUIRE(buffer.download(9, size - 9) == std::vector<cl_uint>(most, expected.end()));
    REQUIRE(buffer.download_async(9, size - 9).get() == std::vector<cl_uint>(most, expected.end()));
    REQUIRE(buffer.download(size, 0).empty());
}

TEST_CASE("a part that a buffer does not have is refused, naming the part and the size") {
    Buffer<cl_uint> buffer(device(), 100);
    const std::vector<cl_uint> elements(3);
    for (const std::size_t first : {std::size_t{98}, std::size_t{101}, ~std::size_t{0}}) {
        const auto error = error_of([&] { buffer.upload(elements, first); });
        INFO(error.what());
        REQUIRE(contains(error.what(), "100"));
        REQUIRE(contains(error.what(), std::to_string(first)));
        REQUIRE_THROWS_AS(buffer.upload_async(elements, first), Error);
        REQUIRE_THROWS_AS(buffer.download(first, 3), Error);
        REQUIRE_THROWS_AS(buffer.download_async(first, 3), Error);
    }
    REQUIRE_THROWS_AS(buffer.download(1, ~std::size_t{0}), Error);
    REQUIRE_THROWS_AS(buffer.upload(std::vector<cl_uint>(101)), Error);
}

TEST_CASE("an empty buffer is a kernel argument") {
    Kernel kernel(device(),
                  "kernel void count(global const uint* in, uint size, global uint* out) "
                  "{ *out = size; for (uint i = 0; i < size; ++i) *out += in[i]; }",
                  "count");
    const Buffer<cl_uint> empty(device(), 0);
    const Buffer<cl_uint> out(device(), 1);
    kernel.run(1, empty, cl_uint{0}, out);
    REQUIRE(out.download()[0] == 0);
}

TEST_CASE("a buffer over the device's limit is refused, naming the size and the limit") {
    const std::uint64_t limit = device().info().max_allocation_bytes;
    for (const std::uint64_t size : {limit / 4 + 1, ~std::uint64_t{0} / 4, ~std::uint64_t{0}}) {
        const auto error = error_of([&] { Buffer<cl_uint>(device(), size); });
        INFO(error.what());
        REQUIRE(contains(error.what(), std::to_string(size)));
        REQUIRE(contains(error.what(), std::to_string(limit)));
    }
}

}  // namespace
}  // namespace cellist::test
