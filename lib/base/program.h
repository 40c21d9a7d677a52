// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ispace {

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
