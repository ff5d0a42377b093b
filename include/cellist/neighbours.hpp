// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include <cellist/buffer.hpp>
#include <cellist/detail/api.hpp>
#include <cellist/opencl.hpp>
#include <cellist/struct.hpp>
#include <cellist/value.hpp>

namespace cellist {

namespace detail {
class ListsCore;
struct NeighbourMemory;
}  // namespace detail

/// Which records Lists::neighbours() finds for each record. Expressions are those of
/// Lists::sort_by(): one OpenCL C expression that does not write.
struct NeighbourOptions {
    /// The distance of two records: an expression of `record` and `other` with a float value, such
    /// as "distance(record.position, other.position)". The kernel functions cellist_minimum_image,
    /// for periodic boxes, and cellist_norm serve here.
    std::string distance;
    /// The largest distance between neighbours. Pairs with a distance of NaN are no neighbours.
    float radius = std::numeric_limits<float>::infinity();
    /// The number of cells to search in each direction along each axis: the radius divided by the
    /// size of a cell, rounded up. Finds no neighbours in cells further away.
    std::uint32_t radius_cells = 1;
    /// The values that the expression uses by name. See Value.
    Values values = {};
};

/// The neighbours of every record, as rows of indices (CSR). Row i belongs to the record at place i
/// of Lists::pack(). It has the indices[offsets[i]] ... indices[offsets[i + 1] - 1], in no
/// particular order. A record is not its own neighbour. Each pair of neighbours is in two rows,
/// unless the distance depends on the order of its records.
///
/// A Neighbours object that is passed to the next search keeps its buffers, which may then have
/// room for more than `records` and `pairs`.
struct Neighbours {
    Buffer<cl_uint> offsets;    ///< records + 1
    Buffer<cl_uint> indices;    ///< pairs
    std::uint64_t records = 0;  ///< rows
    std::uint64_t pairs = 0;    ///< indices

    /// @private
    std::shared_ptr<detail::NeighbourMemory> memory = {};
};

/// Which records Lists::nearest() finds for each query. Expressions are those of Lists::sort_by().
struct NearestOptions {
    /// The number of records for each query, at most 64.
    std::uint32_t k = 1;
    /// Where the query is, in cells: an expression of `query` with a value that is a float or an
    /// int, or a vector of up to 4 of them, such as "query.xyz / 0.1f". It must be what the kernel
    /// that inserts passes to cellist_cell1 ... cellist_cell4 for a record in the same place.
    /// Components beyond the dimensions of the shape have no effect.
    std::string position;
    /// The distance of a record to a query: an expression of `record` and `query` with a float
    /// value, such as "distance(record.position, query)".
    std::string distance;
    /// The largest distance of a record from its query. Records with a distance of NaN are not
    /// found.
    float radius = std::numeric_limits<float>::infinity();
    /// Only cells that are at most this far from the query's along each axis are searched.
    std::uint32_t radius_cells = 1;
    /// The values that the expressions use by name. See Value.
    Values values = {};
};

/// The nearest records of each query, nearest first. Query q has counts[q] records: the records
/// q * k ... q * k + counts[q] - 1. The elements from there to (q + 1) * k - 1 are undefined.
///
/// A Nearest object that is passed to the next search keeps its buffers, which may then have room
/// for more queries.
template <class T>
struct Nearest {
    Buffer<cl_uint> counts;      ///< queries
    Buffer<T> records;           ///< queries * k
    Buffer<cl_float> distances;  ///< queries * k
};

namespace detail {

/// Finds the neighbours. `index` is the member whose value is the index of a record; empty for the
/// record's place.
CELLIST_API void find_neighbours(const ListsCore& lists, const NeighbourOptions& options,
                                 const std::string& index, Neighbours& found);

/// The queries of a search, and where its results go.
struct NearestSearch {
    Definitions types;       ///< of a query
    std::string query_type;  ///< in OpenCL C
    const Memory& queries;
    std::uint64_t count;  ///< of queries
    const Memory& counts;
    const Memory& records;
    const Memory& distances;
};
/// Throws Error if the options are invalid.
CELLIST_API void check_nearest(const NearestOptions& options);
CELLIST_API void find_nearest(const ListsCore& lists, const NearestOptions& options,
                              const NearestSearch& search);

}  // namespace detail
}  // namespace cellist
