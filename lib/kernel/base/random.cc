// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/random.h"

#include <algorithm>
#include <cassert>

#include "base/simd.h"

namespace ispace {

using random_loops::kBlock;
using random_loops::Philox;
using random_loops::Targets;

std::uint64_t hashOf(std::string_view id) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const char c : id) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3U;
    }
    return hash;
}

namespace {

ISPACE_SIMD_CLONES void drawSome(const Philox& philox, std::uint32_t first, std::size_t count,
                                 const Targets& targets) {
    static const random_loops::GroupFunction compute = random_loops::groupFunctions().front();
    random_loops::drawBlock(philox, first, count, targets, compute);
}

std::uint32_t low(std::uint64_t word) { return static_cast<std::uint32_t>(word); }
std::uint32_t high(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32U); }

// Maps 224 bits of a key and an element to Philox' 192: only the upper halves of seed and hash
// share a word.
Philox philoxOf(const RandomKey& key) {
    assert(key.frame < std::uint64_t{1} << 56U);
    return {.counter1 = low(key.frame),
            .counter2 = static_cast<std::uint32_t>(key.purpose) << 24U ^ high(key.frame),
            .counter3 = low(key.sensor),
            .key0 = low(key.seed),
            .key1 = high(key.seed) ^ high(key.sensor)};
}

}  // namespace

void draw(const RandomKey& key, std::uint32_t first, const RandomDraws& draws) {
    const std::size_t count =
        std::max({draws.normal.size(), draws.other.size(), draws.uniform.size()});
    [[maybe_unused]] const auto is_whole = [&](std::span<float> values) {
        return values.empty() || values.size() == count;
    };
    assert(is_whole(draws.normal) && is_whole(draws.other) && is_whole(draws.uniform));
    const Philox philox = philoxOf(key);
    const auto from = [](std::span<float> values, std::size_t k) {
        return values.empty() ? nullptr : values.data() + k;
    };
    for (std::size_t k = 0; k < count; k += kBlock) {
        drawSome(philox, first + low(k), std::min(kBlock, count - k),
                 {from(draws.normal, k), from(draws.other, k), from(draws.uniform, k)});
    }
}

}  // namespace ispace
