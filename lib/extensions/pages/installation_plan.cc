// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the dimensioned plan of the installer's sheet.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/number.h"
#include "drawing/plan/plan.h"
#include "extensions/pages/installation.h"
#include "report/map/sensor_colors.h"

namespace ispace::pages {

namespace {

constexpr double kSheetEm = 2.9;  // text size of the plan, millimetres: above 8 points
constexpr std::size_t kManyMarks = 40;

/// Adds the walls of the plan, which labels should not cover.
void addWalls(const Scene& scene, const PageView& view, LabelPlacer& labels) {
    const Slice slice = scene.environment.slice(kScanHeight);
    const auto add = [&](const Segment2& line) { labels.addLine({view * line.a, view * line.b}); };
    for (const Segment2& line : slice.sheets) add(line);
    for (std::size_t i = 0; i < slice.solids.size(); ++i)
        if (isWall(scene.environment.elements()[slice.solid_owners[i]]))
            forEachEdge(slice.solids[i], add);
}

/// Draws a box with the id of a panel of cables.
void drawPanel(Picture& picture, const PageView& view, const Element& element,
               LabelPlacer& labels) {
    const Tuple& place = element.record.tuple("at");
    const Point2 at = view * Point2{place[0], place[1]};
    const double half = 0.4 * kSheetEm;
    picture.area(Polygon{{at.x - half, at.y - half},
                         {at.x + half, at.y - half},
                         {at.x + half, at.y + half},
                         {at.x - half, at.y + half}},
                 {palette::kWhite, Stroke{palette::kInk, 0.3}});
    picture.line({at.x - half, at.y + half}, {at.x + half, at.y - half}, {palette::kInk, 0.3});
    labels.addMark(at, std::nullopt);
    const TextStyle style{kSheetEm, false, Align::Center, palette::kInk,
                          palette::kWhite.faded(0.85)};
    if (const auto middle =
            labels.placeLabel(at, Angle(), textWidth(element.id, style), style.size, false))
        drawMarkLabel(picture, at, *middle, element.id, style);
}

/// Lines that the mark of a sensor would hide are not drawn, millimetres.
constexpr double kMinLine = 1.2;

/// Returns the offset of dimension lines from a sensor at a wall, on the page: into the room, so
/// that they do not lie on the wall.
Vec2 offWall(const Installation& one, const Pose3& pose, const PageView& view) {
    constexpr double kOff = 2;  // millimetres
    const Point2 at = view * pose.position.onFloor();
    for (const WallDistance& wall : one.walls) {
        const Point2 foot = view * wall.foot;
        if (wall.end || distance(at, foot) > kMinLine) continue;
        const Vec2 face = view * wall.face.b - view * wall.face.a;
        const Vec2 normal = (1 / length(face)) * perpendicular(face);
        const Vec3 axis = Frame3(pose).forward;
        const Vec2 inwards = wall.isOnWall() ? Vec2{axis.x, -axis.y} : at - foot;
        return (dot(normal, inwards) < 0 ? -kOff : kOff) * normal;
    }
    return {};
}

/// A line of the plan with the distance that it shows, on the page.
struct Dimension {
    Segment2 line;
    std::string text;

    [[nodiscard]] Vec2 along() const { return (1 / distance(line.a, line.b)) * (line.b - line.a); }
};

/// Draws a line with ticks at its ends.
void drawDimensionLine(Picture& picture, const Dimension& one) {
    const Stroke pen{palette::kInk, 0.18};
    const Vec2 tick = 0.5 * (one.along() + perpendicular(one.along()));
    for (const Point2 end : {one.line.a, one.line.b}) picture.line(end - tick, end + tick, pen);
    picture.line(one.line.a, one.line.b, pen);
}

/// Writes the distance beside or in its line where that hides no mark, no other text and, as far as
/// there is space, no other line.
void drawDimensionText(Picture& picture, const Dimension& one, LabelPlacer& labels) {
    const TextStyle style{kSheetEm, false, Align::Center, palette::kInk,
                          palette::kWhite.faded(0.85)};
    const Vec2 along = one.along(), across = perpendicular(along);
    const double way = distance(one.line.a, one.line.b);
    const double wide = textWidth(one.text, style) / 2, high = style.size / 2;
    // In the line if it is long enough, with a gap; else beside it.
    const double gap = std::min(std::abs(along.x) > 0 ? wide / std::abs(along.x) : way,
                                std::abs(along.y) > 0 ? high / std::abs(along.y) : way);
    const double aside = wide * std::abs(across.x) + high * std::abs(across.y) + 0.3;
    for (const bool over_lines : {false, true})
        for (const double off : {0.0, aside, -aside, 2 * aside, -2 * aside}) {
            if (off == 0 && way < 2.6 * gap) continue;
            for (const double share : {0.5, 0.35, 0.65, 0.2, 0.8}) {
                const Point2 middle = one.line.a + share * way * along + off * across;
                const Box2 box = Box2{middle, middle}.expanded(wide, high);
                if (!labels.take(box, over_lines, one.line)) continue;
                picture.text({middle.x, middle.y + 0.36 * style.size}, one.text, style);
                return;
            }
        }
}

/// Draws the lines of all distances, then their texts.
void drawDimensions(Picture& picture, const Scene& scene,
                    const std::vector<Installation>& installations, const PageView& view,
                    LabelPlacer& labels) {
    std::vector<Dimension> dimensions;
    for (const Installation& one : installations) {
        const Point2 at = view * scene.sensors[one.sensor].pose.position.onFloor();
        const Vec2 aside = offWall(one, scene.sensors[one.sensor].pose, view);
        for (const WallDistance& wall : one.walls) {
            const Point2 from = wall.end ? view * (wall.foot - wall.distance * wall.along()) : at;
            const Point2 foot = view * wall.foot;
            if (distance(from, foot) > kMinLine)
                dimensions.push_back({{from + aside, foot + aside}, formatFixed(wall.distance, 2)});
        }
    }
    for (const Dimension& one : dimensions) {
        drawDimensionLine(picture, one);
        labels.addLine(one.line);
    }
    for (const Dimension& one : dimensions) drawDimensionText(picture, one, labels);
}

}  // namespace

PageFigure installationPlan(const Scene& scene, const Coverage& coverage,
                            const std::vector<Installation>& installations) {
    constexpr double kWide = 176, kHigh = 225, kRim = 4, kBelow = 8;
    const Box2 box = planBox(scene);
    const double denominator =
        usualScale(1000 * std::max(box.width() / (kWide - 2 * kRim),
                                   box.depth() / (kHigh - 2 * kRim - kBelow)));
    const double scale = 1000 / denominator;
    Picture picture(kWide, std::ceil(scale * box.depth() + 2 * kRim + kBelow),
                    PageUnit::Millimetre);
    picture.describe("dimensioned plan", "");
    const PageView view{scale, {box.low.x, box.high.y}, {(kWide - scale * box.width()) / 2, kRim}};
    PlanDrawing plan(picture, scene, {view, kSheetEm, box, kScanHeight, true});
    plan.drawFloor();
    plan.drawThings();
    plan.drawWalls();
    plan.drawOpenings();
    plan.drawZones();
    std::map<std::size_t, Color> colors;  // by index in Scene::sensors
    const std::vector<Color> by_view = sensorColors(coverage);
    for (std::size_t i = 0; i < by_view.size(); ++i)
        colors.emplace(coverage.sensors[i].index, by_view[i]);
    LabelPlacer labels({{1, 1}, {kWide - 1, picture.height() - kBelow}}, kSheetEm);
    const bool is_crowd = installations.size() > kManyMarks;
    if (!is_crowd) addWalls(scene, view, labels);
    for (const Installation& one : installations) {
        const Pose3& pose = scene.sensors[one.sensor].pose;
        labels.addMark(view * pose.position.onFloor(), headingOf(pose));
    }
    for (const Element& element : scene.environment.elements())
        if (element.record.keyword() == "panel") drawPanel(picture, view, element, labels);
    picture.pushLayer("distances");
    drawDimensions(picture, scene, installations, view, labels);
    picture.pop();
    picture.pushLayer("sensors");
    for (const Installation& one : installations) {
        const Sensor& sensor = scene.sensors[one.sensor];
        const Point2 at = view * sensor.pose.position.onFloor();
        const auto color = colors.find(one.sensor);
        drawSensorMark(picture, at,
                       {kindOf(sensor.model).sign, headingOf(sensor.pose),
                        color == colors.end() ? palette::kSensor : color->second},
                       0.36 * kSheetEm);
    }
    const TextStyle style{kSheetEm, true, Align::Center, palette::kInk,
                          palette::kWhite.faded(0.85)};
    for (const Installation& one : installations) {
        const Sensor& sensor = scene.sensors[one.sensor];
        const Point2 at = view * sensor.pose.position.onFloor();
        const std::string id = fitText(sensor.id, 12 * kSheetEm, style);
        if (const auto middle = labels.placeLabel(at, headingOf(sensor.pose).value_or(Angle()),
                                                  textWidth(id, style), kSheetEm, is_crowd))
            drawMarkLabel(picture, at, *middle, id, style);
    }
    picture.pop();
    drawScaleBar(picture, {kRim, picture.height() - 2}, 40, scale, kSheetEm,
                 "  ·  1:" + formatDouble(denominator));
    return {"Plan at 1:" + formatDouble(denominator) +
                " on A4; lines with ticks are the distances to walls, in metres.",
            std::move(picture)};
}

}  // namespace ispace::pages
