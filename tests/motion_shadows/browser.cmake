# SPDX-License-Identifier: MIT
# Opens the page of cellist-motion-shadows in a browser: plots, tables and pictures are there.
#
#   browser    Chromium, or one of its kind
#   program    cellist-motion-shadows
#   folder     for the page and for what the browser keeps
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../support/browser.cmake")

set(page "${folder}/page.html")
execute_process(
    COMMAND "${program}" --method all --samples 8 --times 310 --width 32 --height 24
        --shadow-map 64 --frames 1 --out "${folder}/a.png" --html "${page}"
    COMMAND_ERROR_IS_FATAL ANY)
cellist_check_page("${browser}" "${folder}" "file://${page}#a=-1&b=2&at=30&differences=1"
    "id=\"edge\" style=\"left: 30%;\""
    "B: tsm, 8 samples"
    "alt=\"difference of tsm, 8 samples\""
    "<title>exact, 8 samples, shadow map: [0-9]"
    "<title>Equation 2, 8 samples: [0-9]"
    "stroke-dasharray"
    ">static, 8 samples</button></td>"
    "which took [0-9]")
