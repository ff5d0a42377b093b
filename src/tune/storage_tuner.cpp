// SPDX-License-Identifier: MIT
#include "tune/storage_tuner.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace cellist::detail {

namespace {

/// Builds that count, of each storage in a trial.
constexpr std::uint32_t samples = 3;
/// A storage that twice took this many times as long as another is not measured again, or at all.
constexpr double slow_factor = 2;
/// Storage::fixed may have this many slots for each record, and so many in any case: the pool of
/// linked lists starts with as many nodes.
constexpr std::uint64_t slots_a_record = 4;
constexpr std::uint64_t slots_free = 65536;
/// Trials of fewer records do not differ enough to be repeated.
constexpr std::uint64_t stored_least = 1024;

std::string text_of(double seconds) {
    const char* units[] = {"s", "ms", "us", "ns"};
    std::size_t unit = 0;
    for (; unit < 3 && seconds < 1; ++unit) seconds *= 1e3;
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %s", seconds, units[unit]);
    return text;
}

std::string text_of_bytes(double bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g MB", 1e-6 * bytes);
    return text;
}

std::string reads_text(std::uint32_t reads) {
    return std::to_string(reads) + (reads == 1 ? " read" : " reads");
}

/// Of two, the lesser.
double median_of(const std::vector<Cost>& costs, double Cost::*part) {
    std::vector<double> values;
    for (const Cost& cost : costs) values.push_back(cost.*part);
    std::ranges::sort(values);
    return values[(values.size() - 1) / 2];
}

Cost scaled(const Cost& cost, double factor) {
    return {factor * cost.build_seconds, factor * cost.read_seconds};
}

}  // namespace

StorageTuner::StorageTuner(const Container& container, const std::optional<Profile>& profile)
    : container_(container), profile_(profile) {
    // How long the lists will be is not known: fixed is for later.
    if (profile_ && profile_seconds(Storage::counted) < profile_seconds(Storage::linked))
        current_ = static_cast<std::size_t>(Storage::counted);
}

double StorageTuner::profile_seconds(Storage storage) const {
    double sum = 0;
    for (const Pattern pattern : patterns) sum += total_seconds(profile_->cost(storage, pattern));
    return sum / patterns.size();
}

std::uint64_t StorageTuner::fixed_nodes_most() const {
    return std::max(slots_a_record * most_stored_, slots_free);
}

ListsOptions StorageTuner::options(Storage storage) const {
    ListsOptions options = container_.options;
    options.storage = storage;
    if (options.overflow != Overflow::grow || most_stored_ == 0) return options;
    if (storage == Storage::fixed) {
        options.slots = static_cast<std::uint32_t>(longest_);
        // Heads, nodes, and more than the counters take: the pool does not grow for a single long
        // list.
        options.budget_bytes =
            std::min(options.budget_bytes, 4 * container_.cells +
                                               container_.record_bytes * fixed_nodes_most() +
                                               (std::uint64_t{1} << 16));
    } else {
        options.capacity_nodes = std::max(options.capacity_nodes.value_or(0), most_stored_);
    }
    return options;
}

void StorageTuner::begin_trial() {
    on_trial_ = true;
    stored_ = most_stored_ = longest_ = 0;
    for (Candidate& candidate : candidates_) {
        candidate.builds = 0;
        candidate.costs.clear();
        if (candidate.exclusion != Exclusion::permanent) candidate.exclude(Exclusion::none, {});
    }
}

void StorageTuner::measured(const Measurement& trial) {
    if (trial.stored == 0) return;
    stored_ = trial.stored;
    expect(trial.stored);
    longest_ = std::max(longest_, trial.longest);

    // Of a record, so that builds of different numbers can be compared.
    Candidate& candidate = candidates_[current_];
    const Cost cost = scaled(trial.cost, 1 / static_cast<double>(trial.stored));
    if (candidate.builds > 0) {
        candidate.costs.push_back(cost);
        candidate.median = {median_of(candidate.costs, &Cost::build_seconds),
                            median_of(candidate.costs, &Cost::read_seconds)};
    }
    ++candidate.builds;
    // Two, since the second build of a storage may be the first to allocate and compile what all
    // others use.
    if (candidate.builds > samples ||
        (candidate.costs.size() >= 2 &&
         total_seconds(candidate.median) > slow_factor * total_seconds(best()->median)))
        next_candidate();
}

/// On to a storage that was not built with in this trial, or to the end of the trial.
void StorageTuner::next_candidate() {
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        Candidate& candidate = candidates_[i];
        if (candidate.builds > 0 || candidate.is_excluded()) continue;
        if (const std::string why = refusal(candidate.storage); !why.empty()) {
            candidate.exclude(Exclusion::this_trial, why);
            continue;
        }
        current_ = i;
        return;
    }
    if (const Candidate* winner = best()) current_ = static_cast<std::size_t>(winner->storage);
    on_trial_ = false;
    builds_ = 0;
    if (builds_between_ < (1u << 30)) builds_between_ *= 2;
}

void StorageTuner::built(std::uint64_t stored) {
    expect(stored);
    if (on_trial_ || ++builds_ < builds_between_) return;
    const std::uint64_t now = std::max(stored, stored_least);
    const std::uint64_t then = std::max(stored_, stored_least);
    if (now > 2 * then || then > 2 * now) begin_trial();
}

const StorageTuner::Candidate* StorageTuner::best() const {
    const Candidate* best = nullptr;
    for (const Candidate& candidate : candidates_)
        if (candidate.is_measured() &&
            (best == nullptr || total_seconds(candidate.median) < total_seconds(best->median)))
            best = &candidate;
    return best;
}

/// Why a storage is not tried; empty if it is.
std::string StorageTuner::refusal(Storage storage) const {
    if (storage == Storage::fixed)
        if (const std::string why = refusal_of_fixed(); !why.empty()) return "not tried: " + why;
    const Candidate* known = best();
    if (!profile_ || known == nullptr || stored_ < profile_->records() / 8) return {};
    // The profile speaks for lists as large as its own that take what it says, and for nothing
    // else: not for small ones, nor for inserts that all go to a few cells.
    double least = std::numeric_limits<double>::max();
    double most = 0;
    double ratio = least;
    for (const Pattern pattern : patterns) {
        const double seconds = total_seconds(profile_->cost(known->storage, pattern));
        least = std::min(least, seconds);
        most = std::max(most, seconds);
        ratio = std::min(ratio, total_seconds(profile_->cost(storage, pattern)) / seconds);
    }
    const double seconds = total_seconds(known->median);
    if (ratio <= slow_factor || seconds < least / 1.5 || seconds > most * 1.5) return {};
    return std::string("not tried: over twice as slow as ") + name_of(known->storage) +
           " in the profile of this device";
}

std::string StorageTuner::refusal_of_fixed() const {
    const ListsOptions& options = container_.options;
    if (options.overflow == Overflow::grow) {
        if (longest_ >= traverse_most)
            return "a list has " + std::to_string(traverse_most) + " records or more";
        const std::uint64_t nodes = longest_ * container_.cells;
        if (nodes > fixed_nodes_most())
            return "a longest list of " + std::to_string(longest_) + " records would take " +
                   text_of_bytes(static_cast<double>(nodes) *
                                 static_cast<double>(container_.record_bytes));
        return {};
    }
    if (!options.slots) return "it needs slots where the pool may not grow";
    if (*options.slots * container_.cells > options.capacity_nodes.value_or(0))
        return "its slots for all cells are more than capacity_nodes";
    return {};
}

std::optional<Storage> StorageTuner::exclude(Storage storage, const std::string& why,
                                             Exclusion exclusion) {
    Candidate& failed = candidate(storage);
    failed.exclude(std::max(failed.exclusion, exclusion), why);

    // If a list is too long for slots, or a kernel does not repeat itself, the other storages work.
    std::optional<Storage> other;
    for (const Storage safe : {Storage::linked, Storage::counted})
        if (!other && !candidate(safe).is_excluded()) other = safe;
    if (const Candidate* known = best(); known != nullptr && known->storage != Storage::fixed)
        other = known->storage;
    if (!other) {
        begin_trial();
        current_ = static_cast<std::size_t>(
            candidate(Storage::linked).is_excluded() ? Storage::counted : Storage::linked);
        return {};
    }
    if (candidates_[current_].storage == storage) {
        if (on_trial_)
            next_candidate();
        else
            current_ = static_cast<std::size_t>(*other);
    }
    return other;
}

std::string StorageTuner::reason() const {
    const Candidate& chosen = candidates_[current_];
    std::string text = std::string(name_of(chosen.storage)) + ": ";
    const std::uint32_t reads = container_.options.expected_reads;
    const auto sum = [&](const Cost& cost) {
        return "build " + text_of(cost.build_seconds) + " + " + reads_text(reads) + " of " +
               text_of(cost.read_seconds) + " = " + text_of(total_seconds(cost));
    };
    if (on_trial_) {
        if (chosen.builds > 0 || best() != nullptr)
            text += "on trial, build " + std::to_string(chosen.builds) + " of " +
                    std::to_string(samples + 1);
        else if (profile_)
            text += "nothing is measured yet; the profile of this device has " +
                    text_of(profile_seconds(Storage::linked)) + " a record for linked, and " +
                    text_of(profile_seconds(Storage::counted)) + " for counted, with " +
                    reads_text(reads);
        else
            text +=
                "nothing is measured yet, and there is no profile of this device: run cellist tune";
    } else if (chosen.is_measured()) {
        text += sum(scaled(chosen.median, static_cast<double>(stored_))) + " for " +
                std::to_string(stored_) + " records";
    } else {
        text += "the only one that is left";
    }
    for (const Candidate& other : candidates_) {
        if (&other == &chosen) continue;
        if (other.is_excluded())
            text += std::string("; ") + name_of(other.storage) + " " + other.why_excluded;
        else if (other.is_measured())
            text += std::string("; ") + name_of(other.storage) + " " +
                    text_of(static_cast<double>(stored_) * total_seconds(other.median));
    }
    return text;
}

}  // namespace cellist::detail
