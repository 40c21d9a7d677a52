// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/site_sight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "record/text.h"
#include "scene/sensor/field_of_view.h"
#include "sense/detection.h"
#include "site/site_coverage.h"
#include "support/test_cast.h"
#include "trace/ray_world.h"

namespace ispace {
namespace site_sight_test {

using testing::castTo;

constexpr const char* kFence =
    "{fence: {id: f, path: [[0, 0], [8, 0], [8, 6], [0, 6]], closed: yes, height: 2.5}}";
constexpr const char* kShaft =
    "- shaft: {storeys: 'ground,upper', path: [[3, 2], [5, 2], [5, 4], [3, 4]]}\n";

SiteScene sceneOf(const std::string& text) {
    return makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
}

/// Returns a building whose floors are 3 m apart; records of the rooms, and passages.
SiteScene towerOf(const std::string& ground, const std::string& upper, const std::string& passages,
                  const std::string& height = "3", const std::string& frame = "") {
    const auto room = [](const std::string& more) {
        return "[" + std::string(kFence) + (more.empty() ? "" : ", " + more) + "]";
    };
    return sceneOf("- storey: {id: ground, height: " + height + ", records: " + room(ground) +
                   "}\n- storey: {id: upper, z: 3, height: 3" + frame +
                   ", records: " + room(upper) + "}\n" + passages);
}

/// Returns the area of the only view into a storey; 0 without one.
double areaSeen(const SiteScene& building, std::size_t storey, double plane = 0) {
    const auto views = viewsBetweenStoreys(Coupling(building), {.plane = plane});
    if (views[storey].empty()) return 0;
    EXPECT_EQ(views[storey].size(), 1U);
    return signedArea(views[storey].front().view->region);
}

const std::string kDown = "{camera: {id: c, at: [4, 3, 2], tilt: -90, fov: 120}}";
const std::string kUp = "{camera: {id: c, at: [4, 3, 1], tilt: 90, fov: 120}}";

TEST(BuildingSight, ShaftFramesTheFloorBelow) {
    // The eye is 2 m above a square of 2 m, and 5 m above the floor that it sees.
    EXPECT_NEAR(areaSeen(towerOf("", kDown, kShaft), 0), 25, 1e-4);
    EXPECT_EQ(areaSeen(towerOf("", kDown, kShaft), 1), 0);
    EXPECT_EQ(areaSeen(towerOf("", kDown, ""), 0), 0);
}

TEST(BuildingSight, OpeningsAreNoFloor) {
    // A shaft of 2 m x 2 m and a flight of 1 m x 4 m in a room of 8 m x 6 m.
    const std::string flight =
        "- stairs: {id: s, storeys: 'ground,upper', at: [7, 1], heading: 90, size: [1, 4]}\n";
    const SiteScene building = towerOf("", "{desk: {id: d, at: [1, 1]}}", kShaft + flight);
    const SiteCoverage coverage = measureSite(building, {});
    EXPECT_NEAR(coverage.storeys[0].report.indoor_area, 48, 1e-9);
    EXPECT_NEAR(coverage.storeys[1].report.indoor_area, 48 - 4 - 4, 1e-9);
    EXPECT_NEAR(coverage.indoor_area, 88, 1e-9);
    EXPECT_NE(coverage.floors[0], building.scenes[0]);
    EXPECT_EQ(coverage.storeys[1].report.digest, building.scenes[1]->digest());
    EXPECT_EQ(coverage.floors[1]->records, building.scenes[1]->records);
}

TEST(BuildingSight, AShaftMayTakeTheWholeFloor) {
    const std::string whole =
        "- shaft: {storeys: 'ground,upper', path: [[0, 0], [8, 0], [8, 6], [0, 6]]}\n";
    const std::string wider =
        "- shaft: {storeys: 'ground,upper', path: [[-1, -1], [9, -1], [9, 7], [-1, 7]]}\n";
    for (const std::string& shaft : {whole, wider}) {
        const SiteScene building = towerOf("", kDown, shaft);
        EXPECT_NEAR(measureSite(building, {}).storeys[1].report.indoor_area, 0, 1e-6);
        EXPECT_GT(areaSeen(building, 0), 40);
        EXPECT_TRUE(measureSite(building, {}).coverage.grid);
        const Coupling coupling(building);
        const RayWorld rays = RayWorld::ofEnvironment(*coupling.surroundings(1));
        Directions down;
        down.resize(1);
        down.set(0, {0, 0, -1});
        std::array<float, 1> range = {kNoReturn};
        rays.cast({4, 3, 2}, down, 20, range);
        EXPECT_NEAR(range[0], 5, 1e-5);
    }
}

TEST(BuildingSight, DepthOfTheFloorNarrowsTheOpening) {
    // The storey is 2.5 m high: the lower rim of the opening is 2.5 m below the eye.
    EXPECT_NEAR(areaSeen(towerOf("", kDown, kShaft, "2.5"), 0), 16, 1e-4);
}

TEST(BuildingSight, LooksUpAtPlanesAboveTheFloor) {
    EXPECT_NEAR(areaSeen(towerOf(kUp, "", kShaft), 1, 1), 9, 1e-4);
    EXPECT_EQ(areaSeen(towerOf(kUp, "", kShaft), 1, 0), 0);
}

TEST(BuildingSight, HoldsInTurnedStoreys) {
    // The room above is turned about the building's origin and moved back; its camera stands over
    // the same point: (4, 3) in the building is (1, 2) there.
    const std::string camera = "{camera: {id: c, at: [1, 2, 2], tilt: -90, fov: 120, heading: 0}}";
    const SiteScene building = towerOf("", camera, kShaft, "3", ", at: [6, 2], heading: 90");
    EXPECT_NEAR(areaSeen(building, 0), 25, 1e-4);
    const auto views = viewsBetweenStoreys(Coupling(building), {});
    const Point3 eye = views[0].front().view->sensor.pose.position;
    EXPECT_NEAR(eye.x, 4, 1e-9);
    EXPECT_NEAR(eye.y, 3, 1e-9);
    EXPECT_NEAR(eye.z, 5, 1e-9);
}

TEST(BuildingSight, CeilingsAreOpenAboveAShaft) {
    const auto building = [](const char* ceiling) {
        const std::string room = "{ispace: {size: [8, 6, 3], at: [4, 3], ceiling: ";
        return sceneOf("- storey: {id: ground, height: 3, records: [" + room + ceiling + "}}, " +
                       kUp + "]}\n- storey: {id: upper, z: 3, height: 3, records: [" + kFence +
                       "]}\n" + kShaft);
    };
    EXPECT_NEAR(areaSeen(building("no"), 1, 1), 9, 1e-4);
    EXPECT_NEAR(areaSeen(building("yes"), 1, 1), 9, 1e-4);
}

TEST(BuildingSight, StepsHideTheFloorBelowThem) {
    const std::string stairs =
        "- stairs: {storeys: 'ground,upper', at: [4, 2], heading: 90, size: [2, 2]}\n";
    // A line of sight leads k aside along the steps for each metre down; for k > -0.2 it meets them
    // (5 - z) = 3.5 / (1 + 1.5 k) below the eye, if it is less than a metre from their middle
    // there.
    const double hidden = 2 / 3.5 * ((0.5 + 0.75 * 0.25) - (-0.2 + 0.75 * 0.04));
    EXPECT_NEAR(areaSeen(towerOf("", kDown, stairs), 0), 25 * (1 - hidden), 1e-4);
    // From before the lowest step, sight goes over all of them.
    const std::string camera =
        "{camera: {id: c, at: [4, 0.5, 1], heading: 90, tilt: 50, fov: 100}}";
    const double over = areaSeen(towerOf(camera, "", stairs), 1, 1.5);
    EXPECT_GT(over, 0.5);
    EXPECT_NEAR(areaSeen(towerOf(camera, "", kShaft), 1, 1.5), over, 1e-6);
}

TEST(BuildingSight, LasersSeeTheirStoreyAlone) {
    const std::string laser = "{laser: {id: l, at: [4, 3, 2], tilt: -90}}";
    EXPECT_TRUE(viewsBetweenStoreys(Coupling(towerOf("", laser, kShaft)), {})[0].empty());
}

TEST(BuildingSight, ReportsNameTheStoreyOfTheSensor) {
    const SiteCoverage coverage = measureSite(towerOf("", kDown, kShaft), {});
    ASSERT_EQ(coverage.storeys[0].report.sensors.size(), 1U);
    EXPECT_EQ(coverage.storeys[0].report.sensors[0].id, "upper/c");
    EXPECT_EQ(coverage.storeys[1].report.sensors[0].id, "upper/c");
    EXPECT_EQ(coverage.sensors, (std::vector<std::size_t>{0, 1}));
    EXPECT_NEAR(coverage.storeys[0].report.coverage.exact.value(), 25.0 / 48, 1e-5);
    EXPECT_NEAR(coverage.storeys[0].report.coverage.grid.value(), 25.0 / 48, 0.01);
}

/// Rays in each room by itself agree: they leave one in the opening and go on in the other.
TEST(BuildingSight, AgreesWithRaysOfBothRooms) {
    const std::string things =
        "{desk: {at: [2.6, 3], size: [1.4, 0.7]}}, {pillar: {at: [5.6, 3.2], size: [0.4, 0.4], "
        "height: 2}}";
    const std::string above =
        "{cube: {at: [4.2, 2.3], size: [0.5, 0.3, 0.8]}}, "
        "{camera: {id: c, at: [3.2, 4.4, 1.7], heading: -70, tilt: -60, fov: 110}}";
    const SiteScene building = towerOf(things, above, kShaft);
    const auto views = viewsBetweenStoreys(Coupling(building), {.plane = 0.3});
    ASSERT_EQ(views[0].size(), 1U);
    const OutsideView& view = *views[0].front().view;
    const FieldOfView field = *fieldOfView(view.sensor);
    const Point3 eye = view.sensor.pose.position;
    const RayWorld below = RayWorld::ofEnvironment(building.scenes[0]->environment);
    const RayWorld over = RayWorld::ofEnvironment(building.scenes[1]->environment);
    const Grid grid = gridOf({0, 0}, 0.05, 160, 120);
    const CellSet cells = sensorViewOf(view, 0, grid, {{-99, -99}, {99, 99}}, {.plane = 0.3}).cells;
    std::size_t wrong = 0, seen_cells = 0;
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
        const Point2 p = grid.center(cell);
        const Point3 target{p.x, p.y, 0.3};
        const Vec3 way = target - eye;
        const Point3 cut = eye + (3 - eye.z) / way.z * way;
        const bool in_shaft = cut.x > 3 && cut.x < 5 && cut.y > 2 && cut.y < 4;
        bool is_seen = in_shaft && field.holds(target);
        if (is_seen) {
            std::array<std::uint8_t, 1> free{};
            const std::array<Point3, 1> end{Point3{cut.x, cut.y, 0}};
            over.query({eye.x, eye.y, eye.z - 3}, end, free);
            is_seen = free[0] != 0;
            const std::array<Point3, 1> last{target};
            below.query(cut, last, free);
            is_seen = is_seen && free[0] != 0;
        }
        seen_cells += is_seen ? 1 : 0;
        wrong += is_seen != cells.test(cell) ? 1 : 0;
    }
    EXPECT_GT(seen_cells, 1000U);
    EXPECT_LE(wrong, 4U);  // on the rim, where rays and areas round differently
}

/// Returns the share of a grid on the floor of a storey that rays of its only sensor, which looks
/// straight down, reach in the surroundings.
double coverageByRays(const SiteScene& building, std::size_t storey) {
    const RayWorld world = RayWorld::ofEnvironment(*Coupling(building).surroundings(storey));
    const Sensor& sensor = building.scenes[storey]->sensors.front();
    const Point3 eye = sensor.pose.position;
    std::vector<Point3> targets;
    std::size_t all = 0;
    for (double x = 0.025; x < 8; x += 0.05)
        for (double y = 0.025; y < 6; y += 0.05, ++all)
            if (fieldOfView(sensor)->holds({x, y, 0})) targets.push_back({x, y, 0});
    std::vector<std::uint8_t> seen(targets.size());
    world.query(eye, targets, seen);
    return static_cast<double>(std::count(seen.begin(), seen.end(), 1)) / static_cast<double>(all);
}

TEST(BuildingSight, RaysPassOpeningsInTheRoomWithItsSurroundings) {
    const SiteScene building = towerOf("{robot: {id: r, at: [4.6, 3]}}", "", kShaft);
    const Coupling coupling(building);
    const Environment upper = *coupling.surroundings(1, Coupling::Movers::OfNeighbours);
    EXPECT_NEAR(upper.indoor().area(), 48 - 4, 1e-6);
    EXPECT_NEAR(castTo(upper, {3.5, 3, 2}, {0, 0, -1}), 5, 1e-5);
    EXPECT_NEAR(castTo(upper, {2.5, 3, 2}, {0, 0, -1}), 2, 1e-5);
    EXPECT_LT(castTo(upper, {4.6, 3, 2}, {0, 0, -1}), 4.9);  // the robot below
    const Environment ground = *coupling.surroundings(0);
    EXPECT_NEAR(castTo(ground, {2.5, 3, 1}, {0, 0, 1}), 2, 1e-5);
    EXPECT_EQ(castTo(ground, {3.5, 3, 1}, {0, 0, 1}), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(castTo(ground, {3.5, 2.2, 1}, {0, 3.8, 4.3}), std::hypot(3.8, 4.3), 1e-4);
    const SiteScene apart = towerOf("", "", "");
    const Coupling closed(apart);
    EXPECT_TRUE(closed.isAlone(1)) << "under the roof";
    EXPECT_FALSE(closed.isAlone(0));
    EXPECT_EQ(closed.surroundings(1).get(), &apart.scenes[1]->environment);
}

TEST(BuildingSight, SlabsHaveUndersidesAndWallsReachUpToThem) {
    // Walls of 2.5 m, and storeys of 2.8 m below floors 3 m apart.
    for (const std::string& passages : {std::string(), std::string(kShaft)}) {
        const SiteScene building = towerOf("", "", passages, "2.8");
        const Environment ground = *Coupling(building).surroundings(0);
        EXPECT_NEAR(castTo(ground, {1, 1, 2}, {0, 0, 1}), 0.8, 1e-5);
        EXPECT_NEAR(castTo(ground, {1, 1, 2.7}, {-1, 0, 0}), 1, 1e-5);
        EXPECT_NEAR(castTo(ground, {1, 1, 2.4}, {-1, 0, 0}), 1, 1e-5);
    }
}

const std::string kFlight =
    "- stairs: {id: s, storeys: 'ground,upper', at: [5, 1], heading: 90, size: [1.2, 3]}\n";

TEST(BuildingSight, StepsHideFloorOfTheirOwnStorey) {
    const std::string ranger =
        "{ranger: {id: r, at: [3.5, 2.5, 2.4], tilt: -90, fov: '130,130', pixels: '9,9', "
        "range: '0,30'}}";
    const SiteScene building = towerOf(ranger, "", kFlight);
    const SiteCoverage with = measureSite(building, {});
    const SiteCoverage without = measureSite(towerOf(ranger, "", ""), {});
    const auto exact = [](const SiteCoverage& coverage) {
        return coverage.storeys[0].report.coverage.exact.value();
    };
    EXPECT_NEAR(coverageByRays(building, 0), exact(with), 0.005);
    EXPECT_NEAR(with.storeys[0].report.coverage.grid.value(), exact(with), 0.005);
    EXPECT_LT(exact(with), exact(without) - 0.03);
    EXPECT_NEAR(with.storeys[0].report.indoor_area, 48, 1e-9) << "there is floor below steps";
}

TEST(BuildingSight, StepsStopLevelLasers) {
    const SiteScene building =
        towerOf("{laser: {id: l, at: [5, 0.5, 0.5], heading: 90, fov: 10, step: 5}}", "", kFlight);
    RoomsAround rooms(building);
    const Scene& scene = *building.scenes[0];
    RayScenes worlds(scene.environment, rooms.around(0, scene));
    worlds.prepare(scene.sensors[0].pose);
    Directions ahead;
    ahead.resize(1);
    ahead.set(0, {0, 1, 0});
    std::array<float, 1> range{};
    worlds.at(scene.sensors[0].pose).cast(scene.sensors[0].pose.position, ahead, 100, range);
    EXPECT_NEAR(range[0], 1, 1e-6) << "the steps are 0.5 m high at y = 1.5";
}

TEST(BuildingSight, NoViewPassesOverTheOuterWallsOfOtherStoreys) {
    // Walls of 2.5 m below a floor at 3 m, seen aslant through a flight at the wall.
    const std::string camera = "{camera: {id: c, at: [0.1, 0.1, 2.4], heading: 20, tilt: -15}}";
    const std::string flight =
        "- stairs: {id: s, storeys: 'ground,upper', at: [7.3, 1], heading: 90, size: [1.2, 4]}\n";
    const SiteCoverage coverage = measureSite(towerOf("", camera, flight), {});
    const CoverageReport& ground = coverage.storeys[0].report;
    EXPECT_NEAR(ground.total_effective_area.exact.value(),
                ground.coverage.exact.value() * ground.indoor_area, 1e-6);
}

/// Returns the scene of a storey with its first record of this keyword at another position, or
/// without it.
Scene edited(const SiteScene& building, std::size_t storey, const std::string& keyword,
             std::optional<Tuple> at) {
    const Scene& scene = *building.scenes[storey];
    std::vector<Record> records = scene.records;
    const auto record = std::find_if(records.begin(), records.end(),
                                     [&](const Record& each) { return each.keyword() == keyword; });
    if (at)
        record->set("at", *at);
    else
        records.erase(record);
    return makeScene(std::move(records), scene, building.devices);
}

TEST(RoomsAround, AreBuiltAnewIfTheRoomOfTheStoreyChanges) {
    const SiteScene building =
        towerOf("{desk: {id: d, at: [6.5, 3]}}, " + kUp, "{laser: {id: l, at: [1, 3]}}", kShaft);
    RoomsAround rooms(building);
    const auto start = rooms.around(0, *building.scenes[0]);
    ASSERT_NE(start, nullptr);
    EXPECT_EQ(rooms.around(0, edited(building, 0, "camera", Tuple{3.5, 3, 1})), start);
    EXPECT_LT(castTo(start->environment(), {6.5, 3, 1.5}, {0, 0, -1}), 1);
    const Scene cleared = edited(building, 0, "desk", std::nullopt);
    const auto changed = rooms.around(0, cleared);
    EXPECT_NEAR(castTo(changed->environment(), {6.5, 3, 1.5}, {0, 0, -1}), 1.5, 1e-6);
    EXPECT_EQ(castTo(changed->environment(), {4, 3, 1.5}, {0, 0, 1}),
              std::numeric_limits<double>::infinity());
    EXPECT_EQ(rooms.around(0, cleared), changed);
    EXPECT_NE(rooms.around(1, *building.scenes[1]), nullptr) << "sides of shafts stop lasers";
    EXPECT_EQ(rooms.around(0, edited(building, 0, "camera", std::nullopt)), nullptr);
    const SiteScene apart = towerOf(kUp, kUp, "");
    EXPECT_EQ(RoomsAround(apart).around(1, *apart.scenes[1]), nullptr);
}

TEST(RoomsAround, FixedSensorsOfOtherStoreysSeeTheFloorThatTheyCover) {
    const SiteScene building = towerOf(
        "", kDown + ", {robot: {id: r, at: [2, 3]}}, {camera: {id: m, on: r, tilt: -60}}", kShaft);
    RoomsAround rooms(building);
    const OutsideWatch watch = rooms.outside(0, *building.scenes[0]);
    ASSERT_EQ(watch.sensors.size(), 1U);
    EXPECT_EQ(watch.sensors.front().id, "c");
    EXPECT_EQ(watch.sensors.front().pose.position.z, 5);
    const DetectionMonitor monitor(*building.scenes[0],
                                   {.outside = [&](const Scene&) { return watch; }});
    // The square of 5 m that ShaftFramesTheFloorBelow measures.
    for (double x = 0.05; x < 8; x += 0.2)
        for (double y = 0.05; y < 6; y += 0.2) {
            const bool is_seen = std::fabs(x - 4) < 2.5 && std::fabs(y - 3) < 2.5;
            EXPECT_EQ(monitor.seenBy({{x, y}}), is_seen ? 1U : 0U) << x << ',' << y;
        }
    EXPECT_TRUE(rooms.outside(1, *building.scenes[1]).sensors.empty());
    // A floor is not seen from below, a plane above it is.
    const SiteScene upwards = towerOf(kUp, "", kShaft);
    EXPECT_TRUE(RoomsAround(upwards).outside(1, *upwards.scenes[1]).sensors.empty());
    EXPECT_EQ(RoomsAround(upwards, 1).outside(1, *upwards.scenes[1]).sensors.size(), 1U);
}

/// 200 equal storeys around a shaft, with a camera in it on each.
TEST(BuildingSight, EqualStoreysShareViews) {
    std::string text = "- storey: {id: s0, height: 3, records: &room [" + std::string(kFence) +
                       ", " + kDown + "]}\n";
    std::string storeys = "s0";
    for (int i = 1; i < 200; ++i) {
        const std::string id = "s" + std::to_string(i);
        text += "- storey: {id: " + id + ", z: " + std::to_string(3 * i) +
                ", height: 3, records: *room}\n";
        storeys += "," + id;
    }
    text += "- shaft: {storeys: '" + storeys + "', path: [[3, 2], [5, 2], [5, 4], [3, 4]]}\n";
    const SiteScene building = sceneOf(text);
    const auto begin = std::chrono::steady_clock::now();
    const auto views = viewsBetweenStoreys(Coupling(building), {});
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
    std::set<const OutsideView*> known;
    std::size_t uses = 0;
    for (const auto& of_storey : views)
        for (const StoreyView& one : of_storey) {
            known.insert(one.view.get());
            ++uses;
        }
    EXPECT_LE(known.size(), kSightBetweenStoreys / 3);
    EXPECT_GT(uses, 190 * known.size());
    // The floor k storeys below is seen through k openings, of which the last is the narrowest.
    EXPECT_NEAR(signedArea(views[100].front().view->region), 25, 1e-3);
}

}  // namespace site_sight_test
}  // namespace ispace
