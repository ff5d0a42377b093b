# SPDX-License-Identifier: MIT
# Runs cellist-budget-grid on one small scene. Checks that budgets are kept and that the JSON can be
# read, but not the cost of settings.
execute_process(
    COMMAND "${program}" --filter coplanar --size 48x36 --frames 1 --cost 1000000 --json "${json}"
    RESULT_VARIABLE result)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "cellist-budget-grid: ${result}")
endif()
file(READ "${json}" text)
string(JSON count LENGTH "${text}" cases)
if(NOT count EQUAL 3)
    message(FATAL_ERROR "${count} cases instead of 3")
endif()
foreach(i 0 1)
    string(JSON budget GET "${text}" cases ${i} budget)
    foreach(member chosen best)
        string(JSON error GET "${text}" cases ${i} ${member} error largest)
        if(NOT error GREATER_EQUAL 0 OR error GREATER 1)
            message(FATAL_ERROR "${budget}: ${member} has the error ${error}")
        endif()
    endforeach()
endforeach()
string(JSON none TYPE "${text}" cases 2 best)
if(NOT none STREQUAL "NULL")
    message(FATAL_ERROR "a setting keeps a budget that no picture of floats can keep")
endif()
