// SPDX-License-Identifier: MIT
// Damaged PLY, OFF and STL files are refused with the place of the damage, or loaded with a count
// of what is missing.
#include "meshes/support/loaded.hpp"
#include "meshes/support/odd_file.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using support::InputError;
using support::Mesh;

const std::string ply_head =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
    "property float y\nproperty float z\n";
const std::string list = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string ply_corners = "0 0 0\n1 0 0\n0 1 0\n";

void check_refused(const std::string& name, const std::string& text, const std::string& part) {
    const Folder folder;
    const auto path = folder.write(name, text);
    const std::string message =
        error_of<InputError>([&] { (void)support::load_mesh(path); }).what();
    INFO(message);
    CHECK(contains(message, name));
    CHECK(contains(message, part));
    CHECK(!contains(message, "\n"));
}

TEST_CASE("damaged PLY headers are refused with the line") {
    check_refused("a.ply", "ply\nformat ascii 2.0\n" + list, "line 2");
    check_refused("a.ply", "ply\nformat text 1.0\n" + list, "line 2");
    check_refused("a.ply", "ply\nelement vertex 3\nproperty float x\nend_header\n", "format");
    check_refused("a.ply", ply_head + "property quad w\n" + list + ply_corners, "'quad'");
    check_refused("a.ply", ply_head + "property float x\n" + list + ply_corners, "second property");
    check_refused("a.ply", ply_head + "colour blue\n" + list + ply_corners, "'colour'");
    check_refused("a.ply", ply_head + "element face -1\nend_header\n", "'-1'");
    check_refused("a.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n", "line 3");
    check_refused("a.ply",
                  ply_head + "element face 1\nproperty int vertex_indices\nend_header\n" +
                      ply_corners + "3\n",
                  "vertex_indices");
    check_refused(
        "a.ply", ply_head.substr(0, ply_head.find("property float z")) + list + ply_corners, "'z'");
    check_refused("a.ply", ply_head, "does not end");
}

TEST_CASE("damaged PLY data are refused with the line or the byte") {
    check_refused("a.ply", ply_head + list + "0 0 0\n1 0x10 0\n0 1 0\n3 0 1 2\n", "'0x10'");
    check_refused("a.ply", ply_head + list + "0 0 0\n1 1,5 0\n0 1 0\n3 0 1 2\n", "line 11");
    check_refused("a.ply", ply_head + list + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line");
    check_refused("a.ply", ply_head + list + "0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n", "line 10");
    check_refused("a.ply", ply_head + list + ply_corners + "-3 0 1 2\n", "-3");
    check_refused("a.ply", ply_head + list + ply_corners + "4 0 1 2\n", "it has 0");
    check_refused("a.ply", ply_head + list + ply_corners, "it has 0");
}

TEST_CASE("declared counts of 4 billion take no memory") {
    const std::string body = "end_header\n" + std::string(100, '\1');
    const std::string binary =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n"
        "property float x\nproperty float y\nproperty float z\n";
    check_refused("a.ply", binary + body, "declares 4000000000");
    check_refused("a.off", "OFF\n4000000000 4000000000 0\n0 0 0\n", "declares 4000000000");
    check_refused("a.off", "OFF\n3 1 0\n" + ply_corners + "4000000000 0 1 2\n",
                  "a face of 4000000000");
    std::string stl(80, ' ');
    stl += "\xFF\xFF\xFF\xFF";
    check_refused("a.stl", stl + std::string(500, '\0'), "declares 4294967295");
    const std::string lists =
        "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\n"
        "property list uint int vertex_indices\nend_header\n";
    check_refused("a.ply", lists + std::string(12, '\0') + "\xF0" + std::string(50, '\1'),
                  "it has 0");
}

TEST_CASE("damaged OFF files are refused with the line") {
    check_refused("a.off", "OFF\n3 1 0\n" + ply_corners + "3 0 1\n", "line 6");
    check_refused("a.off", "OFF\n3 1 0\n" + ply_corners + "3 0 1 2 255 0\n", "line 6");
    check_refused("a.off", "OFF\n3 1 0\n" + ply_corners + "3 0 1 x\n", "'x'");
    check_refused("a.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line");
    check_refused("a.off", "OFF\n3 2 0\n" + ply_corners + "3 0 1 2\n", "it has 1");
    check_refused("a.off", "OFF BINARY\n" + std::string(50, '\0'), "BINARY");
    check_refused("a.off", "4OFF\n3 1 0\n", "4OFF");
    check_refused("a.off", "hello\n", "'hello'");
}

TEST_CASE("text STL files that lack their end are refused") {
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
        "vertex 0 1 0\nendloop\nendfacet\n";
    check_refused("a.stl", "solid a\n" + facet, "no 'endsolid' follows facet 1");
    check_refused("a.stl", "solid a\n" + facet + facet.substr(0, 60), "truncated");
    check_refused("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nendloop\n",
                  "line 5");
    CHECK(load_text("a.stl", "solid endsolid\n" + facet + "endsolid facet\n").triangles.size() ==
          1);
}

TEST_CASE("indices that do not exist are counted, never moved") {
    CHECK(load_text("a.off", "OFF\n3 3 0\n" + ply_corners + "3 0 1 2\n3 0 1 999\n3 0 1 -1\n")
              .drops.out_of_range_triangles == 2);
    CHECK(load_text("a.ply", ply_head +
                                 "element face 3\nproperty list uchar float vertex_indices\n"
                                 "end_header\n" +
                                 ply_corners + "3 0 1 2\n3 0 1 1.5\n3 0 1 5e9\n")
              .drops.out_of_range_triangles == 2);
}

TEST_CASE("bytes after the end are counted") {
    CHECK(load_text("a.ply", ply_head + list + ply_corners + "3 0 1 2\n3 2 1 0\n")
              .drops.bytes_after_end == 8);
    CHECK(
        load_text("a.ply", ply_head + list + ply_corners + "3 0 1 2\n \n").drops.bytes_after_end ==
        0);
    CHECK(
        load_text("a.off", "OFF\n3 1 0\n" + ply_corners + "3 0 1 2\nend\n").drops.bytes_after_end ==
        4);
}

TEST_CASE("edges are counted as lines") {
    const Mesh mesh = load_text(
        "a.ply", ply_head + "element edge 2\nproperty int vertex1\nproperty int vertex2\n" + list +
                     ply_corners + "0 1\n1 2\n3 0 1 2\n");
    CHECK(mesh.triangles.size() == 1);
    CHECK(mesh.drops.points_and_lines == 2);
}

}  // namespace
}  // namespace cellist::test
