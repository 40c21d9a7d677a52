// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of the work and memory that reading one untrusted input may take. A few bytes can request
// any amount of work: blocks inserted in a grid, groups that use groups, parts in parts.
//
// Work is counted in units, not timed, so the same input is accepted or rejected on every machine.
// Not thread-safe: one reader owns a budget, and the budgets of its parts name it as `whole`.
//
//     Budget budget(bytes.size());
//     if (!budget.take(count)) throw FormatError({name, line, 0, "repeats " + budget.excess()});
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace ispace {

class Budget;

/// Limits of a budget besides the size of its input.
struct WorkLimit {
    std::optional<std::uint64_t> max = {};  ///< of --max-work, replaces the bound by size
    Budget* whole = nullptr;  ///< pays as well: that of the building the input is part of
};

/// The units of work that the reader of one input may take.
///
/// A reader that repeats elements takes units before it does the work, even for elements without
/// geometry. A unit is the work of one point, element or record, at most about a microsecond, or 64
/// bytes of text that is copied or read again: 20 million units are some 20 s at most.
class Budget {
  public:
    static constexpr std::uint64_t kMinValue = 1'000'000;  ///< for any input
    static constexpr std::uint64_t kPerByte = 4;           ///< added for each byte of the input
    static constexpr std::uint64_t kMaxWork = 20'000'000;  ///< for any input, without --max-work

    /// \param bytes of the input \param limit its `whole`, if any, outlives this
    explicit Budget(std::size_t bytes, const WorkLimit& limit = {}) : given_(limit) {
        grant(bytes);
    }

    /// Raises the bound for a file of `bytes` bytes that the input names.
    void grant(std::size_t bytes) {
        bytes_ += std::min<std::uint64_t>(bytes, kMaxWork);  // no overflow
        limit_ = given_.max.value_or(
            std::min(kMaxWork, kMinValue + kPerByte * std::min(bytes_, kMaxWork)));
    }

    /// Units in all: min(kMaxWork, kMinValue + kPerByte * bytes), or WorkLimit::max.
    [[nodiscard]] std::uint64_t limit() const { return limit_; }
    /// Units that take() would grant, the least of this budget and those above it.
    [[nodiscard]] std::uint64_t left() const {
        const std::uint64_t own = limit_ - spent_;
        return given_.whole == nullptr ? own : std::min(own, given_.whole->left());
    }

    /// Takes units before work is done. \return false, without taking any, if fewer are left
    [[nodiscard]] bool take(std::uint64_t units) {
        if (units > limit_ - spent_ || (given_.whole != nullptr && !given_.whole->take(units))) {
            is_exceeded_ = true;
            return false;
        }
        spent_ += units;
        return true;
    }
    /// Returns true once units were refused; it stays true.
    [[nodiscard]] bool isExceeded() const { return is_exceeded_; }

    /// Takes units for text that is copied or read again.
    static constexpr std::uint64_t unitsOf(std::size_t bytes) { return bytes / 64; }

    /// Ends a message: "more than 1000000 units of work (`--max-work 2000000` allows more)".
    [[nodiscard]] std::string excess() const {
        if (given_.whole != nullptr && given_.whole->isExceeded()) return given_.whole->excess();
        return "more than " + std::to_string(limit_) + " units of work (`--max-work " +
               std::to_string(2 * limit_) + "` allows more)";
    }

  private:
    WorkLimit given_;
    std::uint64_t bytes_ = 0, limit_ = 0, spent_ = 0;
    bool is_exceeded_ = false;
};

}  // namespace ispace
