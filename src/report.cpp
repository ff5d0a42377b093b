#include <cellist/report.hpp>

namespace cellist {

std::string Validation::message() const {
    if (ok()) return "every node is in exactly one list";
    std::string text = std::to_string(broken_links) + " broken links, " +
                       std::to_string(repeated_nodes) + " links to nodes in a list already, " +
                       std::to_string(lost_nodes) + " lost nodes";
    if (first_bad_cell)
        text += "; the first bad list is that of cell " + std::to_string(*first_bad_cell);
    return text;
}

}  // namespace cellist
