// SPDX-License-Identifier: MIT
// Linked lists on the device against plain C++ on one thread. The picture of plain C++ is compared
// with the reference before the measurement.

#include <array>
#include <stdexcept>

#include "methods/renderer.hpp"
#include "number_text.hpp"
#include "oit/frames/run.hpp"
#include "oit/plain_cpp.hpp"
#include "reference/comparison.hpp"

namespace bench {
namespace {

constexpr double least_psnr_db = 40;

double check_picture(PlainCpp& plain, const oit::Frame& frame) {
    plain.draw();
    const double psnr_db = oit::compare(oit::draw_reference(frame), plain.image(), {}).psnr_db;
    if (!(psnr_db >= least_psnr_db))
        throw std::runtime_error("plain C++ draws another picture: PSNR of " +
                                 support::fixed(psnr_db, 1) + " dB");
    return psnr_db;
}

}  // namespace

void measure_plain_cpp(Run& run) {
    const std::array cases{mesh_case("teapot.obj"), mesh_case("dragon.ply"),
                           gearworks_of_most_layers()};
    run.measure("plain_cpp", cases, [&](const Stage& stage) -> std::vector<Run::Row> {
        PlainCpp plain(stage.frame);
        const double psnr_db = check_picture(plain, stage.frame);
        oit::Renderer renderer(run.device(), stage.frame);
        renderer.warm_up();
        const std::array<std::function<double()>, 2> drawings{[&] { return plain.draw(); },
                                                              [&] { return renderer.draw(); }};
        const std::vector<Samples> times = run.draw_interleaved(drawings);
        return {{{"ratio", times[0].median / times[1].median},
                 {"psnr_db", psnr_db},
                 {"plain_cpp", to_json(times[0])},
                 {"linked", to_json(times[1])}}};
    });
}

}  // namespace bench
