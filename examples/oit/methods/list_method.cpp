#include "methods/list_method.hpp"

#include <bit>
#include <utility>

#include "methods/list_slices.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

// Up to here the nearest layers are kept in registers while the list is visited once; for more,
// sorting the lists is faster.
constexpr std::uint32_t nearest_max = 16;

// Longest lists that a work-item sorts on its way through them; longer ones are sorted before.
constexpr std::uint32_t sorted_on_the_way_max = 63;

bool picks_nearest(const Quality& quality) {
    return quality.layers && *quality.layers <= nearest_max;
}

std::string define(const std::string& name, std::uint32_t value) {
    return "#define " + name + " " + std::to_string(value) + "\n";
}

ListReader blending_reader(const Quality& quality, std::string defines = {}) {
    if (quality.layers) defines += define("OIT_LAYERS", *quality.layers);
    return {defines.append(kernels::lists_cl), "lists.cl", "oit_resolve_lists"};
}

bool needs_sorting(const Quality& quality, const std::optional<ListReader>& reader) {
    return reader || !picks_nearest(quality);
}

ListReader reader_of(const Quality& quality, const std::optional<ListReader>& reader) {
    if (reader) return *reader;
    if (needs_sorting(quality, reader)) return blending_reader(quality);
    return blending_reader(quality, define("OIT_NEAREST", *quality.layers));
}

// The device is waited for where the length of the lists is not known: in the first frame, and in
// others that have more fragments than fit. All further ones are enqueued at once, into a pool with
// room for somewhat more fragments than the first had; or drawn as the first, where there is no
// such room.
template <class Node>
class ListMethod : public Method {
public:
    ListMethod(FragmentSource& source, const cellist::ListsOptions& options,
               const std::optional<ListReader>& reader)
        : source_(source),
          options_(options),
          fragments_(lists_with(options)),
          pass_(source.pass(kernels::lists_cl, "lists.cl", *fragments_)),
          may_fix_capacity_(keeps_all()),
          longer_(source.device(), 1) {
        const Quality& quality = source.frame().quality;
        sorts_ = needs_sorting(quality, reader);
        may_sort_on_the_way_ = !reader && sorts_;
        // What a sort keeps counts for --memory from the first frame.
        if (sorts_ && source.frame().memory_bytes) fragments_->sort(&Node::key);
        reader_.emplace(kernel_of(reader_of(quality, reader)));
    }

    void store() override {
        if (last_lengths_) fix_capacity(*std::exchange(last_lengths_, std::nullopt));
        const auto draw = [this] { source_.draw(pass_, *fragments_); };
        if (has_fixed_capacity_)
            built_ = fragments_->build_async(draw);
        else
            fragments_->build(draw);
    }

    void resolve() override {
        if (has_fixed_capacity_ && sorter_) {
            source_.run_on_screen(*sorter_, *fragments_, longer_);
            longer_read_ = longer_.download_async();
            return;
        }
        if (sorts_) fragments_->sort(&Node::key);
        source_.run_on_screen(*reader_, *fragments_);
    }

    [[nodiscard]] bool finish_or_grow() override {
        if (!has_fixed_capacity_) {
            if (may_fix_capacity_) last_lengths_ = fragments_->lengths();
            return true;
        }
        const bool fitted = built_.get().dropped == 0;
        if (fitted && !(sorter_ && longer_read_.get().front() != 0)) return true;
        grow_again();
        return false;
    }

    [[nodiscard]] std::uint64_t device_bytes() const override { return fragments_->pool_bytes(); }
    [[nodiscard]] std::optional<cellist::Lengths> lengths() const override {
        if (!keeps_all()) return {};
        return fragments_->lengths();
    }
    [[nodiscard]] std::optional<StoredDepths> depths() const override {
        if (!keeps_all()) return {};
        const cellist::HostLists<Node> lists = fragments_->download();
        StoredDepths stored{{lists.offsets().begin(), lists.offsets().end()}, {}};
        for (const Node& node : lists.records())
            stored.depths.push_back(source_.layout().depth_of(node.key, source_.features()));
        return stored;
    }

private:
    [[nodiscard]] bool keeps_all() const { return options_.overflow == cellist::Overflow::grow; }

    // Makes a pool for as many fragments as there were, and a quarter more. Where that is more than
    // the budget or the device has, though the demand itself was not, lists go on to grow.
    void fix_capacity(const cellist::Lengths& lengths) {
        const auto more = [](std::uint64_t n) { return n + n / 4 + 1; };
        cellist::ListsOptions options = options_;
        options.overflow = cellist::Overflow::drop;
        if (options.storage == cellist::Storage::fixed)
            options.slots = static_cast<std::uint32_t>(more(lengths.longest));
        else
            options.capacity_nodes = more(lengths.total);
        const std::uint64_t longest = more(lengths.longest);
        try {
            // The old pool goes first, so that the device never holds both.
            *fragments_ = lists_with(options_);
            *fragments_ = lists_with(options);
        } catch (const cellist::Error&) {
            may_fix_capacity_ = false;
            return;
        }
        if (may_sort_on_the_way_ && longest <= sorted_on_the_way_max)
            sorter_.emplace(kernel_of(blending_reader(
                source_.frame().quality,
                define("OIT_SORTED", static_cast<std::uint32_t>(std::bit_ceil(longest + 1))))));
        else
            sorter_.reset();
        longer_.fill(0);
        has_fixed_capacity_ = true;
    }

    void grow_again() {
        *fragments_ = lists_with(options_);
        has_fixed_capacity_ = false;
    }

    [[nodiscard]] cellist::Lists<Node> lists_with(const cellist::ListsOptions& options) const {
        return {source_.device(), source_.shape(), options};
    }

    [[nodiscard]] cellist::Kernel kernel_of(const ListReader& reader) const {
        return source_.screen_kernel(reader.text, reader.file_name, reader.kernel, *fragments_);
    }

    FragmentSource& source_;
    cellist::ListsOptions options_;
    std::optional<cellist::Lists<Node>> fragments_;
    raster::Pass pass_;
    bool sorts_ = false;
    bool may_sort_on_the_way_ = false;
    std::optional<cellist::Kernel> reader_;
    std::optional<cellist::Kernel> sorter_;  // reads lists that are not sorted
    bool may_fix_capacity_;
    bool has_fixed_capacity_ = false;
    std::optional<cellist::Lengths> last_lengths_;  // of the last frame, for fix_capacity()
    cellist::Buffer<cl_uint> longer_;               // not 0 where it met a list that is too long
    cellist::Pending<cellist::BuildReport> built_;
    cellist::Pending<std::vector<cl_uint>> longer_read_;
};

}  // namespace

std::unique_ptr<Method> make_list_method(FragmentSource& source,
                                         const cellist::ListsOptions& options,
                                         std::optional<ListReader> reader) {
    const Quality& quality = source.frame().quality;
    if (source.frame().memory_bytes && options.overflow == cellist::Overflow::grow)
        return make_list_slices(source, options, reader_of(quality, reader),
                                needs_sorting(quality, reader));
    return with_node_type(source.layout().words,
                          [&]<class Node>(const Node*) -> std::unique_ptr<Method> {
                              return std::make_unique<ListMethod<Node>>(source, options, reader);
                          });
}

}  // namespace oit
