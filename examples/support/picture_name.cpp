// SPDX-License-Identifier: MIT
#include "picture_name.hpp"

#include "files.hpp"
#include "input_error.hpp"

namespace support {

PictureName::PictureName(const std::filesystem::path& path) : path_(path) {
    const auto refuse = [&](const std::string& why) {
        throw InputError("--out " + text_of(path) + ": " + why);
    };
    const std::string name = path.filename().string();
    for (std::size_t i = 0; i < name.size(); ++i) {
        std::string& part = has_number_ ? after_ : before_;
        if (name[i] != '%') {
            part += name[i];
            continue;
        }
        const std::size_t end = name.find_first_not_of("0123456789", i + 1);
        const std::string digits = name.substr(i + 1, end == name.npos ? end : end - i - 1);
        const char kind = end == name.npos ? '\0' : name[end];
        const bool is_padded = digits.size() == 2 && digits[0] == '0' && digits[1] != '0';
        if (kind == '%' && digits.empty()) {
            part += '%';
        } else if (kind != 'd' || !(digits.empty() || is_padded)) {
            refuse("% must start the frame number, such as %04d; write %% for a per cent sign");
        } else if (has_number_) {
            refuse("the frame number may occur only once");
        } else {
            has_number_ = true;
            digits_ = is_padded ? static_cast<std::size_t>(digits[1] - '0') : 0;
        }
        i = end;
    }
}

std::filesystem::path PictureName::of(std::uint32_t frame) const {
    std::string number;
    if (has_number_) number = std::to_string(frame);
    if (number.size() < digits_) number.insert(0, digits_ - number.size(), '0');
    return std::filesystem::path(path_).replace_filename(before_ + number + after_);
}

}  // namespace support
