// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// Length in bytes of the valid UTF-8 sequence at the start of `text`; 0 if there is none (also
/// for overlong forms, surrogates, and what lies beyond U+10FFFF).
std::size_t utf8Length(std::string_view text);

/// `text` made fit for one line of a message or of history: control characters and bytes that are
/// not UTF-8 become '?'.
std::string printable(std::string_view text);

/// A piece of input as messages quote it: "`text`", printable, and cut off with "..." if long.
std::string excerpt(std::string_view text);

/// The known word a person most likely meant, or "" if none is near: at most a third of the
/// letters differ (insertions, deletions, substitutions and swaps of neighbours), whatever their
/// case.
std::string nearestWord(std::string_view word, const std::vector<std::string>& known);

/// ", did you mean `height`?", or "" if no word is near: to be appended to a message.
std::string didYouMean(std::string_view word, const std::vector<std::string>& known);

}  // namespace ispace
