// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/byte_sink.h"
#include "base/file.h"

namespace ispace {

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
