// SPDX-License-Identifier: GPL-3.0-or-later
// NumPy's files: .npy (one array) and .npz (named arrays in a ZIP archive).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"

namespace ispace {

/// What stands before the values of an array, version 1.0 of the format.
/// \param type in NumPy's words: "<f4", "<f8", "|u1" \param shape rows first
std::string npyHeader(std::string_view type, std::span<const std::uint64_t> shape);

/// Writes a ZIP archive piece by piece: files without compression, no time stamps, names in UTF-8;
/// ZIP64 where sizes need it. Equal files give equal bytes.
///
/// Our own, since the libraries for it want to seek in what they write (minizip, libzip), and would
/// leave the sizes out of the head of an entry if they cannot, where simple readers look for them.
class ZipWriter {
  public:
    explicit ZipWriter(ByteSink write) : write_(std::move(write)) {}

    /// The head of a file of `size` bytes with this CRC-32; its bytes go through data().
    void begin(const std::string& name, std::uint64_t size, std::uint32_t crc);
    /// Bytes of the file that was begun last.
    void data(std::string_view bytes) { put(bytes); }
    /// A whole file.
    void add(const std::string& name, std::string_view bytes);
    /// The directory of all files.
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

/// CRC-32 of bytes, and of two pieces behind one another.
std::uint32_t crcOf(std::string_view bytes);
std::uint32_t crcOfBoth(std::uint32_t first, std::uint32_t second, std::uint64_t second_size);

/// Keeps bytes for a file whose beginning tells what follows: in memory as long as they are few,
/// then in a file without a name, in the folder TMPDIR or else /tmp, which is gone with the
/// process.
class Spool {
  public:
    /// \throws std::system_error naming the folder, a full disk included
    void append(std::string_view bytes);
    [[nodiscard]] std::uint64_t size() const { return spilled_ + recent_.size(); }
    /// CRC-32 (that of zlib) of all bytes.
    [[nodiscard]] std::uint32_t crc() const { return crc_; }
    /// All bytes from the first on, in pieces. \throws std::system_error, and what `write` throws
    void copyTo(const ByteSink& write) const;

  private:
    void spill();

    std::string recent_;
    std::uint64_t spilled_ = 0;
    std::uint32_t crc_ = 0;
    OpenFile file_;
};

}  // namespace ispace
