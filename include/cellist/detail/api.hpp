// SPDX-License-Identifier: MIT
#pragma once

/// What a shared library exports. A static library exports nothing, not even from a plug-in that
/// links it.
#if defined(CELLIST_SHARED)
#define CELLIST_API __attribute__((visibility("default")))
#else
#define CELLIST_API
#endif
