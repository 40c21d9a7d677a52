// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/coupling.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "site/site_coverage.h"
#include "site/site_sight.h"
#include "support/test_cast.h"
#include "trace/ray_world.h"

namespace ispace {
namespace coupling_test {

using testing::castTo;

constexpr double kNever = std::numeric_limits<double>::infinity();
const std::string kSquare =
    "{fence: {id: f, path: [[0, 0], [8, 0], [8, 6], [0, 6]], closed: yes, height: 2.5}}";
const std::string kEll =
    "{fence: {id: f, path: [[0, 0], [8, 0], [8, 3], [4, 3], [4, 6], [0, 6]], closed: yes, "
    "height: 2.5}}";
const std::string kShaft =
    "- shaft: {storeys: 'ground,upper', path: [[3, 2], [5, 2], [5, 4], [3, 4]]}\n";
const std::string kFlight =
    "- stairs: {id: s, storeys: 'ground,upper', at: [6.5, 1], heading: 90, size: [1.2, 3]}\n";

struct Room {
    std::string walls = kSquare, more = {};
    [[nodiscard]] std::string text() const {
        return "[" + walls + (more.empty() ? "" : ", " + more) + "]";
    }
};

/// Returns two storeys, 2.8 m high, whose floors are 3.1 m apart: the slab between is 0.3 m thick.
SiteScene twoStoreys(const Room& ground, const Room& upper, const std::string& passages = "") {
    return makeSiteScene(
        readBuilding("- storey: {id: ground, height: 2.8, records: " + ground.text() +
                         "}\n- storey: {id: upper, z: 3.1, height: 2.8, records: " + upper.text() +
                         "}\n" + passages,
                     "house.yaml", {}),
        {}, {});
}

double areaOfGround(const SiteScene& building) {
    return measureSite(building, {}).storeys[0].report.total_effective_area.exact.value();
}

std::vector<std::string> findingsOfGround(const SiteScene& building) {
    std::vector<std::string> messages;
    for (const Diagnostic& finding : storeyFindings(Coupling(building), 0, {})) {
        EXPECT_EQ(finding.severity, Severity::Error);
        messages.push_back(finding.message);
    }
    return messages;
}

TEST(Coupling, SensorsInASlabAreBlindAndFound) {
    using Messages = std::vector<std::string>;
    const auto at = [](const std::string& kind, const std::string& place) {
        return twoStoreys({kSquare, "{" + kind + ": {id: s, at: [" + place + "]}}"}, {}, kShaft);
    };
    for (const std::string kind : {"laser", "ranger", "camera"}) {
        const SiteScene building = at(kind, "2, 3, 3");
        EXPECT_EQ(areaOfGround(building), 0) << kind;
        EXPECT_EQ(findingsOfGround(building),
                  Messages({"ground: " + kind +
                            " s stands inside the floor of upper, 2.80 m to 3.10 m high, at (2.0, "
                            "3.0); lower it to 2.80 m"}));
        EXPECT_TRUE(Coupling(building).isInsideSolid(0, {2, 3, 3}));
        EXPECT_TRUE(viewsBetweenStoreys(Coupling(building), {.plane = 1})[1].empty());
    }
    EXPECT_EQ(findingsOfGround(at("ultrasound", "2, 3, 3")).size(), 1U);
    EXPECT_TRUE(findingsOfGround(at("laser", "2, 3, 2.8")).empty()) << "at its underside";
    EXPECT_GT(areaOfGround(at("laser", "2, 3, 2.8")), 1);
    EXPECT_TRUE(findingsOfGround(at("laser", "4, 3, 3")).empty()) << "in the shaft";
    EXPECT_NEAR(areaOfGround(at("laser", "4, 3, 3")), 2, 1e-6) << "its sides stop the laser";
    EXPECT_TRUE(findingsOfGround(at("laser", "2, 3, 1")).empty());
}

TEST(Coupling, SensorsInStepsAreFound) {
    const auto at = [](const std::string& z) {
        return findingsOfGround(
            twoStoreys({kSquare, "{laser: {id: l, at: [6.5, 2.5, " + z + "]}}"}, {}, kFlight));
    };
    // The steps are 1.55 m high in the middle.
    EXPECT_EQ(at("1.5"), std::vector<std::string>({"ground: laser l stands inside the steps of "
                                                   "stairs s at (6.5, 2.5); move it, or raise it "
                                                   "to 1.55 m"}));
    EXPECT_TRUE(at("1.6").empty());
    EXPECT_TRUE(at("1").empty()) << "under the stairs";
}

TEST(Coupling, SlabsEndWithTheOutlinesOfStoreys) {
    // The box of an L holds the room in its notch, over which it has no floor.
    const std::string notch =
        "{fence: {id: f, path: [[4.5, 3.5], [8, 3.5], [8, 6], [4.5, 6]], closed: yes}}";
    const SiteScene beside = twoStoreys({kEll}, {notch});
    EXPECT_EQ(Coupling(beside).slab(1).bottom, Coupling(beside).slab(1).top);
    EXPECT_TRUE(Coupling(beside).isAlone(0));
    // An L over a square leaves a corner of it open, where no outer wall is raised.
    const SiteScene over = twoStoreys({}, {kEll});
    const auto room = Coupling(over).surroundings(0);
    EXPECT_NEAR(castTo(*room, {2, 2, 1}, {0, 0, 1}), 1.8, 1e-5);
    EXPECT_EQ(castTo(*room, {6, 5, 1}, {0, 0, 1}), kNever);
    EXPECT_NEAR(castTo(*room, {2, 2, 2.6}, {-1, 0, 0}), 2, 1e-5);
    EXPECT_EQ(castTo(*room, {6, 5, 2.6}, {1, 0, 0}), kNever);
    EXPECT_FALSE(Coupling(over).slabAround(0, {6, 5, 3}));
    EXPECT_EQ(Coupling(over).slabAround(0, {2, 2, 3}), 1U);
}

/// Floors leave out only things that hide no floor: with all of them the figures are the same.
TEST(Coupling, FloorsAndSurroundingsGiveTheSameFigures) {
    std::mt19937_64 engine(7);
    const auto number = [&](double low, double high) {
        return std::to_string(std::uniform_real_distribution<double>(low, high)(engine));
    };
    for (int round = 0; round < 12; ++round) {
        const auto sensors = [&] {
            const std::string place = number(0.2, 7.8) + ", " + number(0.2, 5.8) + ", ";
            return "{desk: {at: [1.5, 4.5]}}, {laser: {id: l, at: [" + place + number(0.1, 3.2) +
                   "], heading: " + number(0, 360) + "}}, {ranger: {id: r, at: [" + place +
                   number(0.5, 3) + "], tilt: -50, heading: " + number(0, 360) +
                   ", fov: '90,60', range: '0,20'}}, {tag: {id: m, at: [" + place + number(0.5, 2) +
                   "]}}";
        };
        const std::string ground = sensors(), upper = sensors();
        const SiteScene building =
            twoStoreys({kSquare, ground}, {kEll, upper}, kFlight + (round % 2 == 0 ? kShaft : ""));
        const Coupling coupling(building);
        for (const std::size_t storey : {0U, 1U}) {
            const Scene& floor = *coupling.floor(storey);
            Scene whole = *building.scenes[storey];
            whole.environment = *coupling.surroundings(storey);
            RayScenes one(floor.environment), other(whole.environment);
            const Coverage few = measureCoverage(floor, one, {}),
                           all = measureCoverage(whole, other, {});
            ASSERT_EQ(few.report.sensors.size(), all.report.sensors.size());
            for (std::size_t i = 0; i < few.report.sensors.size(); ++i) {
                const SensorMetrics &a = few.report.sensors[i], &b = all.report.sensors[i];
                EXPECT_NEAR(a.area.exact.value_or(0), b.area.exact.value_or(0), 1e-6)
                    << ground << '\n'
                    << upper << '\n'
                    << storey << ' ' << a.id;
                EXPECT_EQ(a.area.grid, b.area.grid) << ground << '\n' << upper << ' ' << a.id;
            }
        }
    }
}

TEST(Coupling, EqualStoreysShareTheirFloor) {
    std::string text = "- storey: {id: s0, height: 3, records: &room " + Room{}.text() + "}\n";
    for (int i = 1; i < 30; ++i)
        text += "- storey: {id: s" + std::to_string(i) + ", z: " + std::to_string(3.2 * i) +
                ", height: 3, records: *room}\n";
    const SiteScene plain = makeSiteScene(readBuilding(text, "tower.yaml", {}), {}, {});
    for (const auto& floor : Coupling(plain).floors()) EXPECT_EQ(floor, plain.scenes[0]);
    std::string storeys = "s0";
    for (int i = 1; i < 30; ++i) storeys += ",s" + std::to_string(i);
    const std::string flight =
        "- stairs: {storeys: '" + storeys + "', at: [6.5, 1], heading: 90, size: [1.2, 3]}\n";
    const SiteScene tower = makeSiteScene(readBuilding(text + flight, "tower.yaml", {}), {}, {});
    const auto floors = Coupling(tower).floors();
    for (std::size_t i = 2; i + 1 < floors.size(); ++i) EXPECT_EQ(floors[i], floors[1]);
    EXPECT_NE(floors[0], floors[1]) << "it is whole";
    EXPECT_NE(floors[29], floors[1]) << "no steps begin there";
}

/// Steps stop sound of a running building as they do in coverage and scan.
TEST(Coupling, StepsStopSoundInRunsAsWell) {
    const SiteScene building =
        twoStoreys({kSquare, "{tag: {id: m, at: [4, 2.5, 1]}}"}, {}, kFlight);
    const Coupling coupling(building);
    RoomsAround rooms(building);
    const Scene& scene = *building.scenes[0];
    const auto sound_to = [](const Environment& room,
                             std::shared_ptr<const SurroundedRoom> around) {
        RayScenes worlds(room, std::move(around));
        worlds.prepareMesh(Surfaces::Solid);
        Directions ahead;
        ahead.resize(1);
        ahead.set(0, {0, 1, 0});
        std::array<float, 1> range{};
        worlds.mesh(Surfaces::Solid).cast({6.5, 0.5, 1}, ahead, 100, range);
        return static_cast<double>(range[0]);
    };
    const double met = 0.5 + 3 / 3.1;  // where the steps are a metre high
    EXPECT_NEAR(sound_to(scene.environment, rooms.around(0, scene)), met, 1e-5);
    EXPECT_NEAR(sound_to(coupling.floor(0)->environment, nullptr), met, 1e-5);
    EXPECT_NEAR(sound_to(*coupling.surroundings(0), nullptr), met, 1e-5);
}

TEST(Coupling, StoreysWithHolesElsewhereShareNoFloor) {
    // Equal storeys, whose sensor looks over the walls: holes lie in the floors above it.
    const std::string room =
        "[{fence: {id: f, path: [[0, 0], [8, 0], [8, 6], [0, 6]], closed: yes, height: 2.9}}, "
        "{camera: {id: c, at: [4, 3, 3.4], tilt: -90, fov: 120}}]";
    std::string text = "- storey: {id: s0, height: 3, records: &room " + room + "}\n";
    for (int i = 1; i < 6; ++i)
        text += "- storey: {id: s" + std::to_string(i) + ", z: " + std::to_string(3 * i) +
                ", height: 3, records: *room}\n";
    const auto floors = [&](const std::string& second) {
        const SiteScene building = makeSiteScene(
            readBuilding(text +
                             "- shaft: {storeys: 's0,s1', path: [[3, 2], [5, 2], [5, 4], [3, 4]]}\n"
                             "- shaft: {storeys: 's2,s3', path: " +
                             second + "}\n",
                         "tower.yaml", {}),
            {}, {});
        const Coupling coupling(building);
        return coupling.floor(2) == coupling.floor(0);
    };
    EXPECT_FALSE(floors("[[6, 1], [7, 1], [7, 2], [6, 2]]"));
    EXPECT_TRUE(floors("[[3, 2], [5, 2], [5, 4], [3, 4]]")) << "equal holes";
}

}  // namespace coupling_test
}  // namespace ispace
