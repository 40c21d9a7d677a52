// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace ispace {

/// What has this name in a module, a shared object in lib/ispace beside the program, which is
/// opened here and stays open: what few runs need would cost each of them its start. Null where it
/// cannot be opened; then `error` says why.
void* moduleSymbol(const char* module, const char* symbol, std::string& error);

}  // namespace ispace
