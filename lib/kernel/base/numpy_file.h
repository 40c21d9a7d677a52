// SPDX-License-Identifier: GPL-3.0-or-later
// Writes NumPy's files: .npy (one array; NumPy enhancement proposal 1) and .npz (named arrays in a
// ZIP archive). Streams: neither seeks in its output, so both may go to a pipe. Equal arrays give
// equal bytes: no time stamps, no compression.
//
//     std::string bytes = npyHeader("<f4", std::array<std::uint64_t, 2>{frames, beams});
//     ZipWriter zip(write);
//     zip.add("ranges.npy", bytes + values);
//     zip.finish();
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"

namespace ispace {

/// Header of an array file, version 1.0 of the format, padded so that the data are aligned to 64
/// bytes.
/// \param type as NumPy writes it: "<f4", "<f8", "|u1" \param shape rows first
std::string npyHeader(std::string_view type, std::span<const std::uint64_t> shape);

/// Writes a ZIP archive piece by piece: uncompressed files without time stamps, names in UTF-8,
/// ZIP64 if sizes require it. Equal files give equal bytes.
///
/// Existing libraries (minizip, libzip) seek in their output; without seeking they omit the sizes
/// from the header of an entry, where simple readers expect them.
class ZipWriter {
  public:
    explicit ZipWriter(ByteSink write) : write_(std::move(write)) {}

    /// Writes the header of a file of `size` bytes with this CRC-32; data() writes its bytes.
    void begin(const std::string& name, std::uint64_t size, std::uint32_t crc);
    /// Writes bytes of the current file.
    void data(std::string_view bytes) { put(bytes); }
    /// Writes a whole file.
    void add(const std::string& name, std::string_view bytes);
    /// Writes the directory of all files.
    void finish();

  private:
    struct Entry {
        std::string name;
        std::uint64_t size = 0, offset = 0;
        std::uint32_t crc = 0;
    };
    void put(std::string_view bytes);

    ByteSink write_;
    std::uint64_t at_ = 0;
    std::vector<Entry> entries_;
};

/// CRC-32 of bytes, and of two concatenated pieces.
std::uint32_t crcOf(std::string_view bytes);
std::uint32_t crcOfBoth(std::uint32_t first, std::uint32_t second, std::uint64_t second_size);

/// Stores bytes until the header of their file can be written: few in memory, more in an unnamed
/// file in the folder TMPDIR or else /tmp, which vanishes with the process.
class Spool {
  public:
    /// \throws std::system_error naming the folder, a full disk included
    void append(std::string_view bytes);
    [[nodiscard]] std::uint64_t size() const { return spilled_ + recent_.size(); }
    /// CRC-32 (as zlib computes it) of all bytes.
    [[nodiscard]] std::uint32_t crc() const { return crc_; }
    /// Writes all bytes in order, in pieces. \throws std::system_error, and exceptions of `write`
    void copyTo(const ByteSink& write) const;

  private:
    void spill();

    std::string recent_;
    std::uint64_t spilled_ = 0;
    std::uint32_t crc_ = 0;
    OpenFile file_;
};

}  // namespace ispace
