// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of messages, reports and history lines. Input is untrusted: it is quoted as one printable
// line of UTF-8 before it is shown. Pure functions; O(bytes), nearestWord() O(letters^2) a known
// word.
//
//     throw UsageError("unknown key " + excerpt(key) + didYouMean(key, known));
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// Length in bytes of the valid UTF-8 sequence at the start of `text`; 0 if there is none (also for
/// overlong forms, surrogates and code points beyond U+10FFFF).
std::size_t utf8Length(std::string_view text);

/// Converts `text` to one printable line for messages and history: control characters and bytes
/// that are not UTF-8 become '?'.
std::string printable(std::string_view text);

/// Quotes input for messages: "`text`", printable, and cut off with "..." if long.
std::string excerpt(std::string_view text);

/// Finds the known word that the user most likely meant; "" if all are too different. At most a
/// third of the letters may differ, or one (insertions, deletions, substitutions and swaps of
/// neighbours: the optimal string alignment distance); case is ignored. Of equally near words the
/// first; "" for a word of more than 64 bytes.
std::string nearestWord(std::string_view word, const std::vector<std::string>& known);

/// Hint to append to a message: ", did you mean `height`?", or "" if no word is near.
std::string didYouMean(std::string_view word, const std::vector<std::string>& known);

/// Base64: the alphabet of RFC 4648, section 4, with padding.
std::string base64(std::string_view bytes);

/// The folder above that of the running program (`PREFIX` of `PREFIX/bin/envc`), in which it finds
/// its data files, whether installed, moved or in a build tree. "" if unknown.
std::string programPrefix();

class JsonWriter;

/// Version of the project, from CMake's project().
std::string_view version();

/// Begins a report: {"schema","tool","version"; the caller adds the rest of the object.
JsonWriter& beginReport(JsonWriter& json, std::string_view schema, std::string_view tool);

/// The commands that touched a stream, oldest first, without the leading "# ".
///
/// A line holds the tool, the base names of its operands and the options that change the result, so
/// equal work gives equal bytes in any folder.
using History = std::vector<std::string>;

/// Quotes `word` for a shell unless all its characters are plain. Control characters and bytes that
/// are not UTF-8 become '?', so that a history line stays one line of text.
std::string shellQuote(std::string_view word);

/// Operand as written in the history: the base name, "-" for a stream.
std::string baseName(std::string_view operand);

}  // namespace ispace
