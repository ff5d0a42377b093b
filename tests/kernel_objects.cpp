// SPDX-License-Identifier: MIT
// Images, samplers, pipes and buffers are told from one another, by what they are and not by the
// class of the C++ bindings that they come in; sizes of local and constant memory are compared with
// the device's.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/skip.hpp"

namespace cellist::test {
namespace {

constexpr auto objects_source = R"(
kernel void buffer(uint n, global float* x) { x[0] = n; }
kernel void table(constant float* x, global float* y) { y[0] = x[0]; }
kernel void reads2(uint n, read_only image2d_t i) {}
kernel void writes2(uint n, write_only image2d_t i) {}
kernel void reads1(uint n, read_only image1d_t i) {}
kernel void reads3(uint n, read_only image3d_t i) {}
kernel void reads1a(uint n, read_only image1d_array_t i) {}
kernel void reads2a(uint n, read_only image2d_array_t i) {}
kernel void reads1b(uint n, read_only image1d_buffer_t i) {}
kernel void samples(uint n, sampler_t s) {}
kernel void shares(uint n, local uint* l) { l[0] = n; }
kernel void value(uint n, uint v) {}
)";

struct Objects {
    bool has_images =
        device().queue().getInfo<CL_QUEUE_DEVICE>().getInfo<CL_DEVICE_IMAGE_SUPPORT>() != 0;
    Buffer<cl_float> buffer{device(), 16};
    const cl::Context& context = device().context();
    cl::ImageFormat format{CL_RGBA, CL_FLOAT};

    Kernel kernel(const std::string& name) { return {device(), objects_source, name}; }
};

/// The message of a launch with an argument that does not fit.
std::string refusal(Kernel& kernel, const auto& argument) {
    const std::string message = error_of([&] { kernel.run(1, cl_uint{1}, argument); }).what();
    UNSCOPED_INFO(message);
    REQUIRE(contains(message, "kernel " + kernel.name() + ", argument 2 '"));
    return message;
}

TEST_CASE_METHOD(Objects, "an argument of another kind is refused, naming both kinds") {
    if (!has_images) CELLIST_SKIP("the device has no images");
    const cl::Image2D image(context, CL_MEM_READ_WRITE, format, 4, 4);
    const cl::Sampler sampler(context, CL_FALSE, CL_ADDRESS_CLAMP, CL_FILTER_NEAREST);
    struct Taker {
        const char* name;
        const char* parameter;
        const char* takes;
    };
    for (const Taker& expected : {Taker{"buffer", "'global float* x'", "a buffer"},
                                  Taker{"reads2", "'read_only image2d_t i'", "an image"},
                                  Taker{"writes2", "'write_only image2d_t i'", "an image"},
                                  Taker{"reads1b", "'read_only image1d_buffer_t i'", "an image"},
                                  Taker{"samples", "'sampler_t s'", "a sampler"},
                                  Taker{"shares", "'local uint* l'", "local memory"},
                                  Taker{"value", "'uint v'", "a value"}}) {
        Kernel taker = kernel(expected.name);
        const auto refused = [&](const auto& argument, const std::string& what) {
            if (what == expected.takes) return;
            const std::string message = refusal(taker, argument);
            REQUIRE(contains(message, expected.parameter));
            REQUIRE(
                contains(message, std::string("takes ") + expected.takes + ", was given " + what));
        };
        refused(buffer, "a buffer");
        refused(buffer.cl(), "a buffer");
        refused(cl::Memory(buffer.cl()(), true), "a buffer");
        refused(cl::Image2D(buffer.cl()(), true), "a buffer");
        refused(image, "an image");
        refused(cl::Memory(image(), true), "an image");
        refused(cl::Buffer(image(), true), "an image");
        refused(sampler, "a sampler");
        refused(LocalMemory{64}, "local memory");
        refused(cl_uint{1}, "a value");
    }
    Kernel takes_buffer = kernel("buffer");
    takes_buffer.run(1, cl_uint{3}, buffer);
    takes_buffer.run(1, cl_uint{3}, cl::Memory(buffer.cl()(), true));
    REQUIRE(buffer.download()[0] == 3.0f);
    kernel("reads2").run(1, cl_uint{1}, image);
    kernel("reads2").run(1, cl_uint{1}, cl::Memory(image(), true));
    kernel("samples").run(1, cl_uint{1}, sampler);
    device().finish();
}

TEST_CASE_METHOD(Objects, "an image of another kind is refused, naming both kinds") {
    if (!has_images) CELLIST_SKIP("the device has no images");
    struct Made {
        const char* taker;
        const char* name;
        cl::Memory image;
    };
    std::vector<Made> images;
    const auto add = [&](const char* taker, const char* name, const auto& make) {
        try {
            images.push_back({taker, name, make()});
        } catch (const cl::Error&) {}  // the device has none
    };
    const cl_mem_flags flags = CL_MEM_READ_WRITE;
    add("reads1", "a 1D image", [&] { return cl::Image1D(context, flags, format, 4); });
    add("reads2", "a 2D image", [&] { return cl::Image2D(context, flags, format, 4, 4); });
    add("reads3", "a 3D image", [&] { return cl::Image3D(context, flags, format, 4, 4, 4); });
    add("reads1a", "an array of 1D images",
        [&] { return cl::Image1DArray(context, flags, format, 4, 4, 0); });
    add("reads2a", "an array of 2D images",
        [&] { return cl::Image2DArray(context, flags, format, 4, 4, 4, 0, 0); });
    add("reads1b", "a 1D image of a buffer",
        [&] { return cl::Image1DBuffer(context, flags, format, 4, buffer.cl()); });
    REQUIRE(images.size() > 1);
    for (const Made& taken : images) {
        Kernel taker = kernel(taken.taker);
        for (const Made& given : images) {
            INFO(taken.taker << " given " << given.name);
            // PoCL 3.1 crashes where a kernel takes the image of a buffer.
            if (&given == &taken && taken.taker != std::string("reads1b"))
                taker.run(1, cl_uint{1}, given.image);
            else if (&given != &taken)
                REQUIRE(contains(refusal(taker, given.image),
                                 std::string("takes ") + taken.name + ", was given " + given.name));
        }
    }
    device().finish();
}

TEST_CASE_METHOD(Objects, "an image that the kernel may not use so is refused") {
    if (!has_images) CELLIST_SKIP("the device has no images");
    const cl::Image2D read(context, CL_MEM_READ_ONLY, format, 4, 4);
    const cl::Image2D written(context, CL_MEM_WRITE_ONLY, format, 4, 4);
    Kernel reads = kernel("reads2"), writes = kernel("writes2");
    reads.run(1, cl_uint{1}, read);
    writes.run(1, cl_uint{1}, written);
    REQUIRE(contains(refusal(reads, written), "CL_MEM_WRITE_ONLY"));
    REQUIRE(contains(refusal(writes, read), "CL_MEM_READ_ONLY"));
    device().finish();
}

TEST_CASE_METHOD(Objects, "objects of another context and empty ones are refused") {
    const Device other = Device::choose();
    Kernel takes_buffer = kernel("buffer");
    REQUIRE(contains(refusal(takes_buffer, Buffer<cl_float>(other, 1)), "another context"));
    REQUIRE(contains(refusal(takes_buffer, cl::Buffer()), "an empty buffer"));
    if (!has_images) CELLIST_SKIP("the device has no images");
    Kernel reads = kernel("reads2"), samples = kernel("samples");
    REQUIRE(contains(refusal(reads, cl::Image2D(other.context(), CL_MEM_READ_ONLY, format, 4, 4)),
                     "another context"));
    REQUIRE(contains(refusal(reads, cl::Image2D()), "takes an image, was given an empty"));
    REQUIRE(contains(refusal(samples, cl::Sampler(other.context(), CL_FALSE, CL_ADDRESS_CLAMP,
                                                  CL_FILTER_NEAREST)),
                     "another context"));
    REQUIRE(contains(refusal(samples, cl::Sampler()), "an empty sampler"));
}

TEST_CASE_METHOD(Objects, "local memory has a size that the device has") {
    Kernel shares = kernel("shares");
    const std::uint64_t most = device().info().local_memory_bytes;
    for (const std::size_t size : {std::size_t{0}, std::size_t{3}})
        REQUIRE(contains(refusal(shares, LocalMemory{size}), "takes at least 4 bytes"));
    REQUIRE(contains(refusal(shares, LocalMemory{most + 1}),
                     "takes at most " + std::to_string(most) + " bytes"));
    shares.run(1, cl_uint{1}, LocalMemory{4});

    Kernel twice(device(), "kernel void twice(local uint* a, local uint* b) { a[0] = b[0] = 1; }",
                 "twice");
    REQUIRE(contains(error_of([&] { twice.run(1, LocalMemory{most}, LocalMemory{4}); }).what(),
                     "of local memory together"));
    twice.run(1, LocalMemory{8}, LocalMemory{4});
    device().finish();
}

TEST_CASE_METHOD(Objects, "a buffer in constant memory is no larger than the device allows") {
    const auto most =
        device().queue().getInfo<CL_QUEUE_DEVICE>().getInfo<CL_DEVICE_MAX_CONSTANT_BUFFER_SIZE>();
    Kernel table = kernel("table");
    table.run(1, buffer, buffer);
    if (most > (std::uint64_t{64} << 20))
        CELLIST_SKIP("a buffer over the limit: the device allows more than 64 MiB");
    const Buffer<cl_float> large(device(), most / sizeof(cl_float) + 1);
    const std::string message = error_of([&] { table.run(1, large, buffer); }).what();
    INFO(message);
    REQUIRE(contains(message, "'constant float* x'"));
    REQUIRE(contains(message, "at most " + std::to_string(most) + " bytes"));
    table.run(1, buffer, large);
    device().finish();
}

}  // namespace
}  // namespace cellist::test
