// SPDX-License-Identifier: MIT
// Programs are stored in files and loaded by the next process; what is wrong with a file costs a
// build and nothing else.
#include <fstream>
#include <limits>
#include <sstream>

#include "device/device_state.hpp"
#include "support/cache.hpp"
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

namespace fs = std::filesystem;
using detail::Program;
using detail::ProgramFiles;

constexpr auto answer_source =
    "kernel void f(global uint* out, uint x) { *out = 41u + x; }\nkernel void unused(uint x) {}";

/// Without the parameters of its kernels, a binary is not used.
constexpr auto build_options = "-cl-kernel-arg-info";

/// Runs the kernel on a new device.
void require_answer(const Device& on) {
    Kernel kernel(on, answer_source, "f");
    const Buffer<cl_uint> out(on, 1);
    kernel.run(1, out, cl_uint{1});
    REQUIRE(out.download()[0] == 42);
    REQUIRE_THROWS_AS(kernel.run(1, out, 1.0f), Error);  // the parameters are known
}

/// The program of a key on a new device: from a file or not.
bool is_stored(const std::string& source) {
    const Device on = Device::choose();
    return on.state()->programs.get(source, build_options).stored_log.has_value();
}

void store(const std::string& source) {
    const Device on = Device::choose();
    (void)on.state()->programs.get(source, build_options);
    on.state()->programs.store();
}

TEST_CASE("a program is built once, and loaded by the next device") {
    const ProgramCacheDirectory cache;
    for (int i = 0; i < 2; ++i) {
        const Device on = Device::choose();
        on.prepare([&] { require_answer(on); });
    }
    REQUIRE(std::distance(fs::directory_iterator(cache.programs()), {}) == 1);
    REQUIRE_FALSE(is_stored(answer_source));  // the library adds its own text and options
    store(answer_source);
    REQUIRE(is_stored(answer_source));
    const Device on = Device::choose();
    const Program program = on.state()->programs.get(answer_source, build_options);
    REQUIRE(program.program() == on.state()->programs.get(answer_source, build_options).program());
    REQUIRE_FALSE(
        on.state()->programs.get(answer_source, "-cl-kernel-arg-info -DX").stored_log.has_value());
}

TEST_CASE("a program from a file has the log of its build") {
    const ProgramCacheDirectory cache;
    const std::string source = "#warning careful\nkernel void f(global uint* out) { *out = 1; }";
    const Device first = Device::choose();
    const Kernel kernel(first, source, "f");
    first.prepare([&] { Kernel(first, source, "f"); });
    INFO(kernel.log());
    REQUIRE(contains(kernel.log(), "kernel:1:"));
    REQUIRE(contains(kernel.log(), "careful"));
    const Device second = Device::choose();
    REQUIRE(Kernel(second, source, "f").log() == kernel.log());
}

TEST_CASE("files that the driver does not take are built again") {
    const ProgramCacheDirectory cache;
    store(answer_source);
    const ProgramFiles files(device().info());
    const std::string key = std::string(build_options) + '\0' + answer_source;
    const detail::StoredProgram stored = files.load(key).value();
    std::vector<std::string> binaries{"", "x", "x" + stored.binary};
    if (device().info().platform == "Portable Computing Language") {
        // PoCL writes a hash of itself, of LLVM and of the device after the first 8 bytes.
        binaries.push_back(stored.binary);
        binaries.back()[10] = static_cast<char>(binaries.back()[10] ^ 1);
    }
    for (const std::string& binary : binaries) {
        INFO(binary.size() << " bytes");
        files.store(key, {"", binary});
        REQUIRE_FALSE(is_stored(answer_source));
    }
    store(answer_source);
    REQUIRE(is_stored(answer_source));
}

TEST_CASE("files that are damaged are built again") {
    const ProgramCacheDirectory cache;
    store(answer_source);
    const fs::path path = fs::directory_iterator(cache.programs())->path();
    const std::uintmax_t size = fs::file_size(path);
    for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{50}, size / 2, size - 1}) {
        fs::resize_file(path, kept);
        REQUIRE_FALSE(is_stored(answer_source));
        store(answer_source);
        REQUIRE(is_stored(answer_source));
    }
    {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(size / 2));
        file << "garbled";
    }
    REQUIRE_FALSE(is_stored(answer_source));
}

TEST_CASE("a cache that cannot be written changes nothing") {
    const ProgramCacheDirectory cache;
    std::ofstream(cache.path / "cellist") << "a file in the place of the folder";
    const auto use = [] {
        const Device on = Device::choose();
        on.prepare([&] { require_answer(on); });
    };
    use();
    const Variable nowhere("CELLIST_PROGRAM_CACHE", "/proc/cellist");
    use();
    const Variable off("CELLIST_PROGRAM_CACHE", "off");
    use();
    REQUIRE(fs::is_regular_file(cache.path / "cellist"));
}

TEST_CASE("sources with mistakes, and those that include files, are in no cache") {
    const ProgramCacheDirectory cache;
    std::ofstream(cache.path / "value.h") << "#define VALUE 7\n";
    const std::string option = "-I" + cache.path.string();
    for (int i = 0; i < 2; ++i) {
        const Device on = Device::choose();
        const Source source{
            .text = "#include \"value.h\"\nkernel void f(global uint* out) { *out = VALUE; }",
            .options = option};
        on.prepare([&] {
            const auto error = error_of<OpenClError>(
                [&] { Kernel(on, "kernel void f(global uint* out) { *out = missing; }", "f"); });
            REQUIRE(error.call() == "clBuildProgram");
            REQUIRE(contains(error.log(), "missing"));
            Kernel(on, source, "f");
        });
    }
    REQUIRE_FALSE(fs::exists(cache.programs()));
}

TEST_CASE("none of the library's own programs has a warning") {
    const ProgramCacheDirectory cache;
    {
        const Device on = Device::choose();
        const auto use = [&](const ListsOptions& options) {
            Lists<Item> lists(on, {64}, options);
            Kernel insert(on, R"(
                #include <cellist/lists.clh>
                kernel void insert(CELLIST_LISTS(Item, lists)) {
                    const uint i = get_global_id(0);
                    cellist_insert(lists, i % 64u, (Item){(float)(i % 1000u), i});
                })",
                          "insert", lists);
            lists.build(insert, Range::padded(100'000));
            lists.sort(&Item::key);
            lists.sort_by("record.id ^ 1u");
            lists.partial_sort(&Item::key, 2);
            lists.sort_async(&Item::id);
            (void)lists.lengths();
            (void)lists.download();
            (void)lists.pack(&Item::id);
            REQUIRE(lists.validate().ok());
        };
        on.prepare([&] {
            for (const Storage storage : all_storages) use({.storage = storage});
            use({.storage = nearest(&Item::key, 4)});
        });
    }
    std::size_t programs = 0;
    for (const auto& entry : fs::directory_iterator(cache.programs())) {
        std::ifstream file(entry.path(), std::ios::binary);
        std::string line;
        std::getline(file, line);
        REQUIRE(line == "cellist program 1");
        std::getline(file, line);
        std::size_t log = 1;
        file >> log;
        file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
        std::string text(log, ' ');
        file.read(text.data(), static_cast<std::streamsize>(log));
        INFO(text);
        REQUIRE(log == 0);
        ++programs;
    }
    REQUIRE(programs > 10);
}

}  // namespace
}  // namespace cellist::test
