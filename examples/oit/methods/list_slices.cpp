// SPDX-License-Identifier: MIT
#include "methods/list_slices.hpp"

#include <algorithm>
#include <optional>

#include "input_error.hpp"
#include "methods/count_fragments.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

template <class Node>
class ListSlices : public Method {
public:
    ListSlices(FragmentSource& source, const cellist::ListsOptions& options,
               const ListReader& reader)
        : source_(source),
          sorts_(reader.needs_sorted),
          node_bytes_(sizeof(Node) +
                      (options.storage == cellist::Storage::linked ? sizeof(cl_uint) : 0)),
          head_bytes_(bytes_of_empty({.storage = options.storage, .capacity_nodes = 0, .slots = 0},
                                     sorts_)),
          sort_bytes_(
              head_bytes_ -
              bytes_of_empty({.storage = options.storage, .capacity_nodes = 0, .slots = 0}, false)),
          count_bytes_(bytes_of_empty({.storage = cellist::Storage::counted,
                                       .overflow = cellist::Overflow::drop,
                                       .capacity_nodes = 0},
                                      false)),
          fragments_(source.device(), source.shape(), within_budget(options)),
          pass_(source.pass(kernels::lists_cl, "lists.cl", fragments_)),
          reader_(source.screen_kernel(reader.text, reader.file_name, reader.kernel, fragments_)) {}

    void store() override {
        // Slices are chosen by what there is, so nothing may be missing.
        while (!source_.finish_or_grow()) source_.prepare();
        count_ = 0;
        if (budget() < head_bytes_ + count_bytes_) refuse();
        try {
            fragments_.build_slices([&] { source_.draw(pass_, fragments_); },
                                    [&](const cellist::Slice& slice) { blend(slice); });
        } catch (const cellist::OverflowError&) {
            refuse();
        }
    }

    void resolve() override {}

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return fragments_.pool_bytes() + count_bytes_;
    }
    [[nodiscard]] bool blends_slices() const override { return true; }
    [[nodiscard]] std::uint32_t slices() const override { return count_; }
    // The lists are those of the last slice, so fragments are counted anew.
    [[nodiscard]] std::optional<cellist::Lengths> lengths() const override {
        return cellist::Lengths(count_fragments(source_));
    }

private:
    [[nodiscard]] std::uint64_t budget() const { return *source_.frame().memory_bytes; }

    // What lists take without nodes, and with what they keep for sorts.
    [[nodiscard]] std::uint64_t bytes_of_empty(const cellist::ListsOptions& options,
                                               bool sorts) const {
        cellist::Lists<Node> lists(source_.device(), source_.shape(), options);
        if (sorts) lists.sort(&Node::key);
        return lists.pool_bytes();
    }

    // Empty lists can be made under any budget; that it is too small is said when lists are built.
    [[nodiscard]] cellist::ListsOptions within_budget(cellist::ListsOptions options) const {
        options.budget_bytes =
            std::max(budget(), head_bytes_ + count_bytes_) - count_bytes_ - sort_bytes_;
        return options;
    }

    void blend(const cellist::Slice& slice) {
        source_.set_slice(slice);
        if (sorts_) fragments_.sort(&Node::key);
        source_.run_on_screen(reader_, fragments_);
        ++count_;
    }

    [[noreturn]] void refuse() {
        const std::uint64_t longest = cellist::Lengths(count_fragments(source_)).longest;
        throw support::InputError(
            "--memory of " + std::to_string(budget()) +
            " bytes is too little for this frame: it needs at least " +
            std::to_string(head_bytes_ + count_bytes_ + longest * node_bytes_) + " bytes, for " +
            std::to_string(source_.frame().pixels()) + " pixels and a list of " +
            std::to_string(longest) + " fragments");
    }

    FragmentSource& source_;
    bool sorts_;
    std::uint64_t node_bytes_;
    std::uint64_t head_bytes_;   // of all pixels, whatever the lists hold, and of their sorts
    std::uint64_t sort_bytes_;   // the part of it that only sorts need
    std::uint64_t count_bytes_;  // of the counts by which slices are chosen
    cellist::Lists<Node> fragments_;
    raster::Pass pass_;
    cellist::Kernel reader_;
    std::uint32_t count_ = 0;
};

}  // namespace

std::unique_ptr<Method> make_list_slices(FragmentSource& source,
                                         const cellist::ListsOptions& options,
                                         const ListReader& reader) {
    return with_node_type(source.layout().words,
                          [&]<class Node>(const Node*) -> std::unique_ptr<Method> {
                              return std::make_unique<ListSlices<Node>>(source, options, reader);
                          });
}

}  // namespace oit
