// SPDX-License-Identifier: GPL-3.0-or-later
// The choice of the user to read files without a sandbox, --unconfined: one value for the process,
// written before threads start.
#pragma once

namespace ispace {

/// True if files may be read by programs that the system does not confine, by --unconfined; false
/// at first. Set before the first file is read.
bool& mayReadUnconfined();

/// Exit status of a program that the system does not confine, and that may not read unconfined.
constexpr int kNotConfined = 126;

}  // namespace ispace
