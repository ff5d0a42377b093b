// SPDX-License-Identifier: MIT
// Uses an installed cellist::mpi: counts of 1,000 numbers by their remainder, over all ranks.
#include <cstdio>
#include <stdexcept>

#include <cellist/mpi.hpp>

struct Number {
    cl_uint value;
};
CELLIST_STRUCT(Number, value);

namespace {

constexpr auto source = R"(
#include <cellist/lists.clh>
kernel void sort_out(CELLIST_LISTS(Number, numbers), uint first, uint step, uint end)
{
    const uint value = first + get_global_id(0) * step;
    if (value < end) cellist_insert(numbers, value % 7, (Number){value});
}
)";

void require(bool condition) {
    if (!condition) throw std::runtime_error("wrong lists");
}

void run() {
    const cellist::Device device = cellist::mpi::choose(MPI_COMM_WORLD);
    const cellist::mpi::Partition partition(MPI_COMM_WORLD, cellist::Shape{7});
    cellist::mpi::Lists<Number> numbers(device, partition);
    cellist::Kernel kernel(device, source, "sort_out", numbers);
    const auto rank = static_cast<cl_uint>(partition.rank());
    const auto ranks = static_cast<cl_uint>(partition.ranks());
    const cellist::BuildReport report =
        numbers.build(kernel, cellist::Range(1000), rank, ranks, cl_uint{1000});
    require(report.stored == 1000);
    numbers.sort(&Number::value);
    const cellist::HostLists<Number> lists = numbers.download();
    for (std::uint64_t cell = 0; cell < 7; ++cell) {
        cl_uint expected = static_cast<cl_uint>(cell);
        for (const Number& number : lists.cell(cell)) {
            require(number.value == expected);
            expected += 7;
        }
        require(expected >= 1000);
    }
    if (rank == 0) std::printf("1000 numbers on %u ranks\n", ranks);
}

}  // namespace

int main(int argc, char** argv) {
    int level = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
    try {
        run();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Finalize();
}
