// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts doors and windows out of walls: each opening finds the lines along it by a tree of segments,
// each line is divided at the jambs of its openings, from bottom to top. Jambs within kWeldDistance
// of an end, or of each other, are one. O((n + m) log n) for n lines and m openings that go through
// few walls each.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "env/environment.h"
#include "env/openings.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

/// Maximum number of coincident walls that one opening may go through.
constexpr std::size_t kMaxWalls = 64;
/// Limit of reported overlaps; messages show fewer.
constexpr std::size_t kMaxOverlaps = 100;

/// Axis of a line, from its lower end, so that coincident lines measure in the same direction.
struct Axis {
    Point2 origin;
    Vec2 unit;
    double length;
    bool reversed;

    explicit Axis(const Segment2& line)
        : origin(line.a), length(distance(line.a, line.b)), reversed(lexLess(line.b, line.a)) {
        unit = (1 / length) * (line.b - line.a);
        if (!reversed) return;
        origin = line.b;
        unit = -unit;
    }
    [[nodiscard]] double along(Point2 p) const { return dot(p - origin, unit); }
    [[nodiscard]] double beside(Point2 p) const { return cross(unit, p - origin); }
    [[nodiscard]] Point2 foot(Point2 p) const { return origin + along(p) * unit; }
};

/// Interval of an opening along the axis of one of the lines that it goes through.
struct Cut {
    std::size_t line;
    std::size_t opening;
    double from, to;
    Point2 a, b;    ///< the jambs, at `from` and `to`
    double beside;  ///< distance of the opening's own line
};

/// Finds the lines that openings go through.
class CutFinder {
  public:
    explicit CutFinder(const WallPlan& plan) : plan_(plan), tree_(plan.lines) {}

    /// Appends all cuts of one opening; stops above kMaxWalls.
    void find(std::span<const Opening> openings, std::size_t number, std::vector<Cut>& cuts) {
        const Opening& opening = openings[number];
        const auto [a, b] = jambs(opening);
        const double half = std::min(opening.depth / 2, kMaxFace);
        near_.clear();
        tree_.search({a, b}, half + kMaxFace + kWeldDistance,
                     [this](std::size_t line) { near_.push_back(line); });
        std::sort(near_.begin(), near_.end());
        const std::size_t first = cuts.size();
        for (const std::size_t line : near_) {
            addCut(line, number, {a, b}, line == opening.line ? 2 * kMaxFace : half, cuts);
            if (cuts.size() - first > kMaxWalls) break;
        }
    }

  private:
    [[nodiscard]] Segment2 jambs(const Opening& opening) const {
        const auto& [a, b] = plan_.lines[opening.line];
        const double whole = distance(a, b);
        const Vec2 unit = (1 / whole) * (b - a);
        return {opening.from > 0 ? a + opening.from * unit : a,
                opening.to < whole ? a + opening.to * unit : b};
    }

    void addCut(std::size_t line, std::size_t opening, const Segment2& jambs, double half,
                std::vector<Cut>& cuts) const {
        const Axis axis(plan_.lines[line]);
        const double beside =
            std::max(std::abs(axis.beside(jambs.a)), std::abs(axis.beside(jambs.b)));
        const double own = std::min(plan_.walls[line].thickness / 2, kMaxFace);
        // Walls that only touch do not overlap; a sheet on the face of a wall belongs to it.
        const bool both_thick = half > kThinnest / 2 && own > kThinnest / 2;
        if (beside > kWeldDistance &&
            beside > half + own + (both_thick ? -kWeldDistance : kWeldDistance))
            return;
        constexpr double kParallel = std::numbers::pi / 180;
        const Vec2 across = jambs.b - jambs.a;
        if (std::abs(cross(axis.unit, across)) > std::sin(kParallel) * length(across)) return;
        Cut cut{line, opening, axis.along(jambs.a), axis.along(jambs.b), jambs.a, jambs.b, beside};
        if (cut.from > cut.to) {
            std::swap(cut.from, cut.to);
            std::swap(cut.a, cut.b);
        }
        cut.from = std::max(cut.from, 0.0);
        cut.to = std::min(cut.to, axis.length);
        if (cut.to - cut.from <= kWeldDistance) return;
        if (beside > kWeldDistance) {
            cut.a = axis.origin + cut.from * axis.unit;
            cut.b = axis.origin + cut.to * axis.unit;
        }
        cuts.push_back(cut);
    }

    const WallPlan& plan_;
    SegmentTree tree_;
    std::vector<std::size_t> near_;
};

/// Cuts the pieces of one line.
class LineCutter {
  public:
    LineCutter(const WallPlan& plan, std::span<const Opening> openings, CutWalls& out)
        : plan_(plan), openings_(openings), out_(out) {}

    /// \pre pieces are all of the line, in order; cuts are all in it, sorted by `from`
    void cut(std::size_t line, std::span<const Segment2> pieces, std::span<const Cut> cuts) {
        line_ = line;
        const Axis axis(plan_.lines[line]);
        along_ = axis.reversed ? -axis.unit : axis.unit;
        std::vector<Stop> jambs;
        for (const Cut& cut : cuts) {
            jambs.push_back({cut.from, cut.a});
            jambs.push_back({cut.to, cut.b});
        }
        std::sort(jambs.begin(), jambs.end(),
                  [](const Stop& s, const Stop& t) { return s.along < t.along; });
        std::size_t next_jamb = 0, next_cut = 0;
        std::vector<const Cut*> open;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const auto& [a, b] = pieces[axis.reversed ? pieces.size() - 1 - i : i];
            const Stop first{axis.along(axis.reversed ? b : a), axis.reversed ? b : a};
            const Stop last{axis.along(axis.reversed ? a : b), axis.reversed ? a : b};
            Stop from = first;
            const auto step = [&](const Stop& to) {
                const double middle = from.along + (to.along - from.along) / 2;
                for (; next_cut < cuts.size() && cuts[next_cut].from < middle; ++next_cut)
                    open.push_back(&cuts[next_cut]);
                std::erase_if(open, [&](const Cut* cut) { return cut->to <= middle; });
                emit(
                    axis.reversed ? Segment2{to.place, from.place} : Segment2{from.place, to.place},
                    open);
                from = to;
            };
            // A jamb at an end of the piece, or at another jamb, is merged with it.
            for (; next_jamb < jambs.size() && jambs[next_jamb].along < last.along - kWeldDistance;
                 ++next_jamb)
                if (jambs[next_jamb].along > from.along + kWeldDistance) step(jambs[next_jamb]);
            step(last);
        }
    }

  private:
    struct Stop {
        double along;
        Point2 place;
    };

    /// Adds the walls and fillings on a stretch of the line between jambs.
    void emit(const Segment2& stretch, std::vector<const Cut*>& open) {
        std::sort(open.begin(), open.end(), [this](const Cut* c, const Cut* d) {
            return openings_[c->opening].bottom < openings_[d->opening].bottom;
        });
        const WallLine& wall = plan_.walls[line_];
        double from = wall.bottom;
        bool passage = false;
        for (const Cut* cut : open) {
            const Opening& opening = openings_[cut->opening];
            addWall(stretch, from, std::min(opening.bottom, wall.top));
            from = std::max(from, opening.top);
            passage = passage || opening.passage;
            if (opening.line == line_ && opening.filling != Filling::None)
                addFilling(stretch, cut->opening);
        }
        addWall(stretch, from, wall.top);
        (passage ? out_.passages : out_.lines).push_back(stretch);
    }

    void addWall(const Segment2& stretch, double bottom, double top) {
        if (top - bottom <= kWeldDistance) return;
        WallPart part{plan_.walls[line_], along_, line_};
        part.piece.line = stretch;
        part.piece.bottom = bottom;
        part.piece.top = top;
        out_.parts.push_back(part);
    }

    void addFilling(const Segment2& stretch, std::size_t number) {
        const Opening& opening = openings_[number];
        const bool leaf = opening.filling == Filling::Leaf;
        out_.parts.push_back({{stretch, opening.bottom, opening.top, opening.leaf,
                               leaf ? Material::Wood : Material::Glass},
                              along_,
                              plan_.lines.size() + number,
                              true,
                              opening.filling == Filling::ClearPane});
    }

    const WallPlan& plan_;
    std::span<const Opening> openings_;
    CutWalls& out_;
    std::size_t line_ = 0;
    Vec2 along_;
};

/// Cuts all openings of one plan.
class Cutter {
  public:
    Cutter(std::span<const Element> elements, const WallPlan& plan,
           std::span<const Opening> openings, Diagnostics& findings)
        : elements_(elements), plan_(plan), openings_(openings), findings_(findings) {}

    /// Finds all cuts, sorted by line, then along it.
    [[nodiscard]] std::vector<Cut> findCuts() const {
        std::vector<Cut> cuts;
        CutFinder finder(plan_);
        for (std::size_t i = 0; i < openings_.size(); ++i) {
            const std::size_t before = cuts.size();
            finder.find(openings_, i, cuts);
            if (cuts.size() - before <= kMaxWalls) continue;
            cuts.resize(before);
            findings_.add(elementOf(i).record.finding(
                nameOf(elementOf(i)) + " goes through more than " + std::to_string(kMaxWalls) +
                " walls upon each other; leave out the doubles"));
        }
        std::sort(cuts.begin(), cuts.end(), [](const Cut& c, const Cut& d) {
            return std::tuple(c.line, c.from, c.opening) < std::tuple(d.line, d.from, d.opening);
        });
        return cuts;
    }

    /// Reports openings that share a part of a wall; returns true if there are any.
    /// \pre cuts are sorted
    [[nodiscard]] bool findOverlaps(std::span<const Cut> cuts) const {
        std::vector<std::tuple<std::size_t, std::size_t, const Cut*>> pairs;
        std::vector<const Cut*> open;
        for (const Cut& cut : cuts) {
            std::erase_if(open, [&](const Cut* other) {
                return other->line != cut.line || other->to <= cut.from + kWeldDistance;
            });
            for (const Cut* other : open) {
                if (pairs.size() < kMaxOverlaps && overlapUpright(*other, cut))
                    pairs.emplace_back(std::max(other->opening, cut.opening),
                                       std::min(other->opening, cut.opening), &cut);
            }
            open.push_back(&cut);
        }
        std::sort(pairs.begin(), pairs.end());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto& [later, earlier, cut] = pairs[i];
            if (i > 0 && std::get<0>(pairs[i - 1]) == later && std::get<1>(pairs[i - 1]) == earlier)
                continue;  // reported for another wall
            std::string message = nameOf(elementOf(later)) + " overlaps ";
            message += nameOf(elementOf(earlier)) + " in ";
            message += nameOf(elements_[plan_.owner[cut->line]]) + " near " + placeText(cut->a);
            findings_.add(elementOf(later).record.finding(message + "; move one of them"));
        }
        return !pairs.empty();
    }

    void cutAll(const WeldedLines& welded, std::span<const Cut> cuts, CutWalls& out) const {
        out.parts.reserve(welded.pieces.size() + 4 * cuts.size());
        out.lines.reserve(welded.pieces.size() + 2 * cuts.size());
        LineCutter cutter(plan_, openings_, out);
        std::size_t cut = 0;
        for (std::size_t from = 0, to = 0; from < welded.pieces.size(); from = to) {
            const std::size_t line = welded.source[from];
            while (to < welded.pieces.size() && welded.source[to] == line) ++to;
            while (cut < cuts.size() && cuts[cut].line < line) ++cut;  // lost in the weld
            const std::size_t first = cut;
            while (cut < cuts.size() && cuts[cut].line == line) ++cut;
            cutter.cut(line, std::span(welded.pieces).subspan(from, to - from),
                       cuts.subspan(first, cut - first));
        }
    }

    /// Adds sheets between walls that stand apart, to close the space between them, and lines that
    /// separate this space from the rooms that the opening joins.
    void lineReveals(std::span<const Cut> cuts, CutWalls& out) const {
        bool any = false;
        for (const Cut& cut : cuts) {
            if (cut.beside <= kWeldDistance) continue;
            const Opening& opening = openings_[cut.opening];
            const Axis host(plan_.lines[opening.line]);
            const WallLine& wall = plan_.walls[cut.line];
            WallPart part{plan_.walls[opening.line], {}, opening.line};
            part.piece.bottom = std::max(wall.bottom, opening.bottom);
            part.piece.top = std::min(wall.top, opening.top);
            const double apart =
                cut.beside - (part.piece.thickness + wall.thickness) / 2 - kWeldDistance;
            part.piece.thickness = 0;
            for (const Point2 jamb : {cut.a, cut.b}) {
                part.piece.line = {host.foot(jamb), jamb};
                const Vec2 across = jamb - part.piece.line.a;
                // If walls meet at an angle, one jamb may lie on the host's line.
                if (!(length(across) > 0)) continue;
                part.along = (1 / length(across)) * across;
                if (apart > 0 && part.piece.top > part.piece.bottom) out.parts.push_back(part);
                out.lines.push_back(part.piece.line);
                any = any || opening.passage;
            }
        }
        if (any) weldAgain(out);
    }

  private:
    [[nodiscard]] const Element& elementOf(std::size_t opening) const {
        return elements_[openings_[opening].element];
    }

    [[nodiscard]] bool overlapUpright(const Cut& c, const Cut& d) const {
        const Opening& s = openings_[c.opening];
        const Opening& t = openings_[d.opening];
        return s.bottom < t.top - kWeldDistance && t.bottom < s.top - kWeldDistance;
    }

    /// Welds lines and passages again after lines were added.
    static void weldAgain(CutWalls& out) {
        std::vector<Segment2> all = out.lines;
        all.insert(all.end(), out.passages.begin(), out.passages.end());
        const WeldedLines welded = weld(all);
        const std::size_t lines = out.lines.size();
        out.lines.clear();
        out.passages.clear();
        for (std::size_t i = 0; i < welded.pieces.size(); ++i)
            (welded.source[i] < lines ? out.lines : out.passages).push_back(welded.pieces[i]);
    }

    std::span<const Element> elements_;
    const WallPlan& plan_;
    std::span<const Opening> openings_;
    Diagnostics& findings_;
};

}  // namespace

std::vector<OpeningCut> openingCuts(const WallPlan& plan, std::span<const Opening> openings) {
    std::vector<Cut> cuts;
    CutFinder finder(plan);
    for (std::size_t i = 0; i < openings.size(); ++i) finder.find(openings, i, cuts);
    std::vector<OpeningCut> found;
    found.reserve(cuts.size());
    for (const Cut& cut : cuts) found.push_back({cut.opening, cut.line, {cut.a, cut.b}});
    return found;
}

CutWalls cutOpenings(std::span<const Element> elements, const WallPlan& plan,
                     const WeldedLines& welded, std::span<const Opening> openings,
                     Diagnostics& findings) {
    const Cutter cutter(elements, plan, openings, findings);
    std::vector<Cut> cuts = cutter.findCuts();
    if (cutter.findOverlaps(cuts)) cuts.clear();  // an error; plain walls suffice
    CutWalls out;
    cutter.cutAll(welded, cuts, out);
    cutter.lineReveals(cuts, out);
    return out;
}

}  // namespace ispace
