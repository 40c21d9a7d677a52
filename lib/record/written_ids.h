// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "record/record.h"

namespace ispace {

/// The written ids of records, for looking them up. A sorted list of hashes: much faster to make
/// than a tree or table of strings.
class WrittenIds {
  public:
    /// \pre the records stay as they are. O(n log n)
    explicit WrittenIds(std::span<const Record> records);
    /// True if a record has this id. O(log n)
    [[nodiscard]] bool contains(std::string_view id) const;
    /// A record whose id an earlier one has, by their indices.
    struct Doubled {
        std::size_t record, first;
    };
    /// All of them, in order.
    [[nodiscard]] std::vector<Doubled> doubled() const;

  private:
    struct Entry {
        std::uint64_t hash;
        std::size_t record;
    };
    [[nodiscard]] std::string_view id(const Entry& entry) const;

    std::span<const Record> records_;
    std::vector<Entry> entries_;  // sorted by hash, then by record
};

/// A finding for each record whose written id an earlier one has.
void findDoubledIds(std::span<const Record> records, Diagnostics& findings);

}  // namespace ispace
