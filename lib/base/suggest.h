// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// The known word a person most likely meant, or "" if none is near: at most a third of the
/// letters differ (insertions, deletions, substitutions and swaps of neighbours), whatever their
/// case.
std::string nearestWord(std::string_view word, const std::vector<std::string>& known);

/// ", did you mean `height`?" or, with nothing near, "": to be put behind a message.
std::string didYouMean(std::string_view word, const std::vector<std::string>& known);

}  // namespace ispace
