// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "budget/budget_search.hpp"
#include "frame_options.hpp"
#include "picture_name.hpp"

namespace oit {

/// What the command line asks for.
struct Options : FrameOptions {
    std::string method = "linked";
    std::optional<std::uint64_t> memory_bytes = {};  ///< that the method may take
    std::optional<Budget> budget = {};               ///< chooses method and setting
    std::uint32_t check_every = 1;                   ///< of the frames that change, within a budget
    double search_seconds = SearchOptions{}.seconds;  ///< as SearchOptions::seconds
    std::optional<double> until = {};  ///< the last frame's time; the first is at `time`
    double turn_degrees = 0;           ///< from the first frame to the last
    bool reference = false;
    support::PictureName out{"oit.png"};
    std::filesystem::path write_reference = {};   ///< asks for `reference`, too
    std::filesystem::path write_difference = {};  ///< asks for `reference`, too
    std::filesystem::path heatmap = {};
    std::filesystem::path json = {};
    std::uint32_t frames = 5;
    bool mpi = false;  ///< over the ranks of mpirun
    /// The part of the triangles that this process draws. The first process writes all files.
    raster::Share share = {};
    [[nodiscard]] bool writes() const { return share.index == 0; }
    /// Whether frames show different moments.
    [[nodiscard]] bool moves() const { return until || turn_degrees != 0; }
    /// Whether a file goes to stdout, so that the report goes to stderr.
    [[nodiscard]] bool writes_to_stdout() const;

    std::string help_text = {};  ///< to be printed instead, where it is not empty
};

/// Reads and checks the command line, with the paths of the output, and the file of a blend
/// function. Throws InputError where an argument cannot be used.
[[nodiscard]] Options parse_options(int count, const char* const* arguments);

}  // namespace oit
