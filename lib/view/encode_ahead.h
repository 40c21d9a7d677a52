// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "draw/picture.h"

namespace ispace {

/// Encodes pictures on other cores while the next ones are drawn, and writes them in order, from
/// the thread that adds them.
class EncodeAhead {
  public:
    using Encode = std::function<std::string(const Image& image)>;  ///< from any thread
    using Write = std::function<void(const std::string& file, const std::string& bytes)>;

    EncodeAhead(Encode encode, Write write);
    /// Without finish(), after an error, what was added is written all the same; further errors
    /// are passed over.
    ~EncodeAhead();
    EncodeAhead(const EncodeAhead&) = delete;
    EncodeAhead& operator=(const EncodeAhead&) = delete;

    /// Writes earlier ones where more are on their way than there are cores, or than have 64
    /// million pixels. \throws what encoding and writing those throws
    void add(std::string file, Image image);
    /// Writes all that is left. \throws likewise
    void finish();

  private:
    struct Job;
    struct Queue;
    std::unique_ptr<Queue> queue_;
};

}  // namespace ispace
