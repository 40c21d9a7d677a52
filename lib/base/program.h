// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace ispace {

/// The folder above the one that holds the running program (`PREFIX` of `PREFIX/bin/envc`): what
/// comes with the program is found from there, installed, moved or in the build. "" if unknown.
std::string programPrefix();

}  // namespace ispace
