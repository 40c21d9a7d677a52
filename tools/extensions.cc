// SPDX-License-Identifier: GPL-3.0-or-later
// The one list of extensions: the folders of lib/extensions that CMake builds (ISPACE_EXTENSIONS),
// in the order of
// `--help`.
#include "extensions.h"

namespace ispace {

std::span<const ToolExtension> toolExtensions() { return {}; }

}  // namespace ispace
