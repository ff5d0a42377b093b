// SPDX-License-Identifier: MIT
// Writes the C++ source of a program's structs: generate_structs COUNT > structs.hpp
//
// Each struct S<n> has random members in random order, CELLIST_STRUCT, a function that visits its
// scalars in order, and a source with two kernels that take it apart and put it together by the
// members' names.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <vector>

namespace {

struct Scalar {
    std::string host;    ///< path in C++, e.g. ".m3[1].s[2]"
    std::string device;  ///< path in OpenCL C, e.g. ".m3[1].s2"
    std::string type;    ///< in OpenCL C
};

/// A type that members can have.
struct Type {
    std::string name;  ///< in C++
    std::vector<Scalar> scalars;
};

constexpr std::size_t scalars_max = 40;

class Generator {
public:
    void add_struct() {
        Type type{"S" + std::to_string(structs_.size()), {}};
        std::string members, names;
        const std::size_t count = below(8) + 1;
        for (std::size_t i = 0; i < count; ++i) {
            const Type of =
                structs_.empty() || below(5) != 0 ? builtin() : structs_[below(structs_.size())];
            std::vector<std::size_t> extents(std::max<std::size_t>(below(6), 3) - 3);
            std::size_t elements = 1;
            for (std::size_t& extent : extents) elements *= extent = below(3) + 1;
            if (elements * of.scalars.size() > scalars_max) extents.clear(), elements = 1;
            if (type.scalars.size() + elements * of.scalars.size() > scalars_max) break;

            const std::string name = "m" + std::to_string(i);
            members += "    " + of.name + " " + name;
            for (const std::size_t extent : extents) members += "[" + std::to_string(extent) + "]";
            members += ";\n";
            names += ", " + name;
            for (std::size_t n = 0; n < elements; ++n) {
                std::string path = "." + name;
                for (std::size_t d = 0, rest = n, stride = elements; d < extents.size(); ++d) {
                    stride /= extents[d];
                    path += "[" + std::to_string(rest / stride) + "]";
                    rest %= stride;
                }
                for (const Scalar& scalar : of.scalars)
                    type.scalars.push_back({path + scalar.host, path + scalar.device, scalar.type});
            }
        }
        structs_.push_back(type);
        std::cout << "struct " << type.name << " {\n"
                  << members << "};\n"
                  << "CELLIST_STRUCT(" << type.name << names << ");\n"
                  << "void visit(" << type.name << "& record, auto&& with) {\n";
        for (const Scalar& scalar : type.scalars)
            std::cout << "    with(record" << scalar.host << ");\n";
        std::cout << "}\n";
        write_kernels(type);
    }

    void write_list() const {
        std::cout << "#define CELLIST_GENERATED_STRUCTS";
        for (const Type& type : structs_)
            std::cout << " \\\n    CELLIST_GENERATED(" << type.name << ")";
        std::cout << "\n";
    }

private:
    std::size_t below(std::size_t end) { return random_() % end; }

    Type builtin() {
        struct Base {
            const char* device;
            std::array<const char*, 2> host;
        };
        static const std::array<Base, 10> bases{{{"char", {"cl_char", "std::int8_t"}},
                                                 {"uchar", {"cl_uchar", "unsigned char"}},
                                                 {"short", {"cl_short", "short"}},
                                                 {"ushort", {"cl_ushort", "std::uint16_t"}},
                                                 {"int", {"cl_int", "int"}},
                                                 {"uint", {"cl_uint", "unsigned"}},
                                                 {"long", {"cl_long", "long long"}},
                                                 {"ulong", {"cl_ulong", "std::uint64_t"}},
                                                 {"float", {"cl_float", "float"}},
                                                 {"double", {"cl_double", "double"}}}};
        constexpr std::array<std::size_t, 7> counts{1, 1, 1, 2, 4, 8, 16};
        const Base& base = bases[below(bases.size())];
        const std::size_t count = counts[below(counts.size())];
        if (count == 1) return {base.host[below(2)], {{"", "", base.device}}};
        Type type{"cl_" + std::string(base.device) + std::to_string(count), {}};
        for (std::size_t i = 0; i < count; ++i)
            type.scalars.push_back({".s[" + std::to_string(i) + "]",
                                    std::string(".s") + "0123456789abcdef"[i], base.device});
        return type;
    }

    static void write_kernels(const Type& type) {
        std::cout << "inline const std::string source_of_" << type.name << " =\n"
                  << "    \"kernel void take_apart(global const " << type.name
                  << "* records, global uchar* bytes) {\\n\"\n"
                  << "    \"    const " << type.name
                  << " record = records[get_global_id(0)];\\n\"\n"
                  << "    \"    records += get_global_id(0);\\n\"\n"
                  << "    \"    bytes += get_global_id(0) * BYTES;\\n\"\n";
        for (const Scalar& scalar : type.scalars)
            std::cout << "    \"    PUT(" << scalar.type << ", record" << scalar.device
                      << ")\\n\"\n";
        std::cout << "    \"}\\n\"\n"
                  << "    \"kernel void put_together(CELLIST_LISTS(" << type.name
                  << ", lists), global const uchar* bytes) {\\n\"\n"
                  << "    \"    " << type.name << " record;\\n\"\n"
                  << "    \"    bytes += get_global_id(0) * BYTES;\\n\"\n";
        for (const Scalar& scalar : type.scalars)
            std::cout << "    \"    TAKE(" << scalar.type << ", record" << scalar.device
                      << ")\\n\"\n";
        std::cout << "    \"    cellist_insert(lists, get_global_id(0), record);\\n\"\n"
                  << "    \"}\\n\";\n";
    }

    std::mt19937 random_{3};
    std::vector<Type> structs_;
};

}  // namespace

int main(int count, char** arguments) {
    const int structs = count == 2 ? std::atoi(arguments[1]) : 0;
    if (structs < 1) {
        std::cerr << "usage: generate_structs COUNT\n";
        return 2;
    }
    Generator generator;
    for (int i = 0; i < structs; ++i) generator.add_struct();
    generator.write_list();
    return std::cout.good() ? 0 : 1;
}
