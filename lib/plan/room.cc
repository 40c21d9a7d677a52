// SPDX-License-Identifier: GPL-3.0-or-later
// The room of a plan: floor, zones, walls, doors and windows.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/number.h"
#include "plan/display_color.h"
#include "plan/element_lines.h"
#include "plan/drawing.h"

namespace ispace {

namespace {

using namespace plan_colors;

/// Plans show walls cut at this height: what is lower is seen from above, what is higher not.
constexpr double kCut = 1.2;

bool isRoom(const Element& element) {
    const RecordType type = element.record.schema().type;
    return type == RecordType::Wall || type == RecordType::Space;
}

bool isOpening(const Element& element) {
    const std::string& keyword = element.record.keyword();
    return keyword == "door" || keyword == "window";
}

std::string metres(double value) { return formatDouble(std::round(value * 1000) / 1000) + " m"; }

std::string titleOf(const Element& element) {
    const double top = topOf(element.body);
    std::string title = element.id;
    if (element.id.rfind(element.record.keyword(), 0) != 0)
        title.append(": ").append(element.record.keyword());
    if (top > 0) title.append(", up to ").append(metres(top));
    return title;
}

/// A covering: its colour, and squares of another in one path.
DrawnItem coveringItem(const Element& element) {
    DrawnItem item{PlanLayer::Floor, element.id, titleOf(element)};
    const Color light = mixed(displayColor(Material::Floor), kPaper, 0.45);
    const Color dark = mixed(displayColor(Material::FloorDark), kPaper, 0.35);
    item.paths.push_back({{floorOutline(element.record)}, true, light, Stroke{kFaintInk, 0.05}});
    DrawnPath squares{{}, true, dark, {}};
    for (const Plate& plate : element.body.plates)
        if (plate.material == Material::FloorDark) squares.curves.push_back(plate.outline);
    if (!squares.curves.empty()) item.paths.push_back(std::move(squares));
    return item;
}

DrawnItem zoneItem(const Element& element, std::size_t index) {
    const Color color = seriesColor(index);
    const Polygon outline = zoneOutline(element.record);
    DrawnItem item{PlanLayer::Zones, element.id, titleOf(element)};
    item.paths.push_back({{outline}, true, color.faded(0.13), Stroke{color, 0.09, {0.5, 0.35}}});
    return item;
}

/// Its id in the lower left corner of what the plan shows of it, moved in where it would run over
/// the edge.
void addZoneName(PlanDrawing& plan, const Element& element, std::size_t index) {
    const Box2 zone = bounds(zoneOutline(element.record));
    const Box2& box = plan.box;
    const Point2 corner{std::max(zone.low.x, box.low.x), std::max(zone.low.y, box.low.y)};
    if (corner.x >= std::min(zone.high.x, box.high.x) ||
        corner.y >= std::min(zone.high.y, box.high.y))
        return;
    constexpr double kSize = 0.85;
    const double em = plan.metres();
    const TextStyle style{kSize * plan.em, false, Align::Left, kInk, {}};
    const double width = textWidth(element.id, style) * em / plan.em;
    const auto within = [em](double begin, double low, double high) {
        return std::max(low + em / 4, std::min(begin, high - em / 4));
    };
    DrawnText name{{within(corner.x + 0.5 * em, box.low.x, box.high.x - width),
                    within(corner.y + 0.55 * em, box.low.y, box.high.y - em)},
                   element.id};
    name.size = kSize;
    name.color = mixed(seriesColor(index), kInk, 0.35);
    name.halo = true;
    DrawnItem item{PlanLayer::Labels, "", ""};
    item.texts.push_back(std::move(name));
    plan.items.push_back(std::move(item));
}

/// A pen finer where walls are made of short pieces, as in maps that robots made.
double penWidth(const PlanDrawing& plan, const Environment& environment) {
    double sum = 0;
    for (const Segment2& wall : environment.wallLines()) sum += distance(wall.a, wall.b);
    const double mean = sum / static_cast<double>(environment.wallLines().size());
    return std::clamp(0.1 * mean / plan.metres(), 0.06, 0.16);
}

/// Lines as few curves as may be.
DrawnPath linesPath(const std::vector<Segment2>& lines, const Stroke& pen) {
    return {chained(lines), false, {}, pen};
}

DrawnItem wallItem(const Element& element, double pen) {
    DrawnItem item{PlanLayer::Walls, element.id, titleOf(element)};
    std::vector<Segment2> cut, low, high;
    for (const Sheet& sheet : element.body.sheets)
        (sheet.bottom > kCut ? high : sheet.top < kCut ? low : cut).push_back(sheet.line);
    if (!low.empty()) item.paths.push_back(linesPath(low, {kFaintInk, 0.6 * pen}));
    for (const bool is_low : {true, false}) {
        for (const Prism& prism : element.body.prisms) {
            if (prism.bottom > kCut || (prism.top < kCut) != is_low) continue;
            const bool plain = prism.material == Material::Wall;
            const Color color = is_low  ? kLowWall
                                : plain ? kWall
                                        : mixed(displayColor(prism.material), kInk, 0.45);
            // The rim hides seams between the pieces of a wall.
            item.paths.push_back({{prism.footprint}, true, color, Stroke{color, 0.04}});
        }
    }
    if (!cut.empty()) item.paths.push_back(linesPath(cut, {kWallEdge, pen}));
    if (!high.empty()) item.paths.push_back(linesPath(high, {kFaintInk, 0.05, {0.3, 0.25}}));
    return item;
}

/// A line through the opening as wide as its wall, or as the pen of sheets.
std::vector<Point2> gapOf(const Segment2& line, double width) {
    const Vec2 across = width / 2 / distance(line.a, line.b) * perpendicular(line.b - line.a);
    return {line.a - across, line.b - across, line.b + across, line.a + across};
}

/// Frame and pane.
void addWindow(DrawnItem& item, const Segment2& line, double width) {
    item.paths.push_back({{gapOf(line, width)}, true, kPaper, Stroke{kGlass, 0.06}});
    item.paths.push_back({{{line.a, line.b}}, false, {}, Stroke{kGlass, 0.06}});
}

/// The leaf, open or in its frame, and the way it swings: about the beginning of the opening, to
/// the left of its wall. Which way is ours; records do not say.
void addDoor(DrawnItem& item, const Segment2& line, double width, bool open) {
    const double length = distance(line.a, line.b);
    const Vec2 along = 1 / length * (line.b - line.a);
    const Angle heading = directionOf(along.x, along.y);
    const Point2 aside = line.a + length * perpendicular(along);
    item.paths.push_back({{gapOf(line, width)}, true, kPaper, {}});
    const std::vector<double> dashes = open ? std::vector<double>{} : std::vector{0.15, 0.2};
    item.paths.push_back({{planArc(line.a, length, heading, heading + Angle::degrees(90))},
                          false,
                          {},
                          Stroke{kDoor, 0.05, dashes}});
    item.paths.push_back({{{line.a, open ? aside : line.b}}, false, {}, Stroke{kDoor, 0.2}});
}

DrawnItem openingItem(const PlanDrawing& plan, const Element& element, const ElementLines& lines,
                      double pen) {
    DrawnItem item{PlanLayer::Openings, element.id, titleOf(element)};
    const double width = std::max(lines.thickness, 2 * pen * plan.metres());
    for (const std::vector<Point2>& chain : lines.chains) {
        const Segment2 line{chain.front(), chain.back()};
        if (line.a == line.b) continue;
        if (element.record.keyword() == "window")
            addWindow(item, line, width);
        else
            addDoor(item, line, width, element.record.flag("open"));
    }
    return item;
}

}  // namespace

Box2 planBox(const Scene& scene) {
    const Environment& environment = scene.environment;
    Box2 box = environment.limits();
    // What stands far outside does not make the room small.
    const double near = 0.5 + 0.1 * std::max(box.width(), box.depth());
    const Box2 reach{{box.low.x - near, box.low.y - near}, {box.high.x + near, box.high.y + near}};
    const auto add = [&](Point2 p) {
        if (p.x >= reach.low.x && p.x <= reach.high.x && p.y >= reach.low.y && p.y <= reach.high.y)
            box.add(p);
    };
    for (const Element& element : environment.elements())
        for (const Prism& prism : element.body.prisms)
            for (const Point2 p : prism.footprint) add(p);
    return box;
}

void addRoom(PlanDrawing& plan, const Scene& scene) {
    const Environment& environment = scene.environment;
    plan.items.push_back({PlanLayer::Floor, "", "indoor"});
    plan.items.back().paths.push_back({curvesOf(environment.indoor()), true, kIndoor, {}});
    const double pen = penWidth(plan, environment);
    const std::vector<Element>& elements = environment.elements();
    const std::vector<ElementLines> lines = elementLinesOf(environment);
    std::size_t zones = 0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const Element& element = elements[i];
        const std::string& keyword = element.record.keyword();
        if (keyword == "floor")
            plan.items.push_back(coveringItem(element));
        else if (keyword == "zone") {
            plan.items.push_back(zoneItem(element, zones));
            addZoneName(plan, element, zones++);
        } else if (isOpening(element))
            plan.items.push_back(openingItem(plan, element, lines[i], pen));
        else if (isRoom(element) && keyword != "inside")
            plan.items.push_back(wallItem(element, pen));
    }
}

}  // namespace ispace
