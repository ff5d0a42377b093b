// SPDX-License-Identifier: MIT
#pragma once

// CELLIST_FOR_EACH(macro, fixed, a, b, ...) expands to macro(fixed, a) macro(fixed, b) ..., for up
// to 256 arguments.

#define CELLIST_PARENS ()
#define CELLIST_EXPAND(...)                                                                        \
    CELLIST_EXPAND3(CELLIST_EXPAND3(CELLIST_EXPAND3(CELLIST_EXPAND3(__VA_ARGS__))))
#define CELLIST_EXPAND3(...)                                                                       \
    CELLIST_EXPAND2(CELLIST_EXPAND2(CELLIST_EXPAND2(CELLIST_EXPAND2(__VA_ARGS__))))
#define CELLIST_EXPAND2(...)                                                                       \
    CELLIST_EXPAND1(CELLIST_EXPAND1(CELLIST_EXPAND1(CELLIST_EXPAND1(__VA_ARGS__))))
#define CELLIST_EXPAND1(...) __VA_ARGS__

#define CELLIST_FOR_EACH(macro, fixed, ...)                                                        \
    __VA_OPT__(CELLIST_EXPAND(CELLIST_FOR_EACH_STEP(macro, fixed, __VA_ARGS__)))
#define CELLIST_FOR_EACH_STEP(macro, fixed, first, ...)                                            \
    macro(fixed, first) __VA_OPT__(CELLIST_FOR_EACH_AGAIN CELLIST_PARENS(macro, fixed, __VA_ARGS__))
#define CELLIST_FOR_EACH_AGAIN() CELLIST_FOR_EACH_STEP
