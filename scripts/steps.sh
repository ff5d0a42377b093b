# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Sourced by demo and test: runs the steps of a script, each with its output in a log.
: "${log_dir:?is where the logs go; the script that sources this file sets it}"

# step NAME COMMAND...: runs the command, prints one line, and on failure the end of the log.
step() {
    local name=$1 log="${log_dir}/$1.log" started=${SECONDS} ticker=''
    shift
    printf '%-10s ' "${name}"
    if [[ -t 1 ]]; then
        show_progress "${name}" "${log}" &
        ticker=$!
    fi
    local status=0
    "$@" </dev/null >"${log}" 2>&1 || status=$?
    if [[ -n ${ticker} ]]; then
        kill "${ticker}" 2>/dev/null || true
        wait "${ticker}" 2>/dev/null || true
        printf '\r\033[K%-10s ' "${name}"
    fi

    if ((status == 0)); then
        printf 'done, %d s\n' $((SECONDS - started))
        return 0
    fi
    printf 'failed\n' >&2
    tail -n 40 "${log}" >&2
    printf '%s failed with status %d; the whole log is %s\n' "${name}" "${status}" "${log}" >&2
    exit 1
}

# The time since the script began.
elapsed() {
    printf '%d min %d s' $((SECONDS / 60)) $((SECONDS % 60))
}

# Shows the last [done/total] of the build's log, on one line of the terminal, until it is killed.
show_progress() {
    local name=$1 log=$2 counter
    while sleep 0.5; do
        counter=$(grep -o '^\[[0-9]*/[0-9]*\]' "${log}" 2>/dev/null | tail -n 1) || true
        printf '\r%-10s %s' "${name}" "${counter}"
    done
}
