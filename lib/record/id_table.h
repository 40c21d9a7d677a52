// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace ispace {

/// Finds things by their ids, for who asks very often: a table with open addressing, at most half
/// full. `IdOf` is called with a thing's index and gives its id, "" for none.
template <typename IdOf>
class IdTable {
  public:
    /// \pre count < 2^32 - 1, and ids stay as they are. O(count)
    IdTable(std::size_t count, IdOf id_of) : id_of_(std::move(id_of)) {
        slots_.assign(std::bit_ceil(2 * count + 1), kFree);
        for (std::size_t i = 0; i < count; ++i) {
            const std::string_view id = id_of_(i);
            if (id.empty()) continue;
            std::size_t slot = slotOf(id);
            while (slots_[slot] != kFree) slot = next(slot);
            slots_[slot] = static_cast<std::uint32_t>(i);
        }
    }

    /// The first thing with this id.
    [[nodiscard]] std::optional<std::size_t> find(std::string_view id) const {
        std::size_t slot = slotOf(id);
        while (slots_[slot] != kFree && id_of_(slots_[slot]) != id) slot = next(slot);
        if (slots_[slot] == kFree) return std::nullopt;
        return slots_[slot];
    }

  private:
    static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] std::size_t slotOf(std::string_view id) const {
        return std::hash<std::string_view>{}(id) & (slots_.size() - 1);
    }
    [[nodiscard]] std::size_t next(std::size_t slot) const {
        return (slot + 1) & (slots_.size() - 1);
    }

    IdOf id_of_;
    std::vector<std::uint32_t> slots_;
};

}  // namespace ispace
