# SPDX-License-Identifier: MIT
# Runs the tests tagged [oclgrind] in the simulator and fails on what it reports.
#
#   oclgrind   the program
#   tests      cellist_tests
#   log        file for the simulator's reports
#
# Kernels are not optimised: Oclgrind 21.10 does not know all intrinsics that LLVM makes of simple code, such
# as llvm.usub.sat, or llvm.experimental.noalias.scope.decl where it inlines a function that returns a struct.
#
# Some reads race with writes on purpose. All are hints, whose old value costs time and nothing else:
# a shard that was full once stays full, the last of the least words only falls, the longest length
# only rises, and a sort checks each list whatever it expects.
#   allocated   a shard's counter, looked at before an atomic increment is tried on it
#   ranked_lists, tied_lists, tie_level
#               what a sort has found about equal keys
#   pool_full   set, always to 1, by every work-item that saw all shards full
#   atomic_min  on the last of a cell's least words, looked at before a word is ranked
#   atomic_max  on the longest length, looked at before an atomic maximum is tried on it
cmake_minimum_required(VERSION 3.25)

set(ENV{CELLIST_DEVICE} "Oclgrind")
set(ENV{CELLIST_PROGRAM_CACHE} "off")
execute_process(
    COMMAND "${oclgrind}" --data-races --check-api --max-errors 100000
        --build-options -cl-opt-disable --log "${log}"
        "${tests}" "[oclgrind]"
    COMMAND_ECHO STDOUT
    COMMAND_ERROR_IS_FATAL ANY)

file(READ "${log}" text)
string(REGEX MATCHALL "(^|\n)[^ \t\n][^\n]*" reports "${text}")
string(REGEX MATCHALL "(^|\n)Read-write data race at global memory[^\n]*" races "${text}")
string(REGEX MATCHALL "load volatile i32[^\n]*%(allocated|pool_full|ranked_lists|tied_lists|tie_level)|call [^\n]*atomic_m(in|ax)PU3AS1Vjj"
    hints "${text}")
list(LENGTH reports report_count)
list(LENGTH races race_count)
list(LENGTH hints hint_count)
if(NOT report_count EQUAL race_count OR NOT race_count EQUAL hint_count)
    message(FATAL_ERROR "${text}\n${report_count} reports, ${hint_count} of them expected")
endif()
message(STATUS "nothing reported but ${hint_count} reads of hints")
