// SPDX-License-Identifier: MIT
// Loads the plug-in, and catches an error of the library that is thrown in it.
#include <cstdio>

#include <dlfcn.h>

#include <cellist/cellist.hpp>

int main(int argument_count, char** arguments) {
    void* const plugin = argument_count > 1 ? dlopen(arguments[1], RTLD_NOW) : nullptr;
    auto* const function =
        plugin != nullptr ? reinterpret_cast<void (*)()>(dlsym(plugin, "plugin_throw")) : nullptr;
    if (function == nullptr) return 1;
    try {
        function();
    } catch (const cellist::Error& error) {
        std::puts(error.what());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "not a cellist::Error: %s\n", error.what());
    }
    return 1;
}
