// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/planar_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <utility>

#include "base/error.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

/// The points that represent all others within kWeldDistance of them, sorted, and for each point
/// the index of its representative.
struct WeldedPoints {
    std::vector<Point2> standing;
    std::vector<std::uint32_t> of;
};

/// Points are processed from left to right; each joins the nearest representative in reach or
/// becomes one, so no point moves farther than kWeldDistance however many lie close together.
WeldedPoints weldPoints(std::span<const Segment2> lines) {
    struct End {
        Point2 at;
        std::uint32_t index;
    };
    std::vector<End> ends;
    ends.reserve(2 * lines.size());
    for (const auto& [a, b] : lines)
        for (const Point2 p : {a, b}) ends.push_back({p, static_cast<std::uint32_t>(ends.size())});
    std::sort(ends.begin(), ends.end(), [](const End& e, const End& f) {
        return e.at == f.at ? e.index < f.index : lexLess(e.at, f.at);
    });
    WeldedPoints welded;
    welded.of.resize(ends.size());
    std::size_t oldest = 0;  // of the standing points in reach along x, …
    std::map<std::pair<double, double>, std::uint32_t> by_y_x;  // … to be searched along y
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Point2 p = ends[i].at;
        std::uint32_t& own = welded.of[ends[i].index];
        if (i > 0 && p == ends[i - 1].at) {
            own = welded.of[ends[i - 1].index];
            continue;
        }
        for (; oldest < welded.standing.size(); ++oldest) {
            const Point2 left = welded.standing[oldest];
            if (left.x >= p.x - kWeldDistance) break;
            by_y_x.erase({left.y, left.x});
        }
        double nearest = kWeldDistance;
        bool joined = false;
        for (auto it = by_y_x.lower_bound({p.y - kWeldDistance, p.x - kWeldDistance});
             it != by_y_x.end() && it->first.first <= p.y + kWeldDistance; ++it) {
            const double apart = distance(p, welded.standing[it->second]);
            if (joined ? apart < nearest : apart <= nearest) {
                own = it->second;
                nearest = apart;
                joined = true;
            }
        }
        if (joined) continue;
        own = static_cast<std::uint32_t>(welded.standing.size());
        welded.standing.push_back(p);
        by_y_x.emplace(std::pair(p.y, p.x), own);
    }
    return welded;
}

/// Limits of points on lines, per line and in addition: no plan needs more, and more would not fit
/// into memory.
constexpr std::size_t kTouchesPerLine = 32, kTouchesAnyway = 1U << 21;
/// Tests of a line against a point, per line: first in a grid, which is quickest for evenly spread
/// lines, then in a tree. Only very many long lines that cross need more there.
constexpr std::size_t kGridTestsPerLine = 64;
constexpr std::size_t kTestsPerLine = 1024, kTestsAnyway = 1U << 26;

/// Collects for each segment the points of others that lie on its inside.
class TouchFinder {
  public:
    explicit TouchFinder(const std::vector<Segment2>& segments)
        : segments_(segments), touching_(segments.size()) {}

    /// \pre points: all ends, each once
    std::vector<std::vector<Point2>> find(std::span<const Point2> points) && {
        const std::size_t done = findInGrid(points);
        if (done < points.size()) findInTree(points.subspan(done));
        return std::move(touching_);
    }

  private:
    /// Returns the number of points tested before the limit of tests.
    std::size_t findInGrid(std::span<const Point2> points) {
        const SegmentGrid grid(segments_, kWeldDistance);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const auto near = grid.near(points[k]);
            tests_ += near.size();
            if (tests_ > kGridTestsPerLine * segments_.size()) return k;
            for (const std::uint32_t i : near) test(i, points[k]);
            checkTouches();
        }
        return points.size();
    }

    void findInTree(std::span<const Point2> points) {
        const SegmentTree tree(segments_);
        for (const Point2 p : points) {
            tree.search({p, p}, kWeldDistance, [&](std::size_t i) {
                ++tests_;
                test(i, p);
            });
            checkTouches();
            if (tests_ > kTestsAnyway + kTestsPerLine * segments_.size())
                throw FormatError(Diagnostic{
                    "", 0, 0, "too many wall lines cross each other; end them where they meet"});
        }
    }

    /// Rules out most points beside a line without a division; never wrong.
    static bool isSurelyOff(const Segment2& s, Point2 p) {
        const Vec2 along = s.b - s.a, to = p - s.a;
        // The second term is far above the rounding error of a point on the line.
        const double reach = 2 * kWeldDistance + 1e-14 * (std::abs(to.x) + std::abs(to.y));
        const double twist = cross(along, to);
        return twist * twist > reach * reach * dot(along, along) && std::isfinite(twist * twist);
    }

    void test(std::size_t i, Point2 p) {
        const Segment2& s = segments_[i];
        // Distances that overflow are not near.
        if (isSurelyOff(s, p) || p == s.a || p == s.b || !(distance(p, s) <= kWeldDistance)) return;
        touching_[i].push_back(p);
        ++touches_;
    }

    void checkTouches() const {
        if (touches_ > kTouchesAnyway + kTouchesPerLine * segments_.size())
            throw FormatError(Diagnostic{
                "", 0, 0, "too many wall lines lie upon each other; leave out the doubles"});
    }

    const std::vector<Segment2>& segments_;
    std::vector<std::vector<Point2>> touching_;
    std::size_t touches_ = 0, tests_ = 0;
};

/// For each segment the points of others that lie on its inside, in order along it.
/// \param points all ends, each once
std::vector<std::vector<Point2>> touchingPoints(const std::vector<Segment2>& segments,
                                                std::span<const Point2> points) {
    auto touching = TouchFinder(segments).find(points);
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const Vec2 along = segments[i].b - segments[i].a;
        std::stable_sort(touching[i].begin(), touching[i].end(), [&](Point2 p, Point2 q) {
            return dot(p - segments[i].a, along) < dot(q - segments[i].a, along);
        });
    }
    return touching;
}

}  // namespace

WeldedLines weld(std::span<const Segment2> lines) {
    const WeldedPoints ends = weldPoints(lines);
    std::vector<bool> is_end(ends.standing.size());
    WeldedLines whole;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::uint32_t a = ends.of[2 * i], b = ends.of[2 * i + 1];
        if (a == b) continue;
        is_end[a] = is_end[b] = true;
        whole.pieces.push_back({ends.standing[a], ends.standing[b]});
        whole.source.push_back(i);
    }
    std::vector<Point2> points;
    for (std::size_t i = 0; i < is_end.size(); ++i)
        if (is_end[i]) points.push_back(ends.standing[i]);
    const auto touching = touchingPoints(whole.pieces, points);

    WeldedLines split;
    for (std::size_t i = 0; i < whole.pieces.size(); ++i) {
        Point2 from = whole.pieces[i].a;
        const auto add_piece = [&](Point2 to) {
            split.pieces.push_back({from, to});
            split.source.push_back(whole.source[i]);
            from = to;
        };
        for (const Point2 p : touching[i]) add_piece(p);
        add_piece(whole.pieces[i].b);
    }
    return split;
}

std::vector<Region> boundedFaces(const WeldedLines& lines) {
    return boundedFaces(lines.pieces, {});
}

std::vector<Region> boundedFaces(std::span<const Segment2> lines,
                                 std::span<const Segment2> passages) {
    std::vector<LinePiece> all = linePieces(lines);
    all.reserve(lines.size() + passages.size());
    for (const Segment2& passage : passages)
        all.push_back({passage, static_cast<std::uint32_t>(all.size()), 0, 0, true});
    return facesOf(std::move(all), {"wall lines", "end them where they meet"});
}

namespace {

using Index = std::uint32_t;

constexpr Index kFree = ~Index{0};

/// Multilinear hashing by random keys: any two positions collide with the probability of random
/// hashes (O. Kaser, D. Lemire, Strongly universal string hashing is fast, 2014).
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

/// Positions found so far, by linear probing; at least half of the slots are free.
class PlaceTable {
  public:
    struct Entry {
        Index place = kFree, hash = 0;
    };

    explicit PlaceTable(std::span<const FloatPlace> places)
        : places_(places), slots_(std::size_t{1} << 10U) {}

    /// Prefetches the slot that find() reads.
    void prefetch(Index hash) const { __builtin_prefetch(&slots_[slotOf(hash)]); }
    /// Returns the first equal position; inserts this one if there is none yet.
    Index find(const Entry& entry) {
        Entry* slot = &slots_[slotOf(entry.hash)];
        for (; slot->place != kFree; slot = next(slot))
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
            if (entry.place == kFree) continue;
            Entry* slot = &slots_[slotOf(entry.hash)];
            while (slot->place != kFree) slot = next(slot);
            *slot = entry;
        }
    }

    std::span<const FloatPlace> places_;
    std::vector<Entry> slots_;
    std::size_t count_ = 0;
};

}  // namespace

std::vector<Index> firstAtPlace(std::span<const FloatPlace> places) {
    constexpr std::size_t kAhead = 16;  // hides the latency of cache misses
    const PlaceHash hash_of;
    std::vector<Index> hashes(places.size()), first(places.size());
    std::transform(places.begin(), places.end(), hashes.begin(), hash_of);
    PlaceTable table(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (i + kAhead < places.size()) table.prefetch(hashes[i + kAhead]);
        // Positions with NaN equal no other and would pile up in one slot.
        const bool is_place = std::none_of(places[i].begin(), places[i].end(),
                                           [](float part) { return std::isnan(part); });
        const auto own = static_cast<Index>(i);
        first[i] = is_place ? table.find({own, hashes[i]}) : own;
    }
    return first;
}

}  // namespace ispace
