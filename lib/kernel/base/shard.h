// SPDX-License-Identifier: GPL-3.0-or-later
// Divides a job among machines that share no memory: each is told its number and the number of all,
// and computes the same division.
//
//     const auto [first, end] = parseShard("3/8").blockOf(100);  // 26, 39: the third of 8 blocks
#pragma once

#include <cstdint>
#include <string>

namespace ispace {

/// One of `count` shares of a job, numbered from 1: "3/8". Its work depends only on these two
/// numbers and the units of the job, so shards run on any machines, in any order, and again.
struct Shard {
    int index = 1, count = 1;

    /// Consecutive units, [first, end).
    struct Block {
        std::int64_t first = 0, end = 0;
        friend bool operator==(const Block&, const Block&) = default;
    };
    /// The share of `units`: consecutive blocks in the order of the shards, of equal size except
    /// that the first shards hold one unit more if the division leaves a remainder. Empty if there
    /// are more shards than units.
    [[nodiscard]] Block blockOf(std::int64_t units) const;

    /// "3/8"
    [[nodiscard]] std::string text() const;

    friend bool operator==(const Shard&, const Shard&) = default;
};

/// Most shards of a job.
constexpr int kMaxShards = 1'000'000;

/// Parses "3/8". \throws UsageError with a hint, also for shards counted from 0
Shard parseShard(const std::string& text);

}  // namespace ispace
