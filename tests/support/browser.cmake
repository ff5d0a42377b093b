# SPDX-License-Identifier: MIT
# Opens a page in a browser without a window. Fails where its script did not run to its end without
# an error, or where the document has no match of one of the regular expressions that follow.
#
#   browser    Chromium, or one of its kind
#   folder     for what the browser keeps
#   address    of the page
function(cellist_check_page browser folder address)
    execute_process(
        COMMAND "${browser}" --headless --no-sandbox --disable-gpu
            "--user-data-dir=${folder}/profile" --virtual-time-budget=3000 --dump-dom "${address}"
        OUTPUT_VARIABLE dom
        ERROR_QUIET
        COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCH "<html[^>]*>" root "${dom}")
    if(NOT root MATCHES "data-ready=\"yes\"" OR root MATCHES "data-error")
        message(FATAL_ERROR "the page's script failed: ${root}")
    endif()
    math(EXPR last "${ARGC} - 1")
    foreach(i RANGE 3 ${last})
        if(NOT dom MATCHES "${ARGV${i}}")
            message(FATAL_ERROR "the page has no ${ARGV${i}}")
        endif()
    endforeach()
endfunction()
