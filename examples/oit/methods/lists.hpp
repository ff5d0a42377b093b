// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <cellist/options.hpp>

#include "methods/method.hpp"

namespace oit {

/// What reads lists: a kernel whose parameters are the lists and OIT_SCREEN.
struct ListReader {
    std::string text;
    std::string file_name;
    std::string kernel;
    bool needs_sorted = true;  ///< lists are sorted before it runs
};

/// The source of the pass that puts fragments into lists: see FragmentSource::pass().
[[nodiscard]] std::string_view list_pass();

/// The reader that blends a picture of the quality of the frame, nearest first.
[[nodiscard]] ListReader list_reader(FragmentSource& source);

/// The method that keeps fragments in cellist::Lists with these options, and blends them nearest
/// first; or leaves that to another reader. Under Frame::memory_bytes, a slice of the pixels at a
/// time.
[[nodiscard]] std::unique_ptr<Method> make_list_method(
    FragmentSource& source, const cellist::ListsOptions& options,
    const std::optional<ListReader>& reader = {});

/// The same, or the picture through the frame's lens, which has all layers at once.
[[nodiscard]] std::unique_ptr<Method> make_layer_method(FragmentSource& source,
                                                        const cellist::ListsOptions& options);

}  // namespace oit
