# SPDX-License-Identifier: MIT
# The picture has the same bits on 1, 2, 3, 4 and 8 ranks as without MPI.
#
#   program    cellist-oit
#   arguments  what it draws
#   mpiexec    the launcher of ranks, with its option for their number
#   folder     for the pictures
separate_arguments(arguments UNIX_COMMAND "${arguments}")
separate_arguments(mpiexec UNIX_COMMAND "${mpiexec}")
file(MAKE_DIRECTORY "${folder}")
execute_process(
    COMMAND "${program}" ${arguments} --frames 2 --out "${folder}/plain.png"
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
foreach(ranks IN ITEMS 1 2 3 4 8)
    set(picture "${folder}/${ranks}.png")
    file(REMOVE "${picture}")
    execute_process(
        COMMAND ${mpiexec} ${ranks} "${CMAKE_CURRENT_LIST_DIR}/../support/as_rank.sh"
            "${program}" --mpi ${arguments} --frames 2 --out "${picture}"
        OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
    file(SHA256 "${folder}/plain.png" expected)
    file(SHA256 "${picture}" found)
    if(NOT found STREQUAL expected)
        message(FATAL_ERROR "the picture of ${ranks} ranks differs: ${picture}")
    endif()
endforeach()
