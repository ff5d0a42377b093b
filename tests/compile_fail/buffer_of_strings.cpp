// error: a Buffer holds trivially copyable elements
// SPDX-License-Identifier: MIT
#include <string>

#include <cellist/cellist.hpp>

void use(cellist::Buffer<std::string>& buffer) { buffer.fill("text"); }
