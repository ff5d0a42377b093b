#include "list_method.hpp"

#include "input_error.hpp"
#include "list_slices.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

// Up to here the nearest layers are kept in registers while the list is visited once; for more,
// sorting the lists is faster.
constexpr std::uint32_t nearest_max = 16;

bool picks_nearest(const Quality& quality) {
    return quality.layers && *quality.layers <= nearest_max;
}

ListReader blending_reader(const Quality& quality) {
    const std::string nearest =
        picks_nearest(quality) ? "#define OIT_NEAREST " + std::to_string(*quality.layers) + "\n"
                               : std::string();
    return {nearest + std::string(kernels::lists_cl), "lists.cl", "oit_resolve_lists"};
}

template <class Node>
class ListMethod : public Method {
public:
    ListMethod(FragmentSource& source, const cellist::ListsOptions& options,
               const ListReader& reader, bool sorts)
        : source_(source),
          sorts_(sorts),
          slices_(slice_plan<Node>(source, options)),
          fragments_(source.device(), source.shape(), sliced(options, slices_)),
          pass_(source.pass(kernels::lists_cl, "lists.cl", fragments_)),
          resolve_(source.screen_kernel(reader.text, reader.file_name, reader.kernel, fragments_)) {
    }

    void store() override {
        const auto insert = [&] { source_.draw(pass_, fragments_); };
        if (slices_)
            build_in_slices(source_, *slices_, fragments_, insert, [&] { blend(); });
        else
            fragments_.build(insert);
    }

    void resolve() override {
        if (!slices_) blend();
    }

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return fragments_.pool_bytes() + (slices_ ? slices_->count_bytes : 0);
    }
    [[nodiscard]] std::uint32_t slices() const override { return slices_ ? slices_->count : 1; }
    [[nodiscard]] std::optional<cellist::Lengths> lengths() const override {
        if (slices_) return {};
        return fragments_.lengths();
    }
    [[nodiscard]] std::optional<StoredDepths> depths() const override {
        if (slices_) return {};
        const cellist::HostLists<Node> lists = fragments_.download();
        StoredDepths stored{{lists.offsets().begin(), lists.offsets().end()}, {}};
        for (const Node& node : lists.records())
            stored.depths.push_back(source_.layout().depth_of(node.key, source_.needs()));
        return stored;
    }

private:
    void blend() {
        if (sorts_) fragments_.sort(&Node::key);
        source_.run_on_screen(resolve_, fragments_);
    }

    FragmentSource& source_;
    bool sorts_;
    std::optional<Slices> slices_;  ///< where memory is bounded
    cellist::Lists<Node> fragments_;
    raster::Pass pass_;
    cellist::Kernel resolve_;
};

}  // namespace

std::unique_ptr<Method> make_list_method(FragmentSource& source,
                                         const cellist::ListsOptions& options,
                                         std::optional<ListReader> reader) {
    const Quality& quality = source.frame().quality;
    const bool sorts = reader || !picks_nearest(quality);
    if (!reader) reader = blending_reader(quality);
    return with_node_type(
        source.layout().words, [&]<class Node>(const Node*) -> std::unique_ptr<Method> {
            return std::make_unique<ListMethod<Node>>(source, options, *reader, sorts);
        });
}

}  // namespace oit
