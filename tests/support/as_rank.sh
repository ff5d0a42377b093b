#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs a program as a rank of mpiexec, with a folder of its own for PoCL's programs. Ranks compile
# the same programs at the same time, and PoCL 3.1 fails at times where they share the folder.
#
# usage: as_rank.sh PROGRAM [ARGUMENTS]
export POCL_CACHE_DIR="${POCL_CACHE_DIR:-/tmp}/rank-${OMPI_COMM_WORLD_RANK-${PMI_RANK-0}}"
exec "$@"
