# SPDX-License-Identifier: MIT
# Compiles every header alone, so that no header depends on what its user included before it.
#
#   cellist_add_header_checks(<name> TARGET <target> BASE_DIR <dir> HEADERS <header>...)
#
# Adds the object library <name> with one source per header; each includes its header twice, as
# <path under BASE_DIR>, with the include directories of <target>. A header that wraps an optional
# library is left out, with a message, where that library is missing.
function(cellist_add_header_checks name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "TARGET;BASE_DIR" "HEADERS")
    cmake_path(ABSOLUTE_PATH arg_BASE_DIR NORMALIZE)

    # header path under BASE_DIR -> a file of the library that it wraps
    set(optional_headers "cellist/glm.hpp")
    set(needed_by_cellist_glm_hpp "glm/glm.hpp")

    set(sources "")
    set(extra_include_dirs "")
    foreach(header IN LISTS arg_HEADERS)
        cmake_path(ABSOLUTE_PATH header NORMALIZE)
        cmake_path(RELATIVE_PATH header BASE_DIRECTORY "${arg_BASE_DIR}")
        string(MAKE_C_IDENTIFIER "${header}" id)

        if(header IN_LIST optional_headers)
            find_path(CELLIST_DIR_OF_${id} "${needed_by_${id}}")
            mark_as_advanced(CELLIST_DIR_OF_${id})
            if(NOT CELLIST_DIR_OF_${id})
                message(STATUS "cellist: <${header}> is not checked, ${needed_by_${id}} is missing")
                continue()
            endif()
            list(APPEND extra_include_dirs "${CELLIST_DIR_OF_${id}}")
        endif()

        set(source "${CMAKE_CURRENT_BINARY_DIR}/${name}/${id}.cpp")
        file(CONFIGURE OUTPUT "${source}" CONTENT "#include <${header}>\n#include <${header}>\n")
        list(APPEND sources "${source}")
    endforeach()

    add_library(${name} OBJECT ${sources})
    set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
    target_link_libraries(${name} PRIVATE ${arg_TARGET} cellist_warnings)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O0>)
    target_include_directories(${name} SYSTEM PRIVATE ${extra_include_dirs})
endfunction()
