// SPDX-License-Identifier: MIT
#include "beside.hpp"

#include <algorithm>
#include <system_error>

namespace support {

std::optional<std::filesystem::path> path_beside(const std::filesystem::path& mesh,
                                                 const std::string& name) {
    const std::filesystem::path relative(name);
    const bool has_controls = std::any_of(
        name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; });
    if (name.empty() || has_controls || relative.is_absolute()) return std::nullopt;

    const std::filesystem::path parent = mesh.has_parent_path() ? mesh.parent_path() : ".";
    std::error_code error;
    const auto folder = std::filesystem::weakly_canonical(parent, error);
    if (error) return std::nullopt;
    const auto path = std::filesystem::weakly_canonical(folder / relative, error);
    if (error) return std::nullopt;
    const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    if (end != folder.end() || rest == path.end()) return std::nullopt;
    return path;
}

}  // namespace support
