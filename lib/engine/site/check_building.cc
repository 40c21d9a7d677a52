// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of what joins the storeys of a building.
//
// A way off a flight is eight steps of 40 cm around its end, without those that lead back into the
// flight, of which one must lead over free floor without crossing a wall. Storeys that overlap in
// height are compared pair by pair, up to a million corners: then the check says that it stopped.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "base/budget.h"
#include "env/environment.h"
#include "env/level.h"
#include "env/walls.h"
#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "site/site_scene.h"

namespace ispace {

namespace {

/// A person steps this far off the last step, metres.
constexpr double kLanding = 0.4;
/// Walls nearer than this are those that the stairs stand at, metres.
constexpr double kTouches = 0.02;
/// The landing of a lift lies this far from its cabin, beyond the wall of its shaft, metres.
constexpr std::array kBeforeDoor = {0.4, 0.8};
/// Storeys may overlap by this, metres and square metres.
constexpr double kHeightTolerance = 1e-3, kAreaTolerance = 0.01;
/// Corners of outlines that are compared, of all pairs of storeys: less than a second.
constexpr std::uint64_t kMaxCompared = 1'000'000;

/// True if a person can step from `from` to `to`: free floor, and no wall between.
bool isWay(const Environment& room, Point2 from, Point2 to) {
    const auto level = room.level(kScanHeight);
    if (!level->isFree(to)) return false;
    const Vec2 way = to - from;
    const Segment2 step{from + kTouches / length(way) * way, to};
    bool is_free = true;
    level->slice().forEachLine([&](const Segment2& line) {
        if (intersects(step, line)) is_free = false;
    });
    return is_free;
}

/// Direction of an angle in the building.
Vec2 along(Angle heading) { return Pose2{{}, heading} * Vec2{1, 0}; }

}  // namespace

bool hasPathOn(const SiteScene& building, std::size_t storey, Point2 end,
               std::optional<Vec2> back) {
    constexpr int kDirections = 8;
    constexpr double kAhead = 0.3;  // cosine
    const Storey& own = building.document.storeys[storey];
    const Environment& room = building.scenes[storey]->environment;
    for (int k = 0; k < kDirections; ++k) {
        const Vec2 way = along(Angle::degrees(360.0 * k / kDirections));
        if (back && dot(way, *back) > kAhead) continue;
        if (isWay(room, inStorey(own, end), inStorey(own, end + kLanding * way))) return true;
    }
    return false;
}

namespace {

class BuildingCheck {
  public:
    explicit BuildingCheck(const SiteScene& building) : building_(building) {}

    std::vector<Diagnostic> run() {
        for (const StoreyPassage& passage : building_.document.passages) {
            if (passage.record.keyword() == "stairs")
                checkStairs(passage);
            else if (passage.record.keyword() == "lift")
                checkLift(passage);
            else
                checkShaft(passage);
        }
        checkHeights();
        return std::move(found_);
    }

  private:
    [[nodiscard]] const Storey& storey(std::size_t i) const {
        return building_.document.storeys[i];
    }
    [[nodiscard]] const Environment& room(std::size_t i) const {
        return building_.scenes[i]->environment;
    }

    void report(const StoreyPassage& passage, const char* key, const std::string& message) {
        Diagnostic finding = passage.record.finding(
            key, passage.record.keyword() + ' ' + passage.id + ' ' + message);
        finding.severity = Severity::Warning;
        found_.push_back(std::move(finding));
    }

    /// Returns where in a storey a point of the building lies, for messages.
    [[nodiscard]] std::string placeIn(std::size_t i, Point2 p) const {
        return storey(i).id + " at " + placeText(p);
    }

    /// Reports an end of a flight without a way on. \param back direction of the flight from there;
    /// empty: unknown
    void checkEnd(const StoreyPassage& passage, const char* key, const std::string& verb,
                  std::size_t i, Point2 end, std::optional<Vec2> back) {
        if (hasPathOn(building_, i, end, back)) return;
        const Point2 from = inStorey(storey(i), end);
        const bool is_out = room(i).indoor().locate(from) == Side::Outside;
        report(passage, key,
               verb + (is_out ? " outside of the rooms of " : " in a wall or object of ") +
                   placeIn(i, end));
    }

    void checkStairs(const StoreyPassage& passage) {
        const Record& record = passage.record;
        const Point2 foot = pointOf(record.tuple("at"));
        const Vec2 up = along(record.angle("heading"));
        const double run = record.tuple("size")[1];
        const bool is_straight = !record.has("top");
        const Point2 top = is_straight ? foot + run * up : pointOf(record.tuple("top"));
        for (std::size_t k = 0; k + 1 < passage.storeys.size(); ++k) {
            const std::size_t below = passage.storeys[k], above = passage.storeys[k + 1];
            if (!(storey(below).floor < storey(above).floor))
                report(
                    passage, "storeys",
                    "joins " + storey(below).id + " and " + storey(above).id + ", which are level");
            checkEnd(passage, "at", "begins", below, foot, up);
            checkEnd(passage, is_straight ? "at" : "top", "ends", above, top,
                     is_straight ? std::optional(-1 * up) : std::nullopt);
        }
    }

    void checkLift(const StoreyPassage& passage) {
        const Record& record = passage.record;
        const Tuple& size = record.tuple("size");
        if (!record.has("door"))
            report(passage, "id", "has no door: give its width, such as door=0.9");
        else if (record.number("door") > size[0])
            report(passage, "door", "has a door that is wider than its cabin");
        const Vec2 out = along(record.angle("heading"));
        const Point2 door = pointOf(record.tuple("at")) + size[1] / 2 * out;
        for (const std::size_t i : passage.storeys) {
            const auto level = room(i).level(kScanHeight);
            const bool opens = std::any_of(kBeforeDoor.begin(), kBeforeDoor.end(), [&](double way) {
                return level->isFree(inStorey(storey(i), door + way * out));
            });
            if (opens) continue;
            const Point2 before = door + kBeforeDoor.front() * out;
            const bool is_out =
                room(i).indoor().locate(inStorey(storey(i), before)) == Side::Outside;
            report(passage, "at",
                   (is_out ? "opens outside of the rooms of " : "opens into a wall or object of ") +
                       placeIn(i, before));
        }
    }

    void checkShaft(const StoreyPassage& passage) {
        Polygon outline;
        for (const Tuple& corner : passage.record.list("path")) outline.push_back(pointOf(corner));
        if (outline.size() < 3)
            report(passage, "path", "has less than three corners");
        else if (const auto crossing = selfCrossing(outline))
            report(passage, "path", "crosses itself near " + placeText(*crossing));
        else
            for (const std::size_t i : passage.storeys)
                if (!meetsRooms(i, outline))
                    report(passage, "path", "lies outside of the rooms of " + storey(i).id);
    }

    /// True if an outline in the building has area in common with the rooms of a storey.
    [[nodiscard]] bool meetsRooms(std::size_t i, Polygon outline) const {
        for (Point2& p : outline) p = inStorey(storey(i), p);
        const Regions& rooms = room(i).indoor();
        double left = 0;
        for (const Region& part : difference(rooms, {&outline, 1})) left += part.area();
        return rooms.area() - left > 1e-6 * std::fabs(signedArea(outline));
    }

    /// Outlines of the rooms of a storey, in the building.
    struct Floor {
        std::vector<Polygon> outlines;
        Box2 box;
        std::size_t corners = 0;
    };

    [[nodiscard]] Floor floorOf(std::size_t i) const {
        Floor floor;
        for (const Region& part : room(i).indoor().parts) {
            Polygon outline = part.outline;
            for (Point2& p : outline) floor.box.add(p = storey(i).building_from_storey * p);
            floor.corners += outline.size();
            floor.outlines.push_back(std::move(outline));
        }
        return floor;
    }

    /// True if the storeys lie above each other, at least in part.
    [[nodiscard]] static bool shareArea(const Floor& a, const Floor& b) {
        for (const Polygon& outline : a.outlines) {
            const Region whole{outline, {}};
            double left = 0;
            for (const Region& part : difference(whole, b.outlines)) left += part.area();
            if (whole.area() - left > kAreaTolerance) return true;
        }
        return false;
    }

    /// Reports the lowest storey that each one reaches into.
    void checkHeights() {
        std::vector<Floor> floors;
        for (std::size_t i = 0; i < building_.scenes.size(); ++i) floors.push_back(floorOf(i));
        Budget work(0, {kMaxCompared});
        for (std::size_t a = 0; a < floors.size(); ++a) {
            const double top = storey(a).floor + building_.height(a);
            for (std::size_t b = a + 1; b < floors.size(); ++b) {
                if (top <= storey(b).floor + kHeightTolerance) break;  // lowest first
                if (!floors[a].box.meets(floors[b].box)) continue;
                if (!work.take(floors[a].corners + floors[b].corners))
                    return reportHeight(a, "too many storeys reach into others to compare all");
                if (!shareArea(floors[a], floors[b])) continue;
                reportHeight(a, "storeys " + storey(a).id + " and " + storey(b).id +
                                    " overlap: " + storey(a).id + " reaches up to " +
                                    lengthText(top) + " m, and " + storey(b).id + " begins at " +
                                    lengthText(storey(b).floor) + " m");
                break;
            }
        }
    }

    void reportHeight(std::size_t i, const std::string& message) {
        Diagnostic finding = storey(i).record.finding(storey(i).height ? "height" : "id", message);
        finding.severity = Severity::Warning;
        found_.push_back(std::move(finding));
    }

    const SiteScene& building_;
    std::vector<Diagnostic> found_;
};

}  // namespace

std::vector<Diagnostic> checkBuilding(const SiteScene& building) {
    return BuildingCheck(building).run();
}

}  // namespace ispace
