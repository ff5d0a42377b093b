# SPDX-License-Identifier: MIT
# Opens the report of cellist-tradeoff in a browser: it shows what the address asks for.
#
#   browser    Chromium, or one of its kind
#   tradeoff   cellist-tradeoff
#   folder     for the report and for what the browser keeps
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../support/browser.cmake")

set(page "${folder}/report.html")
execute_process(
    COMMAND "${tradeoff}" extreme-alphas --size 64x48 --methods weighted,fixed --frames 3
        --html "${page}"
    COMMAND_ERROR_IS_FATAL ANY)
cellist_check_page("${browser}" "${folder}" "file://${page}#a=-1&b=1&at=30&differences=1"
    "id=\"edge\" style=\"left: 30%;\""
    "class=\"point on-front\""
    "<text [^>]*text-anchor=\"end\">fixed</text>"
    "<rect class=\"bar\""
    "<button type=\"button\" aria-pressed=\"true\""
    "A: reference"
    "alt=\"difference of [a-z]"
    "<td class=\"text\"><code>--method weighted</code></td>")
