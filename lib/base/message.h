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

/// Bytes as text: the alphabet of RFC 4648, section 4, with padding.
std::string base64(std::string_view bytes);

/// The folder above that of the running program (`PREFIX` of `PREFIX/bin/envc`), from which its
/// data files are found, whether installed, moved or in a build tree. "" if unknown.
std::string programPrefix();

class JsonWriter;

/// Version of the project, as CMake's project() has it.
std::string_view version();

/// Begins the object of a report: {"schema","tool","version", and the rest follows.
JsonWriter& beginReport(JsonWriter& json, std::string_view schema, std::string_view tool);

/// The commands that touched a stream, oldest first, without the leading "# ".
///
/// A line holds the tool, the base names of its operands and the options that change the result, so
/// equal work gives equal bytes wherever it is done.
using History = std::vector<std::string>;

/// `word` as a shell needs it, quoted unless all its characters are plain. Control characters and
/// bytes that are not UTF-8 become '?', so that a history line stays one line of text.
std::string shellQuote(std::string_view word);

/// The operand as history names it: the base name, "-" for a stream.
std::string baseName(std::string_view operand);

}  // namespace ispace
