// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <utility>

namespace cellist::detail {

/// A map of the `most` values that were used last: a new value replaces the least recently used
/// one. The address of a value stays the same while it is in the map.
template <class Key, class Value>
class Recent {
public:
    explicit Recent(std::size_t most) : most_(most) {}

    /// Null if there is none.
    [[nodiscard]] Value* find(const Key& key) {
        const auto known = places_.find(key);
        if (known == places_.end()) return nullptr;
        values_.splice(values_.begin(), values_, known->second);
        return &values_.front().second;
    }
    /// Adds a value; its key must not be in the map.
    Value& add(const Key& key, Value value) {
        values_.emplace_front(key, std::move(value));
        try {
            places_.emplace(key, values_.begin());
        } catch (...) {
            values_.pop_front();
            throw;
        }
        if (values_.size() > most_) {
            places_.erase(values_.back().first);
            values_.pop_back();
        }
        return values_.front().second;
    }
    [[nodiscard]] std::size_t size() const { return values_.size(); }
    /// Keys and values, the last used first.
    [[nodiscard]] auto begin() { return values_.begin(); }
    [[nodiscard]] auto end() { return values_.end(); }

private:
    using Values = std::list<std::pair<Key, Value>>;

    std::size_t most_;
    Values values_;  ///< the last used first
    std::map<Key, typename Values::iterator> places_;
};

}  // namespace cellist::detail
