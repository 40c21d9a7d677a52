// SPDX-License-Identifier: GPL-3.0-or-later
// Reads instances of the art gallery problem (AGPLIB: M. C. Couto, C. C. de Souza, P. J. de
// Rezende, Instances for the Art Gallery Problem, 2009). Fractions are rounded to doubles, and
// coordinates are not snapped: a proof about a gallery is about these doubles.
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "env/walls.h"
#include "extensions/cad/cad.h"
#include "geom/polygon.h"
#include "io/import_records.h"

namespace ispace::cad {

namespace {

/// Splits text at blanks and line breaks.
class GalleryWords {
  public:
    explicit GalleryWords(std::string_view text) : text_(text) {}

    /// Returns the next word; "" at the end.
    std::string_view next() {
        constexpr std::string_view kSpaces = " \t\r\n";
        text_.remove_prefix(std::min(text_.find_first_not_of(kSpaces), text_.size()));
        const std::string_view word = text_.substr(0, text_.find_first_of(kSpaces));
        text_.remove_prefix(word.size());
        return word;
    }

  private:
    std::string_view text_;
};

/// Parses a number or a fraction p/q, rounded to a double.
std::optional<double> fractionOf(std::string_view word) {
    const std::size_t slash = word.find('/');
    if (slash == std::string_view::npos) return parseDouble(word);
    const auto above = parseDouble(word.substr(0, slash));
    const auto below = parseDouble(word.substr(slash + 1));
    if (!above || !below || *below == 0) return std::nullopt;
    return *above / *below;
}

class GalleryReader {
  public:
    GalleryReader(std::string_view bytes, const std::string& name) : words_(bytes), name_(name) {}

    Region read() {
        Region region;
        region.outline = ring("the outline");
        const std::string_view word = words_.next();
        if (word.empty()) return region;
        const std::int64_t holes = count(word, "holes", 0);
        for (std::int64_t i = 1; i <= holes; ++i)
            region.holes.push_back(ring("hole " + std::to_string(i)));
        if (const std::string_view rest = words_.next(); !rest.empty())
            fail("found " + excerpt(rest) + " after the last hole");
        return region;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { failFile(name_, message); }

    [[nodiscard]] std::int64_t count(std::string_view word, const std::string& things,
                                     std::int64_t least) const {
        const auto number = parseInteger(word);
        if (!number || *number < least)
            fail("found " + (word.empty() ? "the end" : excerpt(word)) + ", wanted the number of " +
                 things);
        return *number;
    }

    double coordinate(const std::string& of) {
        const std::string_view word = words_.next();
        const auto number = fractionOf(word);
        if (!number)
            fail(of + ": found " + (word.empty() ? "the end" : excerpt(word)) +
                 ", wanted a coordinate, a number or a fraction p/q");
        if (!(std::abs(*number) <= kMaxSurveyed))
            fail(of + ": " + excerpt(word) + " is too far away, wanted metres up to " +
                 formatDouble(kMaxSurveyed));
        return *number;
    }

    Polygon ring(const std::string& name) {
        const std::int64_t corners = count(words_.next(), "corners of " + name, 3);
        Polygon curve;
        for (std::int64_t i = 0; i < corners; ++i) {
            const double x = coordinate(name), y = coordinate(name);
            if (curve.empty() || curve.back() != Point2{x, y}) curve.push_back({x, y});
        }
        while (curve.size() > 1 && curve.front() == curve.back()) curve.pop_back();
        if (curve.size() < 3 || signedArea(curve) == 0) fail(name + " encloses no area");
        if (selfCrossing(curve)) fail(name + " crosses itself");
        return curve;
    }

    GalleryWords words_;
    const std::string& name_;
};

/// Moves a gallery in surveyors' coordinates to the origin. Doubles less whole metres are exact.
void moveHome(Region& region, const std::string& name, ImportRecords& out) {
    const Box2 box = bounds(region.outline);
    Box2 all = box;
    for (const Polygon& hole : region.holes)
        for (const Point2 p : hole) all.add(p);
    if (std::max(all.width(), all.depth()) > kMaxPlanCoordinate)
        failFile(name, "the gallery is wider than 900 km: is it in metres?");
    const auto way = wayFromSurvey(box.low);
    if (!way) return;
    for (Point2& p : region.outline) p = p - *way;
    for (Polygon& hole : region.holes)
        for (Point2& p : hole) p = p - *way;
    out.report(surveyText(*way, "gallery"));
}

/// Adds a closed fence with the coordinates as they are: a proof is about this polygon, and whole
/// micrometres would make another of it.
void addExactFence(const Polygon& curve, const ImportOptions& options, ImportRecords& out) {
    Record& record = out.add("fence", 0);
    TupleList points;
    points.reserve(curve.size());
    for (const Point2 p : curve) points.push_back({p.x, p.y});
    record.set("path", std::move(points));
    record.set("closed", true);
    record.set("height", options.wall_height);
    record.set("thickness", options.wall_thickness);
}

/// A point of the gallery. Fails for a polygon that has none between the doubles of its edges, and
/// for one that its holes cover.
Point2 insideOf(const Region& region, const std::string& name) {
    try {
        return interiorPoint(region);
    } catch (const std::invalid_argument&) {
        failFile(name,
                 "the polygon leaves no floor, wanted one wider than its edges' rounding and "
                 "larger than its holes");
    }
}

}  // namespace

bool isGalleryFile(std::string_view bytes, bool is_named) {
    GalleryWords words(bytes.substr(0, 4096));
    const auto corners = parseInteger(words.next());
    const std::string_view first = words.next();
    return corners && *corners >= 3 && (is_named || first.find('/') != std::string_view::npos) &&
           fractionOf(first).has_value();
}

Document readGalleryFile(std::string_view bytes, const std::string& name,
                         const ImportOptions& options, const Schemas& schemas) {
    Region region = GalleryReader(bytes, name).read();
    if (signedArea(region.outline) < 0) std::reverse(region.outline.begin(), region.outline.end());
    ImportRecords out(schemas, name, options);
    moveHome(region, name, out);
    for (const Polygon& curve : curvesOf(region)) addExactFence(curve, options, out);
    for (const Point2 p : options.inside) out.inside(p);
    if (options.inside.empty() && options.known_inside.empty()) {
        for (Polygon& hole : region.holes)
            if (signedArea(hole) > 0) std::reverse(hole.begin(), hole.end());
        const Point2 inside = insideOf(region, name);
        out.add("inside", 0).set("at", Tuple{inside.x, inside.y});
    }
    return out.take();
}

}  // namespace ispace::cad
