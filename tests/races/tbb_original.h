// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <dlfcn.h>

#include <cstdlib>

namespace tbb::detail {

/// The library's own function of a name that is defined here, too.
template <typename Function>
Function* original(const char* symbol) {
    void* const found = ::dlsym(RTLD_NEXT, symbol);
    if (found == nullptr) std::abort();  // another TBB: its names are to be put here
    return reinterpret_cast<Function*>(found);
}

}  // namespace tbb::detail
