#pragma once

#include <filesystem>
#include <span>

namespace shadows {

/// Writes values from 0 to `most` as colours from black over red and yellow to white, row by row
/// from the top, with a scale in the lower left corner; as they are to a format of floats. Throws
/// as support::write_file() does.
void write_heat_map(const std::filesystem::path& path, std::span<const double> values, double most,
                    int width, int height);

}  // namespace shadows
