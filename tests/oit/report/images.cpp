// SPDX-License-Identifier: MIT
// A picture's file holds what its name says, and floats as they are.
#include <cstring>
#include <map>

#include "image.hpp"
#include "image_difference.hpp"
#include "input_error.hpp"
#include "oit/support/program.hpp"
#include "picture_name.hpp"
#include "report/picture.hpp"

namespace cellist::test {
namespace {

constexpr int image_width = 3, image_height = 2;

std::vector<cl_float4> pixels() {
    std::vector<cl_float4> image(image_width * image_height);
    for (std::size_t i = 0; i < image.size(); ++i)
        image[i] = {{0.25F * static_cast<float>(i), 1e6F, -2.0F - static_cast<float>(i), 9}};
    return image;
}

std::string written(const std::string& name) {
    const Folder folder;
    support::write_image(folder / name, pixels(), image_width, image_height);
    return read_file(folder / name);
}

// Reads a file from its beginning.
class Bytes {
public:
    explicit Bytes(std::string bytes) : bytes_(std::move(bytes)) {}
    template <class T>
    T take() {
        REQUIRE(at_ + sizeof(T) <= bytes_.size());
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }
    std::string text() {
        const std::string result = bytes_.c_str() + at_;
        at_ += result.size() + 1;
        return result;
    }
    void go_to(std::size_t at) { at_ = at; }
    [[nodiscard]] std::size_t at() const { return at_; }
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    [[nodiscard]] const std::string& all() const { return bytes_; }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

TEST_CASE("EXR files have the attributes and the lines that the format asks for") {
    Bytes file(written("a.exr"));
    CHECK(file.take<std::int32_t>() == 0x01312f76);
    CHECK(file.take<std::int32_t>() == 2);
    std::map<std::string, std::string> attributes;
    for (std::string name = file.text(); !name.empty(); name = file.text()) {
        const std::string type = file.text();
        const auto size = static_cast<std::size_t>(file.take<std::int32_t>());
        attributes[name + ":" + type] = file.all().substr(file.at(), size);
        file.go_to(file.at() + size);
    }
    for (const char* required :
         {"channels:chlist", "compression:compression", "dataWindow:box2i", "displayWindow:box2i",
          "lineOrder:lineOrder", "pixelAspectRatio:float", "screenWindowCenter:v2f",
          "screenWindowWidth:float"})
        CHECK(attributes.contains(required));
    Bytes channels(attributes["channels:chlist"]);
    std::string names;
    for (std::string name = channels.text(); !name.empty(); name = channels.text()) {
        names += name;
        CHECK(channels.take<std::int32_t>() == 2);  // float
        CHECK(channels.take<std::int32_t>() == 0);
        CHECK(channels.take<std::int32_t>() == 1);
        CHECK(channels.take<std::int32_t>() == 1);
    }
    CHECK(names == "BGR");
    Bytes window(attributes["dataWindow:box2i"]);
    for (const std::int32_t corner : {0, 0, image_width - 1, image_height - 1})
        CHECK(window.take<std::int32_t>() == corner);
    CHECK(attributes["compression:compression"] == std::string(1, '\0'));
    std::size_t table = file.at();
    for (int y = 0; y < image_height; ++y, table += 8) {
        file.go_to(table);
        file.go_to(file.take<std::uint64_t>());
        CHECK(file.take<std::int32_t>() == y);
        CHECK(file.take<std::int32_t>() == 3 * 4 * image_width);
        for (const int channel : {2, 1, 0})
            for (int x = 0; x < image_width; ++x)
                CHECK(file.take<float>() ==
                      pixels()[static_cast<std::size_t>(y * image_width + x)].s[channel]);
    }
    CHECK(file.at() == file.size());
}

TEST_CASE("PFM files have floats, row by row from the bottom") {
    Bytes file(written("a.PFM"));
    const std::string head = "PF\n3 2\n-1.0\n";
    REQUIRE(file.all().starts_with(head));
    file.go_to(head.size());
    for (int y = image_height; y-- > 0;)
        for (int x = 0; x < image_width; ++x)
            for (int c = 0; c < 3; ++c)
                CHECK(file.take<float>() ==
                      pixels()[static_cast<std::size_t>(y * image_width + x)].s[c]);
    CHECK(file.at() == file.size());
}

TEST_CASE("names of 8-bit files decide between PNG and JPEG") {
    CHECK(written("a.png").starts_with("\x89PNG"));
    CHECK(written("a.b.PNG").starts_with("\x89PNG"));
    for (const char* name : {"a.jpg", "a.jpeg", "a.JPG"})
        CHECK(written(name).starts_with("\xFF\xD8\xFF"));
}

TEST_CASE("other names are refused with those that there are") {
    for (const char* name : {"a", "a.gif", "a.png.txt", "png", ".png", "a."}) {
        INFO(name);
        CHECK_THROWS_AS(support::image_format(name), support::InputError);
    }
    CHECK(support::image_format("/dev/null") == support::ImageFormat::png);
    CHECK(support::image_format("-") == support::ImageFormat::png);
}

TEST_CASE("a number in a name counts the frames") {
    for (const auto& [name, seventh] : {std::pair{"a.png", "a.png"},
                                        {"a-%04d.png", "a-0007.png"},
                                        {"%d.exr", "7.exr"},
                                        {"x/50%%-%02d.png", "x/50%-07.png"},
                                        {"50%%.png", "50%.png"},
                                        {"%s/a.png", "%s/a.png"}})
        CHECK(support::PictureName(name).of(7) == seventh);
    CHECK(support::PictureName("%02d.png").of(123) == "123.png");
    CHECK_FALSE(support::PictureName("50%%.png").has_number());
    for (const char* name : {"%.png", "%s.png", "%4d.png", "%0d.png", "%00d.png", "%04x.png",
                             "%012d.png", "%d-%d.png", "a%"}) {
        INFO(name);
        CHECK_THROWS_AS(support::PictureName(name), support::InputError);
    }
}

TEST_CASE("differences are shown sixteen times as large, and kept in floats as they are") {
    const std::vector<cl_float4> a{{{0, 1, 0.25F, 1}}}, b{{{0, 0.5F, 0.25F, 1}}};
    CHECK(support::shown_difference(a, b) == std::vector<std::uint8_t>{0, 255, 0});
    const cl_float4 difference = support::linear_difference(a, b).front();
    CHECK(difference.s[0] == 0);
    CHECK(difference.s[1] == 0.5F);
    // 0.5 / 255 of an encoded value: a step and a half in a picture of 8 bits would be 12 / 255.
    const std::vector<cl_float4> black(1), dark{{{0.5F / 255 / 12.92F, 0, 0, 1}}};
    CHECK(support::shown_difference(black, dark) == std::vector<std::uint8_t>{8, 0, 0});
}

}  // namespace
}  // namespace cellist::test
