// SPDX-License-Identifier: GPL-3.0-or-later
// Text files that zstd has compressed, written and read while they grow; `zstd -d` unpacks them.
//
//     ZstdPacker packer;
//     file.write(packer.pack(line));  // readable up to here
//     file.write(packer.end());
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/file.h"

namespace ispace {

/// Ends the names of files that zstd has compressed.
constexpr std::string_view kZstdSuffix = ".zst";

/// Compresses a growing text as one zstd frame (RFC 8878), at zstd's default level: the same pieces
/// give the same bytes with one version of the library. Later pieces refer to earlier ones, so that
/// small pieces compress nearly as well as the whole. Holds some 1.5 MB.
class ZstdPacker {
  public:
    /// \throws std::bad_alloc
    ZstdPacker();
    ~ZstdPacker();
    ZstdPacker(const ZstdPacker&) = delete;
    ZstdPacker& operator=(const ZstdPacker&) = delete;

    /// Returns the bytes of the next piece. A reader of all bytes so far gets the whole text so
    /// far.
    std::string pack(std::string_view text);
    /// Returns the bytes that end the frame, with a checksum: without them `zstd -d` writes the
    /// text and then complains of a missing end.
    std::string end();

  private:
    struct State;
    std::string run(std::string_view text, bool is_last);
    std::unique_ptr<State> state_;
};

/// Reads a file piece by piece as InputFile does; one whose name ends in kZstdSuffix is unpacked.
/// It may still grow, or have lost its end: its text ends with the last whole block.
class TextFile {
  public:
    /// \throws as InputFile
    explicit TextFile(const std::string& name, InputKind kind = InputKind::Any);
    ~TextFile();
    TextFile(TextFile&&) noexcept;
    TextFile& operator=(TextFile&&) noexcept;

    /// Appends the available bytes of the text; false at the end. \throws FormatError for bytes
    /// that zstd did not write, and for text of more than 64 MB and 1000 bytes for each of them
    bool read(std::string& text);

  private:
    struct Unpacker;
    std::string name_;
    InputFile file_;
    std::unique_ptr<Unpacker> unpacker_;  // null: plain
};

}  // namespace ispace
