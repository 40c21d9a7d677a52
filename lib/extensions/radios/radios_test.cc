// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "cli/common_options.h"
#include "extensions/radios/radio.h"
#include "extensions/radios/radio_role.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/server_state.h"
#include "server/session.h"
#include "sim/simulation.h"

namespace ispace::radios {
namespace radios_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

Scene sceneOf(const std::string& records) {
    static const bool added = [] {
        addSceneSchemas(radioSchemas());
        addRadios();
        return true;
    }();
    EXPECT_TRUE(added);
    return makeScene(readRecordText("#env 1\nispace size=40,10,3\ninside at=-10,0\n" + records,
                                    "room.env", sceneSchemas()),
                     nullptr, shippedDevices());
}

/// Returns the margin between the radios a and b.
std::optional<double> margin(const std::string& records) {
    const Scene scene = sceneOf(records);
    const RayWorld solid = RayWorld::ofEnvironment(scene.environment, Surfaces::Solid);
    const RayWorld opaque = RayWorld::ofEnvironment(scene.environment);
    std::vector<const Record*> radios;
    for (const Record& record : scene.records)
        if (record.keyword() == "radio") radios.push_back(&record);
    const Radio sender = radioOf(*radios[0]);
    return signalMargin(sender, radioCarrier(scene, *radios[0]).pose, radioOf(*radios[1]),
                        radioCarrier(scene, *radios[1]).pose, sender.is_infrared ? opaque : solid);
}

TEST(Radio, ReachesItsRange) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 100; ++i) {
        const Point3 a{-10 + 9 * any(random), 4 * any(random), 1 + 0.5 * any(random)};
        const Point3 b{-10 + 9 * any(random), 4 * any(random), 1 + 0.5 * any(random)};
        const auto text = [](Point3 p) {
            return std::to_string(p.x) + ',' + std::to_string(p.y) + ',' + std::to_string(p.z);
        };
        const double distance = length(b - a);
        const auto found =
            margin("radio id=a range=7 at=" + text(a) + "\nradio id=b at=" + text(b) + '\n');
        ASSERT_EQ(found.has_value(), distance <= 7) << distance;
        if (found) {
            EXPECT_NEAR(*found, 20 * std::log10(7 / distance), 1e-5);
        }
    }
}

TEST(Radio, LosesInWalls) {
    const std::string wall = "wall id=w from=0,-5 to=0,5 height=3\n";
    const auto across = [&](const std::string& keys, const std::string& walls) {
        return margin(walls + "radio id=a at=-3,0,1 range=10 " + keys + "\nradio id=b at=3,0,1 " +
                      keys + '\n');
    };
    const double free = 20 * std::log10(10.0 / 6);
    EXPECT_NEAR(*across("", ""), free, 1e-9);
    EXPECT_FALSE(across("loss=6", wall)) << "4.4 dB are left in free air";
    EXPECT_NEAR(*across("loss=3", wall), free - 3, 1e-9);
    EXPECT_NEAR(*across("loss=2", wall + "wall id=v from=1,-5 to=1,5\n"), free - 4, 1e-9);
    // Glass is a wall for radio, and none for infrared light.
    const std::string glass = wall + "window id=g wall=w offset=5 size=2,0.5,2\n";
    EXPECT_NEAR(*across("loss=3", glass), free - 3, 1e-9);
    EXPECT_FALSE(across("kind=infrared", wall));
    EXPECT_NEAR(*across("kind=infrared", glass), free, 1e-9);
}

TEST(Radio, SendsAndReceivesInItsCone) {
    const auto between = [](const std::string& a, const std::string& b) {
        return margin("radio id=a at=-3,0,1 " + a + "\nradio id=b at=0,1,1 " + b + '\n')
            .has_value();
    };
    // b is at 18.4 degrees from a, and a at -161.6 degrees from b.
    EXPECT_TRUE(between("", ""));
    EXPECT_TRUE(between("fov=40", ""));
    EXPECT_FALSE(between("fov=30", ""));
    EXPECT_TRUE(between("fov=30 heading=18", ""));
    EXPECT_FALSE(between("fov=30 heading=18 tilt=20", ""));
    EXPECT_FALSE(between("", "fov=40"));
    EXPECT_TRUE(between("", "fov=40 heading=180"));
}

TEST(Radio, IsOnAnObject) {
    const Scene scene =
        sceneOf("table id=t at=2,1 heading=90 height=0.7\nradio id=a on=t at=0.3,0,0.1\n");
    const RadioCarrier carrier = radioCarrier(scene, scene.records.back());
    EXPECT_NEAR(carrier.pose.position.x, 2, 1e-12);
    EXPECT_NEAR(carrier.pose.position.y, 1.3, 1e-12);
    EXPECT_NEAR(carrier.pose.position.z, 0.8, 1e-12);
}

TEST(RadioChecks, FindTheLonelyAndTheLost) {
    const auto finding = [](const std::string& records) {
        const Scene scene = sceneOf(records);
        const auto found = checkRadio(scene, scene.records.size() - 1);
        return found ? found->message : "";
    };
    EXPECT_EQ(finding("radio id=a\nradio id=b\n"), "");
    EXPECT_EQ(finding("radio id=a\nradio id=b channel=2\n"), "no other radio is on channel 2 of b");
    EXPECT_EQ(finding("radio id=a kind=infrared\nradio id=b\n"),
              "no other radio is on channel 1 of b");
    // A scene has no others: a request that leads to one is refused.
    EXPECT_THROW(sceneOf("radio id=b on=q\n"), FormatError);
    EXPECT_THROW(sceneOf("zone id=z at=0,0 size=1,1\nradio id=b on=z\n"), FormatError);
    EXPECT_THROW(sceneOf("radio id=a\nradio id=b on=a\n"), FormatError);
}

class RadioRole : public ::testing::Test {
  protected:
    explicit RadioRole(const std::string& more = "")
        : scene_(sceneOf("robot id=r at=-15,0\nhuman id=ann at=-5,3\n"
                         "radio id=base at=-12,0,2 range=6\nradio id=rover on=r range=6\n"
                         "radio id=badge on=ann at=0,0,1.2 range=6 channel=2\n" +
                         more)),
          world_(scene_, milliseconds(100)),
          simulation_(world_, {}, {Clock::Kind::Step, 1}, {}),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makeRadios({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) {
            simulation_.allow(1);
            simulation_.run(std::chrono::steady_clock::now(), seconds(10));
            service_->stepped();
        }
    }
    static std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }
    static std::string heard(Session& session) {
        session.stepped();
        return session.take();
    }

    Scene scene_;
    World world_;
    Simulation simulation_;
    ServerState state_;
    RunRoom room_;
    std::unique_ptr<RoleService> service_;
};

TEST_F(RadioRole, CarriesTextsToThoseInReach) {
    Session base(state_), rover(state_);
    EXPECT_EQ(ask(base, "RADIO base"), "OK RADIO base t=0.000 radios=base\n");
    EXPECT_EQ(ask(rover, "RADIO rover"), "OK RADIO rover t=0.000 radios=rover\n");
    EXPECT_EQ(ask(base, "SEND base go  to 3,4"), "OK SEND id=base t=0.000\n");
    // They are 3 m and 1.5 m in height apart.
    const double free = 20 * std::log10(6 / std::hypot(3, 1.5));
    EXPECT_EQ(heard(rover), "EVENT message t=0.000 id=rover from=base margin=" +
                                formatFixed(free, 1) + " text=go  to 3,4\n");
    EXPECT_EQ(heard(base), "") << "not by itself";
    EXPECT_EQ(ask(rover, "READ rover"), "OK READ id=rover t=0.000 channel=1 sent=0 heard=1\n");
    EXPECT_EQ(ask(base, "READ base"), "OK READ id=base t=0.000 channel=1 sent=1 heard=0\n");
    EXPECT_EQ(ask(base, "SEND rover x").substr(0, 8), "ERR 404 ") << "not one of its radios";
    EXPECT_EQ(ask(base, "SEND base " + std::string(1001, 'x')).substr(0, 8), "ERR 413 ");
    EXPECT_EQ(service_->states(),
              (std::vector<RoomState>{
                  {"badge", "heard", "0"}, {"base", "heard", "0"}, {"rover", "heard", "1"}}));
}

TEST_F(RadioRole, GoesWithItsRobot) {
    Session base(state_), rover(state_);
    ask(base, "RADIO base");
    ask(rover, "RADIO rover");
    world_.command(*world_.moverNamed("r"), {.verb = Verb::Forward, .value = 14});
    bool was_heard = true;
    for (int i = 0; i < 400; ++i) {
        run(1);
        ask(base, "SEND base ping");
        const Point2 place = world_.status(*world_.moverNamed("r")).pose.position;
        const double distance = std::hypot(place.x + 12, place.y, 1.5);
        const bool is_heard = !heard(rover).empty();
        if (std::abs(distance - 6) > 1e-6) {
            EXPECT_EQ(is_heard, distance < 6) << distance;
        }
        was_heard = is_heard;
    }
    EXPECT_FALSE(was_heard) << "at the end it is too far";
}

TEST_F(RadioRole, KeepsChannelsApart) {
    Session all(state_);
    EXPECT_EQ(ask(all, "RADIO *"), "OK RADIO * t=0.000 radios=badge,base,rover\n");
    ask(all, "SEND badge hello");
    EXPECT_EQ(heard(all), "");
    world_.change(makeScene(editedRecords(world_.scene(), parseEdits("ACT base channel=2"),
                                          [](const std::string&) { return std::nullopt; }),
                            world_.scene(), shippedDevices()));
    ask(all, "SEND badge hello");
    EXPECT_EQ(heard(all), "") << "still 7.6 m away";
    world_.change(makeScene(editedRecords(world_.scene(), parseEdits("ACT badge range=9"),
                                          [](const std::string&) { return std::nullopt; }),
                            world_.scene(), shippedDevices()));
    ask(all, "SEND badge hello");
    EXPECT_NE(heard(all).find("id=base from=badge"), std::string::npos);
}

class LossyRadios : public RadioRole {
  protected:
    LossyRadios()
        : RadioRole(
              "radio id=far at=-14,2,1 range=20 drop=20% channel=7\n"
              "radio id=ear at=-10,2,1 drop=10% channel=7\n") {}
};

TEST_F(LossyRadios, LoseTheirShare) {
    Session all(state_);
    ask(all, "RADIO *");
    constexpr int kMessages = 5000;
    for (int i = 0; i < kMessages; ++i) ask(all, "SEND far x");
    const std::string read = ask(all, "READ ear");
    const double heard_count = std::stod(read.substr(read.find("heard=") + 6));
    // 0.8 x 0.9, within four standard deviations.
    EXPECT_NEAR(heard_count / kMessages, 0.72, 4 * std::sqrt(0.72 * 0.28 / kMessages));
    const auto again = makeRadios({&room_, 1}, 1);
    ServerState other_state(simulation_);
    other_state.addRoleService(*again);
    Session other(other_state);
    ask(other, "RADIO *");
    for (int i = 0; i < kMessages; ++i) ask(other, "SEND far x");
    EXPECT_EQ(ask(other, "READ ear"), read) << "the same messages";
}

TEST(RadioService, IsForRadios) {
    const Scene scene = sceneOf("robot id=r\n");
    World world(scene, milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    const RunRoom room{"", &simulation};
    EXPECT_EQ(makeRadios({&room, 1}, 1), nullptr);
}

}  // namespace radios_test
}  // namespace ispace::radios
