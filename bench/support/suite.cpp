// SPDX-License-Identifier: MIT
#include "support/suite.hpp"

#include <algorithm>
#include <memory>
#include <sstream>

#include <benchmark/benchmark.h>

#include "files.hpp"

namespace bench {
namespace {

/// Prints results to the terminal, and keeps them as JSON.
class Reporters : public benchmark::BenchmarkReporter {
public:
    Reporters() {
        json_.SetOutputStream(&text_);
        json_.SetErrorStream(&text_);
    }
    bool ReportContext(const Context& context) override {
        screen_->SetOutputStream(&GetOutputStream());
        screen_->SetErrorStream(&GetErrorStream());
        return screen_->ReportContext(context) && json_.ReportContext(context);
    }
    void ReportRuns(const std::vector<Run>& runs) override {
        screen_->ReportRuns(runs);
        json_.ReportRuns(runs);
    }
    void Finalize() override {
        screen_->Finalize();
        json_.Finalize();
    }
    [[nodiscard]] std::string json() const { return text_.str(); }

private:
    std::unique_ptr<benchmark::BenchmarkReporter> screen_{
        benchmark::CreateDefaultDisplayReporter()};
    benchmark::JSONReporter json_;
    std::ostringstream text_;
};

}  // namespace

Result build_and_read(const Sampling& sampling, double nodes,
                      const std::function<std::pair<double, double>()>& run) {
    const std::vector<Samples> samples = sample(sampling, [&]() -> std::vector<double> {
        const auto [build, read] = run();
        return {build + read, build, read};
    });
    return {samples[0],
            nodes,
            0,
            {{"build_ms", 1e3 * samples[1].median}, {"read_ms", 1e3 * samples[2].median}}};
}

Suite::Suite(const cellist::Device& device, Effort effort, cl_uint nodes, cl_uint occupancy,
             unsigned threads)
    : device_(device), effort_(effort), nodes_(nodes), occupancy_(occupancy), threads_(threads) {
    if (effort == Effort::tiny) sampling_ = {.least = 1, .most = 1, .seconds = 0};
    // A GPU takes as many samples in less time.
    const bool gpu = device.info().is_gpu();
    if (gpu) sampling_.seconds = 0.15;
    if (effort == Effort::quick) sampling_.seconds = 0.1;
}

std::uint64_t Suite::copies(std::uint64_t bytes) const {
    constexpr std::uint64_t cache_bytes = 128 << 20;
    if (effort_ == Effort::tiny) return 1;
    return std::clamp<std::uint64_t>(cache_bytes / std::max<std::uint64_t>(bytes, 1), 1, 256);
}

Workload Suite::base(const Distribution& distribution) const {
    return {.distribution = distribution, .occupancy = occupancy_, .nodes = nodes_};
}

std::vector<Workload> Suite::bases(double longest) const {
    std::vector<Workload> all;
    for (const Distribution& distribution : distributions)
        if (const Workload base = this->base(distribution); base.longest() <= longest)
            all.push_back(base);
    return all;
}

std::vector<Workload> Suite::readable_bases() const {
    std::vector<Workload> all = bases();
    std::transform(all.begin(), all.end(), all.begin(), readable);
    return all;
}

std::vector<Workload> Suite::sorted_workloads() const {
    std::vector<Workload> all = readable_bases();
    if (effort_ != Effort::full || occupancy_ < 4) return all;
    for (Workload workload : bases()) {
        workload.nodes /= 4;
        workload.occupancy /= 4;
        all.push_back(readable(workload));
    }
    return all;
}

std::vector<Workload> Suite::workloads() const {
    std::vector<Workload> all;
    for (const Workload& base : bases()) {
        const auto add = [&](cl_uint Workload::*member, cl_uint value) {
            all.push_back(base);
            all.back().*member = value;
        };
        all.push_back(base);
        if (effort_ != Effort::full) continue;
        for (cl_uint bits = 12; bits <= 26; bits += 2) add(&Workload::nodes, 1u << bits);
        if (random_and_coherent({base}).empty()) continue;
        for (const cl_uint bytes : {8u, 32u}) add(&Workload::node_bytes, bytes);
        for (const cl_uint occupancy : {1u, 4u, 64u}) add(&Workload::occupancy, occupancy);
    }
    return all;
}

void Suite::add(const std::string& name, std::function<Result()> measure) {
    const auto [at, is_new] = cases_.emplace(name, std::move(measure));
    if (!is_new) return;
    const auto run = [this, &measured = at->second](benchmark::State& state) {
        try {
            Result result;
            // One iteration for Google Benchmark; its time is the median of all samples.
            for (auto _ : state) {
                result = measured();
                state.SetIterationTime(result.samples.median);
            }
            state.counters["least_ms"] = 1e3 * result.samples.least;
            state.counters["greatest_ms"] = 1e3 * result.samples.greatest;
            state.counters["samples"] = static_cast<double>(result.samples.count);
            for (const auto& [counter, value] : result.counters) state.counters[counter] = value;
            if (result.nodes > 0) state.SetItemsProcessed(static_cast<std::int64_t>(result.nodes));
            if (result.bytes > 0) state.SetBytesProcessed(static_cast<std::int64_t>(result.bytes));
        } catch (const std::exception& error) {
            ++failures_;
            state.SkipWithError(error.what());
        }
    };
    benchmark::RegisterBenchmark(name.c_str(), run)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
}

bool Suite::run(const std::filesystem::path& out) {
    Reporters reporters;
    const std::size_t count = benchmark::RunSpecifiedBenchmarks(&reporters);
    if (!out.empty() && count > 0) support::write_file(out, reporters.json());
    return count > 0 && failures_ == 0;
}

}  // namespace bench
