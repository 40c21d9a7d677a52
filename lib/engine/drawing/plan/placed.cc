// SPDX-License-Identifier: GPL-3.0-or-later
// Draws placed records on a plan: sensors with their fields of view, tags, mats, gates, robots,
// people; and names. A label takes the cheapest of eight directions and up to four distances around
// its mark; covering another label costs most, then marks, then lines.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "base/number.h"
#include "drawing/plan/plan.h"
#include "env/body.h"
#include "scene/bodies.h"
#include "scene/placement_schemas.h"
#include "scene/sensor/sensor.h"

namespace ispace {

bool crosses(const Segment2& line, const Box2& box) {
    double from = 0, to = 1;
    const Vec2 way = line.b - line.a;
    const auto clip = [&](double start, double step, double low, double high) {
        if (step == 0) return start > low && start < high;
        const double a = (low - start) / step, b = (high - start) / step;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
        return from < to;
    };
    return clip(line.a.x, way.x, box.low.x, box.high.x) &&
           clip(line.a.y, way.y, box.low.y, box.high.y);
}

namespace {

Box2 boxAround(Point2 p, double half_width, double half_height) {
    return {{p.x - half_width, p.y - half_height}, {p.x + half_width, p.y + half_height}};
}

/// Fills the mark's body about the origin, y up.
void fillBody(Picture& picture, SensorSign sign, double radius, Color color, double rim = 0) {
    Polygon curve;
    if (sign == SensorSign::Disc) {
        picture.circle({}, radius + rim, {color});
        return;
    }
    if (sign == SensorSign::Square) {
        const double half = 0.9 * radius;
        curve = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
    } else {
        const double tip = 1.35 * radius, side = std::sqrt(0.75) * tip;
        curve = {{0, tip}, {-side, -tip / 2}, {side, -tip / 2}};
    }
    if (rim > 0)
        picture.area(curve, {color, Stroke{color, 2 * rim}});
    else
        picture.area(curve, {color});
}

}  // namespace

BearingSpan bearingsOf(const Scene& scene, const PlacedRecord& placed) {
    const Record& record = scene.records[placed.record];
    const SensorKind* kind = sensorKind(record.keyword());
    if (kind != nullptr && kind->bearings != nullptr)
        return kind->bearings(scene.sensors[placed.index].model);
    BearingSpan span{Angle::degrees(-22.5), Angle::degrees(22.5), 5};
    // Of things of extensions, too, some of which have one number.
    const auto number_of = [&record](std::string_view key, bool is_last) -> std::optional<double> {
        const Value* const value = record.has(key) ? record.find(key) : nullptr;
        if (value == nullptr) return std::nullopt;
        if (const double* const number = std::get_if<double>(value)) return *number;
        const Tuple* const numbers = std::get_if<Tuple>(value);
        if (numbers == nullptr) return std::nullopt;
        return is_last ? numbers->back() : numbers->front();
    };
    if (const auto fov = number_of("fov", false)) {
        const Angle half = Angle::degrees(*fov / 2);
        span = {-half, half, 5};
    }
    if (const auto range = number_of("range", true)) span.range = *range;
    return span;
}

std::optional<Angle> headingOf(const Pose3& pose) {
    constexpr double kSteep = 0.02;  // horizontal part, about a degree from vertical
    const Vec3 forward = pose.beam(Angle());
    if (length(Vec2{forward.x, forward.y}) <= kSteep) return std::nullopt;
    return directionOf(forward.x, forward.y);
}

void drawSensorMark(Picture& picture, Point2 page, const SensorMark& mark, double radius) {
    using palette::kWhite;
    picture.pushView({1, {0, 0}, page});
    if (mark.heading) {
        const Vec2 forward = unitVector(*mark.heading), left = perpendicular(forward);
        const Point2 center, tip = center + 3.4 * radius * forward;
        const Point2 neck = center + 1.9 * radius * forward;
        const Polygon head = {tip, neck + 0.85 * radius * left, neck - 0.85 * radius * left};
        picture.line(center, neck, {kWhite, radius});
        picture.area(head, {Stroke{kWhite, 0.6 * radius}});
        picture.line(center, neck, {mark.color, 0.5 * radius});
        picture.area(head, {mark.color});
    }
    fillBody(picture, mark.sign, radius, kWhite, 0.3 * radius);
    fillBody(picture, mark.sign, radius, mark.color);
    if (mark.hollow) fillBody(picture, mark.sign, 0.5 * radius, kWhite);
    picture.pop();
}

LabelPlacer::LabelPlacer(const Box2& frame, double em) : frame_(frame), em_(em) {
    constexpr double kMostCells = 256;  // along a side
    side_ = std::max({em, frame.width() / kMostCells, frame.depth() / kMostCells});
    columns_ = static_cast<std::size_t>(std::max(1.0, std::ceil(frame.width() / side_)));
    rows_ = static_cast<std::size_t>(std::max(1.0, std::ceil(frame.depth() / side_)));
    cells_.resize(columns_ * rows_);
}

LabelPlacer::CellRange LabelPlacer::cellsOf(const Box2& box) const {
    const auto cell = [this](double offset, std::size_t count) {
        return static_cast<std::size_t>(
            std::clamp(offset / side_, 0.0, static_cast<double>(count - 1)));
    };
    return {cell(box.low.x - frame_.low.x, columns_), cell(box.high.x - frame_.low.x, columns_),
            cell(box.low.y - frame_.low.y, rows_), cell(box.high.y - frame_.low.y, rows_)};
}

void LabelPlacer::addBox(const Box2& box, std::vector<Box2> Cell::*list) {
    const CellRange range = cellsOf(box);
    for (std::size_t row = range.low; row <= range.high; ++row)
        for (std::size_t i = range.left; i <= range.right; ++i)
            (cells_[row * columns_ + i].*list).push_back(box);
}

void LabelPlacer::addLine(const Segment2& page_line) {
    const Vec2 way = page_line.b - page_line.a;
    const double steps = std::clamp(std::ceil(std::max(std::abs(way.x), std::abs(way.y)) / side_),
                                    1.0, 2.0 * static_cast<double>(columns_ + rows_));
    // Cells about each piece of the line; neighbours share some.
    CellRange before{1, 0, 1, 0};
    for (double i = 0; i < steps; ++i) {
        Box2 box;
        box.add(page_line.a + i / steps * way);
        box.add(page_line.a + (i + 1) / steps * way);
        const CellRange range = cellsOf(box.expanded(1e-6 * side_));
        for (std::size_t row = range.low; row <= range.high; ++row)
            for (std::size_t k = range.left; k <= range.right; ++k)
                if (row < before.low || row > before.high || k < before.left || k > before.right)
                    cells_[row * columns_ + k].lines.push_back(page_line);
        before = range;
    }
}

void LabelPlacer::addMark(Point2 page, std::optional<Angle> heading) {
    addBox(boxAround(page, 0.45 * em_, 0.45 * em_), &Cell::marks);
    if (!heading) return;
    const Vec2 forward = em_ * unitVector(*heading);
    addBox(boxAround({page.x + forward.x, page.y - forward.y}, 0.4 * em_, 0.4 * em_), &Cell::marks);
}

Point2 LabelPlacer::placeSign(Point2 page, double radius) {
    const double half = radius + 0.1 * em_;
    Point2 best = page;
    constexpr double kAny = std::numeric_limits<double>::infinity();
    double least = costOf(boxAround(page, half, half), kAny);
    for (const double away : {1.2, 2.4}) {
        for (int turn = 0; turn < 8 && least > 0; ++turn) {
            const Vec2 off = away * em_ * unitVector(Angle::degrees(45.0 * turn));
            const Point2 place{page.x + off.x, page.y - off.y};
            if (const double cost = costOf(boxAround(place, half, half), least) + away;
                cost < least) {
                least = cost;
                best = place;
            }
        }
    }
    addBox(boxAround(best, half, half), &Cell::labels);
    return best;
}

std::optional<Point2> LabelPlacer::placeLabel(Point2 page, Angle heading, double width, double size,
                                              bool crowd) {
    constexpr std::array<double, 8> kTurns = {180, 135, -135, 90, -90, 45, -45, 0};
    const double half_width = width / 2 + 0.15 * em_, half_height = 0.55 * size;
    std::optional<Point2> best;
    double least = crowd ? 1 : 100;  // cost above which the label is skipped
    for (const double ring : {0.6, 2.0, 3.5, 5.0}) {
        for (std::size_t i = 0; i < kTurns.size(); ++i) {
            const Vec2 away = unitVector(heading + Angle::degrees(kTurns[i]));
            const Point2 middle{page.x + away.x * (ring * em_ + half_width),
                                page.y - away.y * (ring * em_ + half_height)};
            const Box2 box = boxAround(middle, half_width, half_height);
            const double cost = costOf(box, least) + static_cast<double>(i) / 10;
            if (cost < least) {
                least = cost;
                best = middle;
            }
        }
        if (least < 1 || crowd) break;  // farther away only from marks and lines
    }
    if (best) addBox(boxAround(*best, half_width, half_height), &Cell::labels);
    return best;
}

void drawMarkLabel(Picture& picture, Point2 mark, Point2 middle, const std::string& text,
                   const TextStyle& style) {
    const Box2 box = boxAround(middle, textWidth(text, style) / 2, style.size / 2);
    const Point2 edge{std::clamp(mark.x, box.low.x, box.high.x),
                      std::clamp(mark.y, box.low.y, box.high.y)};
    if (distance(mark, edge) > 1.5 * style.size)
        picture.line(mark, edge, {style.color, style.size / 16});
    picture.text({middle.x, middle.y + 0.36 * style.size}, text, style);
}

bool LabelPlacer::take(const Box2& box, bool over_lines, std::optional<Segment2> own) {
    if (costOf(box, 1, over_lines, own) > 0) return false;
    addBox(box, &Cell::labels);
    return true;
}

double LabelPlacer::costOf(const Box2& box, double enough, bool over_lines,
                           std::optional<Segment2> own) const {
    constexpr double kOverFrame = 100, kOverLabel = 100, kOverMark = 5, kOverLine = 2;
    double cost = frame_.contains(box) ? 0 : kOverFrame;
    const CellRange range = cellsOf(box);
    // Boxes that overlap share several cells: they count in the first of them.
    const auto add = [&](const std::vector<Box2>& boxes, std::size_t column, std::size_t row,
                         double each) {
        for (const Box2& one : boxes) {
            if (!one.overlaps(box)) continue;
            const CellRange cells = cellsOf(one);
            const bool is_first =
                column == std::max(range.left, cells.left) && row == std::max(range.low, cells.low);
            if (is_first && (cost += each) >= enough) return;
        }
    };
    const auto is_crossed = [&](const Segment2& line) {
        return crosses(line, box) && !(own && own->a == line.a && own->b == line.b);
    };
    bool is_over_line = over_lines;  // not to be looked for
    for (std::size_t row = range.low; row <= range.high && cost < enough; ++row)
        for (std::size_t i = range.left; i <= range.right && cost < enough; ++i) {
            const Cell& cell = cells_[row * columns_ + i];
            add(cell.labels, i, row, kOverLabel);
            if (cost < enough) add(cell.marks, i, row, kOverMark);
            if (cost >= enough || is_over_line) continue;
            is_over_line = std::any_of(cell.lines.begin(), cell.lines.end(), is_crossed);
            if (is_over_line) cost += kOverLine;
        }
    return cost;
}

namespace {

using namespace palette;

/// Radius of a sensor's mark, in text sizes.
constexpr double kMark = 0.3;

bool looksAside(const Record& record, const Pose3& pose) {
    const SensorKind* kind = sensorKind(record.keyword());
    return kind != nullptr && kind->perceives && std::abs(pose.tilt.degrees()) < 70;
}

bool isPerson(const Record& record) { return record.keyword() == "human"; }
bool movesItself(const Record& record) { return isPerson(record) || record.keyword() == "robot"; }

Pose2 levelPose(const PlacedRecord& placed) {
    return {placed.pose.position.onFloor(), placed.pose.heading};
}

void drawRobot(Picture& picture, const Pose2& pose, const RobotModel& model, const Stroke& edge) {
    const double half = model.length > 0 ? model.length / 2 : model.radius;
    const Ink fill = mixed(kRobot, kWhite, 0.45);
    if (model.length > 0)
        picture.area(
            rectangle(pose * Point2{model.center, 0}, model.length, model.width, pose.heading),
            {fill, edge});
    else
        picture.circle(pose * Point2{model.center, 0}, model.radius, {fill, edge});
    picture.area(Polygon{pose * Point2{model.center + 0.85 * half, 0},
                         pose * Point2{model.center + 0.2 * half, 0.35 * half},
                         pose * Point2{model.center + 0.2 * half, -0.35 * half}},
                 {kRobot});
}

/// Draws shoulders, head, nose.
void drawPerson(Picture& picture, const Pose2& pose, double tall, const Stroke& edge) {
    picture.area(ellipse(pose.position, 0.14 * tall, 0.27 * tall, pose.heading),
                 {mixed(kPerson, kWhite, 0.4), edge});
    picture.area(Polygon{pose * Point2{0.1 * tall, 0}, pose * Point2{0.04 * tall, 0.03 * tall},
                         pose * Point2{0.04 * tall, -0.03 * tall}},
                 {kPerson});
    picture.circle(pose.position, 0.06 * tall,
                   {mixed(displayColor(Material::Skin), kWhite, 0.2), edge});
}

/// Draws the parts of a body that an extension shapes, as seen from above.
void drawFigure(Picture& picture, const PlacedPerson& person, const Pose2& pose,
                const Stroke& edge) {
    std::vector<BodyPart> parts = personParts(person);
    std::stable_sort(parts.begin(), parts.end(),
                     [](const BodyPart& a, const BodyPart& b) { return a.top < b.top; });
    for (const BodyPart& part : parts) {
        const Point2 center = pose * part.center;
        const Color color = part.material == Material::Skin
                                ? mixed(displayColor(Material::Skin), kWhite, 0.2)
                                : mixed(kPerson, kWhite, 0.4);
        if (part.radius > 0)
            picture.circle(center, part.radius, {color, edge});
        else
            picture.area(rectangle(center, 2 * part.half_length, 2 * part.half_width, pose.heading),
                         {color, edge});
    }
}

}  // namespace

void PlanDrawing::drawFieldsOfView() {
    const std::vector<Polygon> indoor = curvesOf(scene_.environment.indoor());
    const PlanLayer layer(*this, "fields of view", indoor);
    for (const PlacedRecord& placed : scene_.placed) {
        if (!looksAside(scene_.records[placed.record], placed.pose)) continue;
        const Point2 place = placed.pose.position.onFloor();
        const BearingSpan glyph = bearingsOf(scene_, placed);
        picture_.pushGroup("", "field of view of " + scene_.ids[placed.record]);
        picture_.sector(place, std::min(metres(4.5), glyph.range), placed.pose.heading + glyph.from,
                        placed.pose.heading + glyph.to, {kSensor.faded(0.2), pen(kSensor, 0.05)});
        picture_.pop();
    }
}

void PlanDrawing::drawRobots() {
    const PlanLayer layer(*this, "robots");
    for (const PlacedRecord& placed : scene_.placed) {
        const Record& record = scene_.records[placed.record];
        if (!movesItself(record)) continue;
        const std::string& id = scene_.ids[placed.record];
        const Pose2 pose = levelPose(placed);
        const Color color = isPerson(record) ? kPerson : kRobot;
        picture_.pushGroup(id, id + ": " + (isPerson(record) ? "person" : "robot"));
        if (record.has("path")) {  // autonomous mover
            std::vector<Point2> way{pose.position};
            for (const Tuple& point : record.list("path")) way.push_back({point[0], point[1]});
            picture_.lines(way, {pen(color.faded(0.7), 0.07, {0.3, 0.3})});
        }
        if (isPerson(record) && scene_.people[placed.index].figure != nullptr)
            drawFigure(picture_, scene_.people[placed.index], pose, pen(kPerson, 0.04));
        else if (isPerson(record))
            drawPerson(picture_, pose, record.number("height"), pen(kPerson, 0.07));
        else
            drawRobot(picture_, pose, scene_.robots[placed.index].model, pen(kRobot, 0.09));
        picture_.pop();
    }
}

void PlanDrawing::drawSensors() {
    const PlanLayer layer(*this, "sensors");
    for (const PlacedRecord& placed : scene_.placed) {
        const Record& record = scene_.records[placed.record];
        if (movesItself(record)) continue;
        const std::string& id = scene_.ids[placed.record];
        const std::string& keyword = record.keyword();
        const Pose2 pose = levelPose(placed);
        std::string title = id;
        title.append(": ").append(keyword);
        const SensorKind* kind = sensorKind(keyword);
        if (kind != nullptr && kind->perceives)
            title += " at height " +
                     formatDouble(std::round(placed.pose.position.z * 1000) / 1000) + " m";
        picture_.pushGroup(id, title);
        if (keyword == "mat") {
            const Tuple& size = record.tuple("size");
            picture_.area(rectangle(pose.position, size[0], size[1], pose.heading),
                          {kMat.faded(0.25), pen(kMat, 0.09)});
        } else if (keyword == "gate") {
            const double half = record.number("width") / 2;
            const Point2 left = pose * Point2{0, half}, right = pose * Point2{0, -half};
            picture_.line(left, right, pen(kSensor, 0.08, {0.25, 0.2}));
            for (const Point2 p : {left, right})
                picture_.circle(p, metres(0.25), {kSensor, pen(kWhite, 0.06)});
        } else if (kind != nullptr && kind->sign == SensorSign::Diamond) {
            const double size = metres(0.4);
            const Point2 p = pose.position;
            picture_.area(
                Polygon{{p.x + size, p.y}, {p.x, p.y + size}, {p.x - size, p.y}, {p.x, p.y - size}},
                {kMat, pen(kWhite, 0.08)});
        } else {
            const bool aside = looksAside(record, placed.pose);
            if (!aside)  // upwards or downwards
                picture_.circle(pose.position, metres(2 * kMark),
                                {pen(kSensor, 0.08, {0.25, 0.2})});
            drawSensorMark(picture_, picture_.toPage(pose.position),
                           {kind == nullptr ? SensorSign::Disc : kind->sign,
                            aside ? headingOf(placed.pose) : std::nullopt, kSensor},
                           kMark * style_.em);
        }
        picture_.pop();
    }
}

void PlanDrawing::drawNames() {
    picture_.pushLayer("labels");
    picture_.pushView(style_.view);
    std::size_t zones = 0;
    for (const Element& element : scene_.environment.elements())
        if (element.record.keyword() == "zone") drawZoneName(element, zones++);
    // In the middle of things with enough space.
    const TextStyle style{0.7 * style_.em, false, Align::Center, kInk, kWhite.faded(0.85)};
    for (const Thing& thing : things_) {
        const Point2 middle = thing.box.center();
        if (!isOverhead(thing) && thing.box.depth() >= metres(0.8) &&
            textWidth(thing.element->id, style) <= 0.96 * style_.view.scale * thing.box.width())
            picture_.text({middle.x, middle.y - metres(0.25)}, thing.element->id, style);
    }
    picture_.pop();
    drawPlacedNames();
    picture_.pop();
}

/// Writes the zone's id in the lower left corner of its visible part, shifted inwards if it would
/// cross the edge.
void PlanDrawing::drawZoneName(const Element& element, std::size_t index) {
    const Box2 zone = bounds(zoneOutline(element.record));
    const Box2& box = style_.box;
    const Point2 corner{std::max(zone.low.x, box.low.x), std::max(zone.low.y, box.low.y)};
    if (corner.x >= std::min(zone.high.x, box.high.x) ||
        corner.y >= std::min(zone.high.y, box.high.y))
        return;
    const TextStyle style{0.85 * style_.em, false, Align::Left,
                          mixed(seriesColor(index), kInk, 0.35), kWhite.faded(0.85)};
    const double em = metres(1), width = textWidth(element.id, style) / style_.view.scale;
    const auto within = [em](double begin, double low, double high) {
        return std::max(low + em / 4, std::min(begin, high - em / 4));
    };
    picture_.text({within(corner.x + 0.5 * em, box.low.x, box.high.x - width),
                   within(corner.y + 0.55 * em, box.low.y, box.high.y - em)},
                  element.id, style);
}

void PlanDrawing::drawPlacedNames() {
    constexpr std::size_t kMaxNames = 500;  // more are unreadable on one page
    if (scene_.placed.size() > kMaxNames) return;
    const Box2 page{{0, 0}, {picture_.width(), picture_.height()}};
    LabelPlacer places(page, style_.em);
    for (const PlacedRecord& placed : scene_.placed) {
        const bool has_arrow = looksAside(scene_.records[placed.record], placed.pose);
        places.addMark(style_.view * placed.pose.position.onFloor(),
                       has_arrow ? headingOf(placed.pose) : std::nullopt);
    }
    TextStyle style{0.85 * style_.em, true, Align::Center, {}, kWhite.faded(0.85)};
    for (const PlacedRecord& placed : scene_.placed) {
        const Record& record = scene_.records[placed.record];
        const std::string& id = scene_.ids[placed.record];
        style.color = isPerson(record)      ? kPerson
                      : movesItself(record) ? kRobot
                                            : mixed(kSensor, kInk, 0.5);
        const Point2 page_place = style_.view * placed.pose.position.onFloor();
        if (const auto middle = places.placeLabel(page_place, placed.pose.heading,
                                                  textWidth(id, style), style.size, false))
            drawMarkLabel(picture_, page_place, *middle, id, style);
    }
}

}  // namespace ispace
