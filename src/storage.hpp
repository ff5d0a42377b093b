#pragma once

#include <memory>
#include <optional>
#include <string>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>

#include "device_state.hpp"
#include "view.hpp"

namespace cellist::detail {

/// How a container keeps its nodes: the buffers, and the passes of a build. One class a storage; the
/// device's side of all of them is kernels/cellist/lists.clh.
class ListStorage {
public:
    virtual ~ListStorage() = default;
    ListStorage(const ListStorage&) = delete;
    ListStorage& operator=(const ListStorage&) = delete;

    /// Empties the lists. Does not block.
    virtual void clear() = 0;

    /// A build is start(), then begin_pass(), the user's kernels and end_pass() until end_pass() says
    /// that the lists are complete. More passes may follow, where another container needs them: they
    /// fill the lists anew.
    virtual void start() {}
    /// Prepares the next run of the kernels.
    virtual void begin_pass() = 0;
    /// Takes the counters of a run into the report, and grows, stops or drops by the options. True if
    /// the lists are complete. Throws OverflowError; the caller empties the lists then. Blocks.
    virtual bool end_pass(BuildReport& report) = 0;

    /// Whether kernels may insert: only inside of a build.
    void open(bool inserts) { open_ = inserts; }

    /// Makes what a failed build may have left undone. The pool is empty afterwards if there was none,
    /// or if `without_pool` says so.
    virtual void recover(bool without_pool) = 0;

    /// Links, offsets and counts that do not belong together. Blocks.
    [[nodiscard]] virtual Validation validate() = 0;

    /// Adds what CELLIST_LISTS declares.
    void add_to(Arguments& arguments) const;

    [[nodiscard]] std::uint64_t capacity_nodes() const { return capacity_nodes_; }
    /// Device memory of all buffers.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_with(capacity_nodes_); }
    /// The mode in which the lists are read.
    [[nodiscard]] cl_uint mode() const { return mode_; }

protected:
    struct Counters {
        std::uint64_t allocated = 0;
        std::uint64_t dropped = 0;
        std::uint64_t rejected = 0;
        std::uint64_t late = 0;
    };

    ListStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                const Shape& shape, const ListsOptions& options, cl_uint mode,
                std::size_t node_bytes, std::uint64_t head_words);

    [[nodiscard]] const RecordType& record() const { return definitions_.records.back(); }
    [[nodiscard]] std::uint64_t bytes_with(std::uint64_t capacity_nodes) const;
    /// Why the pool cannot have this capacity, if it cannot.
    [[nodiscard]] std::optional<std::string> refusal(std::uint64_t capacity_nodes) const;
    /// Makes a pool of this capacity; the nodes of the old one are gone. Throws Error.
    void allocate_pool(std::uint64_t capacity_nodes);
    [[nodiscard]] bool has_pool() const { return nodes_.cl()() != nullptr; }
    [[nodiscard]] Counters read_counters() const;
    void clear_counters();
    /// Sets the heads from a word on. Does not block.
    void fill_heads(cl_uint value, std::uint64_t first_word = 0);
    /// A report of the counters, with one pass more than before.
    void update(BuildReport& report, const Counters& counters, std::uint64_t stored) const;
    /// Throws OverflowError if the policy or a limit forbids a pool of `demand` nodes.
    void require(std::uint64_t demand, const BuildReport& report) const;
    /// Runs a validating kernel over all cells: (container, arguments..., findings). Blocks.
    [[nodiscard]] cellist_findings findings(Kernel& kernel, const Arguments& arguments);
    /// A kernel of the library for this record.
    [[nodiscard]] Kernel kernel(const std::string& name, std::string_view source) const;

    std::shared_ptr<DeviceState> device_;
    Definitions definitions_;
    Shape shape_;
    ListsOptions options_;
    cl_uint mode_;
    std::size_t node_bytes_;
    std::uint64_t capacity_nodes_ = 0;
    cl_uint shard_bits_ = 0;
    cl_uint slots_ = 0;
    bool open_ = false;
    Memory heads_;
    Memory nodes_;
    Memory shards_;
};

/// The lowest bad cell, if there is one.
[[nodiscard]] inline std::optional<std::uint64_t> bad_cell(const cellist_findings& findings) {
    if (findings.first_bad_cell == CELLIST_NONE) return {};
    return findings.first_bad_cell;
}

/// The storage that the options name, with empty lists. Throws Error if a size exceeds a limit.
[[nodiscard]] std::unique_ptr<ListStorage> make_storage(std::shared_ptr<DeviceState> device,
                                                        const Definitions& definitions,
                                                        const Shape& shape,
                                                        const ListsOptions& options);

}  // namespace cellist::detail
