// SPDX-License-Identifier: MIT
// Members may have any name that C allows, and words that OpenCL C reserves are named in the error.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// The names of parameters, variables and members of the library's kernels, macros and host code.
struct Names {
    cl_uint word, words;
    cl_uchar record, records, member, members, a, b, x, y, z, w, key, keys, node, nodes, next,
        lists;
    cl_uchar cell, cells, heads, shards, view, extent, mode, slots, length, at, found, k, out,
        value;
    cl_uchar values, type, name, tag, size, first, last, row, begin, end, i, j, n, T, E, M, index;
    cl_uchar order, own, other, place, places, count, scalar, path, offset, pointer, bits, cellist;
};
CELLIST_STRUCT(Names, word, words, record, records, member, members, a, b, x, y, z, w, key, keys,
               node, nodes, next, lists, cell, cells, heads, shards, view, extent, mode, slots,
               length, at, found, k, out, value, values, type, name, tag, size, first, last, row,
               begin, end, i, j, n, T, E, M, index, order, own, other, place, places, count, scalar,
               path, offset, pointer, bits, cellist);

/// Structs are found by their tags, and may be called like variables as well.
struct words {
    cl_uint value;
    Names record;
};
CELLIST_STRUCT(words, value, record);

Inserts<Names> names(cl_uint count) {
    Inserts<Names> inserts;
    for (cl_uint i = 0; i < count; ++i) {
        Names record{};
        record.word = (i * 7) % count;
        record.words = i;
        record.record = static_cast<cl_uchar>(count - i);
        record.cellist = static_cast<cl_uchar>(i);
        inserts.add(0, record);
    }
    return inserts;
}

TEST_CASE("members with the names of the library's variables work everywhere") {
    CELLIST_EACH_STORAGE(storage);
    const Inserts<Names> inserts = names(20);
    Lists<Names> lists(device(), {1}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    lists.sort(&Names::word);
    for (cl_uint i = 0; i < 20; ++i) REQUIRE(lists.download().cell(0)[i].word == i);
    lists.sort(&Names::record);
    const std::vector<cl_uchar> packed = lists.pack(&Names::record).records.download();
    for (cl_uint i = 0; i < 20; ++i) {
        REQUIRE(lists.download().cell(0)[i].words == 19 - i);
        REQUIRE(packed[i] == i + 1);
    }
    lists.sort_by("record.record * record.word - record.value");
    require_sound(lists, 20);

    const Buffer<cl_uint> found(device(), 2);
    Kernel nearest(device(),
                   "kernel void f(CELLIST_LISTS(Names, lists), global uint* found) {\n"
                   "    Names out[2];\n"
                   "    cellist_nearest(lists, 0, words, 2, out);\n    found[0] = out[1].words;\n"
                   "    cellist_nearest(lists, 0, record, 2, out);\n    found[1] = out[1].words;\n"
                   "}\n",
                   "f", lists);
    nearest.run(1, lists, found);
    REQUIRE(found.download() == std::vector<cl_uint>{1, 18});
}

TEST_CASE("the nearest are kept by members with the names of the library's variables") {
    const Inserts<Names> inserts = names(20);
    for (const auto by : {&Names::word, &Names::words}) {
        Lists<Names> lists(device(), {1}, {.storage = nearest(by, 3)});
        Inserter(lists).build(lists, inserts);
        lists.sort(by);
        const HostLists<Names> kept = lists.download();
        REQUIRE(kept.records().size() == 3);
        for (cl_uint i = 0; i < 3; ++i) REQUIRE(kept.records()[i].*by == i);
    }
}

TEST_CASE("a struct with the name of a variable holds others") {
    Inserts<words> inserts;
    for (cl_uint i = 0; i < 5; ++i) inserts.add(0, {5 - i, names(5).records[i]});
    Lists<words> lists(device(), {1}, {.storage = Storage::counted});
    Inserter(lists).build(lists, inserts);
    lists.sort(&words::value);
    const std::vector<Names> packed = lists.pack(&words::record).records.download();
    REQUIRE(packed.size() == 5);
    for (cl_uint i = 0; i < 5; ++i) REQUIRE(packed[i].words == 4 - i);
}

struct Half {
    cl_float half;
    cl_uint id;
};
CELLIST_STRUCT(Half, half, id);
struct Spaces {
    cl_uint id, global;
};
CELLIST_STRUCT(Spaces, id, global);
struct Access {
    cl_ulong read_only;
};
CELLIST_STRUCT(Access, read_only);
struct Fence {
    cl_uint id[2], CLK_LOCAL_MEM_FENCE;
};
CELLIST_STRUCT(Fence, id, CLK_LOCAL_MEM_FENCE);
struct None {
    cl_uint CELLIST_NONE_;
};
CELLIST_STRUCT(None, CELLIST_NONE_);
struct kernel {
    cl_uint id;
};
CELLIST_STRUCT(kernel, id);
struct float4 {
    cl_uint id;
};
CELLIST_STRUCT(float4, id);

template <class T>
void require_named(const std::string& word) {
    INFO(word);
    const auto error = error_of<OpenClError>(
        [] { Kernel(device(), "kernel void f(uint parameter) {}", "f", type<T>); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "does not accept " + word + ":"));
    REQUIRE_FALSE(contains(error.what(), "layout of a struct differs"));
    // The compiler's own words follow.
    REQUIRE(contains(error.log(), "error"));
}

TEST_CASE("a name that OpenCL C reserves is named, and the compiler's log is kept", "[oclgrind]") {
    require_named<Half>("member half of struct Half");
    require_named<Spaces>("member global of struct Spaces");
    require_named<Access>("member read_only of struct Access");
    require_named<Fence>("member CLK_LOCAL_MEM_FENCE of struct Fence");
    require_named<kernel>("struct kernel");
    require_named<float4>("struct float4");
    Kernel(device(), "kernel void f(uint parameter) {}", "f", type<None>);
}

TEST_CASE("macros of the build options change no struct, and no call of the library",
          "[oclgrind]") {
    Lists<Item> lists(device(), {2, 3, 4});
    const std::string text =
        "kernel void f(CELLIST_LISTS(Item, lists), global uint* out) {\n"
        "    Item item = { 2.0f, KEY };\n"
        "    out[0] = cellist_cells(lists) + cellist_extent(lists).z;\n"
        "    out[1] = cellist_cell3(lists, 1, 2, 3);\n"
        "    cellist_insert(lists, 3, item);\n"
        "}\n";
    Kernel kernel(device(),
                  Source{.text = text,
                         .options = "-Dkey=1 -D id=2 -Dview -Dcells=3 -Dextent=x -Drecord=4 -DT=5 "
                                    "-Dnode=6 -Dshard=7 -DKEY=9 -Da=b"},
                  "f", lists);
    const Buffer<cl_uint> out(device(), 2);
    const BuildReport report = lists.build(kernel, 1, out);
    REQUIRE(report.stored == 1);
    REQUIRE(out.download() == std::vector<cl_uint>{28, 23});
    REQUIRE(lists.download().cell(3)[0] == Item{2.0f, 9});
}

TEST_CASE("a macro of the build options that breaks the user's own code is named", "[oclgrind]") {
    const auto error = error_of<OpenClError>([] {
        Kernel(device(),
               Source{.text = "kernel void f(global Item* items) {\n    items->key = 1;\n}\n",
                      .file_name = "user.cl",
                      .options = "-Dkey=1 -DUNUSED"},
               "f", type<Item>);
    });
    INFO(error.what());
    REQUIRE(contains(error.what(), "macro 'key'"));
    REQUIRE(contains(error.what(), "user.cl:2:"));
}

}  // namespace
}  // namespace cellist::test
