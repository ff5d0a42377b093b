# SPDX-License-Identifier: MIT
# Configures, builds and runs one outside project against this cellist.
#
#   way          find_package, fetch_content or add_subdirectory
#   source_dir   this repository
#   build_dir    a finished build of it, which find_package installs from
#   work_dir     directory of this test; emptied first
#   config, generator, make_program, cxx_compiler, cxx_flags   as in that build
#   mpiexec      the program that starts ranks, or empty
#
# An installed package must work where it was moved to and without a trace of where it came from,
# so it is installed to one prefix, moved to another, and used there.
cmake_minimum_required(VERSION 3.25)

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${work_dir}")
file(MAKE_DIRECTORY "${work_dir}")

if(way STREQUAL "find_package")
    set(first_prefix "${work_dir}/first")
    set(prefix "${work_dir}/moved")
    # The examples are left out.
    foreach(component development command)
        run("${CMAKE_COMMAND}" --install "${build_dir}" --config "${config}"
            --component "${component}" --prefix "${first_prefix}")
    endforeach()
    file(RENAME "${first_prefix}" "${prefix}")

    file(GLOB_RECURSE package_files "${prefix}/*.cmake" "${prefix}/*.pc")
    if(NOT package_files)
        message(FATAL_ERROR "no CMake package was installed")
    endif()
    foreach(file IN LISTS package_files)
        file(READ "${file}" text)
        foreach(trace "${source_dir}" "${first_prefix}" "-Werror" "cellist_warnings")
            string(FIND "${text}" "${trace}" position)
            if(NOT position EQUAL -1)
                message(FATAL_ERROR "${file} holds `${trace}`")
            endif()
        endforeach()
    endforeach()

    set(cellist_location "-DCMAKE_PREFIX_PATH=${prefix}")
else()
    # What is checked is that the library builds, links and runs there, not how fast it is.
    string(TOUPPER "${config}" upper_config)
    set(cellist_location
        "-DCELLIST_SOURCE_DIR=${source_dir}" "-DCMAKE_CXX_FLAGS_${upper_config}=-O0")
endif()

run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/${way}" -B "${work_dir}/build" -G "${generator}"
    "-DCMAKE_MAKE_PROGRAM=${make_program}"
    "-DCMAKE_CXX_COMPILER=${cxx_compiler}"
    "-DCMAKE_CXX_FLAGS=${cxx_flags}"
    "-DCMAKE_BUILD_TYPE=${config}"
    ${cellist_location})
run("${CMAKE_COMMAND}" --build "${work_dir}/build" --config "${config}")

find_program(consumer consumer NO_DEFAULT_PATH NO_CACHE REQUIRED
    PATHS "${work_dir}/build" "${work_dir}/build/${config}")
run("${consumer}")
find_program(mpi_consumer mpi_consumer NO_DEFAULT_PATH NO_CACHE PATHS "${work_dir}/build")
if(mpi_consumer AND mpiexec)
    run("${mpiexec}" -n 2 "${mpi_consumer}")
endif()

if(way STREQUAL "find_package")
    find_program(nm nm)
    find_program(host host NO_DEFAULT_PATH NO_CACHE PATHS "${work_dir}/build")
    if(nm AND host)
        run("${host}" "${work_dir}/build/libplugin.so")
        # Templates of the standard library are weak, and every library may have them.
        execute_process(COMMAND "${nm}" -DC --defined-only "${work_dir}/build/libplugin.so"
            OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
        string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
        foreach(symbol IN LISTS symbols)
            if((symbol MATCHES " [A-TX-Z] " OR symbol MATCHES "cellist|cl::")
               AND NOT symbol MATCHES " T plugin_throw$")
                message(FATAL_ERROR "the plug-in exports `${symbol}`")
            endif()
        endforeach()
    endif()

    find_program(pkg_config NAMES pkg-config pkgconf)
    file(GLOB_RECURSE pc_file "${prefix}/*/cellist.pc")
    if(pkg_config)
        cmake_path(GET pc_file PARENT_PATH pc_dir)
        set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
        execute_process(COMMAND "${pkg_config}" --cflags --libs cellist
            OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
        separate_arguments(flags UNIX_COMMAND "${flags}")
        separate_arguments(cxx_flags UNIX_COMMAND "${cxx_flags}")
        run("${cxx_compiler}" ${cxx_flags} -std=c++20 "${CMAKE_CURRENT_LIST_DIR}/main.cpp"
            -o "${work_dir}/by_pkg_config" ${flags})
        run("${work_dir}/by_pkg_config")
    endif()

    find_program(command cellist NO_DEFAULT_PATH NO_CACHE PATHS "${prefix}/bin")
    if(command)
        run("${command}" devices)
    endif()
endif()
