// SPDX-License-Identifier: GPL-3.0-or-later
// Draws sensors on a map: each with its view, mark and id; and signs of unseen spots. More than
// kCrowd sensors have smaller marks, and beams are thinned until their ends are apart.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/message.h"
#include "raster/contour.h"
#include "report/map/map_parts.h"

namespace ispace {

namespace {

constexpr std::size_t kCrowd = 40;  // number of sensors above which marks and labels are smaller
/// True for receivers, which cover floor only as one set.
bool countsInSet(const SensorView& view) { return view.isPartial(); }

constexpr std::size_t kManySensors = 2 * kSeriesColors;  // above it, lines are finer

std::vector<Polygon> contoursOf(const MapPicture& map, const CoveredSet& set) {
    if (set.region) return drawable(map, *set.region);
    return drawable(map, contours(map.coverage.target.grid, set.cells));
}

void drawContours(Picture& picture, const MapPicture& map, const std::vector<Polygon>& curves,
                  const Stroke& line) {
    constexpr std::size_t kMaxBands = 12;  // soft rims of more views would hide floor
    const bool plain = map.other == nullptr && map.options.color != MapColor::Sensor;
    if (plain && map.coverage.sets.size() <= kMaxBands) {
        const Box2& limits = map.limits();
        const double rim = std::min(
            0.9 * map.em, 0.04 * map.view.scale * std::min(limits.width(), limits.depth()));
        picture.pushClip(std::span(curves));
        picture.area(curves, {Stroke{line.color.faded(0.16), rim}});
        picture.pop();
    }
    // A pale rim separates the line from stripes.
    if (map.other == nullptr && map.options.color == MapColor::Sensor)
        picture.area(curves, {Stroke{palette::kWhite.faded(0.7), line.width + map.em / 9}});
    picture.area(curves, {line});
}

/// Returns the beams on the plan, from above: each to its return, or to the maximum range. If the
/// ends of neighbours would lie too near each other, skips every second one, or three of four, ...
std::vector<Segment2> beamsOf(const MapPicture& map, const SensorView& view) {
    const Laser& laser = map.scene.sensors[view.index].as<Laser>();
    const double least_gap = std::max(2.0, map.em / 6) / map.view.scale;
    const Point3 origin = view.pose.position;
    std::vector<Segment2> beams;
    for (std::size_t k = 0; k < view.beams.size(); ++k) {
        const double range = std::min<double>(view.beams[k], view.max_range);
        const Vec3 way = range * view.pose.beam(laser.bearing(static_cast<int>(k)));
        const double gap = length(Vec2{way.x, way.y}) * std::abs(laser.step.radians());
        std::size_t stride = 1;
        while (static_cast<double>(stride) * gap < least_gap && stride < view.beams.size())
            stride *= 2;
        if (k % stride != 0) continue;
        const Segment2 beam{origin.onFloor(), (origin + way).onFloor()};
        if (const auto part = clipped(beam, map.limits())) beams.push_back(*part);
    }
    return beams;
}

/// A sweep is excluded: the beams of its many scans would hide the floor.
bool showsBeams(const MapPicture& map, const SensorView& view) {
    return map.options.fans == FanStyle::Beams && !view.beams.empty() &&
           map.scene.sensors[view.index].as<Laser>().sweep == SweepAxis::None;
}

void drawBeams(Picture& picture, const MapPicture& map, std::size_t sensor) {
    Stroke line = sensorStroke(map, sensor);
    line.dashes.clear();
    line.width = map.em / 24;
    line.color = line.color.faded(0.6);
    picture.lines(beamsOf(map, map.coverage.sensors[sensor]), {line});
}

Point2 pageOf(const MapPicture& map, const SensorView& sensor) {
    return map.view * sensor.pose.position.onFloor();
}

/// Points by cells as wide as the distance at which they are near.
class PointsNear {
  public:
    explicit PointsNear(double reach) : reach_(reach) {}

    /// Returns whether a point added before is nearer than the reach.
    bool addAndFind(Point2 p) {
        const std::pair cell{std::floor(p.x / reach_), std::floor(p.y / reach_)};
        bool is_near = false;
        for (const double right : {-1, 0, 1})
            for (const double up : {-1, 0, 1}) {
                const auto found = cells_.find({cell.first + right, cell.second + up});
                if (found == cells_.end()) continue;
                is_near = is_near || std::any_of(found->second.begin(), found->second.end(),
                                                 [&](Point2 q) { return distance(p, q) < reach_; });
            }
        // Of points at one point the first is enough.
        std::vector<Point2>& points = cells_[cell];
        if (std::find(points.begin(), points.end(), p) == points.end()) points.push_back(p);
        return is_near;
    }

  private:
    double reach_;
    std::map<std::pair<double, double>, std::vector<Point2>> cells_;
};

/// Draws the marks of sensors on the plan; `hollow`: of the layout that this one is compared with.
void drawSensors(Picture& picture, const MapPicture& map, const Box2& frame, bool hollow,
                 LabelPlacer& places) {
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    const double radius = map.em * (sensors.size() > kCrowd ? 0.24
                                    : sensors.size() > 14   ? 0.3
                                                            : 0.36);
    PointsNear marks(0.4 * radius);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const Point2 page = pageOf(map, sensors[i]);
        const bool on_top = marks.addAndFind(page);
        if (!frame.contains({page, page})) continue;
        SensorMark mark = markOf(map, i);
        mark.hollow = hollow;
        if (hollow) mark.color = palette::kOtherSensor;
        picture.pushGroup(hollow ? "" : sensors[i].id,
                          sensors[i].id + ": " + std::string(sensors[i].kind->keyword));
        // A mark on top of another one is smaller, so that both are visible.
        drawSensorMark(picture, page, mark, on_top ? 0.5 * radius : radius);
        picture.pop();
        places.addMark(page, mark.heading);
    }
}

/// Adds the walls, which labels should not cover.
void addWallLines(const MapPicture& map, LabelPlacer& places) {
    const Slice slice = map.scene.environment.slice(map.coverage.target.height);
    const auto add = [&](const Segment2& line) {
        places.addLine({map.view * line.a, map.view * line.b});
    };
    for (const Segment2& line : slice.sheets) add(line);
    for (std::size_t i = 0; i < slice.solids.size(); ++i)
        if (isWall(map.scene.environment.elements()[slice.solid_owners[i]]))
            forEachEdge(slice.solids[i], add);
}

void drawIds(Picture& picture, const MapPicture& map, const Box2& frame, LabelPlacer& places) {
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    const bool crowd = sensors.size() > kCrowd;
    const double size = crowd ? std::max(10.0, 0.7 * map.em) : map.em;
    const TextStyle style{size, true, Align::Center, palette::kInk, palette::kWhite.faded(0.85)};
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const Point2 page = pageOf(map, sensors[i]);
        if (!frame.contains({page, page})) continue;
        const std::string id = fitText(sensors[i].id, 10 * size, style);
        const Angle heading = markOf(map, i).heading.value_or(Angle());
        if (const auto middle = places.placeLabel(page, heading, textWidth(id, style), size, crowd))
            drawMarkLabel(picture, page, *middle, id, style);
    }
}

/// Returns the boxes of this size that lie in a corner of an outline, those at the corners of its
/// bounds first, and one about the mean of its corners.
std::vector<Box2> labelBoxes(const Polygon& outline, double inset, Vec2 size) {
    const Box2 all = bounds(outline);
    std::vector<Point2> corners = {
        {all.low.x, all.high.y}, all.low, all.high, {all.high.x, all.low.y}};
    corners.insert(corners.end(), outline.begin(), outline.end());
    std::vector<Box2> boxes;
    const auto add = [&](const Box2& box) {
        bool is_crossed = false;
        forEachEdge(outline,
                    [&](const Segment2& edge) { is_crossed = is_crossed || crosses(edge, box); });
        if (!is_crossed && locate(outline, box.center()) == Side::Inside) boxes.push_back(box);
    };
    for (const Point2 corner : corners)
        for (const double right : {1.0, -1.0})
            for (const double down : {-1.0, 1.0}) {
                const Point2 near{corner.x + right * inset, corner.y + down * inset};
                Box2 box;
                box.add(near);
                box.add({near.x + right * size.x, near.y + down * size.y});
                add(box);
            }
    Vec2 sum{};
    for (const Point2 corner : outline) sum = sum + (corner - Point2{});
    const Point2 mean = Point2{} + (1.0 / static_cast<double>(outline.size())) * sum;
    add({mean - 0.5 * size, mean + 0.5 * size});
    return boxes;
}

/// Writes names of zones in their first free corner; the legend lists names without one.
void drawZoneNames(Picture& picture, const MapPicture& map, LabelPlacer& places) {
    const double size = std::max(10.0, 0.85 * map.em), inset = 0.4 * map.em;
    const TextStyle style{size, false, Align::Left, palette::kZone, palette::kWhite.faded(0.8)};
    for (const Element& element : map.scene.environment.elements()) {
        if (element.record.keyword() != "zone") continue;
        Polygon outline = zoneOutline(element.record);
        for (Point2& p : outline) p = map.view * p;
        const double room = bounds(outline).width() - 2 * inset;
        const std::string name = fitText(element.id, room, style);
        const double width = textWidth(name, style);
        if (width > room || (room < 5 * size && name != printable(element.id))) continue;
        for (const Box2& box : labelBoxes(outline, inset, {width, size})) {
            if (!places.take(box)) continue;
            picture.text({box.low.x, box.low.y + 0.86 * size}, name, style);
            break;
        }
    }
}

}  // namespace

std::size_t setOf(const Coverage& coverage, std::size_t sensor) {
    if (!countsInSet(coverage.sensors[sensor])) return sensor;
    const auto first = std::find_if(coverage.sensors.begin(), coverage.sensors.end(), countsInSet);
    return static_cast<std::size_t>(first - coverage.sensors.begin());
}

Color sensorColor(const MapPicture& map, std::size_t sensor) {
    return map.other != nullptr ? palette::kInk : setColor(map, setOf(map.coverage, sensor));
}

Stroke sensorStroke(const MapPicture& map, std::size_t sensor) {
    const double em = map.em;
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    const bool many = map.coverage.sets.size() > kManySensors;
    if (map.other != nullptr) return {palette::kInk.faded(many ? 0.3 : 0.55), em / 16};
    const Color color = sensorColor(map, sensor);
    Stroke stroke{color.faded(0.95), em / 9};
    if (many) stroke = {color.faded(sensors.size() > 3 * kManySensors ? 0.4 : 0.6), em / 18};
    const std::size_t set = setOf(map.coverage, sensor);
    std::size_t dashes = set / kSeriesColors % 2;
    if (map.options.color == MapColor::Sensor) dashes = set % 4;
    if (dashes == 1) stroke.dashes = {em / 2, em / 4};
    if (dashes == 2) stroke.dashes = {em / 6, em / 4};
    if (dashes == 3) stroke.dashes = {0.8 * em, em / 4, em / 6, em / 4};
    return stroke;
}

void drawViews(Picture& picture, const MapPicture& map) {
    const std::vector<SensorView>& sensors = map.coverage.sensors;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const SensorView& view = sensors[i];
        const Stroke line = sensorStroke(map, i);
        const bool has_beams = !countsInSet(view) && showsBeams(map, view);
        const FittedCurves outline = has_beams ? FittedCurves{} : fittedContours(map, view);
        picture.pushGroup("", "field of view of " + view.id + toleranceText(outline));
        if (countsInSet(view)) {
            const Color faint = line.color.faded(0.5 * line.color.alpha);
            picture.area(outline.curves, {Stroke{faint, map.em / 24}});
        } else if (has_beams) {
            drawBeams(picture, map, i);
        } else {
            drawContours(picture, map, outline.curves, line);
        }
        picture.pop();
    }
    if (!sensors.empty() && countsInSet(sensors.back()))
        drawContours(picture, map, contoursOf(map, map.coverage.sets.back()),
                     sensorStroke(map, sensors.size() - 1));
}

void drawRegions(Picture& picture, const MapPicture& map) {
    for (std::size_t i = 0; i < map.coverage.sensors.size(); ++i) {
        const SensorView& view = map.coverage.sensors[i];
        const FittedCurves outline = fittedContours(map, view);
        picture.pushGroup("view-" + view.id,
                          "field of view of " + view.id + toleranceText(outline));
        picture.area(outline.curves, {sensorStroke(map, i)});
        picture.pop();
    }
}

SensorMark markOf(const MapPicture& map, std::size_t sensor) {
    const SensorView& view = map.coverage.sensors[sensor];
    return {view.kind->sign, headingOf(view.pose), sensorColor(map, sensor)};
}

void drawSpotSign(Picture& picture, Point2 page, const std::string& number, double em) {
    picture.circle(page, kSpotRadius * em, {palette::kWhite});
    picture.circle(page, kSpotRadius * em, {Stroke{palette::kInk, em / 12}});
    const TextStyle style{std::max(10.0, 0.85 * em), true, Align::Center, palette::kInk, {}};
    picture.text({page.x, page.y + 0.36 * style.size}, number, style);
}

std::size_t markedSpots(const MapPicture& map) {
    constexpr double kMinShare = 0.0025;  // of the room's area
    const CoverageReport& report = map.coverage.report;
    const std::size_t most = std::min<std::size_t>(map.terse ? 3 : 5, report.unseen.size());
    std::size_t count = 0;
    while (count < most && report.unseen[count].area >= kMinShare * report.indoor_area) ++count;
    return count;
}

void drawMarks(Picture& picture, const MapPicture& map, const Box2& frame,
               const std::string& suffix) {
    LabelPlacer places(frame, map.em);
    if (map.coverage.sensors.size() <= kCrowd) addWallLines(map, places);
    picture.pushLayer("sensors" + suffix);
    if (map.other != nullptr) {
        const MapPicture other{map.scene, *map.other, map.options, nullptr, map.em, map.view};
        drawSensors(picture, other, frame, true, places);
    }
    drawSensors(picture, map, frame, false, places);
    picture.pop();
    picture.pushLayer("unseen spots" + suffix);
    for (std::size_t i = 0; i < markedSpots(map); ++i) {
        const Point2 page = map.view * map.coverage.report.unseen[i].place;
        drawSpotSign(picture, places.placeSign(page, kSpotRadius * map.em), std::to_string(i + 1),
                     map.em);
    }
    picture.pop();
    picture.pushLayer("labels" + suffix);
    drawIds(picture, map, frame, places);
    drawZoneNames(picture, map, places);
    picture.pop();
}

namespace {

/// Number of distinct colours of positions: each draws its dots in one path.
constexpr int kLevels = 32;

/// Minimum radius of a dot with tick and rim (page units); on smaller ones they are invisible.
constexpr double kMinTicked = 2;

/// Returns the radius of a dot on the page: dots of a lattice over the plan do not touch.
double dotRadius(const MapPicture& map, std::size_t places) {
    const Box2& limits = map.limits();
    const double area = map.view.scale * map.view.scale * limits.width() * limits.depth();
    const double spacing = std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, places)));
    const double ticked = 0.24 * spacing;  // leaves room for the tick
    return ticked > kMinTicked ? std::min(ticked, 0.26 * map.em)
                               : std::clamp(0.38 * spacing, 0.6, kMinTicked);
}

/// Dots and ticks of one colour.
struct Dots {
    std::vector<Segment2> dots, ticks;
};

}  // namespace

std::vector<TriedPlace> placesTried(const std::vector<TriedPose>& trace) {
    std::vector<TriedPlace> places;
    std::map<std::pair<double, double>, std::size_t> at;
    for (const TriedPose& tried : trace) {
        const Point2 place = tried.pose.position.onFloor();
        const auto [entry, is_new] = at.try_emplace({place.x, place.y}, places.size());
        if (is_new) places.push_back({place, tried.value, headingOf(tried.pose), false});
        TriedPlace& own = places[entry->second];
        own.is_chosen = own.is_chosen || tried.is_chosen;
        if (tried.value > own.value) {
            own.value = tried.value;
            own.heading = headingOf(tried.pose);
        }
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const TriedPlace& a, const TriedPlace& b) { return a.value < b.value; });
    return places;
}

Color triedColor(double share) {
    constexpr std::array<std::uint32_t, 5> kStops = {0xF2CF4E, 0xF2A83A, 0xE26D14, 0xA83A05,
                                                     0x4A1600};
    return rampColor(kStops, share);
}

void drawChosenRing(Picture& picture, Point2 page, double radius, double em) {
    picture.circle(page, radius, {Stroke{palette::kWhite, em / 4}});
    picture.circle(page, radius, {Stroke{palette::kInk, em / 9}});
}

void drawTrace(Picture& picture, const MapPicture& map, const Box2& frame) {
    const std::vector<TriedPlace> places = placesTried(map.options.trace);
    if (places.empty()) return;
    const double radius = dotRadius(map, places.size());
    const double least = places.front().value, span = places.back().value - least;
    std::array<Dots, kLevels> levels;
    std::vector<Point2> chosen;
    for (const TriedPlace& tried : places) {
        const Point2 page = map.view * tried.place;
        if (!frame.contains(page)) continue;
        const double share = span > 0 ? (tried.value - least) / span : 1;
        Dots& own = levels[static_cast<std::size_t>(std::lround(share * (kLevels - 1)))];
        own.dots.push_back({page, page});  // a line of length 0 has round ends
        if (tried.heading) {
            const Vec2 way = 2.2 * radius * unitVector(*tried.heading);
            own.ticks.push_back({page, {page.x + way.x, page.y - way.y}});
        }
        if (tried.is_chosen) chosen.push_back(page);
    }
    for (int i = 0; i < kLevels; ++i) {
        const Dots& own = levels[static_cast<std::size_t>(i)];
        const Color color = triedColor(i / (kLevels - 1.0));
        if (radius > kMinTicked) {
            // Pale rims separate dots from dark floor; the palest dot is darker than any pale
            // floor.
            const double rim = std::min(0.25 * radius, map.em / 16);
            picture.lines(own.dots, {Stroke{palette::kWhite, 2 * (radius + rim)}});
            picture.lines(own.ticks, {Stroke{palette::kWhite, 0.55 * radius + 2 * rim}});
            picture.lines(own.ticks, {Stroke{color, 0.55 * radius}});
        }
        picture.lines(own.dots, {Stroke{color, 2 * radius}});
    }
    for (const Point2 page : chosen) drawChosenRing(picture, page, 0.68 * map.em, map.em);
}

}  // namespace ispace
