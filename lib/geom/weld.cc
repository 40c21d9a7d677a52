// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

namespace ispace {

namespace {

using Index = std::uint32_t;

constexpr Index kNone = ~Index{0};

/// Multilinear hashing by random keys: any two places collide as seldom as chance has it (Lemire
/// and Kaser, Strongly Universal String Hashing is Fast, 2014).
class PlaceHash {
  public:
    PlaceHash() {
        std::random_device device;
        for (std::uint64_t& key : keys_)
            key = static_cast<std::uint64_t>(device()) << 32U | device();
    }
    [[nodiscard]] Index operator()(const FloatPlace& place) const {
        std::uint64_t sum = keys_[3];
        for (std::size_t i = 0; i < 3; ++i)
            sum += keys_[i] * std::bit_cast<Index>(place[i] + 0.0F);  // -0 + 0 is 0
        return static_cast<Index>(sum >> 32U);
    }

  private:
    std::array<std::uint64_t, 4> keys_{};
};

/// Places found so far, by linear probing; at least half of the slots are free.
class PlaceTable {
  public:
    struct Entry {
        Index place = kNone, hash = 0;
    };

    explicit PlaceTable(std::span<const FloatPlace> places)
        : places_(places), slots_(std::size_t{1} << 10U) {}

    /// Fetches what find() will look at.
    void prefetch(Index hash) const { __builtin_prefetch(&slots_[slotOf(hash)]); }
    /// The first place that is equal; this one if there is none yet.
    Index find(const Entry& entry) {
        Entry* slot = &slots_[slotOf(entry.hash)];
        for (; slot->place != kNone; slot = next(slot))
            if (slot->hash == entry.hash && places_[slot->place] == places_[entry.place])
                return slot->place;
        *slot = entry;
        if (2 * ++count_ > slots_.size()) grow();
        return entry.place;
    }

  private:
    [[nodiscard]] std::size_t slotOf(Index hash) const {
        return static_cast<std::size_t>(std::uint64_t{hash} * slots_.size() >> 32U);
    }
    Entry* next(Entry* slot) { return slot == &slots_.back() ? slots_.data() : slot + 1; }
    void grow() {
        const std::vector<Entry> old = std::exchange(slots_, std::vector<Entry>(4 * slots_.size()));
        for (const Entry& entry : old) {
            if (entry.place == kNone) continue;
            Entry* slot = &slots_[slotOf(entry.hash)];
            while (slot->place != kNone) slot = next(slot);
            *slot = entry;
        }
    }

    std::span<const FloatPlace> places_;
    std::vector<Entry> slots_;
    std::size_t count_ = 0;
};

}  // namespace

std::vector<Index> firstAtPlace(std::span<const FloatPlace> places) {
    constexpr std::size_t kAhead = 16;  // hides what a miss of the cache costs
    const PlaceHash hash_of;
    std::vector<Index> hashes(places.size()), first(places.size());
    std::transform(places.begin(), places.end(), hashes.begin(), hash_of);
    PlaceTable table(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (i + kAhead < places.size()) table.prefetch(hashes[i + kAhead]);
        // Equal to nothing, they would pile up in one slot.
        const bool is_place = std::none_of(places[i].begin(), places[i].end(),
                                           [](float part) { return std::isnan(part); });
        const auto own = static_cast<Index>(i);
        first[i] = is_place ? table.find({own, hashes[i]}) : own;
    }
    return first;
}

}  // namespace ispace
