// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "record/record.h"

namespace ispace {

/// True if the bytes begin with `#env` or `#3dm`, the magic line of our text formats.
bool isRecordText(std::string_view bytes);

/// Reads `.env` and `.3dm` text. `name` is used in messages as it is.
///
/// Grammar, a line each: blank, `# comment`, or `keyword key=value …` with blanks between and
/// none around `=`. A value is a run of characters other than blanks, `"` and `#`, or a "string"
/// with the escapes \" \\ \n \t. `#` begins a comment after a blank or at the start of a line.
/// Lines end with LF or CRLF. A key may appear once. History is the run of `# ` lines directly
/// after the magic line; later magic lines (cat of two files) are comments. A byte order mark at
/// the start is passed over. O(bytes), also for files full of errors.
/// \throws FormatError with all findings: unknown keywords and keys with a suggestion, bad
///         values, missing keys, doubled ids, bytes that are no UTF-8 or control
///         characters (one finding at the first of them), another version, an empty file
Document readRecordText(std::string_view bytes, const std::string& name, const Schemas& schemas);

/// Magic line, history lines, one record a line in canonical form (written values only, those
/// equal to the default left out, keys in schema order).
std::string writeRecordText(const Document& document);

/// One record in canonical form, without newline.
std::string formatRecord(const Record& record);
/// Appends formatRecord(record).
void appendRecord(std::string& out, const Record& record);

/// Reads one record from the text of a line, for options such as `--add`; `name` is the place.
Record readRecord(std::string_view line, const std::string& name, const Schemas& schemas);

/// A doubled written id is an error of the file: findings name both lines.
/// \throws FormatError
void checkIds(const std::vector<Record>& records);

}  // namespace ispace
