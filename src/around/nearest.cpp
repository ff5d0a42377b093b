// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>

#include <cellist/detail/lists_core.hpp>
#include <cellist/error.hpp>
#include <cellist/neighbours.hpp>

#include "cellist_kernels.hpp"
#include "device/device_state.hpp"
#include "device/record_kernels.hpp"
#include "expression/expression.hpp"
#include "expression/program.hpp"
#include "storage/container_storage.hpp"

namespace cellist::detail {

namespace {

constexpr std::uint32_t k_max = 64;

/// Work-items that share a query on GPUs.
constexpr std::size_t team_size = 64;

bool has_teams(const DeviceInfo& device) {
    return device.is_gpu() && device.max_work_group_size >= team_size;
}

Range range_of(std::uint64_t queries, const DeviceInfo& device) {
    return has_teams(device) ? Range::padded(queries * team_size, team_size)
                             : Range::padded(queries, 16);
}

/// What `record` and `query` are.
std::vector<Subject> query_subjects() {
    return {{"record", "(*cellist_record)"}, {"query", "(*cellist_query)"}};
}

}  // namespace

void check_nearest(const NearestOptions& options) {
    if (options.k > k_max)
        throw Error("the " + std::to_string(options.k) +
                    " nearest records of each query exceed the limit of " + std::to_string(k_max) +
                    ": lower k");
    check_expression(options.position, "position expression");
    check_expression(options.distance, "distance expression");
    check_values(options.values, query_subjects());
}

void find_nearest(const ListsCore& lists, const NearestOptions& options,
                  const NearestSearch& search) {
    lists.require_not_building();
    lists.make_ready_for_commands();
    RecordKernels& kernels = lists.storage().kernels();
    const std::string query = "const " + search.query_type + "* cellist_query,\n    ";
    ExpressionProgram program = expression_program(
        options.values, {{.expression = options.position,
                          .what = "position expression",
                          .head = "static inline int4 cellist_query_position(" + query,
                          .before = "cellist_position",
                          .subjects = {query_subjects()[1]}},
                         {.expression = options.distance,
                          .what = "distance expression",
                          .head = "static inline float cellist_distance(const " +
                                  kernels.record().type() + "* cellist_record, " + query,
                          .before = "(float)",
                          .subjects = query_subjects()}});
    program.types.add(search.types);
    const DeviceInfo& device = lists.device()->info;
    const std::string& record = kernels.record().name;
    const std::string definitions =
        "#define CELLIST_QUERY " + search.query_type + "\n#define CELLIST_K_MAX " +
        std::to_string(std::max(std::bit_ceil(options.k), 1U)) + "u\n#define CELLIST_DIMENSIONS " +
        std::to_string(lists.shape().dimensions()) + "\n#define CELLIST_NODE cellist_node_" +
        record + "\n#define CELLIST_VIEW cellist_view_" + record + "\n" +
        (has_teams(device) ? "#define CELLIST_TEAM " + std::to_string(team_size) + "u\n" : "") +
        program.source;
    Arguments arguments;
    lists.add_to(arguments);
    arguments.add(search.queries);
    arguments.add(static_cast<cl_uint>(search.count));
    arguments.add(static_cast<cl_uint>(options.k));
    arguments.add(static_cast<cl_uint>(options.radius_cells));
    arguments.add(options.radius);
    arguments.append(program.values);
    arguments.add(search.counts);
    arguments.add(search.records);
    arguments.add(search.distances);
    kernels
        .get({{"k_nearest.cl", kernels::k_nearest_cl}}, "cellist_find_nearest", lists.mode(),
             definitions, program.types)
        .enqueue(range_of(search.count, device), arguments);
}

}  // namespace cellist::detail
