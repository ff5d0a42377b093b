// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <stdexcept>
#include <string>

#include <cellist/cellist.hpp>

#include "support/distribution.h"

namespace bench {

/// The records of the benchmarks, named by their size in bytes. A node of a linked list also has a
/// link of 4 bytes.
struct Record4 {
    cl_uint key;
};
struct Record12 {
    cl_uint key, b, c;
};
struct Record28 {
    cl_uint key, b, c, d, e, f, g;
};
CELLIST_STRUCT(Record4, key);
CELLIST_STRUCT(Record12, key, b, c);
CELLIST_STRUCT(Record28, key, b, c, d, e, f, g);

template <class Record>
inline constexpr cl_uint words_of = sizeof(Record) / sizeof(cl_uint);

template <class Record>
Record record_of(cl_uint i) {
    std::array<cl_uint, words_of<Record>> words;
    for (cl_uint j = 0; j < words.size(); ++j) words[j] = bench_word(i, j);
    return std::bit_cast<Record>(words);
}

template <class Record>
cl_uint digest_of(const Record& record) {
    const auto words = std::bit_cast<std::array<cl_uint, words_of<Record>>>(record);
    cl_uint digest = 0;
    for (cl_uint j = 0; j < words.size(); ++j) digest += bench_digest_word(words[j], j);
    return digest;
}

/// Calls `call.template operator()<Record>()` with the record whose linked node has `node_bytes`.
template <class Call>
auto with_record(cl_uint node_bytes, const Call& call) {
    switch (node_bytes) {
        case 8:
            return call.template operator()<Record4>();
        case 16:
            return call.template operator()<Record12>();
        case 32:
            return call.template operator()<Record28>();
        default:
            throw std::invalid_argument("nodes have 8, 16 or 32 bytes, not " +
                                        std::to_string(node_bytes));
    }
}

}  // namespace bench
