// SPDX-License-Identifier: MIT
#include "mtl.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "input_error.hpp"
#include "read_file.hpp"
#include "text.hpp"
#include "text_lines.hpp"

namespace support {
namespace {

constexpr std::uint64_t most_bytes_of_materials = std::uint64_t{1} << 26;

class MtlReader {
public:
    MtlReader(const std::filesystem::path& path, MtlLibrary& library)
        : path_(path),
          library_(library),
          text_(read_file("material file", path, most_bytes_of_materials)) {}

    bool read() {
        TextLines lines(text_);
        std::vector<std::string_view> words;
        while (lines.next()) {
            line_ = lines.number();
            split(without_comment(lines.line()), words);
            if (words.empty()) continue;
            if (words[0] == "newmtl")
                begin(name_of(lines.line()));
            else if (material_ != nullptr)
                add(words);
        }
        return lines.is_open();
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(quoted("material file", path_) + ", line " + std::to_string(line_) + ": " +
                         what);
    }

    void begin(std::string_view name) {
        const auto [entry, is_new] = library_.try_emplace(std::string(name));
        entry->second.look.name = name;
        material_ = is_new ? &entry->second : &ignored_;
        has_dissolve_ = false;
    }

    // A value from 0 to 1. Some exporters write more than 1 for the brightest.
    [[nodiscard]] float fraction(std::string_view keyword, std::string_view word) const {
        const std::optional<double> value = parse_number(word);
        if (!value || !std::isfinite(*value) || *value < 0)
            fail("'" + std::string(keyword) + "' needs numbers from 0 to 1");
        return static_cast<float>(std::min(*value, 1.0));
    }

    void add(const std::vector<std::string_view>& words) {
        const std::string_view keyword = words[0];
        if (keyword == "Kd") {
            // "Kd spectral FILE" and "Kd xyz X Y Z" are rare, and not supported.
            if (words.size() != 2 && words.size() != 4)
                fail("'Kd' has " + std::to_string(words.size() - 1) +
                     " values; it needs red, green and blue");
            glm::vec3 colour;
            for (int i = 0; i < 3; ++i)
                colour[i] = fraction(
                    keyword, words[words.size() == 2 ? 1 : static_cast<std::size_t>(i) + 1]);
            material_->look.base_colour = colour;
        } else if (keyword == "d" || keyword == "Tr") {
            // With "d -halo" the opacity changes towards the silhouette; the factor is that of the
            // middle.
            const std::size_t at = words.size() > 1 && words[1] == "-halo" ? 2 : 1;
            if (words.size() != at + 1) fail("'" + std::string(keyword) + "' needs one number");
            const float value = fraction(keyword, words[at]);
            if (keyword == "d") {
                material_->look.opacity = value;
                has_dissolve_ = true;
            } else if (!has_dissolve_) {
                material_->look.opacity = 1 - value;
            }
        } else if (keyword == "map_Kd" || keyword == "map_d" || keyword == "map_Tr") {
            ++material_->textures;
        }
    }

    const std::filesystem::path& path_;
    MtlLibrary& library_;
    std::string text_;
    std::uint64_t line_ = 0;
    MtlMaterial* material_ = nullptr;
    MtlMaterial ignored_;  // takes what a second material of one name has
    bool has_dissolve_ = false;
};

}  // namespace

bool read_mtl(const std::filesystem::path& path, MtlLibrary& library) {
    return MtlReader(path, library).read();
}

}  // namespace support
