// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of witnesses that single points may see, by the vertices of the arrangement of their
// windows: corners, ends of windows and crossings. Nearly parallel windows cross somewhere along
// their common part; the vertex then has an error of half its length, and its set grows by all that
// come so near.
#include "extensions/proofs/gallery/witness_sets.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <unordered_map>
#include <utility>

#include "extensions/proofs/gallery/view_cells.h"
#include "geom/spatial_index.h"

namespace ispace::proofs::gallery {

namespace {

/// Finds the point where two windows cross. Windows from the same corner meet there alone.
void addCrossing(const Window& s, const Window& t, std::vector<WindowVertex>& vertices) {
    if (s.near == t.near) return;
    const Vec2 d = s.far - s.near, e = t.far - t.near;
    const double d_length = length(d), e_length = length(e);
    if (d_length == 0 || e_length == 0) return;
    const Vec2 u = (1 / d_length) * d, v = (1 / e_length) * e;
    const double turn = cross(u, v);
    const Vec2 way = t.near - s.near, far_way = t.far - s.near;
    constexpr double kParallel = 0x1p-26;
    const double clear_turn = std::abs(turn) - kOffLine * (1 / d_length + 1 / e_length);
    if (clear_turn > kParallel) {
        const double error = 4 * kOffLine / clear_turn;
        const double along = cross(way, v) / turn, other = cross(way, u) / turn;
        if (along < -error || along > d_length + error || other < -error ||
            other > e_length + error)
            return;
        vertices.push_back({s.near + along * u, error});
        return;
    }
    const double begin = std::max(std::min(dot(way, u), dot(far_way, u)), 0.0);
    const double end = std::min(std::max(dot(way, u), dot(far_way, u)), d_length);
    if (begin > end + kOneLine) return;
    const double near_apart = std::abs(cross(u, way)), far_apart = std::abs(cross(u, far_way));
    if (std::max(near_apart, far_apart) <= kOneLine) return;
    if (std::min(near_apart, far_apart) > kParallel * (d_length + e_length) + kOneLine) return;
    const double half = std::max(0.0, (end - begin) / 2);
    vertices.push_back(
        {s.near + (begin + half) * u, half + std::max(near_apart, far_apart) + kOneLine});
}

using Bits = std::vector<std::uint64_t>;

Bits bitsOf(const std::vector<std::uint32_t>& set, std::size_t count) {
    Bits bits((count + 63) / 64);
    for (const std::uint32_t i : set) bits[i / 64] |= std::uint64_t{1} << (i % 64);
    return bits;
}

bool isSubsetOf(const Bits& a, const Bits& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if ((a[i] & ~b[i]) != 0) return false;
    return true;
}

std::uint64_t hashOf(const std::vector<std::uint32_t>& set) {
    std::uint64_t hash = set.size();
    for (const std::uint32_t i : set) hash = (hash ^ i) * 0x9e3779b97f4a7c15U + (hash >> 29U);
    return hash;
}

/// Merges equal sets, in order of first appearance.
std::vector<WitnessSet> distinct(std::vector<std::vector<std::uint32_t>> seen,
                                 const std::vector<WindowVertex>& vertices) {
    std::vector<WitnessSet> sets;
    std::unordered_multimap<std::uint64_t, std::size_t> known;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen[i].empty()) continue;
        const std::uint64_t hash = hashOf(seen[i]);
        const auto [begin, end] = known.equal_range(hash);
        const auto it = std::find_if(
            begin, end, [&](const auto& entry) { return sets[entry.second].witnesses == seen[i]; });
        if (it != end) {
            sets[it->second].points.push_back(vertices[i]);
            continue;
        }
        known.emplace(hash, sets.size());
        sets.push_back({std::move(seen[i]), {vertices[i]}});
    }
    return sets;
}

/// Removes subsets of others.
std::vector<WitnessSet> largest(std::vector<WitnessSet> sets, std::size_t witnesses) {
    std::stable_sort(sets.begin(), sets.end(), [](const WitnessSet& a, const WitnessSet& b) {
        return a.witnesses.size() > b.witnesses.size();
    });
    std::vector<WitnessSet> kept;
    std::vector<Bits> kept_bits;
    std::vector<std::vector<std::uint32_t>> holding(witnesses);  // kept sets, by witness
    for (WitnessSet& set : sets) {
        const Bits bits = bitsOf(set.witnesses, witnesses);
        const auto& rarest = *std::min_element(set.witnesses.begin(), set.witnesses.end(),
                                               [&](std::uint32_t a, std::uint32_t b) {
                                                   return holding[a].size() < holding[b].size();
                                               });
        const std::vector<std::uint32_t>& others = holding[rarest];
        if (std::any_of(others.begin(), others.end(),
                        [&](std::uint32_t other) { return isSubsetOf(bits, kept_bits[other]); }))
            continue;
        for (const std::uint32_t i : set.witnesses)
            holding[i].push_back(static_cast<std::uint32_t>(kept.size()));
        kept.push_back(std::move(set));
        kept_bits.push_back(bits);
    }
    return kept;
}

}  // namespace

std::vector<WindowVertex> windowVertices(const Floor& floor, std::span<const Witness> witnesses,
                                         const Progress& progress) {
    std::vector<WindowVertex> vertices;
    for (const Segment2& wall : floor.walls()) vertices.push_back({wall.a, kRounding});
    std::vector<Window> windows;
    for (const Witness& witness : witnesses)
        windows.insert(windows.end(), witness.windows.begin(), witness.windows.end());
    for (const Window& window : windows) vertices.push_back({window.far, window.error});
    std::vector<Segment2> segments;
    segments.reserve(windows.size());
    for (const Window& window : windows) segments.push_back({window.near, window.far});
    const SegmentGrid grid(segments, kClearance);
    constexpr std::size_t kBlock = 64;
    std::vector<std::vector<WindowVertex>> found((windows.size() + kBlock - 1) / kBlock);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found.size()), [&](const auto& range) {
        std::vector<std::uint32_t> stamps(windows.size(), static_cast<std::uint32_t>(-1));
        for (std::size_t block = range.begin(); block < range.end(); ++block) {
            if (progress.stopped()) return;
            const std::size_t end = std::min(windows.size(), (block + 1) * kBlock);
            for (auto i = static_cast<std::uint32_t>(block * kBlock); i < end; ++i)
                grid.searchAlong(segments[i], [&](std::span<const std::uint32_t> near) {
                    for (auto j = std::upper_bound(near.begin(), near.end(), i); j != near.end();
                         ++j)
                        if (std::exchange(stamps[*j], i) != i)
                            addCrossing(windows[i], windows[*j], found[block]);
                });
        }
    });
    for (const auto& part : found) vertices.insert(vertices.end(), part.begin(), part.end());
    return vertices;
}

std::optional<std::vector<WitnessSet>> largestWitnessSets(const Floor& floor,
                                                          std::span<const Witness> witnesses,
                                                          const Progress& progress) {
    const std::vector<WindowVertex> vertices = windowVertices(floor, witnesses, progress);
    ViewCells cells(floor);
    for (const Witness& witness : witnesses) cells.add(witness.view);
    std::vector<std::vector<std::uint32_t>> seen(vertices.size());
    constexpr std::size_t kGrain = 256;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices.size(), kGrain),
                      [&](const auto& range) {
                          if (progress.stopped()) return;
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              const double margin = vertices[i].error + kOneLine;
                              cells.forEachNear(vertices[i].at, margin, [&](std::uint32_t w) {
                                  if (witnesses[w].view.mayHold(vertices[i].at, margin))
                                      seen[i].push_back(w);
                              });
                          }
                      });
    if (progress.stopped()) return std::nullopt;
    return largest(distinct(std::move(seen), vertices), witnesses.size());
}

}  // namespace ispace::proofs::gallery
