// SPDX-License-Identifier: MIT
// A path that is not a regular file is refused in one line, without waiting.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include "meshes/support/odd_file.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using support::InputError;

std::string refusal_of(const std::filesystem::path& path) {
    const std::string message =
        error_of<InputError>([&] { (void)support::load_mesh(path); }).what();
    CHECK(contains(message, path.filename().string()));
    CHECK(!contains(message, "\n"));
    return message;
}

TEST_CASE("FIFOs, sockets, devices and folders are refused") {
    const Folder folder;
    REQUIRE(mkfifo((folder / "fifo.ply").c_str(), 0600) == 0);
    CHECK(contains(refusal_of(folder / "fifo.ply"), "is a FIFO"));
    CHECK(contains(refusal_of("/dev/zero"), "is a device"));
    std::filesystem::create_directory(folder / "folder.obj");
    CHECK(contains(refusal_of(folder / "folder.obj"), "is a folder"));
    CHECK(contains(refusal_of(folder / "missing.obj"), "does not exist"));
    CHECK(contains(refusal_of(folder.write("file", "x") / "mesh.obj"), "does not exist"));

    const int number = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = (folder / "socket.stl").string();
    REQUIRE(name.size() < sizeof address.sun_path);
    std::copy(name.begin(), name.end(), address.sun_path);
    REQUIRE(bind(number, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    CHECK(contains(refusal_of(folder / "socket.stl"), "is a socket"));
    close(number);
}

TEST_CASE("files of more than 1 GiB are refused before they are read") {
    const Folder folder;
    const auto path = folder.write("large.ply", "ply\n");
    std::filesystem::resize_file(path, std::uintmax_t{1} << 40);  // holds no blocks
    CHECK(contains(refusal_of(path), "1073741824"));
}

TEST_CASE("a name with a line's end keeps to one line") {
    const Folder folder;
    const std::string message = error_of<InputError>([&] {
                                    (void)support::load_mesh(folder.write("a\nb.ply", "ply\n"));
                                }).what();
    CHECK(contains(message, "a?b.ply"));
    CHECK(!contains(message, "\n"));
}

TEST_CASE("the contents tell a format that has a mark, the name in any case tells the others") {
    const Folder folder;
    const PlainMesh plain = icosphere();
    const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (const char* name : {"a.off", "a.OFF", "a.Off"})
        CHECK(support::load_mesh(folder.write(name, off)).triangles.size() == 1);
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (const char* name : {"a.PLY", "a.txt", "a", "a.obj"})
        CHECK(support::load_mesh(folder.write(name, ply)).triangles.size() == 1);
}

}  // namespace
}  // namespace cellist::test
