// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/crossings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "base/error.h"
#include "base/number.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Pairs of lines by which crossings are counted.
constexpr std::size_t kSampledPairs = 1U << 17, kSampledPairsPerLine = 16, kMostSampled = 1U << 22;
constexpr std::size_t kSureHits = 16;

/// Two digits: it is an estimate.
std::string roundNumber(double value) {
    const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(value)) - 1));
    return std::to_string(static_cast<std::uint64_t>(std::round(value / unit) * unit));
}

}  // namespace

double sampledCrossings(std::span<const Segment2> lines) {
    const std::size_t n = lines.size();
    if (n < 2) return 0;
    std::mt19937_64 random(1);
    const std::size_t pairs = std::min(kSampledPairs + kSampledPairsPerLine * n, kMostSampled);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < pairs; ++i) {
        const std::uint64_t bits = random();
        const Segment2& s = lines[(bits >> 32U) % n];
        const Segment2& t = lines[(bits & 0xffffffffU) % n];
        hits += &s != &t && intersects(s, t);
    }
    if (hits < kSureHits) return 0;
    return static_cast<double>(hits) / static_cast<double>(pairs) * static_cast<double>(n) *
           static_cast<double>(n) / 2;
}

void mustCrossRarely(std::span<const Segment2> lines, const std::string& what,
                     const std::string& hint) {
    // Of fewer lines not even all pairs are too many.
    if (static_cast<double>(lines.size()) <= std::sqrt(2 * kMostCrossings)) return;
    const double crossings = sampledCrossings(lines);
    if (crossings <= kMostCrossings) return;
    throw FormatError(Diagnostic{"", 0, 0,
                                 what + " cross each other about " + roundNumber(crossings) +
                                     " times, at most " + roundNumber(kMostCrossings) +
                                     " can be; " + hint});
}

}  // namespace ispace
