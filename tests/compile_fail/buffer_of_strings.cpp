// SPDX-License-Identifier: MIT
// error: a Buffer holds trivially copyable elements
#include <string>

#include <cellist/cellist.hpp>

void use(cellist::Buffer<std::string>& buffer) { buffer.fill("text"); }
