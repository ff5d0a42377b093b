# SPDX-License-Identifier: MIT
# Completion of cellist and of the example programs for bash.

_cellist() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
    COMPREPLY=()
    if [[ ${before} == --device ]]; then
        # Indices of devices; the first line is the header.
        local indices
        indices=$("${COMP_WORDS[0]}" devices 2>/dev/null | awk 'NR > 1 { print $1 }')
        mapfile -t COMPREPLY < <(compgen -W "${indices}" -- "${word}")
    elif ((COMP_CWORD == 1)); then
        mapfile -t COMPREPLY < <(compgen -W "devices selftest tune --help --version" -- "${word}")
    elif [[ ${COMP_WORDS[1]} == selftest || ${COMP_WORDS[1]} == tune ]]; then
        mapfile -t COMPREPLY < <(compgen -W "--device" -- "${word}")
    fi
}
complete -F _cellist cellist

# Their options, from --help. Arguments are files.
_cellist_example() {
    local word=${COMP_WORDS[COMP_CWORD]}
    COMPREPLY=()
    if [[ ${word} == -* ]]; then
        local options
        options=$("${COMP_WORDS[0]}" --help 2>/dev/null | grep -oE '^ +(-[a-zA-Z],)?--[a-z-]+' |
            grep -oE -- '--[a-z-]+')
        mapfile -t COMPREPLY < <(compgen -W "${options}" -- "${word}")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "${word}")
    fi
}
complete -o filenames -F _cellist_example \
    cellist-oit cellist-tradeoff cellist-shadows cellist-motion-shadows cellist-view
