// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace ispace {

/// Lets the process reuse freed memory instead of returning it to the system, which would have to
/// clear it anew, if these files are so large that it allocates and frees hundreds of megabytes.
void keepFreedMemory(const std::vector<std::string>& inputs);

}  // namespace ispace
