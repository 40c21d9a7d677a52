// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace ispace {

/// Bounds the work and memory that reading one input may take.
///
/// A few bytes can request any amount of work: blocks inserted in a grid, groups that use groups,
/// parts in parts. A reader that repeats elements takes units before it does the work, even for
/// elements without geometry. A unit is the work of one point, element or record, at most about a
/// microsecond, or 64 bytes of text that is copied or read again.
class Budget {
  public:
    static constexpr std::uint64_t kMinValue = 1'000'000;  ///< for any input
    static constexpr std::uint64_t kPerByte = 4;           ///< added for each byte of the input
    static constexpr std::uint64_t kMost = 20'000'000;     ///< for any input, without --max-work

    /// \param bytes of the input \param max_work of --max-work, replaces the bound by size
    explicit Budget(std::size_t bytes, std::optional<std::uint64_t> max_work = {})
        : max_work_(max_work) {
        grant(bytes);
    }

    /// Raises the bound for a file of `bytes` bytes that the input names.
    void grant(std::size_t bytes) {
        bytes_ += std::min<std::uint64_t>(bytes, kMost);  // no overflow
        limit_ =
            max_work_.value_or(std::min(kMost, kMinValue + kPerByte * std::min(bytes_, kMost)));
    }

    [[nodiscard]] std::uint64_t limit() const { return limit_; }
    [[nodiscard]] std::uint64_t left() const { return limit_ - spent_; }

    /// Takes units before work is done. \return false, without taking any, if fewer are left
    [[nodiscard]] bool take(std::uint64_t units) {
        if (units > left()) return false;
        spent_ += units;
        return true;
    }

    /// Takes units for text that is copied or read again.
    static constexpr std::uint64_t unitsOf(std::size_t bytes) { return bytes / 64; }

    /// Ends a message: "more than 1000000 units of work (`--max-work 2000000` allows more)".
    [[nodiscard]] std::string excess() const {
        return "more than " + std::to_string(limit_) + " units of work (`--max-work " +
               std::to_string(2 * limit_) + "` allows more)";
    }

  private:
    std::optional<std::uint64_t> max_work_;
    std::uint64_t bytes_ = 0, limit_ = 0, spent_ = 0;
};

}  // namespace ispace
