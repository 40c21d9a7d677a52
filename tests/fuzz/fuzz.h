// SPDX-License-Identifier: GPL-3.0-or-later
// tests/fuzz: libFuzzer targets, one for each format and protocol. A target is a source
// NAME_fuzz.cc that defines tryInput(), with NAME.dict and seeds/NAME/. A reader returns a document
// or throws FormatError, whatever the bytes are, and a document survives writing and reading. Any
// other exception ends the program, as a finding of a sanitizer does.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/importers.h"
#include "record/record.h"

namespace ispace::fuzz {

/// The target: reads the bytes and checks the result. FormatError is a refusal and ends the input.
void tryInput(std::string_view bytes);

/// Ends the program with this message if the condition does not hold.
void require(bool condition, const char* message);

/// Calls read() for bytes that were written by the program: a refusal ends it.
template <typename Read>
auto readBack(Read read) {
    try {
        return read();
    } catch (const FormatError& error) {
        require(false, error.what());
        throw;
    }
}

/// Reader of a plan, a map or a drawing, see importers.h.
using PlanReader = Document (*)(std::string_view, const std::string&, const ImportOptions&,
                                const Schemas&);

/// Reads a plan, and checks its document with checkText() and tryScene().
void tryPlan(PlanReader read, std::string_view bytes, const std::string& name,
             const ImportOptions& options = {});

/// Options for drawings: metres, layers of doors and windows, and few points, because blocks within
/// blocks multiply them.
ImportOptions drawingOptions();

/// Writes the document as text and reads that: the same document, and again the same text.
void checkText(const Document& document);

/// True for records with few vertices and small counts: geometry and readings of large ones take a
/// thousand times as long and show no other paths.
bool isSmall(const Record& record);

/// Now and then, as the bytes decide, makes the scene of a small document and all that is made of
/// scenes: geometry takes a thousand times as long as reading.
void tryScene(const Document& document, std::string_view bytes);

/// A folder in memory of this process, for readers that open files beside theirs.
const std::string& scratchFolder();

/// Replaces a file without the care of base/file.h: it lives for one input.
void writeFile(const std::string& path, std::string_view bytes);

/// Line between the files of one input.
constexpr std::string_view kSeparator = "\n---\n";

/// The files of one input: the pieces between separators, at least one.
std::vector<std::string_view> filesOf(std::string_view bytes);

/// Cuts off the first byte, which chooses the size of the pieces in which the rest arrives: 1 to
/// 32 bytes.
std::size_t takePieceSize(std::string_view& bytes);

/// Reader of a stream that appends the next piece to a buffer; false at the end. The bytes must
/// outlive it.
std::function<bool(std::string& buffer)> streamOf(std::string_view bytes, std::size_t piece);

}  // namespace ispace::fuzz
