// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/module_symbol.h"

#include <dlfcn.h>

#include <filesystem>

#include "base/program.h"

namespace ispace {

void* moduleSymbol(const char* module, const char* symbol, std::string& error) {
    const std::string path =
        (std::filesystem::path(programPrefix()) / "lib" / "ispace" / module).string();
    void* const opened = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    void* const found = opened == nullptr ? nullptr : ::dlsym(opened, symbol);
    if (found != nullptr) return found;
    const char* const reason = ::dlerror();
    error = reason == nullptr ? path : reason;
    return nullptr;
}

}  // namespace ispace
