// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/opening_sites.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/message.h"
#include "env/environment.h"
#include "env/openings.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Walls count as parallel to a heading within a degree, and to the direction from `from` to `to`
/// within thirty, since those points may lie off the line.
constexpr double kParallel = std::numbers::pi / 180, kAlmostParallel = 30 * kParallel;

OpeningSite siteAround(std::size_t line, double middle, const Record& record) {
    const double half = record.tuple("size")[0] / 2;
    return {line, middle - half, middle + half};
}

}  // namespace

OpeningSites::OpeningSites(std::span<const Element> elements, const WallPlan& plan,
                           Diagnostics& findings)
    : elements_(elements), plan_(plan), findings_(findings), by_id_(elements.size(), {elements}) {
    starts_.reserve(plan.lines.size() + 1);
    starts_.push_back(0);
    for (const auto& [a, b] : plan.lines) starts_.push_back(starts_.back() + distance(a, b));
}

const SegmentGrid& OpeningSites::grid() const {
    if (!grid_) grid_.emplace(plan_.lines, kWeldDistance);
    return *grid_;
}

std::optional<OpeningSite> OpeningSites::find(const Element& opening) const {
    if (!hasOnePlace(opening.record)) return std::nullopt;
    const auto lines = linesOf(opening);
    if (!lines) return std::nullopt;
    if (opening.record.has("offset")) return byOffset(opening, *lines);
    if (opening.record.has("at")) return byPoint(opening, *lines);
    return byEnds(opening, *lines);
}

void OpeningSites::fail(const Element& opening, std::string_view key, std::string message) const {
    findings_.add(opening.record.finding(key, std::move(message)));
}

bool OpeningSites::hasOnePlace(const Record& record) const {
    const bool by_ends = record.has("from") || record.has("to");
    const auto fail_at = [&](std::string_view key, std::string message) {
        findings_.add(record.finding(key, std::move(message)));
        return false;
    };
    const auto twice = [&](std::string_view key, const std::string& other) {
        return fail_at(key, record.keyword() + " has " + other + " and also `" + std::string(key) +
                                "`: give its place one way only");
    };
    if (record.has("at") && record.has("offset")) return twice("at", "`offset`");
    if (record.has("at") && by_ends) return twice("at", "`from`/`to`");
    if (record.has("offset") && by_ends) return twice("offset", "`from`/`to`");
    if (by_ends && !record.has("to"))
        return fail_at("from", "`from` and `to` belong together: `to` is missing");
    if (by_ends && !record.has("from"))
        return fail_at("to", "`from` and `to` belong together: `from` is missing");
    if (record.has("offset") && !record.has("wall"))
        return fail_at("offset", "`offset` counts along a wall: give `wall` too");
    if (by_ends || record.has("offset") || record.has("at")) return true;
    findings_.add(record.finding(
        record.keyword() + " has no place: give `wall` and `offset`, or `at`, or `from` and `to`"));
    return false;
}

std::optional<OpeningSites::Lines> OpeningSites::linesOf(const Element& opening) const {
    if (!opening.record.has("wall")) return Lines{0, plan_.lines.size()};
    const std::string& id = opening.record.text("wall");
    const std::optional<std::size_t> found = by_id_.find(id);
    if (!found) {
        fail(opening, "wall", "`wall`: nothing has the id `" + id + '`' + hintFor(id));
        return std::nullopt;
    }
    const Element& wall = elements_[*found];
    if (!isWall(wall.record)) {
        fail(opening, "wall",
             "`wall`: " + id + " is a " + wall.record.keyword() + "; a " +
                 opening.record.keyword() + " is in a wall, fence or ispace");
        return std::nullopt;
    }
    const auto [first, last] = std::equal_range(plan_.owner.begin(), plan_.owner.end(), *found);
    if (first == last) return std::nullopt;  // the wall's record has a finding
    return Lines{static_cast<std::size_t>(first - plan_.owner.begin()),
                 static_cast<std::size_t>(last - plan_.owner.begin()), &wall};
}

std::string OpeningSites::hintFor(const std::string& id) const {
    if (findings_.full()) return "";
    std::vector<std::string> known;
    for (const Element& element : elements_)
        if (isWall(element.record)) known.push_back(element.id);
    return didYouMean(id, known);
}

std::optional<OpeningSite> OpeningSites::byOffset(const Element& opening,
                                                  const Lines& lines) const {
    const double offset = opening.record.number("offset");
    const double total = starts_[lines.last] - starts_[lines.first];
    if (offset > total + kFitDistance) {
        fail(opening, "offset",
             "`offset` of " + lengthText(offset) + " m lies beyond the end of " +
                 nameOf(*lines.wall) + ", which is " + lengthText(total) + " m long");
        return std::nullopt;
    }
    const auto ends = starts_.begin() + 1;
    const auto end = std::lower_bound(ends + static_cast<std::ptrdiff_t>(lines.first),
                                      ends + static_cast<std::ptrdiff_t>(lines.last) - 1,
                                      starts_[lines.first] + offset);
    const auto line = static_cast<std::size_t>(end - ends);
    return siteAround(line, starts_[lines.first] + offset - starts_[line], opening.record);
}

double OpeningSites::along(std::size_t line, Point2 p) const {
    const auto& [a, b] = plan_.lines[line];
    return dot(p - a, b - a) / distance(a, b);
}

/// Computes the length of the site beyond the ends of its line.
double OpeningSites::excess(const OpeningSite& site) const {
    const auto& [a, b] = plan_.lines[site.line];
    return std::max(0.0, -site.from) + std::max(0.0, site.to - distance(a, b));
}

/// Returns how far off a line the position of an opening may be.
double OpeningSites::reach(std::size_t line) const {
    return std::max(kNearWall, std::min(plan_.walls[line].thickness / 2, kMaxFace) + kNearFace);
}

bool OpeningSites::isParallel(std::size_t line, Vec2 direction, double within) const {
    const Vec2 own = plan_.lines[line].b - plan_.lines[line].a;
    return std::abs(cross(own, direction)) <= std::sin(within) * length(own) * length(direction);
}

/// Finds, among the lines around p with allowed(line), the one with the least off(line) within its
/// reach; among equally near lines, the one that site_on(line) exceeds least, then the first.
template <typename Allowed, typename Off, typename SiteOn>
std::optional<OpeningSite> OpeningSites::nearest(Point2 p, Allowed allowed, Off off,
                                                 SiteOn site_on) const {
    constexpr double kReach = kMaxFace + kNearFace;
    std::vector<std::pair<double, std::size_t>> near;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](std::span<const std::uint32_t> cell) {
        for (const std::uint32_t line : cell) {
            if (!allowed(line)) continue;
            const double d = off(line);
            if (d > reach(line) || d > least + kWeldDistance) continue;
            least = std::min(least, d);
            near.emplace_back(d, line);
        }
    };
    grid().searchBox(Box2{p, p}.expanded(kReach), look);
    std::optional<OpeningSite> best;
    for (const auto& [d, line] : near) {
        if (d > least + kWeldDistance || (best && best->line == line)) continue;
        const OpeningSite site = site_on(line);
        const double more = best ? excess(site) - excess(*best) : -1;
        if (more < -kWeldDistance || (more <= kWeldDistance && line < best->line)) best = site;
    }
    return best;
}

std::optional<OpeningSite> OpeningSites::byPoint(const Element& opening, const Lines& lines) const {
    const Record& record = opening.record;
    const Point2 at = pointOf(record.tuple("at"));
    const bool turned = record.has("heading");
    const Vec2 heading = turned ? unitVector(record.angle("heading")) : Vec2{1, 0};
    const auto allowed = [&](std::size_t line) {
        return lines.first <= line && line < lines.last &&
               (!turned || isParallel(line, heading, kParallel));
    };
    const auto off = [&](std::size_t line) { return distance(at, plan_.lines[line]); };
    const auto site_on = [&](std::size_t line) {
        return siteAround(line, along(line, at), record);
    };
    const auto site = nearest(at, allowed, off, site_on);
    if (!site) reportNearest(opening, "at", at, lines, allowed);
    return site;
}

std::optional<OpeningSite> OpeningSites::byEnds(const Element& opening, const Lines& lines) const {
    const Record& record = opening.record;
    const Point2 from = pointOf(record.tuple("from")), to = pointOf(record.tuple("to"));
    const double width = distance(from, to);
    if (width <= kFitDistance) {
        fail(opening, "to", record.keyword() + " has zero width");
        return std::nullopt;
    }
    if (record.has("size") && std::abs(record.tuple("size")[0] - width) > kFitDistance) {
        fail(opening, "size",
             record.keyword() + " is " + lengthText(width) + " m wide by `from` and `to`, and " +
                 lengthText(record.tuple("size")[0]) + " m by `size`");
        return std::nullopt;
    }
    const Point2 middle = from + 0.5 * (to - from);
    const auto allowed = [&](std::size_t line) {
        return lines.first <= line && line < lines.last &&
               isParallel(line, to - from, kAlmostParallel);
    };
    // Distance sideways; Fitter checks the part beyond the ends of the line.
    const auto off = [&](std::size_t line) {
        const auto& [a, b] = plan_.lines[line];
        const Vec2 side = (1 / distance(a, b)) * perpendicular(b - a);
        return std::max({distance(middle, plan_.lines[line]), std::abs(dot(from - a, side)),
                         std::abs(dot(to - a, side))});
    };
    const auto site_on = [&](std::size_t line) {
        const auto [low, high] = std::minmax({along(line, from), along(line, to)});
        return OpeningSite{line, low, high};
    };
    const auto site = nearest(middle, allowed, off, site_on);
    if (!site) reportNearest(opening, "from", middle, lines, allowed);
    return site;
}

template <typename Allowed>
void OpeningSites::reportNearest(const Element& opening, std::string_view key, Point2 p,
                                 const Lines& lines, Allowed allowed) const {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t nearest_line = 0;
    const auto look = [&](std::span<const std::uint32_t> cell) {
        for (const std::uint32_t line : cell) {
            if (!allowed(line)) continue;
            const double d = distance(p, plan_.lines[line]);
            if (d > nearest || (d == nearest && line >= nearest_line)) continue;
            nearest = d;
            nearest_line = line;
        }
    };
    // A message that is not shown needs no nearest wall; the finding is only counted.
    if (!findings_.full()) grid().searchFrom(p, look, [&](double seen) { return nearest <= seen; });
    std::string message = nameOf(opening) + " at " + placeText(p) + " is not on ";
    message += lines.wall != nullptr ? nameOf(*lines.wall) : "a wall";
    if (nearest == std::numeric_limits<double>::infinity()) {
        message += ": none has that direction";
    } else {
        message += ": the nearest ";
        if (lines.wall == nullptr)
            message += "is " + nameOf(elements_[plan_.owner[nearest_line]]) + ", ";
        else
            message += "point of it is ";
        message += lengthText(nearest) + " m away";
    }
    fail(opening, key, std::move(message));
}

}  // namespace ispace
