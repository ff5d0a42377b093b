# SPDX-License-Identifier: MIT
# A rank that fails alone, here for want of its device, ends the job, and is named in one line.
#
#   program   particles
#   mpiexec   the launcher of ranks
#   option    its option for their number
set(arguments --mpi --points 3000 --runs 1)
execute_process(
    COMMAND "${mpiexec}" ${option} 2 "${program}" ${arguments} : ${option} 1 "${program}" ${arguments}
        --device nosuch
    RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE error)
string(REPLACE ";" "," lines "${error}")
string(REGEX MATCHALL "particles: [^\n]+" lines "${lines}")
list(LENGTH lines count)
if(code EQUAL 0 OR NOT count EQUAL 1 OR NOT lines MATCHES "^particles: rank 2 of 3: .*'nosuch'")
    message(FATAL_ERROR "exit code ${code}, stdout '${out}', stderr '${error}'")
endif()
