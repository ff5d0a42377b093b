// SPDX-License-Identifier: MIT
#pragma once

namespace viewer {

/// Long work ends early, because its result is no longer wanted.
struct Interrupted {};

}  // namespace viewer
