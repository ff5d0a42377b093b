# SPDX-License-Identifier: MIT
# Runs a program in which one rank is killed. Fails unless the whole job ends: the time limit guards
# against hanging.
#
#   cmake -D mpiexec="mpirun;-n" -D program=... -P killed.cmake
execute_process(COMMAND ${mpiexec} 3 "${program}" killed TIMEOUT 60 RESULT_VARIABLE result
    OUTPUT_VARIABLE output ERROR_VARIABLE output)
message("${output}")
if(NOT output MATCHES "all ranks work")
    message(FATAL_ERROR "the job has not started")
elseif(result MATCHES "timeout")
    message(FATAL_ERROR "the job goes on after one rank was killed")
elseif(result EQUAL 0)
    message(FATAL_ERROR "the job succeeds although one rank was killed")
endif()
