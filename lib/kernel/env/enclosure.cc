// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/enclosure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "env/environment.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Loose walls around a room count as a leaky room only if the gaps between them are at most this
/// share of the plan's shorter side.
constexpr double kLeakShare = 0.5;
constexpr double kAnyWidth = std::numeric_limits<double>::infinity();

/// Finds faces, and the gap that explains a missing one.
class Search {
  public:
    Search(const WallPlan& plan, std::span<const Region> faces, std::span<const Element> elements)
        : plan_(plan), faces_(faces), elements_(elements) {}

    [[nodiscard]] const Region* faceAt(Point2 p) const {
        for (const Region& face : faces_)
            if (face.locate(p) == Side::Inside) return &face;
        return nullptr;
    }

    [[nodiscard]] const Region* largest() const {
        const Region* best = nullptr;
        double best_area = 0;
        for (const Region& face : faces_) {
            const double area = face.area();
            if (best != nullptr && area <= best_area) continue;
            best = &face;
            best_area = area;
        }
        return best;
    }

    [[nodiscard]] bool onWall(Point2 p) const {
        return std::any_of(plan_.lines.begin(), plan_.lines.end(), [p](const Segment2& line) {
            return distance(p, line) <= kWeldDistance;
        });
    }

    /// Throws FormatError for the gap that keeps `inside` (or any region) from being enclosed, if
    /// there is one of at most this width.
    void throwGap(std::optional<Point2> inside, double widest) const {
        const auto gap = findGap(plan_.lines, inside);
        if (gap && gap->width <= widest) throw FormatError(gapFinding(*gap));
    }

    /// Returns a point just outside of the face, if the face lies clear of the limits on all sides
    /// and no face contains the point: then the lines around may be a room that does not close.
    [[nodiscard]] std::optional<Point2> openPlaceAround(const Region& face,
                                                        const Box2& limits) const {
        const Box2 box = bounds(face.outline);
        if (box.low.x <= limits.low.x || box.low.y <= limits.low.y || box.high.x >= limits.high.x ||
            box.high.y >= limits.high.y)
            return std::nullopt;
        // A leftmost vertex: no part of the face is farther left.
        const Point2 vertex = *std::min_element(face.outline.begin(), face.outline.end(),
                                                [](Point2 a, Point2 b) { return a.x < b.x; });
        double free = vertex.x - limits.low.x;
        for (const Segment2& line : plan_.lines) {
            const Point2 near = nearestPoint(line, vertex);
            const double d = distance(near, vertex);
            if (d > kWeldDistance) free = std::min(free, d);
        }
        const Point2 beside{vertex.x - free / 2, vertex.y};
        if (faceAt(beside) != nullptr) return std::nullopt;
        return beside;
    }

  private:
    [[nodiscard]] const Element& elementOf(std::size_t line) const {
        return elements_[plan_.owner[line]];
    }

    [[nodiscard]] Diagnostic gapFinding(const Gap& gap) const {
        const auto [first, second] = std::minmax(gap.a, gap.b);
        const Element& a = elementOf(first);
        const Element& b = elementOf(second);
        std::string hint = "make them meet";
        if (&a == &b && a.record.keyword() == "fence")
            hint =
                a.record.flag("closed") ? "its path must meet itself" : "closed=yes joins its ends";
        return a.record.finding("not enclosed: " + lengthText(gap.width) + " m between " + a.id +
                                " and " + b.id + " near " + placeText(gap.place) + "; " + hint);
    }

    const WallPlan& plan_;
    std::span<const Region> faces_;
    std::span<const Element> elements_;
};

/// Returns the face that contains the record's point.
/// \throws FormatError with the reason if no face does
const Region& faceOf(const Record& inside, const Search& search, double leak, bool any_face) {
    const Tuple& at = inside.tuple("at");
    const Point2 point{at[0], at[1]};
    if (const Region* face = search.faceAt(point)) return *face;
    if (search.onWall(point))
        throw FormatError(inside.finding(
            "at", "inside point " + placeText(point) + " lies on a wall; move it off"));
    double widest = kAnyWidth;
    if (any_face) widest = leak;
    search.throwGap(point, widest);
    throw FormatError(inside.finding(
        "at",
        "inside point " + placeText(point) + " lies outside of everything enclosed" +
            (any_face ? "; move it into the room, or leave it out" : ": the walls do not close")));
}

}  // namespace

Enclosure enclose(const WallPlan& plan, std::span<const Region> faces, const Box2& limits,
                  std::span<const Element> elements, std::span<const Record* const> inside) {
    const Search search(plan, faces, elements);
    const double leak = kLeakShare * std::min(limits.width(), limits.depth());
    if (!inside.empty()) {
        std::vector<const Region*> held;
        Diagnostics findings;
        for (const Record* record : inside) {
            try {
                const Region* face = &faceOf(*record, search, leak, !faces.empty());
                if (std::find(held.begin(), held.end(), face) == held.end()) held.push_back(face);
            } catch (const FormatError& error) {
                findings.add(error);
            }
        }
        findings.throwIfAny();
        Enclosure enclosure;
        const Tuple& first = inside.front()->tuple("at");
        enclosure.inside = {first[0], first[1]};
        for (const Region* face : held) enclosure.indoor.parts.push_back(*face);
        return enclosure;
    }
    if (faces.empty()) {
        search.throwGap(std::nullopt, kAnyWidth);
        throw FormatError(elements[plan.owner.front()].record.finding(
            "not enclosed: the walls do not close anywhere; add what is missing"));
    }
    const Point2 origin;
    const Region* at_origin = search.faceAt(origin);
    const Region& face = at_origin != nullptr ? *at_origin : *search.largest();
    if (const auto open = search.openPlaceAround(face, limits)) search.throwGap(open, leak);
    return {{{face}}, at_origin != nullptr ? origin : interiorPoint(face)};
}

}  // namespace ispace
