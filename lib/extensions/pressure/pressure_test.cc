// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pressure/pressure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/pressure/pressure_role.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "server/session.h"

namespace ispace::pressure {
namespace pressure_test {

using std::chrono::milliseconds;

constexpr double kGravity = 9.80665;
constexpr std::string_view kRoom =
    "#env 1\nispace size=10,8\ncube id=bed at=3,3 size=2,1,0.5\nchair id=chair1 at=-3,3\n";

Scene sceneOf(const std::string& layout) {
    static const bool added = [] {
        addSceneSchemas(pressureSchemas());
        return true;
    }();
    EXPECT_TRUE(added);
    const Document placed = readRecordText("#3dm 1\n" + layout, "room.3dm", sceneSchemas());
    return makeScene(readRecordText(kRoom, "room.env", sceneSchemas()), &placed, shippedDevices());
}

std::string refusal(const std::string& layout) {
    try {
        pressureScene(sceneOf(layout), "");
    } catch (const FormatError& error) {
        return error.diagnostics().front().text();
    }
    return "";
}

TEST(PressureRecords, AreReadWithHints) {
    const PressureScene made = pressureScene(
        sceneOf("floor_sensor id=f at=1,0 size=4,2 heading=90 cell=50cm threshold=8 sigma=2\n"
                "seat_sensor id=b of=bed reach=40cm settle=3s\nhuman id=ann at=0,0 height=1.6\n"
                "human id=bob at=1,1\nload of=bob kg=82\nrobot id=r1 model=pioneer-2dx at=2,0\n"),
        "");
    ASSERT_EQ(made.floors.size(), 1U);
    const PressureFloor& floor = made.floors.front();
    EXPECT_EQ(floor.id, "f");
    EXPECT_EQ(floor.columns(), 8U);
    EXPECT_EQ(floor.rows(), 4U);
    // Along the heading, which is +y, and to the left, which is -x.
    EXPECT_NEAR(distance(floor.middleOf(0), Point2{1.75, -1.75}), 0, 1e-9);
    EXPECT_NEAR(distance(floor.middleOf(7), Point2{1.75, 1.75}), 0, 1e-9);
    EXPECT_NEAR(distance(floor.middleOf(8), Point2{1.25, -1.75}), 0, 1e-9);
    ASSERT_EQ(made.seats.size(), 1U);
    EXPECT_EQ(made.seats.front().distanceTo({3, 3.2}), 0);
    EXPECT_NEAR(made.seats.front().distanceTo({4.5, 3}), 0.5, 1e-9);
    EXPECT_NEAR(massOfPerson(1.6), 58.88, 1e-9);
    EXPECT_EQ(made.loads, (std::map<std::string, double>{{"bob", 82}}));
    EXPECT_NEAR(massOfRobot(0.25), 9, 1e-9);

    EXPECT_EQ(refusal("seat_sensor id=b of=bet\n"),
              "room.3dm:2:21: error: `of`: no thing of the room is `bet`, did you mean `bed`?");
    EXPECT_NE(refusal("human id=ann at=0,0\nload of=anna kg=3\n").find("did you mean `ann`?"),
              std::string::npos);
    EXPECT_NE(refusal("floor_sensor at=0,0 size=100,100 cell=5cm\n").find("a million cells"),
              std::string::npos);
    EXPECT_NE(refusal("floor_sensor at=0,0 size=1,2 cell=3\n").find("larger than the floor"),
              std::string::npos);
    EXPECT_NE(refusal("human id=ann at=0,0\nload of=ann kg=60\nload of=ann kg=70\n")
                  .find("`ann` has a load already"),
              std::string::npos);
    EXPECT_THROW(sceneOf("floor_sensor at=0,0\n"), FormatError);
    EXPECT_THROW(sceneOf("floor_sensor at=0,0 size=1,1 cell=0\n"), FormatError);
    EXPECT_THROW(sceneOf("seat_sensor id=b\n"), FormatError);
}

/// A floor at the origin that feels any force.
PressureFloor floorOf(double length, double width, double cell) {
    PressureFloor floor;
    floor.id = "f";
    floor.length = length;
    floor.width = width;
    floor.cell = cell;
    floor.threshold = 0;
    return floor;
}

double sumOf(const std::vector<FootContact>& feet) {
    double sum = 0;
    for (const FootContact& foot : feet) sum += foot.newtons;
    return sum;
}

TEST(Feet, BearTheWeightInTurns) {
    RobotStatus status;
    status.pose = {{1, 2}, Angle::degrees(90)};
    const auto standing = feetOf(1.7, 70, status);
    ASSERT_EQ(standing.size(), 2U);
    EXPECT_NEAR(standing[0].newtons, 35 * kGravity, 1e-9);
    EXPECT_NEAR(standing[1].newtons, 35 * kGravity, 1e-9);
    EXPECT_NEAR(standing[0].center.y, 2, 1e-9) << "side by side, across her heading";
    EXPECT_NEAR(standing[0].center.x + standing[1].center.x, 2, 1e-9);
    status.speed = 1;
    const auto left_of = [&](double phase) {
        status.phase = phase;
        const auto feet = feetOf(1.7, 70, status);
        EXPECT_NEAR(sumOf(feet), 70 * kGravity, 1e-9) << phase;
        return feet[0].center.x < feet[1].center.x ? feet[0] : feet[1];
    };
    // Down in front of her, below her while it bears all, up behind her, and through the air.
    EXPECT_NEAR(left_of(0.25).newtons, 35 * kGravity, 1e-6);
    EXPECT_GT(left_of(0.25).center.y, 2.2);
    EXPECT_NEAR(left_of(0.5).newtons, 70 * kGravity, 1e-6);
    EXPECT_NEAR(left_of(0.5).center.y, 2, 1e-6);
    EXPECT_LT(left_of(0.75).center.y, 1.8);
    EXPECT_NEAR(left_of(0).newtons, 0, 1e-6);
    EXPECT_NEAR(sumOf(wheelsOf(0.25, 9, status)), 9 * kGravity, 1e-9);
}

/// A body of two boxes on the floor, one of three times the volume, and one above it.
TEST(Feet, LyingBodiesPressTheFloorByTheirVolumes) {
    PersonFigure figure;
    figure.rest = "lies";
    figure.fixed = {
        {.center = {0.5, 0}, .half_length = 0.5, .half_width = 0.1, .bottom = 0, .top = 0.3},
        {.center = {-0.5, 0}, .half_length = 0.5, .half_width = 0.1, .bottom = 0, .top = 0.1},
        {.center = {0, 0}, .half_length = 0.5, .half_width = 0.1, .bottom = 0.3, .top = 0.5}};
    const Pose2 pose{{1, 2}, Angle::degrees(90)};
    const std::vector<FootContact> contacts = restingContacts(figure, 80, pose);
    EXPECT_NEAR(sumOf(contacts), 80 * kGravity, 1e-9);
    Vec2 moment{};
    for (const FootContact& contact : contacts) {
        EXPECT_LE(std::abs(contact.center.x - 1) + contact.radius, 0.1 + 1e-9);
        EXPECT_LE(std::abs(contact.center.y - 2) + contact.radius, 1 + 1e-9);
        moment = moment + contact.newtons * (contact.center - pose.position);
    }
    EXPECT_NEAR(moment.y / sumOf(contacts), 0.75 * 0.5 - 0.25 * 0.5, 1e-9);
    // A thing beside the body has no weight.
    figure.fixed.push_back({.center = {3, 0}, .half_length = 0.1, .half_width = 0.1, .top = 0.1});
    figure.load_parts = 1;
    EXPECT_EQ(restingContacts(figure, 80, pose).size(), contacts.size());
    EXPECT_NEAR(sumOf(restingContacts(figure, 80, pose)), sumOf(contacts), 1e-9);
    figure.support = 0.4;
    const std::vector<FootContact> on_thing = restingContacts(figure, 80, pose);
    ASSERT_EQ(on_thing.size(), 1U);
    EXPECT_EQ(on_thing.front().center, pose.position);
}

/// Whatever the grid, cells hold together the weight of all that stands on it.
TEST(FloorReading, HoldsAllWeights) {
    RobotStatus status;
    for (const double cell : {0.02, 0.1, 0.25, 0.7, 5.0})
        for (const double heading : {0.0, 33.0, 190.0}) {
            PressureFloor floor = floorOf(3, 2.5, cell);
            floor.pose = {{0.4, -0.2}, Angle::degrees(heading)};
            status.pose = {{0.1, 0.3}, Angle::degrees(20)};
            const auto feet = feetOf(1.8, 80, status);
            const PressureReading reading = readFloor(floor, feet, 0, nullptr);
            EXPECT_NEAR(reading.kilograms(), 80, 1e-9);
            EXPECT_TRUE(reading.is_occupied);
            // The centre of pressure lies between the feet, within a cell.
            Vec2 moment{};
            for (const auto& [index, newtons] : reading.cells)
                moment = moment + newtons * (floor.middleOf(index) - Point2{});
            const Vec2 middle = (1 / reading.newtons) * moment;
            EXPECT_LT(length(middle - (status.pose.position - Point2{})), cell);
        }
    PressureFloor half = floorOf(2, 2, 0.25);
    status.pose = {{1, 0}, Angle::degrees(90)};
    // Half of each foot of one who stands on the edge; the left one is on it.
    EXPECT_NEAR(readFloor(half, feetOf(1.7, 70, status), 0, nullptr).kilograms(), 35, 1e-9);
    half.threshold = 1e4;
    EXPECT_FALSE(readFloor(half, feetOf(1.7, 70, status), 0, nullptr).is_occupied);
}

TEST(FloorReading, HasNoiseThatRepeats) {
    PressureFloor floor = floorOf(10, 10, 0.1);
    floor.sigma = 3;
    floor.threshold = 6;
    const std::uint64_t seed = 5, other = 6;
    const auto a = readFloor(floor, {}, 1, &seed), b = readFloor(floor, {}, 1, &seed);
    EXPECT_EQ(a.cells, b.cells);
    EXPECT_NE(a.cells, readFloor(floor, {}, 2, &seed).cells);
    EXPECT_NE(a.cells, readFloor(floor, {}, 1, &other).cells);
    // Beyond two sigma: 2.3 % of 10000 cells.
    EXPECT_NEAR(static_cast<double>(a.cells.size()), 227.5, 60);
    EXPECT_TRUE(readFloor(floor, {}, 1, nullptr).cells.empty());
}

/// Ann walks over the floor to the bed and stays there.
class FloorRole : public ::testing::Test {
  protected:
    FloorRole()
        : scene_(sceneOf(
              "floor_sensor id=f at=0,3 size=3,1 rate=20\nseat_sensor id=bed-sensor of=bed\n"
              "human id=ann at=-2.5,3 speed=1\nload of=ann kg=60\n")),
          world_(scene_, milliseconds(10)),
          simulation_(world_, {}, parseClock("step"), std::nullopt),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makePressure({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
        simulation_.events().want({EventKind::State});
    }
    static std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }
    std::string run(int steps, Session& session) {
        std::string told;
        for (int i = 0; i < steps; ++i) {
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), std::chrono::seconds(1));
            service_->stepped();
            session.proceed();
            told += session.take();
        }
        return told;
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
    ServerState state_;
    RunRoom room_;
    std::unique_ptr<RoleService> service_;
};

TEST_F(FloorRole, ReadsWatchesAndTellsStates) {
    Session floor(state_), beds(state_);
    EXPECT_EQ(ask(floor, "FLOOR *"), "OK FLOOR * t=0.000 sensors=bed-sensor,f\n");
    EXPECT_EQ(ask(beds, "FLOOR bed*"), "OK FLOOR bed* t=0.000 sensors=bed-sensor\n");
    EXPECT_EQ(ask(floor, "READ f"),
              "OK READ id=f t=0.000 seq=0 weight=0.00 occupied=0 columns=12 rows=4 cells=\n");
    EXPECT_EQ(ask(floor, "READ g"), "ERR 404 no floor or seat `g`\n");
    EXPECT_EQ(ask(beds, "READ f").substr(0, 8), "ERR 404 ");
    for (const char* const bad : {"WATCH every=0", "WATCH 3", "WATCH every=x"})
        EXPECT_EQ(ask(floor, bad).substr(0, 8), "ERR 400 ") << bad;
    world_.command(0, {.verb = Verb::Forward, .value = 4.2});
    EXPECT_EQ(ask(floor, "WATCH every=10"), "OK WATCH every=10\n");
    const std::string told = run(300, floor);
    EXPECT_NE(told.find("EVENT floor id=f t=2.500 seq=50 weight=60.00 occupied=1 "),
              std::string::npos)
        << told;
    EXPECT_EQ(told.find("seq=51 "), std::string::npos);
    EXPECT_EQ(ask(floor, "UNWATCH"), "OK UNWATCH t=3.000\n");
    EXPECT_EQ(run(500, floor), "");
    EXPECT_EQ(ask(beds, "READ bed-sensor"),
              "OK READ id=bed-sensor t=8.000 seq=80 weight=60.00 occupied=1\n");
    EXPECT_NE(ask(floor, "READ f").find("occupied=0"), std::string::npos);
    std::vector<std::string> states;
    EventLog& events = simulation_.events();
    for (auto i = events.first(); i < events.next(); ++i)
        if (events.at(i).other == "occupied")
            states.push_back(events.at(i).id + "=" + events.at(i).text);
    EXPECT_EQ(states, (std::vector<std::string>{"f=1", "f=0", "bed-sensor=1"}));
}

/// One that stood still, and is at the bed at once by a change, settles there first.
TEST(Pressure, SettlesAfterEachChangeOfPlace) {
    const std::string seat = "seat_sensor id=s of=bed\nhuman id=ann at=";
    const Scene scene = sceneOf(seat + "-2,0\n");
    World world(scene, milliseconds(100));
    PressureField field(world, "");
    const auto run = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            world.step();
            field.observe();
        }
        return field.read(field.seats().front(), 0).is_occupied;
    };
    EXPECT_FALSE(run(50));
    world.change(sceneOf(seat + "3,2.2\n"));
    EXPECT_FALSE(run(19));
    EXPECT_TRUE(run(3));
}

TEST_F(FloorRole, FollowsChanges) {
    Session floor(state_);
    ask(floor, "FLOOR *");
    world_.change(sceneOf("floor_sensor id=g at=-2.5,3 size=1,1\nhuman id=ann at=-2.5,3\n"));
    run(30, floor);
    EXPECT_EQ(ask(floor, "READ f").substr(0, 8), "ERR 404 ");
    EXPECT_NE(ask(floor, "READ g").find("weight=66.47 occupied=1"), std::string::npos);
    // A record that refers to no thing is left out, and the others follow the change.
    world_.change(
        sceneOf("floor_sensor id=f at=2.5,3 size=1,1\nseat_sensor id=h of=nowhere\n"
                "floor_sensor id=k at=0,0 size=1000,1000 cell=0.01\nload of=nix kg=3\n"
                "load of=ann kg=50\nhuman id=ann at=2.5,3\n"));
    run(30, floor);
    EXPECT_NE(ask(floor, "READ f").find("weight=50.00"), std::string::npos);
    for (const char* const gone : {"g", "h", "k"})
        EXPECT_EQ(ask(floor, std::string("READ ") + gone).substr(0, 8), "ERR 404 ");
}

TEST(Pressure, IsNoneWithoutSensors) {
    const Scene scene = sceneOf("robot id=r1 at=0,0\n");
    World world(scene, milliseconds(5));
    Simulation simulation(world, {}, parseClock("step"), std::nullopt);
    const RunRoom room{"", &simulation};
    EXPECT_EQ(makePressure({&room, 1}, 1), nullptr);
}

}  // namespace pressure_test
}  // namespace ispace::pressure
