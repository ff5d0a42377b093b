// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <cellist/options.hpp>

#include "device/profile.hpp"

namespace cellist::detail {

/// A build that was measured.
struct Measurement {
    Cost cost;
    std::uint64_t stored = 0;
    std::uint64_t longest = 0;  ///< records of the longest list
};

/// To measure what reading takes, lists of up to this many records are traversed to the end, and
/// longer lists only so far.
inline constexpr std::uint32_t traverse_most = 1u << 20;

/// Chooses the storage of a container from the times of its builds. Knows nothing of devices: it
/// takes measurements as input.
///
/// A trial builds with each storage in turn: once to warm up, then up to three times, fewer if the
/// first two show that another storage is twice as fast. The median time of a build and
/// `expected_reads` times that of a read decide. A trial is repeated when the number of records has
/// doubled or halved. The builds required between trials double each time, so that a number that
/// alternates does not cause endless trials.
class StorageTuner {
public:
    /// What does not change from build to build.
    struct Container {
        std::uint64_t cells;
        std::uint64_t record_bytes;
        ListsOptions options;
    };
    StorageTuner(const Container& container, const std::optional<Profile>& profile);

    /// For the next build.
    [[nodiscard]] Storage storage() const { return candidates_[current_].storage; }
    /// The options of a storage, with room for what was stored so far.
    [[nodiscard]] ListsOptions options(Storage storage) const;
    /// Whether to pass the next build to measured(); if not, pass it to built().
    [[nodiscard]] bool on_trial() const { return on_trial_; }
    /// After a build in storage().
    void measured(const Measurement& trial);
    void built(std::uint64_t stored);

    /// Makes room for so many records in the options.
    void expect(std::uint64_t records) { most_stored_ = std::max(most_stored_, records); }

    /// Whether a trial may choose a storage.
    enum class Exclusion { none, this_trial, permanent };
    /// Excludes a storage that has failed. Returns another that may succeed. None if there is none:
    /// the next build is the first of a trial.
    [[nodiscard]] std::optional<Storage> exclude(Storage storage, const std::string& why,
                                                 Exclusion exclusion = Exclusion::this_trial);

    /// For people: which storage, and the figures that speak for it.
    [[nodiscard]] std::string reason() const;

private:
    struct Candidate {
        Storage storage;
        std::uint32_t builds = 0;      ///< of this trial, the first to warm up
        std::vector<Cost> costs = {};  ///< of a record, in each build but the first
        Cost median = {};              ///< of these
        Exclusion exclusion = Exclusion::none;
        std::string why_excluded = {};

        void exclude(Exclusion how_long, const std::string& why) {
            exclusion = how_long;
            why_excluded = why;
        }
        [[nodiscard]] bool is_excluded() const { return exclusion != Exclusion::none; }
        [[nodiscard]] bool is_measured() const { return builds > 1 && !is_excluded(); }
    };

    void begin_trial();
    void next_candidate();
    [[nodiscard]] std::string refusal(Storage storage) const;
    [[nodiscard]] std::string refusal_of_fixed() const;
    [[nodiscard]] const Candidate* best() const;
    [[nodiscard]] Candidate& candidate(Storage storage) {
        return candidates_[static_cast<std::size_t>(storage)];
    }
    /// A build and all reads.
    [[nodiscard]] double total_seconds(const Cost& cost) const {
        return cost.build_seconds + container_.options.expected_reads * cost.read_seconds;
    }
    /// Of the same in a device's profile, the mean over the patterns.
    [[nodiscard]] double profile_seconds(Storage storage) const;
    [[nodiscard]] std::uint64_t fixed_nodes_most() const;

    Container container_;
    std::optional<Profile> profile_;
    std::array<Candidate, choices.size()> candidates_{{{choices[0]}, {choices[1]}, {choices[2]}}};
    std::size_t current_ = 0;
    bool on_trial_ = true;
    std::uint64_t stored_ = 0;          ///< by the last build of the trial
    std::uint64_t most_stored_ = 0;     ///< by any build since the trial began
    std::uint64_t longest_ = 0;         ///< list of any build of the trial
    std::uint32_t builds_ = 0;          ///< since the trial ended
    std::uint32_t builds_between_ = 8;  ///< trials
};

}  // namespace cellist::detail
