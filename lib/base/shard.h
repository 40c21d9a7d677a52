// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace ispace {

/// One of `count` shares of a job, numbered from 1: "3/8". What a shard does depends on these two
/// numbers and the units of the job alone.
struct Shard {
    int index = 1, count = 1;

    /// Consecutive units, [first, end).
    struct Block {
        std::int64_t first = 0, end = 0;
        friend bool operator==(const Block&, const Block&) = default;
    };
    /// The share of `units`: blocks follow each other in the order of the shards and hold as many
    /// each, but for one more in the first shards where the division leaves a rest. Empty where
    /// there are more shards than units.
    [[nodiscard]] Block blockOf(std::int64_t units) const;

    /// "3/8"
    [[nodiscard]] std::string text() const;

    friend bool operator==(const Shard&, const Shard&) = default;
};

/// Most shards of a job.
constexpr int kMaxShards = 1'000'000;

/// Reads "3/8". \throws UsageError with a hint, for shards counted from 0, too
Shard parseShard(const std::string& text);

}  // namespace ispace
