# SPDX-License-Identifier: MIT
# Fails unless a program refuses its arguments: exit code 1, nothing on stdout, and one line on
# stderr that names the program and the last argument.
separate_arguments(arguments UNIX_COMMAND "${arguments}")
execute_process(COMMAND "${program}" ${arguments}
    RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE error)
list(GET arguments -1 named)
cmake_path(GET program STEM name)
string(FIND "${error}" "${named}" at)
if(NOT code EQUAL 1 OR NOT out STREQUAL "" OR at EQUAL -1
        OR NOT error MATCHES "^${name}: [^\n]+\n$")
    message(FATAL_ERROR "exit code ${code}, stdout '${out}', stderr '${error}'")
endif()
