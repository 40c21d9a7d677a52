// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the room of a plan: floor, zones, walls, doors and windows.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/number.h"
#include "drawing/plan/plan.h"
#include "env/body_shapes.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "scene/thing_kind.h"

namespace ispace {

namespace {

using namespace palette;

bool isOpening(const Element& element) {
    const std::string& keyword = element.record.keyword();
    return keyword == "door" || keyword == "window";
}

std::string titleOf(const Element& element) {
    const double top = topOf(element.body);
    std::string title = element.id;
    if (element.id.rfind(element.record.keyword(), 0) != 0)
        title.append(": ").append(element.record.keyword());
    if (top > 0)
        title.append(", up to ").append(formatDouble(std::round(top * 1000) / 1000) + " m");
    if (const std::string_view barrier = barrierOf(element.record); !barrier.empty())
        title.append(", ").append(barrier);
    return title;
}

/// Draws a covering: its colour, and a pattern of squares in another colour as one path.
void drawCovering(Picture& picture, const Element& element, const Stroke& edge) {
    picture.pushGroup(element.id, titleOf(element));
    picture.area(floorOutline(element.record),
                 {mixed(displayColor(Material::Floor), kWhite, 0.45), edge});
    std::vector<Polygon> squares;
    for (const Plate& plate : element.body.plates)
        if (plate.material == Material::FloorDark) squares.push_back(plate.outline);
    picture.area(squares, {mixed(displayColor(Material::FloorDark), kWhite, 0.35)});
    picture.pop();
}

/// Returns a pen in text sizes; finer if walls consist of short pieces, as in maps that robots
/// made.
double wallPen(const Environment& environment, double em_metres) {
    double sum = 0;
    for (const Segment2& wall : environment.wallLines()) sum += distance(wall.a, wall.b);
    const double mean = sum / static_cast<double>(environment.wallLines().size());
    return std::clamp(0.1 * mean / em_metres, 0.06, 0.16);
}

/// Returns a line through the opening as wide as its wall, or as the pen of sheets.
std::vector<Point2> gapOf(const Segment2& line, double width) {
    const Vec2 across = width / 2 / distance(line.a, line.b) * perpendicular(line.b - line.a);
    return {line.a - across, line.b - across, line.b + across, line.a + across};
}

}  // namespace

PlanLayer::PlanLayer(PlanDrawing& plan, std::string_view name) : PlanLayer(plan, name, {}) {}

PlanLayer::PlanLayer(PlanDrawing& plan, std::string_view name, std::span<const Polygon> clip)
    : picture_(plan.picture_) {
    picture_.pushView(plan.style_.view);
    // Pens on the edge are not cut.
    const auto [low, high] = plan.style_.box.expanded(plan.metres(0.5));
    const Polygon frame = {low, {high.x, low.y}, high, {low.x, high.y}};
    picture_.pushLayer(name, clip.empty() ? std::span(&frame, 1) : clip);
}

PlanLayer::~PlanLayer() {
    picture_.pop();
    picture_.pop();
}

bool isWall(const Element& element) {
    const RecordType type = element.record.schema().type;
    return type == RecordType::Wall || type == RecordType::Space;
}

bool standsAt(double bottom, double top, double height) {
    return bottom <= height && height <= top;
}

Box2 planBox(const Scene& scene) {
    const Environment& environment = scene.environment;
    Box2 box = environment.limits();
    // Bodies far outside are skipped: they would shrink the room on the page.
    const Box2 reach = box.expanded(0.5 + 0.1 * std::max(box.width(), box.depth()));
    for (const Element& element : environment.elements())
        for (const Prism& prism : element.body.prisms)
            for (const Point2 p : prism.footprint)
                if (reach.contains(p)) box.add(p);
    return box;
}

std::vector<Polygon> outsideOf(const Regions& indoor) {
    if (std::none_of(indoor.parts.begin(), indoor.parts.end(),
                     [](const Region& part) { return !part.holes.empty(); }))
        return {};
    std::vector<Point2> middles;
    middles.reserve(indoor.parts.size());
    for (const Region& part : indoor.parts) middles.push_back(interiorPoint(part));
    std::vector<Polygon> outside;
    for (const Region& part : indoor.parts)
        for (const Polygon& hole : part.holes) {
            // Subtracts rooms within the hole; the outer loop adds the holes of these rooms.
            std::vector<Polygon> rooms;
            for (std::size_t i = 0; i < indoor.parts.size(); ++i)
                if (&indoor.parts[i] != &part && locate(hole, middles[i]) == Side::Inside)
                    rooms.push_back(indoor.parts[i].outline);
            if (rooms.empty())
                outside.push_back(hole);
            else
                for (Polygon& curve : curvesOf(difference(Region{hole, {}}, rooms)))
                    outside.push_back(std::move(curve));
        }
    return outside;
}

PlanDrawing::PlanDrawing(Picture& picture, const Scene& scene, const PlanStyle& style)
    : picture_(picture),
      scene_(scene),
      style_(style),
      things_(thingsOf(scene.environment)),
      wall_pen_(wallPen(scene.environment, metres(1))) {}

Stroke PlanDrawing::pen(Color color, double width, std::vector<double> dashes) const {
    for (double& dash : dashes) dash *= style_.em;
    return {color, width * style_.em, std::move(dashes)};
}

void PlanDrawing::drawFloor() {
    const PlanLayer layer(*this, "floor");
    picture_.pushGroup("", "indoor");
    picture_.area(curvesOf(scene_.environment.indoor()), {kFloor});
    picture_.pop();
    picture_.pushGroup("", "not indoor");
    picture_.area(outsideOf(scene_.environment.indoor()),
                  {kOutside, Hatch{kOutsideHatch, 0.7 * style_.em, 0.07 * style_.em, 0,
                                   Angle::degrees(-45)}});
    picture_.pop();
    if (style_.neutral) return;
    for (const Element& element : scene_.environment.elements())
        if (element.record.keyword() == "floor")
            drawCovering(picture_, element, pen(kFaintInk, 0.05));
}

void PlanDrawing::drawZones() {
    const PlanLayer layer(*this, "zones");
    std::size_t index = 0;
    for (const Element& element : scene_.environment.elements()) {
        if (element.record.keyword() != "zone") continue;
        const Polygon outline = zoneOutline(element.record);
        const Color color = style_.neutral ? kZone : seriesColor(index++);
        const Stroke edge = pen(color, 0.09, {0.5, 0.35});
        picture_.pushGroup(element.id, titleOf(element));
        if (style_.neutral)
            picture_.area(outline, {edge});
        else
            picture_.area(outline, {color.faded(0.13), edge});
        picture_.pop();
    }
}

void PlanDrawing::drawWalls() {
    const PlanLayer layer(*this, "walls");
    for (const Element& element : scene_.environment.elements())
        if (isWall(element) && !isOpening(element) && element.record.keyword() != "inside")
            drawWall(element);
}

/// Draws the part below the cut first, then the cut part; the part above as a dashed line.
void PlanDrawing::drawWall(const Element& element) {
    const double cut = style_.cut;
    const bool neutral = style_.neutral;
    std::vector<Segment2> low, at_cut, high, glass, cloth;
    for (const Sheet& sheet : element.body.sheets)
        (sheet.bottom > cut ? high
         : sheet.top < cut  ? low
         : sheet.clear      ? glass
         : isSoft(sheet)    ? cloth
                            : at_cut)
            .push_back(sheet.line);
    picture_.pushGroup(element.id, titleOf(element));
    picture_.lines(low, {neutral ? pen(kOpening, wall_pen_ / 2) : pen(kFaintInk, 0.6 * wall_pen_)});
    for (const bool is_low : {true, false}) {
        for (const Prism& prism : element.body.prisms) {
            if (prism.bottom > cut || (prism.top < cut) != is_low) continue;
            const bool plain = neutral || prism.material == Material::Wall;
            const Color color = is_low  ? kLowWall
                                : plain ? kWall
                                        : mixed(displayColor(prism.material), kInk, 0.45);
            // The rim hides seams between the pieces of a wall.
            picture_.area(prism.footprint, {color, pen(color, 0.04)});
        }
    }
    picture_.lines(glass, {pen(kGlass, wall_pen_)});
    picture_.lines(cloth, {pen(displayColor(Material::Cloth), wall_pen_, {0.08, 0.04})});
    picture_.lines(at_cut, {pen(kWall, wall_pen_)});
    picture_.lines(high, {pen(neutral ? kOpening : kFaintInk, 0.05, {0.3, 0.25})});
    picture_.pop();
}

void PlanDrawing::drawOpenings() {
    const PlanLayer layer(*this, "doors & windows");
    const std::vector<Element>& elements = scene_.environment.elements();
    if (std::none_of(elements.begin(), elements.end(), isOpening)) return;
    const std::vector<ElementLines> lines = elementLinesOf(scene_.environment);
    for (std::size_t i = 0; i < elements.size(); ++i)
        // Below an overlay, openings are drawn only at the height of the cut.
        if (isOpening(elements[i]) &&
            (!style_.neutral || standsAt(lines[i].bottom, lines[i].top, style_.cut)))
            drawOpening(elements[i], lines[i]);
}

/// Draws the bolt of a shut door that lets no person pass: a square at the end of its leaf.
void PlanDrawing::drawBolt(const Segment2& leaf, double width) {
    const double side = std::max(width, metres(6 * wall_pen_)), length = distance(leaf.a, leaf.b);
    const Vec2 along = 1 / length * (leaf.b - leaf.a);
    const Vec2 half = side / 2 * along, across{-half.y, half.x};
    const Point2 middle = leaf.b - std::min(side, length / 2) * along;
    picture_.area(Polygon{middle - half - across, middle + half - across, middle + half + across,
                          middle - half + across},
                  {kDoor});
}

/// Draws a window's frame and pane; a door's leaf, open or in its frame, and its swing: about the
/// start of the opening, to the left of its wall. The side is arbitrary, since records do not store
/// it.
void PlanDrawing::drawOpening(const Element& element, const ElementLines& lines) {
    picture_.pushGroup(element.id, titleOf(element));
    const double width = std::max(lines.thickness, metres(2 * wall_pen_));
    for (const std::vector<Point2>& chain : lines.chains) {
        const Segment2 line{chain.front(), chain.back()};
        if (line.a == line.b) continue;
        if (element.record.keyword() == "window") {
            picture_.area(gapOf(line, width), {kWhite, pen(kGlass, 0.06)});
            picture_.line(line.a, line.b, pen(kGlass, 0.06));
            continue;
        }
        const bool is_open = element.record.flag("open");
        const double length = distance(line.a, line.b);
        const Vec2 along = 1 / length * (line.b - line.a);
        const Angle heading = directionOf(along.x, along.y);
        std::vector<Point2> swing;
        for (int turn = 0; turn <= 90; turn += 5)
            swing.push_back(line.a + length * unitVector(heading + Angle::degrees(turn)));
        picture_.area(gapOf(line, width), {kWhite});
        picture_.lines(swing, {is_open ? pen(kDoor, 0.05) : pen(kDoor, 0.05, {0.15, 0.2})});
        picture_.line(line.a, is_open ? swing.back() : line.b, pen(kDoor, 0.2));
        if (!barrierOf(element.record).empty()) drawBolt(line, width);
    }
    picture_.pop();
}

void PlanDrawing::drawFreeFloor(double height) {
    const PlanLayer layer(*this, "floor");
    const Box2& box = style_.box;
    picture_.pushGroup("", "not indoor");
    picture_.area(Polygon{box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}},
                  {kOutside});
    picture_.pop();
    picture_.pushGroup("", "free floor at " + formatDouble(height) + " m");
    picture_.area(curvesOf(scene_.environment.indoor()), {kWhite});
    picture_.pop();
}

void PlanDrawing::drawObstacles(double height) {
    const std::string at_height = " at " + formatDouble(height) + " m";
    const Environment& environment = scene_.environment;
    const auto level = environment.level(height);
    const Slice& slice = level->slice();
    struct Parts {
        std::vector<Segment2> sheets;
        std::vector<Polygon> solids;
    };
    std::map<std::size_t, Parts> parts;  // by element
    for (std::size_t i = 0; i < slice.sheets.size(); ++i)
        parts[slice.sheet_owners[i]].sheets.push_back(slice.sheets[i]);
    for (std::size_t i = 0; i < slice.solids.size(); ++i)
        parts[slice.solid_owners[i]].solids.push_back(slice.solids[i]);
    const PlanLayer layer(*this, "walls");
    for (const auto& [owner, of_one] : parts) {
        const std::string& id = environment.elements()[owner].id;
        picture_.pushGroup(id, id + at_height);
        for (const Polygon& solid : of_one.solids)
            picture_.area(solid, {kSolidEdge, pen(kSolidEdge, 0.03)});
        picture_.lines(of_one.sheets, {pen(kInk, 0.1)});
        picture_.pop();
    }
}

}  // namespace ispace
