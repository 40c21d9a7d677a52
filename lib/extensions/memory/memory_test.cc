// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/memory/memory.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "extensions/memory/touches.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/session.h"

namespace ispace::memory {
namespace memory_test {

constexpr std::string_view kRoom = R"(#env 1
fence path=-4,-3;4,-3;4,3;-4,3 closed=yes height=2.8
inside at=0,0
)";

Scene sceneOf(const std::string& layout) {
    static const bool added = [] {
        addSceneSchemas(volumeSchemas());
        return true;
    }();
    EXPECT_TRUE(added);
    const Document placed = readRecordText("#3dm 1\n" + layout, "room.3dm", sceneSchemas());
    return makeScene(readRecordText(kRoom, "room.env", sceneSchemas()), &placed, shippedDevices());
}

TEST(VolumeRecord, IsABallOrABox) {
    const std::vector<Volume> volumes =
        volumesOf(sceneOf("volume id=news at=1,2 content=\"today's headline\"\n"
                          "volume id=box at=1,2,0.5 size=0.4,0.2,1 heading=90 dwell=2s\n"
                          "volume id=ball at=0,0,1 radius=30cm\n"),
                  "ground/", 3);
    ASSERT_EQ(volumes.size(), 3U);
    EXPECT_EQ(volumes[0].id, "ground/news");
    EXPECT_EQ(volumes[0].room, 3U);
    EXPECT_EQ(volumes[0].at, (Point3{1, 2, 1.2}));
    EXPECT_EQ(volumes[0].radius, 0.2);
    EXPECT_EQ(volumes[0].content, "today's headline");
    EXPECT_EQ(volumes[1].dwell, 2);
    EXPECT_EQ(volumes[2].radius, 0.3);
    // The box is turned: 0.4 m along y.
    EXPECT_TRUE(volumes[1].contains({1.099, 2.199, 0.999}));
    EXPECT_FALSE(volumes[1].contains({1.101, 2, 0.5}));
    EXPECT_FALSE(volumes[1].contains({1, 2.201, 0.5}));
    EXPECT_FALSE(volumes[1].contains({1, 2, 1.001}));
    EXPECT_TRUE(volumes[2].contains({0, 0.3, 1}));
    EXPECT_FALSE(volumes[2].contains({0.2, 0.2, 1.2}));
    EXPECT_THROW(volumesOf(sceneOf("volume at=0,0 radius=1 size=1,1,1\n"), "", 0), FormatError);
    EXPECT_THROW(sceneOf("volume radius=1\n"), FormatError);
    EXPECT_THROW(sceneOf("volume at=0,0 radius=0\n"), FormatError);
}

TEST(VolumeIndex, FindsWhatContainsAPointAsASearchOfAllDoes) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-5, 5), size(0.05, 1.5);
    VolumeIndex index;
    std::vector<Volume> all;
    for (int i = 0; i < 200; ++i) {
        Volume volume{.id = "v" + std::to_string(i), .room = static_cast<std::size_t>(i % 2)};
        volume.at = {place(random), place(random), size(random)};
        volume.radius = size(random);
        if (i % 3 == 0) volume.size = Vec3{size(random), size(random), size(random)};
        volume.heading = 40 * place(random);
        all.push_back(volume);
        EXPECT_TRUE(index.store(volume));
    }
    std::size_t found = 0;
    for (int i = 0; i < 500; ++i) {
        const Point3 point{place(random), place(random), size(random)};
        const std::size_t room = static_cast<std::size_t>(i % 3);
        std::vector<std::string> expected;
        for (const Volume& volume : all)
            if (volume.room == room && volume.contains(point)) expected.push_back(volume.id);
        std::vector<std::string> ids;
        double nearest = 0;
        for (const Volume* const volume : index.about(room, point)) {
            ids.push_back(volume->id);
            EXPECT_GE(length(volume->at - point), nearest);
            nearest = length(volume->at - point);
        }
        std::sort(ids.begin(), ids.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(ids, expected);
        found += ids.size();
    }
    EXPECT_GT(found, 300U);
    EXPECT_TRUE(index.forget("v0"));
    EXPECT_FALSE(index.forget("v0"));
    EXPECT_EQ(index.find("v0"), nullptr);
}

TEST(VolumeIndex, HasAMost) {
    VolumeIndex index;
    for (std::size_t i = 0; i < VolumeIndex::kMost; ++i)
        ASSERT_TRUE(index.store({.id = std::to_string(i)}));
    EXPECT_FALSE(index.store({.id = "one more"}));
    EXPECT_TRUE(index.store({.id = "7", .content = "replaced"}));
    EXPECT_EQ(index.find("7")->content, "replaced");
}

TEST(Touches, BeginStayAndEnd) {
    const Volume volume{.id = "v", .dwell = 0.5};
    const auto at = [](int ms) { return SimTime(std::chrono::milliseconds(ms)); };
    Touches touches;
    std::string told;
    const auto tell = [&](const std::vector<Touch>& all) {
        for (const Touch& each : all)
            told += each.tag + "TDL"[static_cast<std::size_t>(each.kind)] +
                    formatMilliseconds(each.time) + "/" + formatMilliseconds(each.lasted) + " ";
    };
    for (int ms = 0; ms <= 2000; ms += 100) {
        // One tag is inside from 0.2 s on, but for a reading; the other for a moment.
        const bool is_in = ms >= 200 && ms <= 1000 && ms != 500;
        tell(touches.moved(
            "a", is_in ? std::vector<const Volume*>{&volume} : std::vector<const Volume*>{},
            at(ms)));
        if (ms == 400) {
            tell(touches.moved("b", {&volume}, at(ms)));
            EXPECT_EQ(touches.tagsIn("v"), (std::vector<std::string>{"a", "b"}));
        }
        tell(touches.passed(at(ms)));
    }
    EXPECT_EQ(told, "aT0.200/0.000 bT0.400/0.000 aD0.700/0.500 bL0.700/0.000 aL1.300/0.800 ");
    EXPECT_TRUE(touches.tagsIn("v").empty());
}

/// A person with a tag in the hand walks along y=0, past receivers on the ceiling.
class MemoryTest : public ::testing::Test {
  protected:
    MemoryTest()
        : scene_(sceneOf(
              "ultrasound at=-3,-2,2.7 tilt=-90 range=9 fov=170\n"
              "ultrasound at=3,-2,2.6 tilt=-90 range=9 fov=170\n"
              "ultrasound at=3,2,2.7 tilt=-90 range=9 fov=170\n"
              "ultrasound at=-3,2,2.5 tilt=-90 range=9 fov=170\n"
              "human id=ann at=-3,0 path=3,0 speed=1\n"
              "tag id=hand on=ann at=0.3,0,1.3 rate=20\n"
              "tag id=other at=2,2,1.3\n"
              "volume id=news at=0,0,1.3 radius=0.25 dwell=0.3 content=\"the headline\"\n")),
          world_(scene_, std::chrono::milliseconds(5)),
          simulation_(world_, {}, parseClock("step"), std::nullopt),
          state_(simulation_),
          room_{"", &simulation_},
          service_(makeMemory({&room_, 1}, 1)) {
        state_.addRoleService(*service_);
        simulation_.events().want({EventKind::State});
    }

    std::string ask(Session& session, const std::string& line) {
        session.request(line);
        return session.take();
    }
    /// Returns what the session receives.
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

TEST_F(MemoryTest, TellsOfTouchesByWhatReceiversMeasure) {
    Session memory(state_), deaf(state_);
    EXPECT_EQ(ask(memory, "MEMORY *"), "OK MEMORY * t=0.000 volumes=1 tags=hand,other\n");
    EXPECT_EQ(ask(deaf, "MEMORY other"), "OK MEMORY other t=0.000 volumes=1 tags=other\n");
    const std::string told = run(1400, memory);
    deaf.proceed();
    EXPECT_EQ(deaf.take(), "");
    // From 0.25 m before to 0.25 m behind at a metre a second, once she walks, and 0.3 s until it
    // has left.
    const std::size_t touch = told.find("EVENT touch t="), dwell = told.find("EVENT dwell t="),
                      leave = told.find("EVENT leave t=");
    ASSERT_EQ(touch, 0U) << told;
    ASSERT_NE(dwell, std::string::npos) << told;
    ASSERT_NE(leave, std::string::npos) << told;
    EXPECT_NE(told.find(" id=news by=hand for=0.000 text=the headline\n"), std::string::npos)
        << told;
    EXPECT_EQ(told.find("EVENT", leave + 1), std::string::npos) << told;
    const auto number = [&](std::size_t from, const char* key) {
        return std::stod(told.substr(told.find(key, from) + 3 + (key[1] == 'f' ? 2U : 0U)));
    };
    const double begun = number(touch, " t="), ended = number(leave, " t=");
    EXPECT_NEAR(begun, 2.6, 0.3);
    EXPECT_NEAR(number(leave, " for="), 0.5, 0.06);
    EXPECT_NEAR(ended - begun, 0.8, 0.06);
    std::string states;
    EventLog& events = simulation_.events();
    for (auto i = events.first(); i < events.next(); ++i)
        states += events.at(i).id + "." + events.at(i).other + "=" + events.at(i).text + " ";
    EXPECT_EQ(states, "news.touched=1 news.touched=0 ");
}

TEST_F(MemoryTest, KeepsAndFindsContents) {
    Session memory(state_);
    ask(memory, "MEMORY hand");
    EXPECT_EQ(ask(memory, "STORE mail 0.1,0,1.3 radius=0.5 two  letters"), "OK STORE mail\n");
    EXPECT_EQ(ask(memory, "FIND 0.1,0,1.3"), "OK FIND n=2 ids=mail,news\n");
    EXPECT_EQ(ask(memory, "FIND 0,0,1.3"), "OK FIND n=2 ids=news,mail\n");
    EXPECT_EQ(ask(memory, "FIND LETTERS"), "OK FIND n=1 ids=mail\n");
    EXPECT_EQ(ask(memory, "FIND 3,3,3"), "OK FIND n=0 ids=\n");
    EXPECT_EQ(ask(memory, "RECALL mail"),
              "OK RECALL id=mail at=0.100,0.000,1.300 radius=0.500 by= text=two  letters\n");
    // Without words it moves, and keeps what it has.
    EXPECT_EQ(ask(memory, "STORE mail 1,1"), "OK STORE mail\n");
    EXPECT_EQ(ask(memory, "RECALL mail"),
              "OK RECALL id=mail at=1.000,1.000,1.200 radius=0.500 by= text=two  letters\n");
    EXPECT_EQ(ask(memory, "FORGET mail"), "OK FORGET mail\n");
    EXPECT_EQ(ask(memory, "RECALL newt"), "ERR 404 no volume `newt`, did you mean `news`?\n");
    for (const char* const bad : {"STORE a,b 1,2", "STORE a 1", "STORE a 1,2,3,4", "STORE a 1,x",
                                  "STORE a ground/1,2", "STORE a 1,2,", "STORE a 1e9,2", "STORE a"})
        EXPECT_EQ(ask(memory, bad).substr(0, 8), "ERR 400 ") << bad;
    EXPECT_EQ(ask(memory, "STORE a 1,2 radius=0").substr(0, 8), "ERR 416 ");
    EXPECT_EQ(ask(memory, "STORE a 1,2 " + std::string(1001, 'x')).substr(0, 8), "ERR 413 ");
    EXPECT_NE(ask(memory, "HELP").find("STORE id [storey/]x,y[,z] [radius=m] [text]"),
              std::string::npos);
    EXPECT_EQ(ask(memory, "SCAN hand").substr(0, 10), "SCAN hand ");
}

TEST(Memory, TellsOfAForgottenVolumeInItsRoom) {
    const Scene ground = sceneOf("volume id=news at=0,0\n");
    const Scene upper = sceneOf(
        "ultrasound at=-3,-2,2.7 tilt=-90 range=9 fov=170\n"
        "ultrasound at=3,-2,2.6 tilt=-90 range=9 fov=170\n"
        "ultrasound at=3,2,2.7 tilt=-90 range=9 fov=170\n"
        "ultrasound at=-3,2,2.5 tilt=-90 range=9 fov=170\n"
        "tag id=hand at=0,0,1.3 rate=20\n"
        "volume id=mail at=0,0,1.3\n");
    World low(ground, std::chrono::milliseconds(5)), high(upper, std::chrono::milliseconds(5));
    Simulation below(low, {}, parseClock("step"), std::nullopt);
    Simulation above(high, {}, parseClock("step"), std::nullopt);
    const RunRoom rooms[] = {{"ground", &below}, {"upper", &above}};
    const auto service = makeMemory(rooms, 1);
    const auto run = [&] {
        for (int i = 0; i < 200; ++i) {
            for (const RunRoom& room : rooms) {
                room.simulation->allow(1);
                room.simulation->run(std::chrono::steady_clock::now(), std::chrono::seconds(1));
            }
            service->stepped();
        }
    };
    const auto states = [](Simulation& simulation) {
        EventLog& events = simulation.events();
        std::string text;
        for (auto i = events.first(); i < events.next(); ++i)
            text.append(events.at(i).id).append("=").append(events.at(i).text).append(" ");
        return text;
    };
    below.events().want({EventKind::State});
    above.events().want({EventKind::State});
    std::string answer;
    const auto client = service->take("*", answer);
    run();
    EXPECT_EQ(states(above), "mail=1 ");
    const std::string_view forget[] = {"FORGET", "upper/mail"};
    EXPECT_EQ(client->request(forget).line, "OK FORGET upper/mail\n");
    run();
    EXPECT_EQ(states(above), "mail=1 mail=0 ");
    EXPECT_EQ(states(below), "");
}

TEST(Memory, IsNoneWithoutVolumesAndTags) {
    const Scene scene = sceneOf("robot id=r1 at=0,0\n");
    World world(scene, std::chrono::milliseconds(5));
    Simulation simulation(world, {}, parseClock("step"), std::nullopt);
    const RunRoom room{"", &simulation};
    EXPECT_EQ(makeMemory({&room, 1}, 1), nullptr);
}

}  // namespace memory_test
}  // namespace ispace::memory
