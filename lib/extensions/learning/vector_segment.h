// SPDX-License-Identifier: GPL-3.0-or-later
// The shared memory through which a learner and simrun exchange actions and observations.
//
// The segment begins with text: the line "ispace-vector 1", then a line of JSON, then zeros up to a
// multiple of 4096 bytes. The JSON holds the sizes and, below "arrays", for each array its offset
// in bytes, its shape and its type as numpy writes it ("<f4"). The arrays follow, each at a
// multiple of 64 bytes, in the order of BatchArrays.
//
//     {"schema": "ispace-vector/1", "num_envs": 256, "worlds": 256, "robots": 1, "beams": 181, ...
//      "arrays": {"actions": {"offset": 4096, "shape": [256, 2], "type": "<f4"}, ...}}
//
// Both sides write it in turn: the learner before a request, simrun before its reply.
#pragma once

#include <cstddef>
#include <string>

#include "extensions/learning/learning_batch.h"

namespace ispace::learning {

class VectorSegment {
  public:
    /// Creates a segment /dev/shm/NAME that the user alone can open.
    /// \param facts members of the JSON besides schema and arrays, as text with a comma at the end
    /// \throws UsageError for a name that is taken, std::system_error without memory
    VectorSegment(const std::string& name, const LearningSetting& setting, std::size_t worlds,
                  const std::string& facts);
    ~VectorSegment();
    VectorSegment(const VectorSegment&) = delete;
    VectorSegment& operator=(const VectorSegment&) = delete;

    [[nodiscard]] const BatchArrays& arrays() const { return arrays_; }
    /// The line of JSON at its beginning.
    [[nodiscard]] const std::string& description() const { return description_; }

    /// \throws UsageError unless it is letters, digits, dots, dashes and underscores
    static std::string checkedName(const std::string& text);

  private:
    std::string name_, description_;
    char* memory_ = nullptr;
    std::size_t size_ = 0;
    BatchArrays arrays_;
};

}  // namespace ispace::learning
