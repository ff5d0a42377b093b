#include <cellist/report.hpp>

namespace cellist {

std::string Validation::message() const {
    if (ok()) return "every node is in exactly one list";
    std::string text =
        std::to_string(broken_links) + " links to nodes that were never allocated, " +
        std::to_string(repeated_nodes) + " links to nodes that are in a list already, " +
        std::to_string(lost_nodes) + " nodes in no list";
    if (broken_links + repeated_nodes > 0)
        text += "; the first bad list is that of cell " + std::to_string(first_bad_cell);
    return text;
}

}  // namespace cellist
