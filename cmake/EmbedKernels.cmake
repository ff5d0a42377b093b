# SPDX-License-Identifier: MIT
# Embeds OpenCL sources in a program, so that it needs no file at run time.
#
#   cellist_embed_kernels(TARGET <target> NAMESPACE <ns> [PREFIX <prefix>] FILES <file>...)
#
# Writes the header <ns>_kernels.hpp, which only <target> can include. It defines one
# `constexpr std::string_view` per file in the namespace <ns>::kernels, named after the file
# without its directory, with every character that no identifier can hold turned into `_`:
# kernels/cellist/lists.clh becomes <ns>::kernels::lists_clh. Files of one target need different
# names, also where they are in different directories. A change to a file configures again.
#
# With PREFIX, configuring fails when a file defines a function or a macro whose name does not
# start with <prefix>, in lower or upper case: kernels share one namespace with the code of users.

# Sets `out` to OpenCL C `text` without its comments. Assumes that no string literal holds `//` or
# `/*`, which OpenCL C has no use for.
function(cellist_strip_comments text out)
    set(kept "")
    while(TRUE)
        string(FIND "${text}" "//" line_comment)
        string(FIND "${text}" "/*" block_comment)
        if(line_comment EQUAL -1 AND block_comment EQUAL -1)
            break()
        endif()
        if(block_comment EQUAL -1
           OR (NOT line_comment EQUAL -1 AND line_comment LESS block_comment))
            set(begin ${line_comment})
            set(closing "\n")
            set(closing_length 0)
        else()
            set(begin ${block_comment})
            set(closing "*/")
            set(closing_length 2)
        endif()

        string(SUBSTRING "${text}" 0 ${begin} before)
        string(APPEND kept "${before} ")
        math(EXPR begin "${begin} + 2")
        string(SUBSTRING "${text}" ${begin} -1 text)
        string(FIND "${text}" "${closing}" end)
        if(end EQUAL -1)
            set(text "")
        else()
            math(EXPR end "${end} + ${closing_length}")
            string(SUBSTRING "${text}" ${end} -1 text)
        endif()
    endwhile()
    set(${out} "${kept}${text}" PARENT_SCOPE)
endfunction()

# Sets `out` to `text` with every balanced pair of brackets replaced by `mark`, together with what
# stands between them. `pattern` matches a pair that holds no other pair.
function(cellist_fold text pattern mark out)
    while(text MATCHES "${pattern}")
        string(REGEX REPLACE "${pattern}" "${mark}" text "${text}")
    endwhile()
    set(${out} "${text}" PARENT_SCOPE)
endfunction()

# Fails when `file` with the contents `text` defines a function or a macro without the prefix.
function(cellist_check_prefix file text prefix)
    string(TOUPPER "${prefix}" upper_prefix)
    cellist_strip_comments("${text}" text)
    string(REPLACE "\\\n" " " text "${text}")

    # Macros, then directives out of the way.
    string(REGEX MATCHALL "(^|\n)[ \t]*#[ \t]*define[ \t]+[A-Za-z0-9_]+" names "${text}")
    string(REGEX REPLACE "(^|\n)[ \t]*#[^\n]*" "\n" text "${text}")

    # A function is a name, a folded parameter list and a folded body; a list may follow that
    # belongs to an attribute.
    cellist_fold("${text}" "{[^{}]*}" "@body@" text)
    cellist_fold("${text}" "\\([^()]*\\)" "@list@" text)
    string(REGEX REPLACE "__attribute__[ \t\n]*@list@" "" text "${text}")
    string(REGEX MATCHALL "[A-Za-z0-9_]+[ \t\n]*@list@[ \t\n]*@body@" functions "${text}")

    foreach(name IN LISTS names functions)
        string(REGEX REPLACE "^[ \t\n]*#[ \t]*define[ \t]+|[ \t\n]*@list@.*" "" name "${name}")
        if(NOT name MATCHES "^(${prefix}|${upper_prefix})")
            message(FATAL_ERROR
                "${file} defines `${name}`, which does not start with ${prefix} or ${upper_prefix}")
        endif()
    endforeach()
endfunction()

# Sets `out` to C++ string literals that together equal `text`. One literal holds at most a few
# thousand bytes, because compilers limit the length of each, and ends at the end of a line.
function(cellist_quote text out)
    set(chunk_bytes 8000)
    set(literals "")
    string(LENGTH "${text}" remaining)
    while(remaining GREATER 0)
        string(SUBSTRING "${text}" 0 ${chunk_bytes} chunk)
        if(remaining GREATER chunk_bytes)
            string(FIND "${chunk}" "\n" newline REVERSE)
            if(newline EQUAL -1)
                message(FATAL_ERROR "a line of over ${chunk_bytes} bytes cannot be embedded")
            endif()
            math(EXPR length "${newline} + 1")
            string(SUBSTRING "${chunk}" 0 ${length} chunk)
        endif()
        string(LENGTH "${chunk}" length)
        string(SUBSTRING "${text}" ${length} -1 text)
        string(LENGTH "${text}" remaining)
        string(APPEND literals "\n    R\"opencl(${chunk})opencl\"")
    endwhile()
    if(literals STREQUAL "")
        set(literals " \"\"")
    endif()
    set(${out} "${literals}" PARENT_SCOPE)
endfunction()

function(cellist_embed_kernels)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "TARGET;NAMESPACE;PREFIX" "FILES")
    if(arg_UNPARSED_ARGUMENTS OR NOT arg_TARGET OR NOT arg_NAMESPACE OR NOT arg_FILES)
        message(FATAL_ERROR "usage: cellist_embed_kernels(TARGET <target> NAMESPACE <namespace> "
            "[PREFIX <prefix>] FILES <file>...)")
    endif()

    set(names "")
    set(files "")
    string(CONCAT header
        "// Generated by cellist_embed_kernels.\n"
        "#pragma once\n\n"
        "#include <string_view>\n\n"
        "namespace ${arg_NAMESPACE}::kernels {\n")
    foreach(file IN LISTS arg_FILES)
        cmake_path(ABSOLUTE_PATH file NORMALIZE)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
        file(READ "${file}" text)
        if(text MATCHES "\\)opencl\"")
            message(FATAL_ERROR "${file} holds `)opencl\"`, the end mark of embedded sources")
        endif()
        if(arg_PREFIX)
            cellist_check_prefix("${file}" "${text}" "${arg_PREFIX}")
        endif()

        cmake_path(GET file FILENAME name)
        string(MAKE_C_IDENTIFIER "${name}" name)
        list(FIND names "${name}" other)
        if(NOT other EQUAL -1)
            list(GET files ${other} other)
            message(FATAL_ERROR
                "${file} and ${other} would both be embedded as ${name}: "
                "give one of them another name")
        endif()
        list(APPEND names "${name}")
        list(APPEND files "${file}")
        cellist_quote("${text}" literals)
        string(APPEND header "\ninline constexpr std::string_view ${name} =${literals};\n")
    endforeach()
    string(APPEND header "\n}  // namespace ${arg_NAMESPACE}::kernels\n")

    # An unchanged header keeps its time stamp, so that nothing is compiled again for it.
    set(header_dir "${CMAKE_CURRENT_BINARY_DIR}/${arg_TARGET}_kernels")
    set(header_file "${header_dir}/${arg_NAMESPACE}_kernels.hpp")
    set(present "")
    if(EXISTS "${header_file}")
        file(READ "${header_file}" present)
    endif()
    if(NOT present STREQUAL header)
        file(WRITE "${header_file}" "${header}")
    endif()
    target_include_directories(${arg_TARGET} PRIVATE "${header_dir}")
endfunction()
