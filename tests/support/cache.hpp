// SPDX-License-Identifier: MIT
#pragma once
// Environment variables and cache directories for a test.

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>
#include <string>

namespace cellist::test {

/// An environment variable that has its old value back at the end.
class Variable {
public:
    /// Null unsets it.
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        set(value);
    }
    ~Variable() { set(old_ ? old_->c_str() : nullptr); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    void set(const char* value) {
        if (value != nullptr)
            setenv(name_, value, 1);
        else
            unsetenv(name_);
    }
    const char* name_;
    std::optional<std::string> old_;
};

/// An empty directory that is the user's cache directory for as long as it lives.
class CacheDirectory {
public:
    CacheDirectory()
        : path(std::filesystem::temp_directory_path() /
               ("cellist-test-" + std::to_string(std::random_device{}()))),
          variable_("XDG_CACHE_HOME", path.c_str()) {
        std::filesystem::create_directories(path);
    }
    ~CacheDirectory() { std::filesystem::remove_all(path); }
    CacheDirectory(const CacheDirectory&) = delete;
    CacheDirectory& operator=(const CacheDirectory&) = delete;

    const std::filesystem::path path;

private:
    Variable variable_;
};

/// A cache directory in which the library caches programs, too.
class ProgramCacheDirectory : public CacheDirectory {
public:
    /// Where the programs are.
    [[nodiscard]] std::filesystem::path programs() const { return path / "cellist" / "programs"; }

private:
    Variable on_{"CELLIST_PROGRAM_CACHE", nullptr};
};

}  // namespace cellist::test
