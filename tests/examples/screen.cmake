# SPDX-License-Identifier: MIT
# Fails unless a program says its version, and ends with exit code 1 and one line on stderr where
# stdout is full.
separate_arguments(arguments UNIX_COMMAND "${arguments}")
cmake_path(GET program STEM name)
execute_process(COMMAND "${program}" --version RESULT_VARIABLE code OUTPUT_VARIABLE out)
if(NOT code EQUAL 0 OR NOT out MATCHES "^${name} [0-9]+\\.[0-9]+\\.[0-9]+\n$")
    message(FATAL_ERROR "--version: exit code ${code}, stdout '${out}'")
endif()
execute_process(COMMAND "${program}" ${arguments}
    RESULT_VARIABLE code OUTPUT_FILE /dev/full ERROR_VARIABLE error)
if(NOT code EQUAL 1 OR NOT error STREQUAL
        "${name}: cannot write to stdout: No space left on device\n")
    message(FATAL_ERROR "full stdout: exit code ${code}, stderr '${error}'")
endif()
