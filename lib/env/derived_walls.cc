// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/derived_walls.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "geom/predicates.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace ispace {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are kept as they are");

/// Of what is derived. Whatever changes a result for some plan must raise it: derived_walls_test
/// compares the results of this version with what they were.
constexpr std::uint64_t kVersion = 2;

/// Where a wall line is, in the order of the plan. Without gaps, to be hashed.
struct KeyLine {
    Segment2 line;
    double bottom, top, thickness;
    std::uint32_t is_first;   ///< of its record
    std::uint32_t is_closed;  ///< of a fence that must not cross itself
};
static_assert(sizeof(KeyLine) == 8 * sizeof(double));

struct KeyOpening {
    std::uint64_t line;
    double from, to, bottom, top, depth;
    std::uint64_t is_passage;
};
static_assert(sizeof(KeyOpening) == 7 * sizeof(double));

class Hash {
  public:
    Hash() { XXH3_128bits_reset(&state_); }
    /// \pre T has no gaps
    template <typename T>
    void add(const T& item) {
        XXH3_128bits_update(&state_, &item, sizeof item);
    }
    [[nodiscard]] WallsKey finish() const {
        const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
        return {hash.low64, hash.high64};
    }

  private:
    XXH3_state_t state_;
};

WallsKey checksumOf(std::string_view bytes) {
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    return {hash.low64, hash.high64};
}

}  // namespace

WallsKey keyOf(const WallPlan& plan, std::span<const Element> elements,
               std::span<const Opening> openings, std::span<const Record* const> inside) {
    Hash hash;
    for (const std::uint64_t number :
         {kVersion, std::uint64_t{plan.walls.size()}, std::uint64_t{openings.size()}})
        hash.add(number);
    for (std::size_t i = 0; i < plan.walls.size(); ++i) {
        const WallLine& wall = plan.walls[i];
        const bool is_first = i == 0 || plan.owner[i] != plan.owner[i - 1];
        const Record& record = elements[plan.owner[i]].record;
        const bool is_closed =
            is_first && record.keyword() == "fence" && record.has("path") && record.flag("closed");
        hash.add(KeyLine{wall.line, wall.bottom, wall.top, wall.thickness, is_first ? 1U : 0U,
                         is_closed ? 1U : 0U});
    }
    for (const Opening& opening : openings)
        hash.add(KeyOpening{opening.line, opening.from, opening.to, opening.bottom, opening.top,
                            opening.depth, opening.passage ? 1U : 0U});
    for (const Record* const record : inside) {
        const Tuple& at = record->tuple("at");
        hash.add(Point2{at[0], at[1]});
    }
    return hash.finish();
}

namespace {

class Writer {
  public:
    template <typename T>
    void add(const T& item) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&item), sizeof item);
    }
    /// Their number, then they.
    template <typename T>
    void addList(std::span<const T> items) {
        addCount(items.size());
        bytes_.append(reinterpret_cast<const char*>(items.data()), items.size_bytes());
    }
    void addCount(std::size_t count) { add(static_cast<std::uint32_t>(count)); }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

/// Takes what Writer wrote; once something is not there, nothing is any more.
class Reader {
  public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    template <typename T>
    T take() {
        T item{};
        if (bytes_.size() < sizeof item) {
            fail();
            return item;
        }
        std::memcpy(&item, bytes_.data(), sizeof item);
        bytes_.remove_prefix(sizeof item);
        return item;
    }
    /// A number of things that take at least so many bytes each.
    std::size_t takeCount(std::size_t size) {
        const std::size_t count = take<std::uint32_t>();
        if (count <= bytes_.size() / size) return count;
        fail();
        return 0;
    }
    template <typename T>
    std::vector<T> takeList() {
        std::vector<T> items(takeCount(sizeof(T)));
        if (items.empty()) return items;
        std::memcpy(items.data(), bytes_.data(), items.size() * sizeof(T));
        bytes_.remove_prefix(items.size() * sizeof(T));
        return items;
    }
    void fail() {
        is_sound_ = false;
        bytes_ = {};
    }
    [[nodiscard]] bool isSound() const { return is_sound_; }
    [[nodiscard]] bool isAtEnd() const { return is_sound_ && bytes_.empty(); }

  private:
    std::string_view bytes_;
    bool is_sound_ = true;
};

/// Bit by bit: 0 is not -0.
bool isSame(const Segment2& s, const Segment2& t) {
    using Bits = std::array<std::uint64_t, 4>;
    return std::bit_cast<Bits>(s) == std::bit_cast<Bits>(t);
}

/// Calls visit(line, pieces) for each line, in order.
template <typename Visit>
void forEachLine(std::size_t lines, const DerivedView& derived, Visit visit) {
    for (std::size_t line = 0, from = 0, to = 0; line < lines; ++line, from = to) {
        while (to < derived.pieces.size() && derived.source[to] == line) ++to;
        visit(line, derived.pieces.subspan(from, to - from));
    }
}

/// The lines that are not one piece as they are: their numbers, and of each the ends of its pieces.
void addWelded(Writer& out, std::span<const Segment2> lines, const DerivedView& derived) {
    std::vector<std::uint32_t> changed;
    const auto is_changed = [&lines](std::size_t line, std::span<const Segment2> pieces) {
        return pieces.size() != 1 || !isSame(pieces[0], lines[line]);
    };
    forEachLine(lines.size(), derived, [&](std::size_t line, std::span<const Segment2> pieces) {
        if (is_changed(line, pieces)) changed.push_back(static_cast<std::uint32_t>(line));
    });
    out.addList<std::uint32_t>(changed);
    std::vector<Point2> ends;
    forEachLine(lines.size(), derived, [&](std::size_t line, std::span<const Segment2> pieces) {
        if (!is_changed(line, pieces)) return;
        ends.clear();
        if (!pieces.empty()) ends.push_back(pieces[0].a);
        for (const Segment2& piece : pieces) ends.push_back(piece.b);
        out.addList<Point2>(ends);
    });
}

bool isFinite(Point2 p) { return std::isfinite(p.x) && std::isfinite(p.y); }

WeldedLines takeWelded(Reader& in, std::span<const Segment2> lines) {
    // Ends move by no more, and then pieces bend to ends that have.
    constexpr double kFarthest = 3 * kWeldDistance;
    const auto changed = in.takeList<std::uint32_t>();
    WeldedLines welded;
    welded.pieces.reserve(lines.size() + changed.size());
    welded.source.reserve(lines.size() + changed.size());
    auto next = changed.begin();
    for (std::size_t line = 0; line < lines.size() && in.isSound(); ++line) {
        if (next == changed.end() || *next != line) {
            welded.pieces.push_back(lines[line]);
            welded.source.push_back(line);
            continue;
        }
        ++next;
        const auto ends = in.takeList<Point2>();
        for (const Point2 p : ends)
            if (!isFinite(p) || distance(p, lines[line]) > kFarthest) in.fail();
        for (std::size_t i = 1; i < ends.size(); ++i) {
            if (ends[i - 1] == ends[i]) in.fail();
            welded.pieces.push_back({ends[i - 1], ends[i]});
            welded.source.push_back(line);
        }
    }
    if (next != changed.end()) in.fail();  // not ascending, or beyond the last
    return welded;
}

void addRegions(Writer& out, const Regions& regions) {
    out.addCount(regions.parts.size());
    for (const Region& part : regions.parts) {
        out.addList<Point2>(part.outline);
        out.addCount(part.holes.size());
        for (const Polygon& hole : part.holes) out.addList<Point2>(hole);
    }
}

/// Where what lines enclose is. Crossings are rounded, by far less than a millimetre.
Box2 reachOf(std::span<const Segment2> lines) {
    constexpr double kRounding = 1e-3;
    Box2 box;
    for (const auto& [a, b] : lines) {
        box.add(a);
        box.add(b);
    }
    box.low = box.low - Vec2{kRounding, kRounding};
    box.high = box.high + Vec2{kRounding, kRounding};
    return box;
}

/// \param box where all of it has to be
Polygon takeCurve(Reader& in, const Box2& box, bool is_outline) {
    Polygon curve = in.takeList<Point2>();
    const auto is_out = [&box](Point2 p) {
        return !(p.x >= box.low.x && p.x <= box.high.x && p.y >= box.low.y && p.y <= box.high.y);
    };
    if (std::any_of(curve.begin(), curve.end(), is_out)) in.fail();
    const double area = signedArea(curve);
    if (curve.size() < 3 || !(is_outline ? area > 0 : area < 0)) in.fail();
    return curve;
}

Regions takeRegions(Reader& in, const Box2& box) {
    Regions regions;
    regions.parts.resize(in.takeCount(2 * sizeof(std::uint32_t)));
    if (regions.parts.empty()) in.fail();
    for (Region& part : regions.parts) {
        part.outline = takeCurve(in, box, true);
        part.holes.resize(in.takeCount(sizeof(std::uint32_t)));
        for (Polygon& hole : part.holes) hole = takeCurve(in, box, false);
        if (!in.isSound()) break;
    }
    return regions;
}

void addOrder(Writer& out, const KnownOrder& known) {
    out.add(known.low);
    out.add(known.high);
    out.addList<std::uint32_t>(known.order.items);
    out.addList<std::uint8_t>(known.order.shape);
}

std::shared_ptr<const KnownOrder> takeOrder(Reader& in) {
    const auto known = std::make_shared<KnownOrder>();
    known->low = in.take<std::uint64_t>();
    known->high = in.take<std::uint64_t>();
    known->order.items = in.takeList<std::uint32_t>();
    known->order.shape = in.takeList<std::uint8_t>();
    if (known->order.items.empty()) return nullptr;
    if (!known->order.isOf(known->order.items.size())) in.fail();
    return known;
}

}  // namespace

std::string storedWalls(const WallsKey& key, std::span<const Segment2> lines,
                        const DerivedView& derived) {
    Writer out;
    out.add(WallsKey());
    out.add(key);
    addWelded(out, lines, derived);
    out.add(derived.inside);
    addRegions(out, derived.indoor);
    out.addCount(derived.floor.size());
    for (const Triangulation& part : derived.floor)
        out.addList<std::array<std::uint32_t, 3>>(part.triangles);
    addOrder(out, derived.order);
    std::string stored = out.take();
    seal(stored);
    return stored;
}

std::optional<DerivedWalls> restoredWalls(std::string_view bytes, const WallsKey& key,
                                          std::span<const Segment2> lines) {
    Reader in(bytes);
    const auto checksum = in.take<WallsKey>(), written_for = in.take<WallsKey>();
    if (!in.isSound() || !(written_for == key) ||
        !(checksum == checksumOf(bytes.substr(sizeof(WallsKey)))))
        return std::nullopt;
    DerivedWalls derived;
    derived.welded = takeWelded(in, lines);
    derived.enclosure.inside = in.take<Point2>();
    derived.enclosure.indoor = takeRegions(in, reachOf(derived.welded.pieces));
    derived.floor.resize(in.takeCount(sizeof(std::uint32_t)));
    for (DerivedWalls::Triangles& part : derived.floor)
        part = in.takeList<std::array<std::uint32_t, 3>>();
    derived.order = takeOrder(in);
    if (!in.isAtEnd() || !isFinite(derived.enclosure.inside) ||
        derived.enclosure.indoor.locate(derived.enclosure.inside) != Side::Inside)
        return std::nullopt;
    return derived;
}

void seal(std::string& stored) {
    const WallsKey checksum = checksumOf(std::string_view(stored).substr(sizeof(WallsKey)));
    std::memcpy(stored.data(), &checksum, sizeof checksum);
}

}  // namespace ispace
