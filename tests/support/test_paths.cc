// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/test_paths.h"

namespace ispace::testing {

std::string sourcePath(std::string_view file) {
    return std::string(ISPACE_SOURCE_DIR "/").append(file);
}

std::string buildPath(std::string_view file) {
    return std::string(ISPACE_BINARY_DIR "/").append(file);
}

}  // namespace ispace::testing
