# SPDX-License-Identifier: MIT
# cellist_warnings: the warnings that cellist's own targets compile with.
#
# Link it PRIVATE to a target of this project. It is never installed or exported, so no user of the
# library inherits a warning flag, or a warning as an error.
add_library(cellist_warnings INTERFACE)

target_compile_options(cellist_warnings INTERFACE
    -Wall
    -Wextra
    -Wpedantic
    -Wconversion
    -Wsign-conversion
    -Wdouble-promotion
    -Wshadow
    -Wold-style-cast
    -Wcast-align
    -Wnon-virtual-dtor
    -Woverloaded-virtual
    -Wextra-semi
    -Wundef
    $<$<CXX_COMPILER_ID:GNU>:-Wduplicated-cond>
    $<$<CXX_COMPILER_ID:GNU>:-Wlogical-op>
    # g++ 12 reports an overlapping or oversized memcpy in std::string concatenation where there is
    # none (GCC bug 105651).
    "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow>"
    # g++ takes the files that a unity build includes for headers.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>
    $<$<BOOL:${CELLIST_WERROR}>:-Werror>)

# g++ cannot see through its own instrumentation and reports std::regex and others as uninitialised
# (GCC bug 105562).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
    target_compile_options(cellist_warnings INTERFACE -Wno-maybe-uninitialized)
endif()
