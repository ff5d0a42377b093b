// SPDX-License-Identifier: MIT
#include "mpi/distributed_lists.hpp"

#include <vector>

#include <cellist/mpi.hpp>

#include "input_error.hpp"
#include "methods/lists.hpp"

namespace oit {
namespace {

// Divides the rows of the picture over the ranks, from top to bottom, in the same way for all eyes.
cellist::mpi::Partition rows_of(const cellist::Shape& shape) {
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    return {MPI_COMM_WORLD, shape, {.blocks = {1, static_cast<std::uint32_t>(ranks), 1, 1}}};
}

template <class Node>
class DistributedLists : public Method {
public:
    DistributedLists(FragmentSource& source, cellist::Storage storage)
        : DistributedLists(source, storage, list_reader(source)) {}

    void store() override {
        // No rank may restart a frame alone, so make room for the triangles before the build.
        while (!source_.finish_or_grow()) source_.prepare();
        fragments_.build([&] { source_.draw(pass_, fragments_); });
    }

    void resolve() override {
        if (sorts_) fragments_.sort(&Node::key);
        source_.run_on_screen(reader_, fragments_);
    }

    [[nodiscard]] bool finish_or_grow() override {
        gather_rows();
        return true;
    }

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return fragments_.local().pool_bytes();
    }
    [[nodiscard]] std::optional<cellist::Lengths> lengths() const override {
        return fragments_.lengths();
    }

private:
    DistributedLists(FragmentSource& source, cellist::Storage storage, const ListReader& reader)
        : source_(source),
          sorts_(reader.needs_sorted),
          fragments_(source.device(), rows_of(source.shape()), {.storage = storage}),
          pass_(source.pass(list_pass(), "lists.cl", fragments_)),
          reader_(source.screen_kernel(reader.text, reader.file_name, reader.kernel, fragments_)) {}

    // The number of rows that a rank owns.
    [[nodiscard]] int rows(int rank) const {
        const cellist::mpi::Block& block = fragments_.partition().block(rank);
        return block.cells() == 0 ? 0 : static_cast<int>(block.extent[1]);
    }

    // Copies the rows of all ranks to the image of the first rank.
    void gather_rows() {
        const cellist::mpi::Partition& partition = fragments_.partition();
        const bool is_first = partition.rank() == 0;
        std::vector<int> counts, offsets;
        int sum = 0;
        for (int rank = 0; rank < partition.ranks(); ++rank) {
            offsets.push_back(sum);
            counts.push_back(rows(rank));
            sum += counts.back();
        }
        const auto width = static_cast<std::size_t>(source_.frame().width());
        const auto height = static_cast<std::size_t>(source_.frame().height());
        const std::size_t own = partition.block().origin[1];
        const std::size_t own_rows = static_cast<std::size_t>(rows(partition.rank()));
        MPI_Datatype row = MPI_DATATYPE_NULL;
        MPI_Type_contiguous(static_cast<int>(4 * width), MPI_FLOAT, &row);
        MPI_Type_commit(&row);
        std::vector<cl_float4> image(is_first ? width * height : 0);
        for (std::size_t eye = 0; eye < source_.frame().views.size(); ++eye) {
            const std::vector<cl_float4> mine =
                source_.image().download((eye * height + own) * width, own_rows * width);
            MPI_Gatherv(mine.data(), static_cast<int>(own_rows), row, image.data(), counts.data(),
                        offsets.data(), row, 0, MPI_COMM_WORLD);
            if (is_first) source_.set_image(image, eye);
        }
        MPI_Type_free(&row);
    }

    FragmentSource& source_;
    const bool sorts_;
    cellist::mpi::Lists<Node> fragments_;
    raster::Pass pass_;
    cellist::Kernel reader_;
};

template <cellist::Storage storage>
std::unique_ptr<Method> make(FragmentSource& source) {
    return with_node_type(source.layout().words,
                          [&]<class Node>(const Node*) -> std::unique_ptr<Method> {
                              return std::make_unique<DistributedLists<Node>>(source, storage);
                          });
}

}  // namespace

MethodInfo distributed(const MethodInfo& method) {
    MethodInfo info = method;
    if (method.name == "linked")
        info.make = make<cellist::Storage::linked>;
    else if (method.name == "counted")
        info.make = make<cellist::Storage::counted>;
    else if (method.name == "fixed")
        info.make = make<cellist::Storage::fixed>;
    else
        throw support::InputError("--mpi needs --method linked, counted or fixed, not " +
                                  std::string(method.name));
    return info;
}

}  // namespace oit
