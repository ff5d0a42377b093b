// SPDX-License-Identifier: MIT
// Structs of any members: the library's definition of them against the alignment rules of OpenCL C
// and x86-64, which stand in this file, and against what the device says.
//
// Input: what to do, one to three structs, the seed of the records.
#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include <cellist/detail/build.hpp>
#include <cellist/detail/lists_core.hpp>
#include <cellist/kernel.hpp>

#include "input.hpp"

namespace cellist::fuzz {
namespace {

using detail::Definitions;
using detail::RecordMember;
using detail::RecordType;

/// A scalar inside of a struct.
struct Scalar {
    std::string path;  ///< e.g. "rows[1].position.s2"
    std::string type;  ///< e.g. "float"
    std::size_t offset;
    std::size_t size;
};

/// A type that members can have.
struct Type {
    std::string name;
    std::size_t size;
    std::size_t alignment;
    std::vector<Scalar> scalars;
};

constexpr std::size_t scalars_max = 40;

std::size_t up(std::size_t value, std::size_t alignment) {
    while (value % alignment != 0) ++value;
    return value;
}

void add_scalars(const Type& type, const std::string& path, std::size_t offset,
                 std::vector<Scalar>& out) {
    for (const Scalar& scalar : type.scalars)
        out.push_back({path + scalar.path, scalar.type, offset + scalar.offset, scalar.size});
}

/// A scalar or a vector: aligned to its size, in every version of OpenCL C.
Type take_builtin(Input& input) {
    constexpr std::pair<const char*, std::size_t> bases[] = {
        {"char", 1}, {"uchar", 1}, {"short", 2}, {"ushort", 2}, {"int", 4},
        {"uint", 4}, {"long", 8},  {"ulong", 8}, {"float", 4},  {"double", 8}};
    constexpr std::size_t counts[] = {1, 1, 1, 2, 4, 8, 16};
    const auto& [base, size] = bases[input.below(std::size(bases))];
    const std::size_t count = counts[input.below(std::size(counts))];
    Type type{base, size * count, size * count, {}};
    if (count == 1) type.scalars.push_back({"", base, 0, size});
    if (count > 1) {
        type.name += std::to_string(count);
        for (std::size_t i = 0; i < count; ++i)
            type.scalars.push_back(
                {std::string(".s") + "0123456789abcdef"[i], base, i * size, size});
    }
    return type;
}

/// A name that was not taken before, often one that the library's kernels use too.
std::string take_name(Input& input, std::set<std::string>& taken) {
    constexpr const char* names[] = {"Hit",   "node",  "cell", "key",   "record", "lists", "next",
                                     "a",     "b",     "x",    "y",     "k",      "out",   "found",
                                     "at",    "nodes", "view", "heads", "T",      "size",  "length",
                                     "node_", "keys",  "last", "child", "i",      "j"};
    std::string name = names[input.below(std::size(names))];
    while (!taken.insert(name).second) name += std::to_string(taken.size());
    return name;
}

/// A struct by the rules, and the same as the library describes it.
struct Struct {
    Type type;
    RecordType record;
};

Struct take_struct(Input& input, const std::vector<Struct>& known, std::set<std::string>& taken) {
    Struct out;
    out.type = {take_name(input, taken), 0, 1, {}};
    std::set<std::string> members;
    std::size_t end = 0;
    for (std::size_t i = input.below(7) + 1; i > 0; --i) {
        const std::size_t choice = input.below(8);
        const Type type = choice < known.size() ? known[choice].type : take_builtin(input);
        RecordMember member{take_name(input, members), type.name, {}, 0, {}, false};
        std::vector<std::size_t> extents(std::max<std::size_t>(input.below(6), 3) - 3);
        std::size_t count = 1;
        for (std::size_t& extent : extents) count *= extent = input.below(3) + 1;
        if (count * type.scalars.size() > scalars_max) extents.clear(), count = 1;
        if (out.type.scalars.size() + count * type.scalars.size() > scalars_max) break;
        for (const std::size_t extent : extents)
            member.extents += "[" + std::to_string(extent) + "]";
        const std::size_t offset = up(end, type.alignment);

        std::vector<Scalar> added;
        for (std::size_t n = 0; n < count; ++n) {
            std::string path = member.name;
            for (std::size_t d = 0, rest = n, stride = count; d < extents.size(); ++d) {
                stride /= extents[d];
                path += "[" + std::to_string(rest / stride) + "]";
                rest %= stride;
            }
            add_scalars(type, path, offset + n * type.size, added);
        }
        end = offset + count * type.size;
        out.type.alignment = std::max(out.type.alignment, type.alignment);
        member.offset = offset;
        member.is_scalar =
            extents.empty() && type.scalars.size() == 1 && type.scalars[0].path.empty();
        for (const Scalar& scalar : added) member.scalars.push_back("." + scalar.path);
        out.record.members.push_back(member);
        for (Scalar& scalar : added) {
            scalar.path.insert(0, ".");
            out.type.scalars.push_back(std::move(scalar));
        }
    }
    out.type.size = up(end, out.type.alignment);
    out.record.name = out.type.name;
    out.record.size = out.type.size;
    out.record.alignment = out.type.alignment;
    return out;
}

// ---- what the device says about the layout

/// Sizes, alignments and offsets as differences of addresses, of all structs.
std::string report_source(const std::vector<Struct>& structs) {
    std::string text, values;
    std::size_t count = 0;
    const auto report = [&](const std::string& value) {
        values += "    report_[" + std::to_string(count++) + "] = (uint)(" + value + ");\n";
    };
    for (const Struct& known : structs) {
        const std::string& name = known.type.name;
        text += "typedef struct { uchar first_; " + name + " second_; } aligned_" + name + "_;\n";
        values += "    global " + name + "* p_" + name + "_ = (global " + name + "*)report_;\n";
        values += "    global aligned_" + name + "_* q_" + name + "_ = (global aligned_" + name +
                  "_*)report_;\n";
        report("sizeof(" + name + ")");
        report("(global uchar*)&q_" + name + "_->second_ - (global uchar*)q_" + name + "_");
        for (const Scalar& scalar : known.type.scalars) {
            // The address of a vector's component cannot be taken; its number is its place.
            const std::size_t dot = scalar.path.rfind(".s");
            const bool component = dot != std::string::npos && dot + 3 == scalar.path.size() &&
                                   std::isxdigit(scalar.path.back()) != 0;
            report("(global uchar*)&p_" + name + "_->" +
                   (component ? scalar.path.substr(1, dot - 1) : scalar.path.substr(1)) +
                   " - (global uchar*)p_" + name + "_" +
                   (component ? " + " + std::to_string(scalar.size) + " * 0x" + scalar.path.back()
                              : std::string()));
        }
    }
    return text + "kernel void report_layout_(global uint* report_)\n{\n" + values + "}\n";
}

void compare_with_device(const Device& device, const std::vector<Struct>& structs,
                         const Definitions& definitions) {
    std::vector<cl_uint> expected;
    for (const Struct& known : structs) {
        expected.push_back(static_cast<cl_uint>(known.type.size));
        expected.push_back(static_cast<cl_uint>(known.type.alignment));
        for (const Scalar& scalar : known.type.scalars)
            expected.push_back(static_cast<cl_uint>(scalar.offset));
    }
    const Buffer<cl_uint> report(device, expected.size());
    Kernel kernel(device.state(), Source{.text = report_source(structs)}, "report_layout_",
                  definitions);
    kernel.run(1, report);
    CELLIST_FUZZ_REQUIRE(report.download() == expected);
}

/// What the library says about a description that is wrong.
std::string refusal_of(const Device& device, const Definitions& definitions) {
    try {
        Kernel(device.state(), Source{.text = "kernel void nothing_(uint parameter) {}"},
               "nothing_", definitions);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

void refuse_wrong_layout(const Device& device, Input& input, Definitions definitions) {
    RecordType& record = definitions.records[input.below(definitions.records.size())];
    const std::size_t by = input.below(16) + 1;
    const std::size_t choice = input.below(record.members.size() + 1);
    if (choice == 0)
        record.size += by;
    else
        record.members[choice - 1].offset += by;
    const std::string refusal = refusal_of(device, definitions);
    CELLIST_FUZZ_REQUIRE(refusal.find("the layout of a struct differs") != std::string::npos);
    CELLIST_FUZZ_REQUIRE(refusal.find(record.name) != std::string::npos);

    Definitions twice = definitions;
    try {
        record.members.front().type += "x";
        twice.add(record);
        CELLIST_FUZZ_REQUIRE(false && "another struct of this name is refused");
    } catch (const Error& error) {
        CELLIST_FUZZ_REQUIRE(std::string(error.what()).find(record.name) != std::string::npos);
    }
}

// ---- records through a container

using Bytes = std::vector<unsigned char>;

template <class T>
T read(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// Less than 0, 0 or more: the order of two values of a scalar's type.
int order(const std::string& type, const unsigned char* a, const unsigned char* b) {
    const auto compare = [&]<class T>(T) {
        const T x = read<T>(a), y = read<T>(b);
        return x < y ? -1 : y < x ? 1 : 0;
    };
    // -0 comes before +0; there are no NaNs.
    const auto compare_float = [&]<class T>(T) {
        const int by_value = compare(T{});
        return by_value != 0 ? by_value : std::signbit(read<T>(b)) - std::signbit(read<T>(a));
    };
    if (type == "char") return compare(cl_char{});
    if (type == "uchar") return compare(cl_uchar{});
    if (type == "short") return compare(cl_short{});
    if (type == "ushort") return compare(cl_ushort{});
    if (type == "int") return compare(cl_int{});
    if (type == "uint") return compare(cl_uint{});
    if (type == "long") return compare(cl_long{});
    if (type == "ulong") return compare(cl_ulong{});
    if (type == "float") return compare_float(cl_float{});
    CELLIST_FUZZ_REQUIRE(type == "double");
    return compare_float(cl_double{});
}

/// A record's values without its padding, one behind the other.
Bytes values_of(const Type& type, const unsigned char* record) {
    Bytes values;
    for (const Scalar& scalar : type.scalars)
        values.insert(values.end(), record + scalar.offset, record + scalar.offset + scalar.size);
    return values;
}

/// Records of random values, often equal ones; no float is a NaN.
Bytes random_records(const Type& type, std::size_t count, std::mt19937& random) {
    Bytes bytes(count * type.size);
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random());
    for (std::size_t i = 0; i < count; ++i)
        for (const Scalar& scalar : type.scalars) {
            unsigned char* value = &bytes[i * type.size + scalar.offset];
            if (random() % 2 == 0) std::fill_n(value, scalar.size, static_cast<unsigned char>(0));
            if (scalar.type == "float" || scalar.type == "double")
                value[scalar.size - 1] &= 0xBF;  // an exponent without its highest bit
        }
    return bytes;
}

/// Inserts records, sorts them by a scalar and downloads them.
void compare_records(const Device& device, Input& input, const Struct& record,
                     const Definitions& definitions) {
    const Type& type = record.type;
    const std::size_t cells = 3, count = input.below(120) + 1;
    std::mt19937 random(input.number<std::uint16_t>());
    const Bytes records = random_records(type, count, random);
    std::vector<cl_uint> cell_of(count);
    for (cl_uint& cell : cell_of) cell = static_cast<cl_uint>(random() % cells);
    const Scalar& key = type.scalars[input.below(type.scalars.size())];
    const bool descending = input.below(2) == 1;
    const auto storage = static_cast<Storage>(input.below(3));

    const auto core = std::make_shared<detail::ListsCore>(device.state(), definitions, Shape{cells},
                                                          ListsOptions{.storage = storage});
    detail::ListsCore& lists = *core;
    Definitions with_modes = definitions;
    with_modes.modes = lists.mode();
    Kernel insert(device.state(),
                  Source{.text = "kernel void insert_all_(CELLIST_LISTS(" + type.name +
                                 ", lists_), global const uint* cells_, global const " + type.name +
                                 "* records_)\n{\n    const uint i_ = get_global_id(0);\n"
                                 "    cellist_insert(lists_, cells_[i_], records_[i_]);\n}\n"},
                  "insert_all_", with_modes);
    const Buffer<cl_uint> device_cells(device, cell_of);
    const Buffer<cl_uchar> device_records(device, std::vector<cl_uchar>(records));
    const auto build = detail::Build::start({&lists}, [&] {
        detail::Arguments arguments;
        lists.add_to(arguments);
        arguments.add(device_cells);
        arguments.add(device_records.cl());
        insert.enqueue(count, arguments);
    });
    const BuildReport report = build->finish().front();
    CELLIST_FUZZ_REQUIRE(report.stored == count && report.attempted == count);

    lists.sort({"record" + key.path, 64, descending ? Order::descending : Order::ascending},
               std::numeric_limits<std::uint32_t>::max());
    CELLIST_FUZZ_REQUIRE(lists.validate()().ok());
    Bytes found;
    std::vector<cl_uint> offsets;
    detail::ReadbackFence done;
    lists.download(done, offsets, [&](std::uint64_t total) -> void* {
        found.resize(total * type.size);
        return found.data();
    });
    done.wait();

    const auto at = [&](const Bytes& bytes, std::size_t i) { return &bytes[i * type.size]; };
    CELLIST_FUZZ_REQUIRE(found.size() == records.size());
    for (std::size_t cell = 0; cell < cells; ++cell) {
        std::vector<std::size_t> expected;
        for (std::size_t i = 0; i < count; ++i)
            if (cell_of[i] == cell) expected.push_back(i);
        std::sort(expected.begin(), expected.end(), [&](std::size_t i, std::size_t j) {
            const unsigned char *a = at(records, i), *b = at(records, j);
            if (const int by = order(key.type, a + key.offset, b + key.offset); by != 0)
                return descending ? by > 0 : by < 0;
            for (const Scalar& scalar : type.scalars)
                if (const int by = order(scalar.type, a + scalar.offset, b + scalar.offset);
                    by != 0)
                    return by < 0;
            return false;
        });
        CELLIST_FUZZ_REQUIRE(offsets[cell + 1] - offsets[cell] == expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
            CELLIST_FUZZ_REQUIRE(values_of(type, at(found, offsets[cell] + i)) ==
                                 values_of(type, at(records, expected[i])));
    }
}

void run(Input& input) {
    bool is_new = false;
    const Device& on = device(is_new);
    const std::size_t what = input.below(3);
    std::vector<Struct> structs;
    std::set<std::string> taken;
    Definitions definitions;
    for (std::size_t i = input.below(3) + 1; i > 0; --i) {
        structs.push_back(take_struct(input, structs, taken));
        definitions.add(structs.back().record);
    }
    definitions.needs_fp64 = true;
    if (what == 0)
        compare_with_device(on, structs, definitions);
    else if (what == 1)
        refuse_wrong_layout(on, input, definitions);
    else
        compare_records(on, input, structs.back(), definitions);
}

}  // namespace
}  // namespace cellist::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    cellist::fuzz::Input input(data, size);
    cellist::fuzz::run(input);
    return 0;
}
