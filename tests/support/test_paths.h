// SPDX-License-Identifier: GPL-3.0-or-later
// For tests: paths of the checkout and the build. They are compiled into one small library, so that
// objects of all other tests are the same in every checkout and ccache can share them.
#pragma once

#include <string>
#include <string_view>

namespace ispace::testing {

/// Returns the path of a file in the checkout: sourcePath("share/scenes/hall.env").
std::string sourcePath(std::string_view file);
/// Returns a path in the folder of the build, for files that a test writes.
std::string buildPath(std::string_view file);

}  // namespace ispace::testing
