// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/findings/findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "env/environment.h"
#include "env/openings.h"
#include "geom/planar_map.h"

namespace ispace {

namespace {

/// Metres beyond a door at which its two sides are tested.
constexpr double kBesideDoor = 0.01;

WallPlan planOf(const std::vector<Element>& elements, Diagnostics& ignored) {
    WallPlan plan;
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (isWall(elements[i].record))
            for (const WallLine& wall : wallLinesOf(elements[i].record, ignored)) plan.add(wall, i);
    return plan;
}

/// Returns the first element with the wall end nearest to `p`.
std::size_t wallWithEnd(const std::vector<Element>& elements, Point2 p) {
    Diagnostics ignored;
    const WallPlan plan = planOf(elements, ignored);
    std::size_t owner = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < plan.lines.size(); ++i) {
        const double apart = std::min(distance(p, plan.lines[i].a), distance(p, plan.lines[i].b));
        if (apart >= least) continue;
        least = apart;
        owner = plan.owner[i];
    }
    return owner;
}

/// A wall line and its distance.
struct Behind {
    std::size_t line;
    double distance;
};

/// Finds the first wall line that the way from `from` in this direction meets, beyond `least`.
std::optional<Behind> wallBehind(const WallPlan& plan, Point2 from, Vec2 direction, double least) {
    std::optional<Behind> nearest;
    for (std::size_t i = 0; i < plan.lines.size(); ++i) {
        const Vec2 along = plan.lines[i].b - plan.lines[i].a;
        const double denominator = cross(direction, along);
        if (denominator == 0) continue;
        const Vec2 to_line = plan.lines[i].a - from;
        const double distance = cross(to_line, along) / denominator;
        const double share = cross(to_line, direction) / denominator;
        if (share < 0 || share > 1 || distance <= least || distance > kMaxFace) continue;
        if (!nearest || distance < nearest->distance) nearest = {i, distance};
    }
    return nearest;
}

/// Reports open doors that lead out of the room into a wall close behind, as between two rooms with
/// separate walls. O(doors x walls).
void addBlockedDoors(const CheckContext& context, std::multimap<std::size_t, Finding>& found) {
    const Environment& environment = context.scene.environment;
    const std::vector<Element>& elements = environment.elements();
    Diagnostics ignored;  // the environment would not exist with errors
    const WallPlan plan = planOf(elements, ignored);
    for (const Opening& door : placeOpenings(elements, plan, ignored)) {
        if (!door.passage) continue;
        const Segment2& wall = plan.lines[door.line];
        const Vec2 along = 1 / length(wall.b - wall.a) * (wall.b - wall.a);
        const Point2 middle = wall.a + (door.from + door.to) / 2 * along;
        const double face = door.depth / 2;
        const auto is_indoor = [&](Vec2 side) {
            return environment.indoor().locate(middle + (face + kBesideDoor) * side) ==
                   Side::Inside;
        };
        const Vec2 left = perpendicular(along);
        if (is_indoor(left) == is_indoor(-left)) continue;
        const Vec2 out = is_indoor(left) ? -left : left;
        const auto behind = wallBehind(plan, middle, out, face + kWeldDistance);
        if (!behind) continue;
        found.emplace(
            door.element,
            context.warning(
                door.element, middle,
                " is open, but leads only to " + nameOf(elements[plan.owner[behind->line]]) + ", " +
                    lengthText(behind->distance) + " m behind, near " + placeText(middle),
                "say how far it reaches through with size=" + lengthText(door.to - door.from) +
                    ',' + lengthText(2 * behind->distance)));
    }
}

/// An end of a wall this near to another is reported as a gap, in metres.
constexpr double kLooseReach = 0.2;

void checkWalls(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    const auto element = context.element_of[record];
    if (!element) return;
    const auto [first, last] = context.walls().equal_range(*element);
    for (auto found = first; found != last; ++found) findings.push_back(found->second);
}

void checkObjects(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    const auto element = context.element_of[record];
    if (element && context.isObject(*element)) ThingCheck(context).checkObject(*element, findings);
}

void checkZones(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    const auto element = context.element_of[record];
    if (element && context.element(*element).record.keyword() == "zone")
        ThingCheck(context).checkZone(*element, findings);
}

void checkCollisions(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    context.circles().check(record, findings);
}

/// A check of an extension: one of both.
struct AddedCheck {
    RecordCheck check = nullptr;
    RecordCheckMaker make = nullptr;
};

/// The checks of extensions, by keyword.
std::multimap<std::string, AddedCheck, std::less<>>& recordChecks() {
    static std::multimap<std::string, AddedCheck, std::less<>> checks;
    return checks;
}

void checkRecords(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    if (record >= context.scene.records.size() || recordChecks().empty()) return;
    const auto [first, last] = recordChecks().equal_range(context.scene.records[record].keyword());
    for (auto check = first; check != last; ++check)
        if (auto finding = check->second.make == nullptr
                               ? check->second.check(context.scene, record)
                               : context.made(check->second.make, record))
            findings.push_back(std::move(*finding));
}

constexpr std::array<SceneCheck, 10> kChecks{{{"walls", checkWalls},
                                              {"objects", checkObjects},
                                              {"zones", checkZones},
                                              {"unplaced", checkUnplaced},
                                              {"outside", checkOutside},
                                              {"buried", checkBuried},
                                              {"collisions", checkCollisions},
                                              {"paths", checkPath},
                                              {"loose ends", checkLooseEnds},
                                              {"records", checkRecords}}};

}  // namespace

std::multimap<std::size_t, Finding> wallFindings(const CheckContext& context) {
    std::multimap<std::size_t, Finding> found;
    const auto& elements = context.scene.environment.elements();
    for (const WallCrossing& crossing : wallCrossings(elements, Diagnostics::kMax + 1))
        found.emplace(crossing.a,
                      context.warning(crossing.a, crossing.place,
                                      (crossing.overlap ? " lies on " : " crosses ") +
                                          context.elementName(crossing.b) + " near " +
                                          placeText(crossing.place),
                                      crossing.overlap ? "leave one of them out, or shorten it"
                                                       : "end one of them at the other"));
    addBlockedDoors(context, found);
    return found;
}

void checkLooseEnds(CheckContext& context, std::size_t record, std::vector<Finding>& findings) {
    const Scene& scene = context.scene;
    if (record < scene.records.size()) return;
    const std::vector<Segment2>& lines = scene.environment.wallLines();
    std::map<std::pair<double, double>, int> meeting;  // lines, by their end
    for (const Segment2& line : lines)
        for (const Point2 p : {line.a, line.b}) ++meeting[{p.x, p.y}];
    std::set<std::pair<double, double>> ends;
    std::optional<Closing> narrowest;
    for (const Closing& gap : closings(lines, {}, kLooseReach)) {
        const Point2 middle = gap.line.a + 0.5 * (gap.line.b - gap.line.a);
        if (context.indoor.locate(middle) != Side::Inside) continue;
        if (!narrowest) narrowest = gap;  // they are sorted by width
        for (const Point2 p : {gap.line.a, gap.line.b}) {
            const auto found = meeting.find({p.x, p.y});
            if (found != meeting.end() && found->second == 1) ends.insert(found->first);
        }
    }
    if (!narrowest) return;
    const auto [a, b] = narrowest->line;
    const std::size_t owner =
        wallWithEnd(scene.environment.elements(), ends.count({a.x, a.y}) != 0 ? a : b);
    findings.push_back(
        {.at = a,
         .message = std::to_string(ends.size()) +
                    (ends.size() == 1 ? " loose end of a wall" : " loose ends of walls") +
                    ", the narrowest gap " + lengthText(narrowest->width) + " m near " +
                    placeText(a),
         .hint = "make them meet",
         .source = context.element(owner).record.place()});
}

Diagnostic Finding::diagnostic() const {
    Diagnostic diagnostic = source.finding(text());
    diagnostic.severity = severity;
    return diagnostic;
}

std::span<const SceneCheck> sceneChecks() { return kChecks; }

void addRecordCheck(std::string_view keyword, RecordCheck check) {
    recordChecks().emplace(keyword, AddedCheck{check, nullptr});
}

void addRecordCheck(std::string_view keyword, RecordCheckMaker make) {
    recordChecks().emplace(keyword, AddedCheck{nullptr, make});
}

std::optional<Finding> CheckContext::made(RecordCheckMaker make, std::size_t record) {
    const auto [found, is_new] = made_.try_emplace(make);
    if (is_new) found->second = make(scene);
    return found->second(record);
}

std::vector<Finding> checkScene(const Scene& scene, const FindingFilter& filter) {
    CheckContext context(scene);
    std::vector<Finding> findings;
    const std::size_t count = scene.records.size();
    for (std::size_t record = 0; record <= count && !isFull(findings); ++record) {
        if (filter.ids && (record == count || !filter.ids(scene.ids[record]))) continue;
        for (const SceneCheck& check : kChecks)
            if (filter.checks.empty() || std::find(filter.checks.begin(), filter.checks.end(),
                                                   check.name) != filter.checks.end())
                check.run(context, record, findings);
    }
    return findings;
}

std::vector<Diagnostic> sceneWarnings(const Scene& scene, const FindingFilter& filter) {
    std::vector<Diagnostic> warnings;
    for (const Finding& finding : checkScene(scene, filter)) {
        if (warnings.size() == Diagnostics::kMax) break;
        warnings.push_back(finding.diagnostic());
        warnings.back().severity = Severity::Warning;
    }
    return warnings;
}

}  // namespace ispace
