// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "cli/extension.h"

namespace ispace {

/// Returns the extensions that this build has, of all tools. From the first call on their formats
/// are read, see addImporters().
std::span<const ToolExtension> toolExtensions();

}  // namespace ispace
