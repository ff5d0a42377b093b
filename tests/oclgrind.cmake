# Runs the tests tagged [oclgrind] in the simulator and fails on what it reports.
#
#   oclgrind   the program
#   tests      cellist_tests
#   log        file for the simulator's reports
#
# Kernels are not optimised: Oclgrind 21.10 does not know intrinsics that LLVM makes of simple code
# (llvm.experimental.noalias.scope.decl where it inlines a function that returns a struct, llvm.usub.sat),
# and takes a comparison of vectors for 255 where LLVM extends it without its sign.
#
# Four reads race with writes on purpose. All are hints, whose old value costs one more atomic and
# nothing else; a shard that was full once stays full, the last of the least words only falls, and the
# longest length only rises, so none can be wrong the other way round.
#   allocated   a shard's counter, looked at before an atomic increment is tried on it
#   pool_full   set, always to 1, by every work-item that saw all shards full
#   atomic_min  on the last of a cell's least words, looked at before a word is ranked
#   atomic_max  on the length of the longest list, looked at before a list is compared with it
# Ranking writes bytes to local memory, two to one place where keys are equal. Their sum shows it, and the
# list is ranked anew.
cmake_minimum_required(VERSION 3.25)

set(ENV{CELLIST_DEVICE} "Oclgrind")
execute_process(
    COMMAND "${oclgrind}" --data-races --check-api --max-errors 100000
        --build-options -cl-opt-disable --log "${log}"
        "${tests}" "[oclgrind]"
    COMMAND_ECHO STDOUT
    COMMAND_ERROR_IS_FATAL ANY)

file(READ "${log}" text)
function(count_reports pattern result)
    string(REGEX MATCHALL "${pattern}" matches "${text}")
    list(LENGTH matches count)
    set(${result} ${count} PARENT_SCOPE)
endfunction()
count_reports("(^|\n)[^ \t\n][^\n]*" reports)
count_reports("(^|\n)Read-write data race at global memory" races)
count_reports("load volatile i32[^\n]*%(allocated|pool_full)|call [^\n]*atomic_m(in|ax)PU3AS1Vjj" hints)
count_reports("(^|\n)Write-write data race at local memory[^\n]*\n\tKernel: cellist_sort_" places)
count_reports("store i8 [^\n]*addrspace\\(3\\)" bytes)
math(EXPR expected "${races} + ${places}")
math(EXPR pairs "${bytes} / 2")
if(NOT reports EQUAL expected OR NOT races EQUAL hints OR NOT places EQUAL pairs)
    message(FATAL_ERROR "${text}\n${reports} reports, ${races} races with reads (${hints} of hints), "
        "${places} of places (${bytes} bytes)")
endif()
message(STATUS "nothing reported but ${hints} reads of hints and ${places} places written twice")
