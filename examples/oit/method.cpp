#include "method.hpp"

#include <algorithm>

#include "input_error.hpp"

namespace oit {
namespace {

std::vector<MethodInfo>& table() {
    static std::vector<MethodInfo> methods;
    return methods;
}

}  // namespace

MethodRegistration::MethodRegistration(const MethodInfo& info) {
    std::vector<MethodInfo>& methods = table();
    const auto behind = std::find_if(methods.begin(), methods.end(), [&](const MethodInfo& other) {
        return other.position > info.position;
    });
    methods.insert(behind, info);
}

std::span<const MethodInfo> methods() { return table(); }

const MethodInfo& method_named(std::string_view name) {
    std::string names;
    for (const MethodInfo& info : table()) {
        if (info.name == name) return info;
        names.append(names.empty() ? "" : ", ").append(info.name);
    }
    throw support::InputError("no method is called '" + std::string(name) + "': there are " +
                              names);
}

std::string refuses_nothing(const Frame&, const Needs&) { return {}; }

}  // namespace oit
