// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include <cellist/detail/record_type.hpp>
#include <cellist/error.hpp>
#include <cellist/struct.hpp>

#include "cellist_kernels.hpp"

namespace cellist::detail {

namespace {

bool same_layout(const RecordType& a, const RecordType& b) {
    return a.size == b.size && a.alignment == b.alignment &&
           std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
                      [](const RecordMember& x, const RecordMember& y) {
                          return x.name == y.name && x.type == y.type && x.extents == y.extents &&
                                 x.offset == y.offset;
                      });
}

/// The end of a line that only exists because of a record, or of one of its members: says so where
/// the compiler complains.
std::string because_of(const RecordType& record) { return "  // " + record.type() + "\n"; }
std::string because_of(const RecordType& record, const RecordMember& member) {
    if (!record.is_struct) return because_of(record);
    return "  // member " + member.name + " of " + record.type() + "\n";
}

std::string struct_definition(const RecordType& record) {
    if (!record.is_struct) return {};
    std::string text = "typedef struct " + record.name + " {" + because_of(record);
    for (const RecordMember& member : record.members)
        text += "    " + member.type + " " + member.name + member.extents + ";" +
                because_of(record, member);
    return text + "} " + record.name + ";" + because_of(record);
}

/// Arrays of negative size where the device's compiler disagrees with the host's.
std::string layout_checks(const RecordType& record) {
    const auto check = [&](std::size_t number, const std::string& value, std::size_t expected) {
        return "typedef char cellist_layout_of_" + record.name + "_" + std::to_string(number) +
               "[(" + value + " == " + std::to_string(expected) + ") ? 1 : -1];";
    };
    std::string text = check(0, "sizeof(" + record.type() + ")", record.size) + because_of(record);
    if (!record.is_struct) return text;
    for (std::size_t i = 0; i < record.members.size(); ++i) {
        const RecordMember& member = record.members[i];
        text += check(i + 1, "__builtin_offsetof(" + record.type() + ", " + member.name + ")",
                      member.offset) +
                because_of(record, member);
    }
    return text;
}

/// Elements of arrays that are compared one by one: longer arrays take a loop, and compile as fast.
constexpr std::size_t unrolled_max = 16;

/// The scalars of each element of a member that is an array, after ".name[i]"; none of other
/// members.
std::vector<std::string> element_scalars(const RecordMember& member, std::size_t& elements) {
    elements = member.extents.empty() ? 0 : std::stoul(member.extents.substr(1));
    if (elements <= unrolled_max) return {};
    const std::size_t first = member.name.size() + std::string_view(".[0]").size();
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < member.scalars.size() / elements; ++i)
        parts.push_back(member.scalars[i].substr(first));
    return parts;
}

/// Whether record a comes before record b: by the member that `key` means, then by all members. One
/// function takes records, the other pointers to records of any size that stay where they are.
std::string order_definition(const RecordType& record) {
    const auto define = [&](const std::string& type, const std::string& a, const std::string& b) {
        const auto compare = [&](const std::string& path) {
            return "x = cellist_order(" + a + path + "), y = cellist_order(" + b + path + ");";
        };
        std::string text = "static inline int CELLIST_OVERLOAD cellist_record_before(" + type +
                           " a, " + type +
                           " b, uint key)\n{\n    ulong x = 0, y = 0;\n    switch (key) {\n";
        for (const RecordMember& member : record.members)
            if (member.is_scalar && record.is_struct)
                text += "    case cellist_key_" + member.name + ": " +
                        compare(member.scalars.front()) + " break;" + because_of(record, member);
        text += "    default: break;\n    }\n    if (x != y) return x < y;\n";
        for (const RecordMember& member : record.members) {
            std::size_t elements = 0;
            const std::vector<std::string> parts = element_scalars(member, elements);
            if (!parts.empty())
                text += "    for (uint i = 0; i < " + std::to_string(elements) + "u; ++i) {\n";
            for (const std::string& part : parts)
                text += "    " + compare("." + member.name + "[i]" + part) +
                        because_of(record, member) + "    if (x != y) return x < y;\n";
            if (!parts.empty()) {
                text += "    }\n";
                continue;
            }
            for (const std::string& path : member.scalars)
                text += "    " + compare(path) + because_of(record, member) +
                        "    if (x != y) return x < y;\n";
        }
        return text + "    return 0;\n}\n";
    };
    return define(record.type(), "a", "b") +
           define("global const " + record.type() + "*", "(*a)", "(*b)");
}

/// The words of a record's key for nearest.clh, and their number: those of a member, then those of
/// all.
std::string words_definition(const RecordType& record) {
    std::string members = "    switch (member) {\n";
    std::string lengths = members;
    const auto word_of = [](const std::string& path) {
        const std::string words = "cellist_words_of(record" + path + ")";
        return "if (word < " + words + ") return cellist_word_of(record" + path +
               ", word); word -= " + words + ";";
    };
    const auto add_words_of = [](const std::string& path) {
        return "words += cellist_words_of((*record)" + path + ");";
    };
    for (std::size_t i = 0; i < record.members.size(); ++i) {
        const RecordMember& member = record.members[i];
        if (!member.is_scalar) continue;
        const std::string begin = "    case " + std::to_string(i) + ": ";
        members += begin + word_of(member.scalars.front()) + " break;\n";
        lengths += begin + add_words_of(member.scalars.front()) + " break;\n";
    }
    members += "    default: break;\n    }\n";
    lengths += "    default: break;\n    }\n";
    for (std::size_t i = 0; i < record.members.size(); ++i) {
        // The member itself is not compared again.
        const RecordMember& member = record.members[i];
        const std::string other = "    if (member != " + std::to_string(i) + ") {\n";
        if (member.is_scalar) members += other, lengths += other;
        for (const std::string& path : member.scalars) {
            members += "    " + word_of(path) + "\n";
            lengths += "    " + add_words_of(path) + "\n";
        }
        if (member.is_scalar) members += "    }\n", lengths += "    }\n";
    }
    return "static inline uint CELLIST_OVERLOAD cellist_record_word(" + record.type() +
           " record, uint member, uint word)\n{\n" + members + "    return 0;\n}\n" +
           "static inline uint CELLIST_OVERLOAD cellist_record_words(" + record.type() +
           "* record, uint member)\n{\n    uint words = 0;\n" + lengths + "    return words;\n}\n";
}

}  // namespace

std::string RecordType::definition() const {
    return struct_definition(*this) + layout_checks(*this);
}

void Definitions::add(const RecordType& record) {
    const auto known = std::find_if(records.begin(), records.end(), [&](const RecordType& other) {
        return other.name == record.name;
    });
    if (known == records.end())
        records.push_back(record);
    else if (!same_layout(*known, record))
        throw Error("two different structs are called " + record.name +
                    ": kernels know structs by their plain name");
}

void Definitions::add(const std::string& text) {
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
}

void Definitions::add(const Definitions& other) {
    for (const std::string& text : other.texts) add(text);
    for (const RecordType& record : other.records) add(record);
    needs_fp64 = needs_fp64 || other.needs_fp64;
    modes |= other.modes;
}

std::string Definitions::source() const {
    std::string text;
    for (const std::string& definition : texts) text += definition + "\n";

    // One number for each member name, 1 and up; 0 is no key.
    std::map<std::string, std::size_t> keys;
    for (const RecordType& record : records)
        for (const RecordMember& member : record.members)
            if (member.is_scalar && record.is_struct) keys.emplace(member.name, keys.size() + 1);
    for (const auto& [name, number] : keys)
        text += "#define cellist_key_" + name + " " + std::to_string(number) + "u\n";

    for (const RecordType& record : records) {
        text += "#define cellist_type_" + record.name + " " + record.type() + "\n";
        text += record.definition() + order_definition(record);
        text += "#if CELLIST_MODES & (CELLIST_THRESHOLD_PASS | CELLIST_SELECTION_PASS)\n" +
                words_definition(record) + "#endif\n";
        text += "CELLIST_DEFINE_NODE(" + record.name + ", " +
                std::to_string(node_layout(record).alignment) + ")" + because_of(record);
        text += "CELLIST_DEFINE_RECORD(" + record.name + ")" + because_of(record);
    }
    return text;
}

NodeLayout node_layout(const RecordType& record) {
    constexpr std::size_t link = sizeof(cl_uint);
    const std::size_t least = std::max(record.alignment, link);
    const std::size_t size = round_up(round_up(record.size, link) + link, least);
    // A node of 8 or 16 bytes, or a multiple, can be moved in one go if it is aligned to that.
    const std::size_t natural = size % 16 == 0 ? 16 : size % 8 == 0 ? 8 : 4;
    return {size, std::max(least, natural)};
}

std::string glm_source() { return std::string(kernels::glm_clh); }

}  // namespace cellist::detail
