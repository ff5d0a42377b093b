// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "oit/support/program.hpp"

namespace cellist::test {

/// Adds the keys of a value and of all that it holds.
inline void add_keys(const nlohmann::ordered_json& value, std::set<std::string>& keys) {
    if (value.is_object())
        for (const auto& [key, member] : value.items()) {
            keys.insert(key);
            add_keys(member, keys);
        }
    else if (value.is_array())
        for (const nlohmann::ordered_json& member : value) add_keys(member, keys);
}

/// A JSON file in the folder of a program.
inline nlohmann::ordered_json json_in(const Program& program, const char* name) {
    return nlohmann::ordered_json::parse(read_file(program.folder() / name));
}

}  // namespace cellist::test
