// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/opencl.hpp>

#include "cellist/view.h"
