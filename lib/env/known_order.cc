// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/known_order.h"

#include <algorithm>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace ispace {

namespace {

XXH128_hash_t hashOf(std::span<const Segment2> lines) {
    static_assert(sizeof(Segment2) == 4 * sizeof(double));  // without gaps
    return XXH3_128bits(lines.data(), lines.size_bytes());
}

}  // namespace

KnownOrder KnownOrder::of(std::span<const Segment2> lines) {
    const auto is_point = [](const Segment2& line) { return line.a == line.b; };
    if (lines.empty() || std::any_of(lines.begin(), lines.end(), is_point)) return {};
    const XXH128_hash_t hash = hashOf(lines);
    return {hash.low64, hash.high64, orderOf(lines)};
}

const BoxOrder* KnownOrder::find(std::span<const Segment2> lines) const {
    if (lines.empty() || order.items.size() != lines.size()) return nullptr;
    const XXH128_hash_t hash = hashOf(lines);
    return hash.low64 == low && hash.high64 == high ? &order : nullptr;
}

}  // namespace ispace
