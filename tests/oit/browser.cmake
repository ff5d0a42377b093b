# Opens the report of cellist-tradeoff in a browser without a window, and fails where its script did
# not run to its end without an error, or does not show what the address asks for.
#
#   browser    Chromium, or one of its kind
#   tradeoff   cellist-tradeoff
#   folder     for the report and for what the browser keeps
cmake_minimum_required(VERSION 3.25)

set(page "${folder}/report.html")
execute_process(
    COMMAND "${tradeoff}" extreme-alphas --size 64x48 --methods weighted,fixed --frames 3
        --html "${page}"
    COMMAND_ERROR_IS_FATAL ANY)
execute_process(
    COMMAND "${browser}" --headless --no-sandbox --disable-gpu "--user-data-dir=${folder}/profile"
        --virtual-time-budget=3000 --dump-dom "file://${page}#a=-1&b=1&at=30&differences=1"
    OUTPUT_VARIABLE dom
    ERROR_QUIET
    COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCH "<html[^>]*>" root "${dom}")
if(NOT root MATCHES "data-ready=\"yes\"" OR root MATCHES "data-error")
    message(FATAL_ERROR "the page's script failed: ${root}")
endif()
foreach(part
        "id=\"edge\" style=\"left: 30%;\""
        "class=\"point on-front\""
        "<text [^>]*text-anchor=\"end\">fixed</text>"
        "<rect class=\"bar\""
        "<button type=\"button\" aria-pressed=\"true\""
        "A: reference"
        "alt=\"difference of [a-z]"
        "<td class=\"text\"><code>--method weighted</code></td>")
    if(NOT dom MATCHES "${part}")
        message(FATAL_ERROR "the page has no ${part}")
    endif()
endforeach()
