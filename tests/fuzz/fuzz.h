// SPDX-License-Identifier: GPL-3.0-or-later
// tests/fuzz: libFuzzer targets, one a format. Whatever the bytes are, a reader gives a document or
// throws FormatError; what it gives is written and read again unchanged. Anything else ends the
// program, as what a sanitizer finds does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "record/record.h"

namespace ispace::fuzz {

/// Ends the program with this message if the condition does not hold.
void require(bool condition, const char* message);

/// Calls read(bytes). Refusals are fine.
template <typename Read>
int guarded(const std::uint8_t* data, std::size_t size, Read read) {
    try {
        read(std::string_view(reinterpret_cast<const char*>(data), size));
    } catch (const FormatError&) {
    }
    return 0;
}

/// Writes the document as text and reads that: the same document, and again the same text.
void checkText(const Document& document);

/// Now and then, as the bytes decide, makes the scene of a small document and all that is made of
/// scenes: geometry takes a thousand times as long as reading.
void tryScene(const Document& document, std::string_view bytes);

/// Makes the scene of a small document as if what its file says of its walls were of these:
/// whatever it says, it is refused or can be worked with.
void tryDerived(const Document& document);

/// A folder in memory of this process, for readers that open files beside theirs.
const std::string& scratchFolder();

/// Replaces a file without the care of base/file.h: it lives for one input.
void writeFile(const std::string& path, std::string_view bytes);

}  // namespace ispace::fuzz
