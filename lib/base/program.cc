// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.h"

#include <filesystem>
#include <system_error>

namespace ispace {

std::string programPrefix() {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    return program.parent_path().parent_path().string();
}

}  // namespace ispace
