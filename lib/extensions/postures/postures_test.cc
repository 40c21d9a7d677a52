// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/days/activity.h"
#include "extensions/days/person_verbs.h"
#include "extensions/postures/deeds.h"
#include "extensions/postures/posture.h"
#include "extensions/postures/postures_test.h"
#include "record/edit.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "sense/selection.h"
#include "sim/robot_sensors.h"
#include "sim/simulation.h"
#include "sim/world_editor.h"
#include "support/test_readings.h"
#include "trace/render/render.h"

namespace ispace::postures {
namespace postures_test {

using days::addPersonVerb;
using days::DeedMoment;
using days::PersonDeed;
using days::PersonVerb;
using days::personVerbs;
using std::chrono::milliseconds;

constexpr double kHeight = 1.7;
constexpr std::string_view kRoom = "#env 1\nispace size=10,8\n";

Scene sceneOf(const std::string& people, std::string_view room = kRoom) {
    testing::addPosturesOnce();
    const Document placed = readRecordText("#3dm 1\n" + people, "room.3dm", sceneSchemas());
    return makeScene(readRecordText(room, "room.env", sceneSchemas()), &placed, shippedDevices());
}

PersonPosture posed(Posture posture, double support = 0) {
    return {.height = kHeight, .posture = posture, .support = support};
}

/// An upright box or a ball, of the description of a posture and not of its code.
struct Solid {
    Point3 low, high;   // of a box
    double radius = 0;  // of a ball in the middle of these
};

/// Distance along a ray to a solid; +infinity if it misses.
double meet(const Solid& solid, Point3 from, Vec3 direction) {
    constexpr double kMissed = std::numeric_limits<double>::infinity();
    if (solid.radius > 0) {
        const Vec3 way{(solid.low.x + solid.high.x) / 2 - from.x,
                       (solid.low.y + solid.high.y) / 2 - from.y,
                       (solid.low.z + solid.high.z) / 2 - from.z};
        const double along = dot(way, direction);
        const double square = solid.radius * solid.radius - dot(way, way) + along * along;
        return square < 0 || along < 0 ? kMissed : along - std::sqrt(square);
    }
    double enter = 0, leave = kMissed;
    const auto clip = [&](double at, double step, double low, double high) {
        if (step == 0) {
            if (at < low || at > high) leave = -1;
            return;
        }
        const double a = (low - at) / step, b = (high - at) / step;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    };
    clip(from.x, direction.x, solid.low.x, solid.high.x);
    clip(from.y, direction.y, solid.low.y, solid.high.y);
    clip(from.z, direction.z, solid.low.z, solid.high.z);
    if (enter > leave) return kMissed;
    return enter;
}

/// Solids of a person of 1.7 m that lies with the head ahead: on the floor or a thing.
std::vector<Solid> lying(double z, bool has_fallen) {
    const double h = kHeight, end = 0.195 * h;
    std::vector<Solid> solids = {
        {{-end, -0.1 * h, z}, {end, 0.1 * h, z + 0.12 * h}},
        {{end, -0.065 * h, z}, {end + 0.13 * h, 0.065 * h, z + 0.13 * h}, 0.065 * h}};
    for (const double side : {-1.0, 1.0}) {
        const double leg = side * 0.055 * h, arm = side * 0.125 * h;
        solids.push_back(
            {{-end - 0.48 * h, leg - 0.035 * h, z}, {-end, leg + 0.035 * h, z + 0.07 * h}});
        const bool ahead = has_fallen && side > 0;
        const double from = ahead ? end - 0.05 * h : end - 0.48 * h;
        solids.push_back(
            {{from, arm - 0.025 * h, z}, {from + 0.48 * h, arm + 0.025 * h, z + 0.05 * h}});
    }
    return solids;
}

Point3 placed(const Pose2& pose, Point3 p) {
    const Point2 on = pose * p.onFloor();
    return {on.x, on.y, p.z};
}

TEST(Postures, StandingPeopleHaveTheUsualBody) {
    EXPECT_EQ(figureOf(posed(Posture::Stand)), nullptr);
    PersonPosture arms = posed(Posture::Stand);
    arms.left = ArmPose{Angle::degrees(20), Angle::degrees(-90), 0.6};
    EXPECT_EQ(figureOf(arms), nullptr);
    const Scene scene = sceneOf(
        "human id=ann at=1,2\nhuman id=bob at=3,2 posture=stand "
        "right_arm=0,-90\n");
    for (const PlacedPerson& person : scene.people) EXPECT_EQ(person.figure, nullptr);
    std::string states;
    for (const RoomState& state : roomStates(scene))
        states += state.id + '.' + state.key + '=' + state.value + ' ';
    EXPECT_EQ(states, "bob.posture=stand bob.right_arm=0,-90 ");
}

/// Rays from everywhere meet a lying body where its description says.
TEST(Postures, RaysMeetLyingPeopleExactly) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    std::size_t met = 0;
    for (const bool fallen : {false, true})
        for (const double support : {0.0, 0.5}) {
            const auto figure = figureOf(posed(fallen ? Posture::Fallen : Posture::Lie, support));
            const Pose2 pose{{0.4, -0.3}, Angle::degrees(35)};
            const MovingBodies bodies(humanBodies(kHeight, pose, 0, {}, figure.get()));
            const std::vector<Solid> solids = lying(support, fallen);
            for (int i = 0; i < 4000; ++i) {
                // Every other ray is level.
                const bool is_level = i % 2 == 0;
                const double bearing = 2 * std::numbers::pi * unit(random);
                const Point3 local_aim{2.4 * unit(random) - 1.4, 0.6 * unit(random) - 0.3,
                                       support + 0.25 * unit(random)};
                const Point3 local_from{3 * std::cos(bearing), 3 * std::sin(bearing),
                                        is_level ? local_aim.z : 2 * unit(random)};
                const Vec3 way = local_aim - local_from;
                const Vec3 local = 1 / length(way) * way;
                double expected = std::numeric_limits<double>::infinity();
                for (const Solid& solid : solids)
                    expected = std::min(expected, meet(solid, local_from, local));
                const CosSin axes = cosSin(pose.heading);
                Directions directions;
                directions.resize(1);
                directions.set(0, {axes.cos * local.x - axes.sin * local.y,
                                   axes.sin * local.x + axes.cos * local.y, local.z});
                std::array<float, 1> range{kNoReturn};
                bodies.shorten(placed(pose, local_from), directions, 100, MovingBodies::kNoOwner,
                               range);
                if (expected == std::numeric_limits<double>::infinity()) {
                    EXPECT_EQ(range[0], kNoReturn) << i;
                    continue;
                }
                ++met;
                EXPECT_NEAR(range[0], expected, 2e-6) << i;
            }
        }
    EXPECT_GT(met, 5000U);
}

TEST(Postures, CamerasAndLasersSeeTheSameBodies) {
    const Scene scene = sceneOf(
        "human id=ann at=-2,0 heading=20 posture=sit\nhuman id=bob at=0,0 posture=fallen\n"
        "human id=eve at=2,0 heading=-70 left_arm=40,10 right_arm=-20,-30,0.7\n"
        "camera at=0,-3.9,1.4 heading=90 tilt=-10 pixels=120,60 fov=80\n");
    const Sensor& camera = scene.sensors.front();
    const CameraView view(camera.as<Camera>(), camera.pose);
    const Rendering picture =
        render(RenderScene(scene), view, {.labels = true, .depths = true, .colors = false});
    const MovingBodies bodies(bodiesOf(scene));
    const EvenPixelRays lines = *view.evenPixelRays();
    std::size_t met = 0;
    for (int row = 0; row < 60; ++row)
        for (int column = 0; column < 120; ++column) {
            const auto pixel =
                static_cast<std::size_t>(row) * 120 + static_cast<std::size_t>(column);
            const RayGrid grid{lines.direction, lines.right, lines.down, 120, 60};
            const Vec3 ray = grid.ray(column, row);
            Directions directions;
            directions.resize(1);
            directions.set(0, 1 / length(ray) * ray);
            std::array<float, 1> range{kNoReturn};
            bodies.shorten(camera.pose.position, directions, 100, MovingBodies::kNoOwner, range);
            const std::uint32_t label = picture.labels[pixel];
            const bool is_person = label > 0 && scene.records[label - 1].keyword() == "human";
            if (!is_person) continue;
            ++met;
            EXPECT_NEAR(static_cast<double>(range[0]) / length(ray), picture.depths[pixel], 1e-5);
        }
    EXPECT_GT(met, 300U);
}

/// Hands are where yaw, pitch and reach say; both halves of the arm keep their lengths, and the
/// elbow hangs.
TEST(Postures, ArmsReachTheirPoints) {
    for (const double yaw : {-120.0, 0.0, 35.0})
        for (const double pitch : {-60.0, 0.0, 45.0, 90.0})
            for (const double reach : {0.3, 0.6, 0.731}) {
                PersonPosture posture = posed(Posture::Stand);
                posture.left = ArmPose{Angle::degrees(yaw), Angle::degrees(pitch), reach};
                const auto figure = figureOf(posture);
                ASSERT_NE(figure, nullptr);
                EXPECT_EQ(figure->kept.count(), 6U);
                EXPECT_EQ(figure->rest, "");
                std::vector<Point3> row;
                for (const BodyPart& ball : figure->fixed) {
                    ASSERT_TRUE(ball.is_ball);
                    EXPECT_NEAR(ball.radius, 0.025 * kHeight, 1e-12);
                    row.push_back({ball.center.x, ball.center.y, (ball.bottom + ball.top) / 2});
                }
                const Point3 shoulder{0, 0.125 * kHeight, 0.845 * kHeight};
                const double y = yaw * std::numbers::pi / 180, p = pitch * std::numbers::pi / 180;
                const Point3 hand{shoulder.x + reach * std::cos(p) * std::cos(y),
                                  shoulder.y + reach * std::cos(p) * std::sin(y),
                                  shoulder.z + reach * std::sin(p)};
                EXPECT_NEAR(length(row.front() - shoulder), 0, 1e-9);
                EXPECT_NEAR(length(row.back() - hand), 0, 1e-9);
                double whole = 0;
                for (std::size_t i = 1; i < row.size(); ++i) {
                    EXPECT_LE(length(row[i] - row[i - 1]), 2.0 / 3 * 0.025 * kHeight + 1e-9);
                    whole += length(row[i] - row[i - 1]);
                }
                EXPECT_NEAR(whole, 0.43 * kHeight, 1e-3);
                const Point3 elbow = row[row.size() / 2];
                EXPECT_NEAR(length(elbow - shoulder), length(hand - elbow), 1e-9);
                EXPECT_LE(elbow.z, (shoulder.z + hand.z) / 2 + 1e-9);
                // Back from the hand to the arm.
                const ArmPose back = armTo(posture, hand, 1);
                EXPECT_NEAR(back.pitch.degrees(), pitch, 1e-6);
                EXPECT_NEAR(back.reach, reach, 1e-9);
            }
    PersonPosture posture = posed(Posture::Stand);
    EXPECT_NEAR(armTo(posture, {5, 0, 1}, -1).reach, 0.43 * kHeight, 1e-9);
    EXPECT_NEAR(kUsualReach * kHeight, 0.6, 1e-12);
}

TEST(Postures, AreSymmetric) {
    for (const Posture each : {Posture::Stand, Posture::Sit}) {
        PersonPosture left = posed(each, 0.45), right = left;
        left.left = ArmPose{Angle::degrees(30), Angle::degrees(10), 0.6};
        right.right = ArmPose{Angle::degrees(-30), Angle::degrees(10), 0.6};
        std::vector<BodyPart> a = personParts(kHeight, figureOf(left).get());
        std::vector<BodyPart> b = personParts(kHeight, figureOf(right).get());
        ASSERT_EQ(a.size(), b.size());
        for (const BodyPart& part : a)
            EXPECT_EQ(std::count_if(b.begin(), b.end(),
                                    [&](const BodyPart& other) {
                                        return std::abs(other.center.x - part.center.x) < 1e-12 &&
                                               std::abs(other.center.y + part.center.y) < 1e-12 &&
                                               std::abs(other.bottom - part.bottom) < 1e-12 &&
                                               std::abs(other.top - part.top) < 1e-12 &&
                                               other.half_width == part.half_width;
                                    }),
                      1);
    }
}

/// A sitting person is as long as a standing one from the feet to the head.
TEST(Postures, SittingPeopleHaveFeetOnTheFloor) {
    for (const double seat : {0.0, 0.2, 0.45, 0.8}) {
        const auto figure = figureOf(posed(Posture::Sit, seat));
        EXPECT_EQ(figure->rest, "sits");
        const auto& parts = figure->fixed;
        const BodyPart& trunk = parts.front();
        EXPECT_EQ(trunk.radius, 0);
        EXPECT_EQ(trunk.center, (Point2{0, 0}));
        EXPECT_NEAR(trunk.bottom, seat, 1e-12);
        double top = 0, bottom = 10, knee = 0;
        for (const BodyPart& part : parts) {
            top = std::max(top, part.top);
            bottom = std::min(bottom, part.bottom);
            if (part.radius == 0 && part.bottom == seat && part.half_width < 0.1)
                knee = std::max(knee, part.center.x + part.half_length);
        }
        EXPECT_NEAR(top, seat + 0.52 * kHeight, 1e-9);
        EXPECT_NEAR(bottom, std::max(0.0, seat - 0.28 * kHeight), 1e-9);
        EXPECT_NEAR(knee, 0.48 * kHeight - std::min(seat, 0.28 * kHeight), 1e-9);
    }
}

TEST(Postures, CarryTags) {
    const auto tag_at = [](const std::string& posture, const std::string& at) {
        const Scene scene =
            sceneOf("human id=ann at=1,2 heading=90 " + posture + "\ntag on=ann at=" + at + "\n");
        return scene.sensors.front().pose.position;
    };
    const auto expect = [](Point3 found, Point3 wanted) {
        EXPECT_NEAR(length(found - wanted), 0, 1e-9) << found.x << ' ' << found.y << ' ' << found.z;
    };
    expect(tag_at("", "0.1,0.05,1.3"), {0.95, 2.1, 1.3});
    // The middle of the trunk is 1.1475 m high, and the hip 0.816 m.
    expect(tag_at("posture=sit support=0.4", "0.1,0.05,1.3"), {0.95, 2.1, 0.884});
    expect(tag_at("posture=sit support=0.4", "0,0,0.1"), {1, 2, 0});
    expect(tag_at("posture=lie support=0.5", "0.1,0.05,1.3"), {1.05, 2.1525, 0.702});
    expect(tag_at("posture=fallen", "0.1,0.05,1.3"), {0.95, 2.1525, 0.002});
}

TEST(Postures, CarriedThingsKeepTheirShapes) {
    const auto load = [](const std::string& thing) {
        const Scene scene =
            sceneOf("human id=ann at=0,0\n", std::string(kRoom) + thing + " carried=ann\n");
        const auto& figure = *scene.people.front().figure;
        EXPECT_EQ(figure.load_parts, 1U);
        return figure.fixed.back();
    };
    const BodyPart round = load("cylinder id=a at=2,0 size=0.1,0.1 height=0.3");
    EXPECT_EQ(round.radius, 0.05);
    EXPECT_NEAR(round.top - round.bottom, 0.3, 1e-12);
    EXPECT_EQ(load("cylinder id=a at=2,0 size=0.1,0.2 height=0.3").radius, 0) << "an ellipse";
    EXPECT_EQ(load("cube id=a at=2,0 size=0.1,0.1,0.3").half_width, 0.05);
}

/// A robot stops at the legs of a person that lies on the floor, and passes below a bed's.
TEST(Postures, RobotsRunIntoBodies) {
    const auto way = [](const std::string& keys, double x) {
        // It lies along +x, with its feet 1.2 m behind the middle.
        const Scene scene =
            sceneOf("human id=ann at=0,0 " + keys + "\nrobot id=r at=" + formatDouble(x) +
                    ",-1.5 heading=90 radius=0.2 height=0.4\n");
        World world(scene, milliseconds(50));
        world.command(0, {.verb = Verb::Speed, .value = 0.5});
        for (int i = 0; i < 100; ++i) world.step();
        return world.status(0);
    };
    const RobotStatus stopped = way("posture=fallen", -0.8);
    EXPECT_TRUE(stopped.stall);
    EXPECT_NEAR(stopped.pose.position.y, -0.2 - 0.09 * 1.7, 0.03);
    EXPECT_FALSE(way("posture=fallen", -1.6).stall) << "beyond the feet";
    EXPECT_TRUE(way("posture=fallen", 1.1).stall) << "the arm beside the head";
    EXPECT_FALSE(way("posture=lie support=0.5", -0.8).stall) << "below";
    EXPECT_FALSE(way("posture=stand", -0.8).stall);
    EXPECT_TRUE(way("posture=sit support=0.45", 0.4).stall) << "the shanks";
}

/// A GOTO that such a body stops is tried again round it.
TEST(Postures, RobotsGoRoundBodies) {
    const Scene scene = sceneOf(
        "human id=ann at=0.8,0 posture=fallen\nrobot id=r at=0,-1.5 heading=90 radius=0.2\n");
    World world(scene, milliseconds(50));
    Command there{.verb = Verb::Goto};
    there.course.path = {{0, 1.5}};
    ASSERT_EQ(world.findPath(0, there), "");
    world.command(0, there);
    for (int i = 0; i < 1200; ++i) world.step();
    EXPECT_NEAR(distance(world.status(0).pose.position, Point2{0, 1.5}), 0, 0.1);
}

TEST(Postures, MatsAndGatesFeelLyingPeople) {
    const std::string floor =
        "mat id=m at=-1,0 size=0.2,0.2\ngate id=low at=-1,0 height=0.1\n"
        "gate id=high at=-1,0 height=0.3\nmat id=far at=-1.6,0 size=0.2,0.2\n";
    for (const bool fallen : {false, true}) {
        const Scene scene = sceneOf(std::string("human id=ann at=0,0 ") +
                                    (fallen ? "posture=fallen" : "") + "\n" + floor);
        FloorSensors sensors(scene);
        std::vector<Motion> motions(1);
        const std::vector<Angle> swings(1);
        sensors.follow({{}, motions, swings});
        EXPECT_EQ(sensors.mat(0).on.size(), fallen ? 1U : 0U);
        EXPECT_EQ(sensors.mat(1).on.size(), 0U);
        EXPECT_EQ(sensors.gate(0).broken, fallen);
        EXPECT_FALSE(sensors.gate(1).broken);
    }
}

TEST(Postures, AreRejectedWithHints) {
    const auto refusal = [](const std::string& keys) -> std::string {
        try {
            sceneOf("human id=ann at=0,0 " + keys + "\n");
        } catch (const FormatError& error) {
            return error.diagnostics().front().message;
        }
        return "";
    };
    EXPECT_EQ(refusal("posture=sit left_arm=10,20"), "");
    EXPECT_NE(refusal("posture=sitting").find("sit"), std::string::npos);
    EXPECT_EQ(refusal("posture=fallen left_arm=0,-90"), "");
    EXPECT_NE(refusal("left_arm=0,91").find("pitch from -90"), std::string::npos);
    EXPECT_NE(refusal("left_arm=181,0"), "");
    EXPECT_NE(refusal("right_arm=0,0,0.74").find("to 0.731 m"), std::string::npos);
    EXPECT_NE(refusal("posture=lie right_arm=0,0").find("lies cannot be raised"),
              std::string::npos);

    const auto finding = [](const std::string& keys, const std::string& things) {
        const Scene scene =
            sceneOf("human id=ann at=0,0 " + keys + "\n", std::string(kRoom) + things);
        const auto found = checkBody(scene, scene.records.size() - 1);
        return found ? found->text() : "";
    };
    EXPECT_EQ(finding("posture=lie", ""), "");
    EXPECT_EQ(finding("posture=lie support=0.5", "cube at=0,0 size=2,1,0.5\n"), "");
    EXPECT_EQ(finding("posture=sit", ""),
              "human ann sits 0.45 m above the floor, where no thing is; set support=0.00, or move "
              "it");
    EXPECT_EQ(finding("posture=fallen", "cube at=0,0 size=2,1,0.5\n"),
              "human ann has fallen 0.00 m above the floor, where a thing is 0.50 m high; set "
              "support=0.50, or move it");
    // Through a wall, below a window sill, or past its end.
    const std::string wall = "wall id=w from=0.5,-1 to=0.5,1\n";
    EXPECT_EQ(finding("posture=fallen", wall),
              "human ann has fallen through wall w; move or turn it");
    EXPECT_EQ(finding("posture=fallen heading=90", wall), "");
    EXPECT_EQ(finding("posture=fallen", "wall id=w from=0.6,0.5 to=0.6,1\n"), "");
    EXPECT_EQ(finding("left_arm=0,0", wall), "human ann reaches through wall w; move or turn it");
    EXPECT_EQ(finding("left_arm=180,0", wall), "");
    // People that sit stand in no thing.
    for (const Finding& each :
         checkScene(sceneOf("human id=ann at=0,0 posture=sit support=0.5\n",
                            std::string(kRoom) + "cube at=0,0 size=1,1,0.5\n")))
        ADD_FAILURE() << each.text();
}

/// A run in which changes are made as the server does.
class Home {
  public:
    Home(const std::string& room, const std::string& people, const std::string& script,
         SimTime step = milliseconds(100))
        : scene_(sceneOf(people, std::string(kRoom) + room)),
          world_(scene_, step),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}) {
        simulation_.events().want(
            {EventKind::Activity, EventKind::Unreached, EventKind::Mark, EventKind::State});
        if (!script.empty()) simulation_.follow(days::readDays(script, "s.txt", world_));
    }
    void run(double duration) {
        const SimTime end = world_.time() + simSeconds(duration);
        while (world_.time() < end) {
            while (simulation_.isChangeDue()) {
                const std::string change = simulation_.takeScriptedChange();
                if (!change.empty()) tryToAct(change);
            }
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), std::chrono::seconds(10));
        }
    }
    /// Runs until the states that it has told are these, for a minute at most.
    void runTo(const std::string& wanted) {
        const SimTime most = world_.time() + std::chrono::minutes(1);
        while (states() != wanted && world_.time() < most) run(kStep);
        EXPECT_EQ(states(), wanted);
    }
    void tryToAct(const std::string& change) {
        try {
            act(change);
        } catch (const FormatError& error) {
            simulation_.refuseScripted("ERR 409 " + error.diagnostics().front().message);
        }
    }
    void act(const std::string& change) {
        const auto where = [this](const std::string& id) -> std::optional<Pose2> {
            const auto mover = world_.moverNamed(id);
            return mover ? std::optional(world_.status(*mover).pose) : std::nullopt;
        };
        const std::vector<Edit> edits = parseEdits(change);
        const std::vector<std::string> placed = placedBy(edits, world_.scene());
        world_.change(makeScene(editedRecords(world_.scene(), edits, where), world_.scene(),
                                shippedDevices()),
                      placed);
    }
    [[nodiscard]] Pose2 at(std::string_view person) const {
        return world_.status(*world_.moverNamed(person)).pose;
    }
    /// Returns the states that a run has told: "ann.posture=sit ".
    [[nodiscard]] std::string states() const { return told(EventKind::State); }
    [[nodiscard]] std::string marks() const { return told(EventKind::Mark); }
    /// Returns the ends of actions: "sits on sofa 3s: given up, ".
    [[nodiscard]] std::string ends() const {
        std::string text;
        const EventLog& log = simulation_.events();
        for (std::int64_t i = log.first(); i < log.next(); ++i)
            if (const Event& event = log.at(i);
                event.kind == EventKind::Activity && event.value <= 0)
                text += event.text + (event.value < 0 ? ": given up, " : ": done, ");
        return text;
    }
    [[nodiscard]] const Element& element(std::string_view id) const {
        for (const Element& each : world_.scene().environment.elements())
            if (each.id == id) return each;
        throw std::logic_error("no such element");
    }
    World& world() { return world_; }

  private:
    static constexpr double kStep = 0.1;

    [[nodiscard]] std::string told(EventKind kind) const {
        std::string text;
        const EventLog& log = simulation_.events();
        for (std::int64_t i = log.first(); i < log.next(); ++i) {
            const Event& event = log.at(i);
            if (event.kind != kind) continue;
            text += kind == EventKind::Mark ? event.text + ' '
                                            : event.id + '.' + event.other + '=' + event.text + ' ';
        }
        return text;
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
};

TEST(Deeds, PeopleSitOnChairsAndLieOnBeds) {
    Home home(
        "chair id=chair1 at=2,0 heading=180 size=0.5,0.5,0.9\ncube id=bed at=-3,-2 size=2,1,0.5\n",
        "human id=ann at=0,0\n",
        "at 00:00 ann sits on chair1 20s; goes bed; lies on bed 30s; stays 1s\n");
    home.run(10);
    EXPECT_EQ(home.states(), "ann.posture=sit ");
    const Pose2 seat = home.at("ann");
    EXPECT_NEAR(wrapped(seat.heading - Angle::degrees(180)).degrees(), 0, 1e-9);
    EXPECT_NEAR(seat.position.y, 0, 1e-9);
    EXPECT_NEAR(seat.position.x, 2.098, 1e-3) << "its back at the rest";
    EXPECT_EQ(home.world().people().front().figure->rest, "sits");
    EXPECT_EQ(home.world().refusal(0, {.verb = Verb::Forward, .value = 1}),
              "ann sits, and does not go");
    home.run(30);
    EXPECT_EQ(home.states(), "ann.posture=sit ann.posture=stand ann.posture=lie ");
    // The head towards the bed's heading, the whole body on it.
    const Pose2 bed = home.at("ann");
    EXPECT_NEAR(bed.position.x, -3 + 0.175 * kHeight, 1e-9);
    EXPECT_NEAR(bed.position.y, -2, 1e-9);
    EXPECT_NEAR(home.world().people().front().figure->support, 0.5, 1e-12);
    home.run(30);
    EXPECT_EQ(home.marks(), "");
    EXPECT_EQ(home.states(),
              "ann.posture=sit ann.posture=stand ann.posture=lie ann.posture=stand ");
    EXPECT_GT(std::abs(home.at("ann").position.y + 2), 0.7) << "beside the bed";
}

TEST(Deeds, FallsEndWays) {
    Home home("", "human id=bob at=-3,0 path=3,0 speed=1\n",
              "at 00:00:02 bob falls\nat 00:00:10 bob falls\nat 00:00:20 bob stands; stands\n");
    home.run(5);
    EXPECT_EQ(home.states(), "bob.posture=fallen ");
    const Point2 where = home.at("bob").position;
    EXPECT_NEAR(where.x, -1.2, 0.3);
    home.run(14);
    EXPECT_EQ(home.at("bob").position, where);
    EXPECT_EQ(home.world().status(0).speed, 0);
    EXPECT_EQ(home.marks(), "script: bob falls: it has fallen ");
    home.run(10);
    EXPECT_EQ(home.states(), "bob.posture=fallen bob.posture=stand ");
    EXPECT_NE(home.marks().find("script: bob stands: it stands"), std::string::npos);
    // It goes on with its way.
    EXPECT_GT(home.at("bob").position.x, where.x + 2);
}

TEST(Deeds, ThingsMayBecomeOthers) {
    Home home("cube id=cup at=2,0 size=0.1\nzone id=far at=-4,-4 size=1,1\n",
              "human id=ann at=0,0\n", "at 00:00:01 ann carries cup to far\n");
    home.run(0.5);
    home.act("DELETE cup");
    home.act("ADD wall id=cup from=3,-1 to=3,1");
    home.run(20);
    EXPECT_NE(home.marks().find("cup is nothing to carry"), std::string::npos) << home.marks();
}

TEST(Deeds, NobodyLiesOnAFloor) {
    Home home("floor id=rug at=2,0 size=2,1.2\n", "human id=ann at=0,0\n",
              "at 00:00:01 ann lies on rug 3s\n");
    home.run(20);
    EXPECT_NE(home.marks().find("one does not lie on rug"), std::string::npos) << home.marks();
}

TEST(Deeds, FallsInterruptThePlan) {
    // On a way, and while it uses a thing for longer.
    for (const char* const first : {"goes far; stays 3s", "stays 40s; goes far"}) {
        Home home("zone id=far at=4,4 size=1,1\n", "human id=bob at=-4,-4\n",
                  std::string("at 00:00 bob ") + first + "\nat 00:00:03 bob falls\n");
        home.run(3.5);
        EXPECT_EQ(home.states(), "bob.posture=fallen ") << first;
        const Point2 where = home.at("bob").position;
        home.run(45);
        EXPECT_EQ(home.at("bob").position, where) << first;
        EXPECT_EQ(home.marks(), "") << "the rest of the line is dropped";
    }
}

TEST(Deeds, FallenPeopleGoNowhere) {
    Home home("zone id=far at=3,3 size=1,1\n", "human id=bob at=0,0\n",
              "at 00:00 bob falls; goes far; points at far 2s\n");
    home.run(5);
    EXPECT_EQ(home.marks(),
              "script: bob goes far: it has fallen script: bob points at far 2s: it has fallen ");
    EXPECT_EQ(home.at("bob").position, (Point2{0, 0}));
    home.world().command(0, {.verb = Verb::Stop});
}

TEST(Deeds, BodiesFallWhereTheyHaveRoom) {
    // A wall ahead, and room along it.
    Home home("", "human id=bob at=4.6,0\nhuman id=ann at=0,0 heading=77\n",
              "at 00:00 bob falls\nat 00:00 ann falls\n");
    home.run(1);
    EXPECT_NEAR(std::abs(home.at("bob").heading.degrees()), 90, 1e-9);
    EXPECT_NEAR(home.at("ann").heading.degrees(), 77, 1e-9);
}

TEST(Deeds, PeoplePointAtThingsAndPeople) {
    Home home("lamp id=lamp1 at=0,3\n", "human id=ann at=0,0\nhuman id=bob at=-3,-0.5\n",
              "at 00:00 ann points at lamp1 2s; points at bob 3s\n");
    home.run(2.5);
    const Pose2 pose = home.at("ann");
    EXPECT_NEAR(pose.heading.degrees(), 90, 1) << "she has turned to it";
    const Record* ann = nullptr;
    for (std::size_t i = 0; i < home.world().scene().ids.size(); ++i)
        if (home.world().scene().ids[i] == "ann") ann = &home.world().scene().records[i];
    ASSERT_NE(ann, nullptr);
    const PersonPosture posture = postureOf(*ann);
    ASSERT_TRUE(posture.left || posture.right);
    const bool is_left = posture.left && posture.left->pitch > Angle();
    const ArmPose arm = is_left ? *posture.left : *posture.right;
    // From the shoulder through the hand to the lamp in the ceiling.
    EXPECT_NEAR(pointOf(home.world(), "lamp1")->z, home.world().scene().environment.height(), 1e-9);
    const Point3 shoulder = placed(pose, shoulderOf(posture, is_left ? 1 : -1));
    const Point3 hand = placed(pose, handOf(posture, arm, is_left ? 1 : -1));
    const Vec3 way = hand - shoulder, whole = *pointOf(home.world(), "lamp1") - shoulder;
    EXPECT_NEAR(length(cross(way, whole)) / (length(way) * length(whole)), 0, 2e-3);
    EXPECT_NEAR(length(way), 0.731, 2e-3);
    home.run(2);
    EXPECT_GT(std::abs(home.at("ann").heading.degrees()), 130) << "she has turned to bob";
    home.run(3);
    EXPECT_EQ(home.world().people().front().figure, nullptr);
    EXPECT_EQ(home.marks(), "");
}

TEST(Deeds, PeoplePointAtTheChestsOfThoseWhoRest) {
    const auto chest = [](const std::string& keys) {
        const Scene scene = sceneOf("human id=bob at=1,2 heading=90 height=1.7 " + keys + "\n");
        const World world(scene, milliseconds(100));
        return pointOf(world, "bob").value();
    };
    const auto expect = [&](const std::string& keys, Point3 wanted) {
        const Point3 found = chest(keys);
        EXPECT_NEAR(length(found - wanted), 0, 1e-9)
            << keys << ": " << found.x << ',' << found.y << ',' << found.z;
    };
    const double h = 1.7, up = 0.75 * h, hip = 0.48 * h, middle = (0.48 + 0.87) / 2 * h;
    expect("", {1, 2, up});
    expect("left_arm=0,0", {1, 2, up});
    expect("posture=sit support=0.45", {1, 2, 0.45 + up - hip});
    // The chest is ahead of the middle of the trunk.
    expect("posture=lie support=0.5", {1, 2 + up - middle, 0.5 + 0.06 * h});
    expect("posture=fallen", {1, 2 + up - middle, 0.06 * h});
}

TEST(Deeds, PeopleReachForThings) {
    Home home("cube id=table at=2,0 size=1,1,0.9\n", "human id=ann at=0,0\n",
              "at 00:00 ann reaches table 5s\n");
    for (int i = 0; i < 300 && home.states().empty(); ++i) home.run(0.1);
    const std::string raised = home.states();
    EXPECT_NE(raised.find("_arm="), std::string::npos) << raised;
    ASSERT_NE(home.world().people().front().figure, nullptr);
    home.runTo(raised + raised.substr(0, raised.find('=')) + "=0,-90 ");
    EXPECT_EQ(home.world().people().front().figure, nullptr);
}

/// A person with a thing in its hand: laser beams meet the thing there, and no longer where it was.
TEST(Deeds, PeopleCarryThings) {
    const std::string room =
        "cube id=counter at=2.5,0 size=0.6,2,0.9\ncube id=cup at=2.4,0,0.9 size=0.1,0.1,0.12\n"
        "cube id=trunk at=0,3 size=1,1,1\nzone id=kitchen at=-3,-2 size=2,2\n";
    Home home(room, "human id=ann at=0,0\nhuman id=bob at=0,1.5\ntag id=t on=cup at=0.01,0,0.02\n",
              "at 00:00 ann carries cup to kitchen; carries cup to counter\n"
              "at 00:00:01 bob carries trunk to kitchen\n");
    const auto element = [&](std::string_view id) -> const Element& {
        for (const Element& each : home.world().scene().environment.elements())
            if (each.id == id) return each;
        throw std::logic_error("no such element");
    };
    const auto tag = [&] { return home.world().scene().sensors.front(); };
    EXPECT_NEAR(length(tag().pose.position - Point3{2.41, 0, 1.04}), 0, 1e-9);
    home.runTo("ann.holds=cup ");
    const auto carries = std::find_if(personVerbs().begin(), personVerbs().end(),
                                      [](const PersonVerb& one) { return one.verb == "carries"; });
    ASSERT_NE(carries, personVerbs().end());
    const auto reason = [&](const std::string& thing) {
        return carries->refusal({&home.world(), 1, nullptr, "bob", thing});
    };
    EXPECT_EQ(reason("cup"), "ann carries cup");
    EXPECT_EQ(reason("trunk"), "trunk is larger than 0.6 m");
    EXPECT_EQ(home.marks(), "script: bob carries trunk to kitchen: trunk is larger than 0.6 m ");
    EXPECT_TRUE(element("cup").body.prisms.empty());
    EXPECT_EQ(tag().person, std::optional<std::size_t>(0));
    const auto figure = home.world().people().front().figure;
    ASSERT_NE(figure, nullptr);
    EXPECT_EQ(figure->rest, "");
    // The right hand is 0.6 m from the shoulder, 35 degrees down, and the cup stands on it.
    const double p = -35 * std::numbers::pi / 180;
    const Point3 palm{0.6 * std::cos(p), -0.125 * kHeight,
                      0.845 * kHeight + 0.6 * std::sin(p) + 0.025 * kHeight};
    EXPECT_NEAR(length(figure->load - palm), 0, 1e-9);
    const BodyPart& cup = figure->fixed.back();
    EXPECT_EQ(cup.half_length, 0.05);
    EXPECT_NEAR(cup.top, palm.z + 0.12, 1e-9);
    const Pose2 ann = home.world().people().front().pose;
    EXPECT_NEAR(length(tag().pose.position - placed(ann, {palm.x + 0.01, palm.y, palm.z + 0.14})),
                0, 1e-9);
    home.runTo("ann.holds=cup ann.holds=none ");
    EXPECT_NEAR(element("cup").body.prisms.front().bottom, 0, 1e-9) << "on the floor";
    home.runTo("ann.holds=cup ann.holds=none ann.holds=cup ");
    home.runTo("ann.holds=cup ann.holds=none ann.holds=cup ann.holds=none ");
    EXPECT_EQ(home.world().people().front().figure, nullptr);
    ASSERT_EQ(element("cup").body.prisms.size(), 1U);
    EXPECT_NEAR(element("cup").body.prisms.front().bottom, 0.9, 1e-9) << "on the counter again";
    EXPECT_FALSE(tag().person);
    EXPECT_NEAR(tag().pose.position.z, 1.04, 1e-9);
}

TEST(Deeds, ThingsFallWithPeople) {
    Home home("cube id=cup at=1,0 size=0.1,0.1,0.12\nzone id=far at=-4,0 size=1,1\n",
              "human id=ann at=0,0\n", "at 00:00 ann carries cup to far\n");
    home.runTo("ann.holds=cup ");
    const Scene& scene = home.world().scene();
    const auto ann = static_cast<std::size_t>(std::find(scene.ids.begin(), scene.ids.end(), "ann") -
                                              scene.ids.begin());
    for (const PersonVerb& verb : personVerbs())
        if (verb.verb == "falls") {
            const PersonDeed deed =
                verb.begin({&home.world(), 0, &scene.records[ann], "ann", "", "", home.at("ann")});
            EXPECT_NE(deed.change.find("posture=fallen"), std::string::npos);
            home.act(deed.change);
        }
    home.run(1);
    EXPECT_EQ(home.states(), "ann.holds=cup ann.posture=fallen ann.holds=none ");
}

TEST(Deeds, ThingsDropWhereTheyHaveRoom) {
    constexpr std::string_view kFallen = "ann.posture=fallen ";
    const std::string cup = "cube id=cup at=0,0 size=0.1,0.1,0.12 carried=ann\n";
    // A wall ahead and at both sides, then a desk ahead.
    for (const char* const around :
         {"wall from=-4.2,-0.6 to=-4.2,0.6\nwall from=-4.2,-0.6 to=-3,-0.6\n"
          "wall from=-4.2,0.6 to=-3,0.6\n",
          "desk at=-2.8,0 size=1,2,0.8\n"}) {
        Home home(cup + around, "human id=ann at=-3.8,0 heading=180\n", "at 00:00 ann falls\n");
        home.run(1);
        EXPECT_TRUE(home.states().starts_with(kFallen)) << home.states() << home.marks();
        ASSERT_EQ(home.element("cup").body.prisms.size(), 1U) << around;
        const Obstacles things(home.world().scene().environment.band(0.2, 0.3));
        const Prism& dropped = home.element("cup").body.prisms.front();
        const Point2 at{(dropped.footprint[0].x + dropped.footprint[2].x) / 2,
                        (dropped.footprint[0].y + dropped.footprint[2].y) / 2};
        EXPECT_FALSE(things.overlap(at, 0.07)) << at.x << ' ' << at.y;
        EXPECT_LT(distance(at, home.at("ann").position), 1.5);
        EXPECT_FALSE(things.near({home.at("ann").position, at}, 0));
    }
    // In a narrow closet there is no room: the cup stays in the hand.
    Home closet(cup +
                    "wall from=-0.35,-0.35 to=0.35,-0.35\nwall from=0.35,-0.35 to=0.35,0.35\n"
                    "wall from=0.35,0.35 to=-0.35,0.35\nwall from=-0.35,0.35 to=-0.35,-0.35\n",
                "human id=ann at=0,0\n", "at 00:00 ann falls\n");
    closet.run(1);
    EXPECT_EQ(closet.states(), kFallen);
    EXPECT_TRUE(closet.element("cup").body.prisms.empty());
}

TEST(Deeds, ThingsAreSetDownBesideOthers) {
    for (const char* const things :
         {"", "cylinder id=vase at=1.75,0,0.7 size=0.15,0.15 height=0.3\n",
          "cube id=shelf at=1.7,0.1,0.75 size=0.2,1,0.02\n"}) {
        Home home(
            "cube id=table at=2,0 size=0.8,0.8,0.7\nzone id=far at=-3,0 size=1,1\n"
            "cube id=cup at=0.9,0 size=0.1,0.1,0.12\n" +
                std::string(things),
            "human id=ann at=0.5,0\n", "at 00:00 ann carries cup to table\n");
        home.runTo("ann.holds=cup ann.holds=none ");
        EXPECT_EQ(home.marks(), "");
        const Prism& set = home.element("cup").body.prisms.front();
        EXPECT_NEAR(set.bottom, 0.7, 1e-9) << things;
        const Point2 at{(set.footprint[0].x + set.footprint[2].x) / 2,
                        (set.footprint[0].y + set.footprint[2].y) / 2};
        EXPECT_LE(std::abs(at.x - 2), 0.35 + 1e-9);
        EXPECT_LE(std::abs(at.y), 0.35 + 1e-9);
        EXPECT_LE(distance(at, home.at("ann").position), 1);
        for (const Element& other : home.world().scene().environment.elements()) {
            if (other.id != "vase" && other.id != "shelf") continue;
            for (const Point2 corner : set.footprint)
                for (const Prism& prism : other.body.prisms)
                    EXPECT_EQ(locate(prism.footprint, corner), Side::Outside) << things;
        }
    }
    // No room: a box covers the table.
    Home full(
        "cube id=table at=2,0 size=0.8,0.8,0.7\ncube id=box at=2,0,0.7 size=0.7,0.7,0.3\n"
        "cube id=cup at=0.9,0 size=0.1,0.1,0.12\n",
        "human id=ann at=0.5,0\n", "at 00:00 ann carries cup to table\n");
    full.run(15);
    EXPECT_EQ(full.states(), "ann.holds=cup ");
    EXPECT_EQ(full.marks(), "script: ann carries cup to table: there is no room on table ");
}

TEST(Deeds, ThatTheWorldRefusesAreGivenUp) {
    addPersonVerb({.verb = "floats", .begin = [](const DeedMoment& moment) -> PersonDeed {
                       return {"SET " + moment.id + ".right_arm=0,91", ""};
                   }});
    addPersonVerb({.verb = "waves",
                   .lasts = true,
                   .begin = [](const DeedMoment& moment) -> PersonDeed {
                       return {"SET " + moment.id + ".right_arm=0,60", ""};
                   },
                   .end = [](const DeedMoment& moment) -> PersonDeed {
                       return {"SET " + moment.id + ".right_arm=0,91", ""};
                   }});
    Home home("", "human id=ann at=0,0\n", "at 00:00 ann floats; waves 2s; stays 1s\n");
    home.run(5);
    EXPECT_EQ(home.states(), "ann.right_arm=0,60 ");
    EXPECT_EQ(home.ends(), "floats: given up, waves 2s: given up, stays 1s: done, ");
    const std::string reason =
        "`right_arm`: wanted a pitch from -90 (hanging) to 90 degrees (up), found 91 ";
    EXPECT_EQ(home.marks(), "script: ann floats: " + reason + "script: ann waves 2s: " + reason);
}

TEST(Deeds, ArmsAreLoweredToLieDown) {
    Home home("cube id=bed at=1.5,0 size=2,1,0.5\n",
              "human id=ann at=0,0 right_arm=0,10 left_arm=20,-90\n",
              "at 00:00 ann lies on bed 3s\n");
    home.runTo("ann.posture=lie ann.right_arm=0,-90 ");
    EXPECT_EQ(home.marks(), "");
}

/// Adds a verb like another one, which begins at once.
void addVerbAtOnce(const std::string& like, const std::string& name) {
    for (const PersonVerb& verb : std::vector<PersonVerb>(personVerbs())) {
        if (verb.verb != like) continue;
        PersonVerb at_once = verb;
        at_once.verb = name;
        at_once.approach = PersonVerb::Approach::None;
        at_once.then = nullptr;
        addPersonVerb(at_once);
    }
}

/// Two people begin a deed in one step.
TEST(Deeds, OneOfTwoIsFirst) {
    static_cast<void>(sceneOf(""));
    addVerbAtOnce("carries", "grabs");
    addVerbAtOnce("sits", "flops");
    Home cup("cube id=cup at=0,0 size=0.1,0.1,0.12\n",
             "human id=ann at=1,0\nhuman id=bob at=-1,0\n",
             "at 00:00 ann grabs cup\nat 00:00 bob grabs cup\n");
    cup.run(1);
    EXPECT_EQ(cup.states(), "ann.holds=cup ");
    EXPECT_EQ(cup.marks(), "script: bob grabs cup: ann carries cup ");
    EXPECT_EQ(cup.ends(), "grabs cup: done, grabs cup: given up, ");
    Home stool("cube id=stool at=0,0 size=0.4,0.4,0.45\n",
               "human id=ann at=1,0\nhuman id=bob at=-1,0\n",
               "at 00:00 ann flops on stool 9s\nat 00:00 bob flops on stool 9s\n");
    stool.run(1);
    EXPECT_EQ(stool.states(), "ann.posture=sit ");
    EXPECT_EQ(stool.marks(), "script: bob flops on stool 9s: all of stool is taken ");
}

TEST(Postures, CarriedThingsNeedTheirPeople) {
    const auto refusal = [](const std::string& people, const std::string& things) -> std::string {
        try {
            sceneOf(people, std::string(kRoom) + things);
        } catch (const FormatError& error) {
            return error.diagnostics().front().message;
        }
        return "";
    };
    const std::string ann = "human id=ann at=0,0", cup = "cube id=cup at=2,0 size=0.1 carried=";
    EXPECT_EQ(refusal(ann + '\n', cup + "anna\n"), "no person has the id `anna`, which carries it");
    EXPECT_EQ(refusal(ann + '\n', cup + "ann\ncube id=jug at=2,2 size=0.1 carried=ann\n"),
              "human ann carries cup and jug: one thing is in the hand");
    EXPECT_EQ(refusal(ann + '\n', "cube id=trunk at=2,0 size=0.1,0.7,0.1 carried=ann\n"),
              "`carried`: a person carries things of at most 0.6 m");
    EXPECT_EQ(refusal(ann + '\n', "cylinder id=pipe at=2,0 size=0.6,0.6 height=0.6 carried=ann\n"),
              "");
    // States tell it without the key, whatever a file of a run tells that was edited since.
    std::string states;
    for (const RoomState& state :
         roomStates(sceneOf(ann + " holds=mug\n", std::string(kRoom) + cup + "ann\n")))
        states += state.id + '.' + state.key + '=' + state.value + ' ';
    EXPECT_EQ(states, "ann.holds=cup ");
}

/// Changes of a running world, made and refused as those of files.
TEST(Postures, ChangesKeepThingsInOneHand) {
    Home home("cube id=cup at=2,0 size=0.1\ncube id=jug at=2,2 size=0.1\n",
              "human id=ann at=0,0\nhuman id=bob at=0,2\n", "");
    const auto answer = [&](const std::string& change) -> std::string {
        try {
            home.act(change);
        } catch (const FormatError& error) {
            return error.diagnostics().front().message;
        }
        return "";
    };
    EXPECT_EQ(answer("SET cup.carried=ann"), "");
    home.run(0.1);
    EXPECT_EQ(home.states(), "ann.holds=cup ");
    EXPECT_NE(answer("ACT jug carried=ann"), "");
    EXPECT_NE(answer("ADD cube id=pot at=1,1 size=0.1 carried=ann"), "");
    EXPECT_NE(answer("SET cup.size=0.7"), "");
    EXPECT_EQ(answer("SET ann.holds=none"),
              "human ann holds none, but carries cup; `holds` follows from `carried` of things: "
              "leave it out, or set cup.carried=");
    EXPECT_EQ(
        answer("SET bob.holds=cup"),
        "human bob holds cup, but carries no thing; `holds` follows from `carried` of things: "
        "leave it out, or set cup.carried=bob");
    EXPECT_TRUE(answer("SET ann.holds=jug").ends_with("set cup.carried= and jug.carried=ann"));
    EXPECT_NE(answer("DELETE ann"), "");
    // From hand to hand.
    EXPECT_EQ(answer("SET cup.carried=bob"), "");
    home.run(0.1);
    EXPECT_EQ(home.states(), "ann.holds=cup ann.holds=none bob.holds=cup ");
    EXPECT_EQ(answer("DELETE cup"), "");
    home.run(0.1);
    EXPECT_EQ(home.states(), "ann.holds=cup ann.holds=none bob.holds=cup bob.holds=none ");
}

/// Changes by the editor, as clients make them.
TEST(Postures, StandUpWhereThereIsRoom) {
    const Scene scene = sceneOf(
        "human id=ann at=2,0 posture=sit support=0.45\nhuman id=bob at=-2,0 posture=fallen\n",
        std::string(kRoom) +
            "cube id=sofa at=2,0 size=1,2,0.45\nwall id=w from=-2.1,1 to=-2.1,-1\n");
    World world(scene, milliseconds(100));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    const WorldEditor editor(simulation, std::make_shared<testing::ShippedSource>());
    const auto answer = [&](const std::string& change) -> std::string {
        try {
            editor.edit(parseEdits(change)).carryOut();
        } catch (const FormatError& error) {
            return error.diagnostics().front().message;
        }
        return "";
    };
    EXPECT_EQ(answer("SET ann.posture=stand"),
              "there is no room to stand at 2.00,0.00: sofa is there; set `at` first");
    EXPECT_EQ(answer("SET bob.posture=stand"),
              "there is no room to stand at -2.00,0.00: w is there; set `at` first");
    EXPECT_EQ(answer("SET [ab]*.posture=stand"),
              "there is no room to stand at 2.00,0.00: sofa is there; set `at` first");
    EXPECT_EQ(answer("ACT ann posture=stand at=2.2,0"),
              "there is no room to stand at 2.20,0.00: sofa is there; set `at` first");
    EXPECT_EQ(answer("ACT ann posture=stand at=2.8,0"), "");
    EXPECT_EQ(answer("SET ann.posture=fallen"), "");
    EXPECT_EQ(answer("SET ann.posture=stand"), "");
}

TEST(Deeds, SeatsAndBedsAreFound) {
    const Scene scene = sceneOf("", std::string(kRoom) +
                                        "cube id=sofa at=0,0 size=2,0.8,0.45\n"
                                        "cube id=cupboard at=0,3 size=1,0.5,1.8\n"
                                        "cube id=bed at=3,0 size=1,2,0.5\n");
    const auto element = [&](std::string_view id) -> const Element& {
        for (const Element& each : scene.environment.elements())
            if (each.id == id) return each;
        throw std::logic_error("no such element");
    };
    const auto seat = seatOn(element("sofa"), {0.5, -1}, kHeight);
    ASSERT_TRUE(seat);
    EXPECT_NEAR(seat->support, 0.45, 1e-12);
    EXPECT_NEAR(seat->pose.position.x, 0.5, 1e-9);
    EXPECT_NEAR(seat->pose.position.y, -0.2, 1e-9);
    EXPECT_NEAR(seat->pose.heading.degrees(), -90, 1e-9);
    EXPECT_FALSE(seatOn(element("cupboard"), {0, 2}, kHeight));
    EXPECT_FALSE(bedOn(element("cupboard"), kHeight));
    const auto bed = bedOn(element("bed"), kHeight, 0.1);
    ASSERT_TRUE(bed);
    EXPECT_NEAR(bed->pose.heading.degrees(), 90, 1e-9);
    EXPECT_NEAR(bed->pose.position.y, 0.175 * kHeight, 1e-9);
    EXPECT_NEAR(bed->pose.position.x, 2.9, 1e-9);
}

TEST(Deeds, AreReadWithHints) {
    const Scene scene =
        sceneOf("human id=ann at=0,0\n", std::string(kRoom) + "chair id=chair1 at=2,0\n");
    const World world(scene, milliseconds(100));
    const auto finding = [&](const std::string& action) -> std::string {
        try {
            days::readDayPlan("at 00:00 ann " + action + "\n", "s", world);
        } catch (const FormatError& error) {
            return error.diagnostics().front().message;
        }
        return "";
    };
    EXPECT_EQ(finding("sits on chair1 3min"), "");
    EXPECT_EQ(finding("points at ann 2s; falls; stands"), "");
    EXPECT_EQ(finding("sits chair1 3min"),
              "`sits chair1 3min` is no action, wanted one like sits on chair1 2s");
    EXPECT_EQ(finding("sits on chair2 3min"),
              "no zone or element with a place has the id `chair2`, did you mean `chair1`?");
    EXPECT_EQ(finding("falls down"), "`falls down` is no action, wanted one like falls");
    EXPECT_EQ(finding("lies on chair1 long"),
              "`long` is no duration, wanted one like 90s, 3min or 1h");
    EXPECT_EQ(finding("stnds"), "`stnds` is no action, did you mean `stands`?");
}

}  // namespace postures_test
}  // namespace ispace::postures
