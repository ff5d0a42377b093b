#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
// Motion-blurred shadows from depth-time ranges.
#include <cmath>
#include <cstdio>
#include <iostream>
#include <cstring>

#include "accumulate.hpp"
#include "image.hpp"
#include "renderer.hpp"

using namespace motion;
int main(int argc, char** argv) {
    const std::string name = argc > 1 ? argv[1] : "cubes";
    const std::string which = argc > 2 ? argv[2] : "exact";
    Settings s;
    for (int i = 3; i + 1 < argc; i += 2) {
        const std::string o = argv[i];
        const double v = atof(argv[i + 1]);
        if (o == "n") s.samples = cl_uint(v);
        if (o == "w") { s.width = int(v); s.height = int(v * 3 / 4); }
        if (o == "map") s.shadow_map = int(v);
        if (o == "compress") s.compress = v != 0;
        if (o == "prepass") s.prepass = v != 0;
        if (o == "storage") s.storage = v == 1 ? cellist::Storage::counted : v == 2 ? cellist::Storage::fixed : cellist::Storage::linked;
        if (o == "tol") s.tolerance = float(v);
        if (o == "bias") s.bias = float(v);
        if (o == "budget") s.budget_bytes = std::uint64_t(v);
    }
    const auto device = cellist::Device::choose();
    const Scene scene = name == "walker" ? make_walker() : name == "fan" ? make_fan() : name == "blinds" ? make_blinds() : make_cubes();
    std::printf("%zu triangles\n", scene.triangles.size());
    Renderer r(device, scene, s);
    std::vector<cl_float4> picture;
    if (which == "accumulate") {
        Accumulation a(r.frame());
        support::Stopwatch w;
        a.draw(0, s.samples, s.samples);
        picture = a.picture(s.samples);
        std::printf("%.1f ms\n", w.ms());
    } else {
        auto m = which == "exact" ? make_exact(r.frame()) : which == "tsm" ? make_tsm(r.frame()) : make_still(r.frame());
        r.draw(*m);
        r.draw(*m);
        for (int k = 0; k < 3; ++k) std::printf("frame %.1f ms\n", support::measure_ms(device, [&] { r.draw(*m); }));
        support::PassTimes t(device);
        r.draw(*m, &t);
        for (auto& [p, ms] : t.all()) std::printf("%-12s %8.2f ms\n", p.c_str(), ms);
        const auto z = m->size();
        std::printf("ranges %llu pieces %llu bytes %.1f MB slices %llu refused %llu\n", (unsigned long long)z.ranges,
                    (unsigned long long)z.pieces, z.bytes / 1e6, (unsigned long long)z.slices, (unsigned long long)z.refused);
        picture = r.picture().download();
    }
    double dark = 0; for (auto& p : picture) dark += p.s[3];
    std::printf("mean dark %.6f\n", dark / picture.size());
    FILE* f = std::fopen(("/tmp/w/ms_" + name + "_" + which + ".raw").c_str(), "wb");
    std::fwrite(picture.data(), 16, picture.size(), f);
    std::fclose(f);
    support::write_image("/tmp/w/ms_" + name + "_" + which + ".png", picture, s.width, s.height);
}
