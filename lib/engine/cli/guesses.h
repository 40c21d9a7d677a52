// SPDX-License-Identifier: GPL-3.0-or-later
// Advice for options of other programs that users try by habit.
#pragma once

#include <string>
#include <string_view>

namespace ispace {

/// Returns the advice for an option that a tool does not have but people try, as they know it from
/// other programs: "--report FILE.html has the material". "" for other options. The table is in
/// guesses.cc.
std::string guessAdvice(std::string_view tool, std::string_view option);

}  // namespace ispace
