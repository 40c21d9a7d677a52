// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ostream>
#include <string>

#include "base/file.h"

namespace ispace {

/// A stream into an OutputFile, for what is too large to be held in memory as a whole.
class FileStream : private std::streambuf {
  public:
    /// \throws std::system_error if the file cannot be made there
    explicit FileStream(const std::string& target);

    [[nodiscard]] std::ostream& stream() { return stream_; }
    /// Writes what is left and puts the file in its place. \throws std::system_error naming the
    /// target, a full disk included, whenever it happened
    void commit();

  private:
    int overflow(int c) override;
    int sync() override;

    OutputFile file_;
    std::string buffer_;
    std::ostream stream_;
};

}  // namespace ispace
