// SPDX-License-Identifier: MIT
// The methods that keep every fragment in a list of its pixel, and what they share with others.
#include "methods/lists.hpp"

#include <bit>

#include "methods/lens_gather.hpp"
#include "methods/list_slices.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

// Up to here, the reader keeps the nearest layers in registers while it visits a list once. For
// more, sorting the lists is faster.
std::uint32_t nearest_max(const cellist::DeviceInfo& device) { return device.is_gpu() ? 8 : 16; }

// The longest lists that the reader sorts itself; longer ones are sorted before.
constexpr std::uint32_t sorted_in_reader_max = 127;

// Lists that a work-item of a processor reads together. With 16 instead of 64, blending the dragon
// with 4 samples takes a third longer.
constexpr std::uint32_t strip = 64;

// The macros of a reader that sorts lists of up to `longest` fragments. GPUs sort in runs where
// lists are long. Equal keys, as those of few bits often are, make them sort twice.
std::string sorting_defines(const cellist::DeviceInfo& device, const NodeLayout& layout,
                            std::uint64_t longest) {
    constexpr std::uint64_t run = 16;
    constexpr std::uint64_t in_runs_min = 64;
    std::string defines = define("OIT_SORTED", std::bit_ceil(longest + 1));
    if (device.is_gpu() && has_float_depth(layout.format) && longest >= in_runs_min)
        defines += define("OIT_RUN", run);
    if (!device.is_gpu()) defines += define("OIT_STRIP", strip);
    return defines;
}

std::string layers_define(const Quality& quality) {
    return quality.layers ? define("OIT_LAYERS", *quality.layers) : "";
}

ListReader blending_reader(const Quality& quality, bool needs_sorted, std::string defines = {}) {
    defines += layers_define(quality);
    return {defines.append(kernels::lists_cl), "lists.cl", "oit_resolve_lists", needs_sorted};
}

ListReader first_reader(const Quality& quality, const cellist::DeviceInfo& device) {
    if (quality.layers && *quality.layers <= nearest_max(device))
        return blending_reader(quality, false, define("OIT_NEAREST", *quality.layers));
    return blending_reader(quality, true);
}

// The first frame blocks until the lengths of the lists are known. Later frames are enqueued at
// once, into a pool a quarter larger. A frame that overflows this pool is drawn again, and blocks
// as the first frame does. So do all frames if the larger pool cannot be allocated.
template <class Node>
class ListMethod : public Method {
public:
    // Without a reader, the lists are seen through the frame's lens.
    ListMethod(FragmentSource& source, const cellist::ListsOptions& options,
               const std::optional<ListReader>& reader, bool may_sort_in_reader)
        : source_(source),
          options_(options),
          sorts_(!reader || reader->needs_sorted),
          may_sort_in_reader_(may_sort_in_reader),
          may_fix_capacity_(keeps_all()),
          fragments_(lists_with(options)),
          pass_(source.pass(kernels::lists_cl, "lists.cl", fragments_)) {
        if (reader)
            reader_.emplace(kernel_of(*reader));
        else
            lens_.emplace(source, layers_define(source.frame().quality), fragments_);
        // What a sort keeps counts for --memory from the first frame.
        if (sorts_ && source.frame().memory_bytes) fragments_.sort(&Node::key);
    }

    void store() override {
        if (pool_ == Pool::measured) fix_capacity();
        const auto draw = [this] { source_.draw(pass_, fragments_); };
        if (pool_ == Pool::bounded)
            built_ = fragments_.build_async(draw);
        else
            fragments_.build(draw);
    }

    // The build reads its counters at its end: a read between kernels makes the device wait. So
    // what reads the lists is part of the build, unless a list is complete only after it.
    void draw(const std::function<void()>& stored) override {
        if (pool_ == Pool::measured) fix_capacity();
        if (pool_ != Pool::bounded || !unsorted_reader_ ||
            fragments_.storage() == cellist::Storage::counted)
            return Method::draw(stored);
        built_ = fragments_.build_async([this, stored] {
            source_.draw(pass_, fragments_);
            stored();
            read_unsorted();
        });
    }

    void resolve() override {
        if (pool_ == Pool::bounded && unsorted_reader_) {
            read_unsorted();
            return;
        }
        if (sorts_) fragments_.sort(&Node::key);
        if (lens_)
            lens_->run(fragments_);
        else
            source_.run_on_screen(*reader_, fragments_);
    }

    [[nodiscard]] bool finish_or_grow() override {
        const bool gathered = !lens_ || lens_->finish_or_grow();
        return finish_lists() && gathered;
    }

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return fragments_.pool_bytes() + (lens_ ? lens_->device_bytes() : 0);
    }
    [[nodiscard]] std::optional<cellist::Lengths> lengths() const override {
        if (!keeps_all()) return {};
        return fragments_.lengths();
    }
    [[nodiscard]] std::optional<StoredDepths> depths() const override {
        if (!keeps_all()) return {};
        const cellist::HostLists<Node> lists = fragments_.download();
        StoredDepths stored{{lists.offsets().begin(), lists.offsets().end()}, {}};
        for (const Node& node : lists.records())
            stored.depths.push_back(source_.layout().depth_of(node.key, source_.features()));
        return stored;
    }

private:
    enum class Pool {
        growing,   // store() waits for the device, and the pool grows
        measured,  // as growing, and lengths_ is known: the next store() bounds the capacity
        bounded,   // store() does not wait, and fragments that do not fit are dropped
    };

    void read_unsorted() {
        if (source_.device().info().is_gpu())
            source_.run_on_screen(*unsorted_reader_, fragments_, source_.counts(), longer_);
        else
            source_.run_on_strips(strip, *unsorted_reader_, fragments_, source_.counts(), longer_);
    }

    // As finish_or_grow(), for the lists alone.
    [[nodiscard]] bool finish_lists() {
        if (pool_ != Pool::bounded) {
            if (may_fix_capacity_) {
                lengths_ = fragments_.lengths();
                pool_ = Pool::measured;
            }
            return true;
        }
        const bool fitted = built_.get().dropped == 0;
        if (fitted && !(unsorted_reader_ && source_.note() == longer_)) return true;
        fragments_ = lists_with(options_);
        pool_ = Pool::growing;
        return false;
    }

    [[nodiscard]] bool keeps_all() const { return options_.overflow == cellist::Overflow::grow; }

    // Makes a pool for a quarter more fragments than lengths_ says. If that is more than the budget
    // or the device has, the pool goes on to grow.
    void fix_capacity() {
        const auto more = [](std::uint64_t n) { return n + n / 4 + 1; };
        cellist::ListsOptions options = options_;
        options.overflow = cellist::Overflow::drop;
        if (options.storage == cellist::Storage::fixed)
            options.slots = static_cast<std::uint32_t>(more(lengths_.longest));
        else
            options.capacity_nodes = more(lengths_.total);
        const std::uint64_t longest = more(lengths_.longest);
        try {
            // A default pool replaces the old one first, so that the device never holds the old
            // and the new large pool together.
            fragments_ = lists_with(options_);
            fragments_ = lists_with(options);
        } catch (const cellist::Error&) {
            may_fix_capacity_ = false;
            pool_ = Pool::growing;
            return;
        }
        if (may_sort_in_reader_ && longest <= sorted_in_reader_max)
            unsorted_reader_.emplace(kernel_of(blending_reader(
                source_.frame().quality, false,
                sorting_defines(source_.device().info(), source_.layout(), longest))));
        else
            unsorted_reader_.reset();
        ++longer_;
        pool_ = Pool::bounded;
    }

    [[nodiscard]] cellist::Lists<Node> lists_with(const cellist::ListsOptions& options) const {
        return {source_.device(), source_.shape(), options};
    }

    [[nodiscard]] cellist::Kernel kernel_of(const ListReader& reader) const {
        return source_.screen_kernel(reader.text, reader.file_name, reader.kernel, fragments_);
    }

    FragmentSource& source_;
    const cellist::ListsOptions options_;
    const bool sorts_;
    const bool may_sort_in_reader_;
    bool may_fix_capacity_;
    cellist::Lists<Node> fragments_;
    raster::Pass pass_;
    std::optional<cellist::Kernel> reader_;
    std::optional<LensGather> lens_;
    std::optional<cellist::Kernel> unsorted_reader_;  // of short lists in a fixed pool
    Pool pool_ = Pool::growing;
    cellist::Lengths lengths_ = {};  // of the last frame, if the pool is measured
    cl_uint longer_ = 0;  // the note that unsorted_reader_ leaves if a list is too long for it
    cellist::Pending<cellist::BuildReport> built_;
};

std::unique_ptr<Method> make_unsliced(FragmentSource& source, const cellist::ListsOptions& options,
                                      const std::optional<ListReader>& reader,
                                      bool may_sort_in_reader) {
    return with_node_type(
        source.layout().words, [&]<class Node>(const Node*) -> std::unique_ptr<Method> {
            return std::make_unique<ListMethod<Node>>(source, options, reader, may_sort_in_reader);
        });
}

// Media and functions of one's own need distances, which differ within a pixel.
std::string refusal_of_lists(const Frame& frame, const FrameFeatures& features) {
    if (frame.quality.coverage == Coverage::exact &&
        (features.has(Blend::absorb) || features.has(Blend::user)))
        return "exact coverage cannot blend absorbing surfaces or functions of your own: use "
               "--samples 8";
    return {};
}

template <cellist::Storage storage>
std::unique_ptr<Method> make_lists(FragmentSource& source) {
    return make_layer_method(source, {.storage = storage});
}

const MethodRegistration linked_method(
    {.name = "linked",
     .summary = "a linked list for each pixel (Yang et al. 2010)",
     .position = 10,
     .exact = true,
     .cuts = true,
     .refusal = refusal_of_lists,
     .make = make_lists<cellist::Storage::linked>,
     .bound = bound_of_layers});

const MethodRegistration counted_method({.name = "counted",
                                         .summary = "contiguous lists, in two passes (prefix sums)",
                                         .position = 20,
                                         .exact = true,
                                         .refusal = refusal_of_lists,
                                         .make = make_lists<cellist::Storage::counted>,
                                         .bound = bound_of_layers,
                                         .passes = two_passes});

const MethodRegistration fixed_method(
    {.name = "fixed",
     .summary = "fixed slots for each pixel, up to the longest list (FreePipe, Liu et al. 2010)",
     .position = 30,
     .exact = true,
     .refusal = refusal_of_lists,
     .make = make_lists<cellist::Storage::fixed>,
     .bound = bound_of_layers});

}  // namespace

std::string_view list_pass() { return kernels::lists_cl; }

ListReader list_reader(FragmentSource& source) {
    return first_reader(source.frame().quality, source.device().info());
}

std::unique_ptr<Method> make_list_method(FragmentSource& source,
                                         const cellist::ListsOptions& options,
                                         const std::optional<ListReader>& other_reader) {
    const ListReader reader = other_reader ? *other_reader : list_reader(source);
    if (source.frame().memory_bytes && options.overflow == cellist::Overflow::grow)
        return make_list_slices(source, options, reader);
    // GPUs keep few layers in registers while they visit a list in no order.
    const bool may_sort_in_reader =
        !other_reader && (reader.needs_sorted || !source.device().info().is_gpu());
    return make_unsliced(source, options, reader, may_sort_in_reader);
}

std::unique_ptr<Method> make_layer_method(FragmentSource& source,
                                          const cellist::ListsOptions& options) {
    if (!source.frame().lens) return make_list_method(source, options);
    return make_unsliced(source, options, {}, false);
}

}  // namespace oit
