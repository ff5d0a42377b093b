// SPDX-License-Identifier: MIT
#include "embree.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>

#include "grid/embree.hpp"
#include "stopwatch.hpp"

namespace triangle_grid {

EmbreeAnswers ask_embree(std::span<const grid::GridTriangle> triangles,
                         std::span<const Segment> segments) {
    grid::EmbreeTriangles tree(triangles);
    const support::Stopwatch build;
    tree.rebuild();
    EmbreeAnswers answers{std::vector<std::uint8_t>(segments.size()), build.ms(), 0};

    constexpr std::size_t at_once = 4096;
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (;;) {
            const std::size_t begin = next.fetch_add(at_once);
            if (begin >= segments.size()) return;
            const std::size_t end = std::min(begin + at_once, segments.size());
            for (std::size_t i = begin; i < end; ++i)
                answers.hits[i] = tree.meets_any(segments[i].from, segments[i].to) ? 1 : 0;
        }
    };
    const support::Stopwatch trace;
    {
        std::vector<std::jthread> threads;
        for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
            threads.emplace_back(work);
        work();
    }
    answers.trace_ms = trace.ms();
    return answers;
}

}  // namespace triangle_grid
