#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

#include "comparison.hpp"
#include "mesh.hpp"
#include "options.hpp"
#include "renderer.hpp"

namespace oit {

/// The figures of a run.
struct Report {
    Options options;
    std::string device;
    std::string driver;
    std::uint64_t triangles = 0;
    support::MeshDrops drops;
    bool mesh_ends_within_line = false;
    std::uint64_t fragments = 0;
    std::uint64_t cells_nonempty = 0;
    std::uint64_t longest_list = 0;
    std::uint64_t pool_bytes = 0;
    std::uint64_t device_bytes = 0;
    PassTimes times;
    std::optional<Comparison> comparison;
};

/// One screen for people.
void print(const Report& report, std::ostream& out);

/// The same as JSON. Throws InputError where the file cannot be written.
void write_json(const Report& report, const std::filesystem::path& path);

}  // namespace oit
