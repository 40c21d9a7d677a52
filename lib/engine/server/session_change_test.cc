// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <thread>

#include "support/test_source.h"
#include "support/test_talk.h"

namespace ispace {

using testing::streamed;
using testing::Talk;

namespace session_change_test {

ServerLimits changing() {
    ServerLimits limits;
    limits.source = std::make_shared<testing::TextSource>(std::map<std::string, std::string>{
        {"hall.env", "ispace size=20,20\n"}, {"hall.3dm", "robot id=r1 at=9,9\n"}});
    return limits;
}

/// One whose clients may change the world.
struct Changing : Talk {
    explicit Changing(const ServerLimits& limits = changing())
        : Talk({Clock::Kind::Step, 1}, {}, "", limits) {}
    /// The answer, when the request's turn has come.
    std::string answer(Session& client, std::string_view request) {
        std::string text = ask(client, request);
        while (client.waiting()) {
            std::this_thread::yield();
            client.proceed();
            text += client.take();
        }
        return text;
    }
};

TEST(SessionChange, AddSetDelete) {
    Changing talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.answer(world, "ADD robot at=-2,2"), "OK ADD id=robot1 t=0.000\n");
    EXPECT_EQ(talk.answer(world, "ADD human id=h1 at=2,-2"), "OK ADD id=h1 t=0.000\n");
    EXPECT_EQ(talk.answer(world, "LIST"),
              "OK LIST robots=r1,r2,robot1 lasers=l1,l2 people=h1 sensors=l1,l2\n");
    EXPECT_EQ(talk.answer(world, "SET robot1.at=-2,1"), "OK SET t=0.000\n");
    EXPECT_EQ(talk.answer(world, "SET r2.heading=0"), "OK SET t=0.000\n");
    EXPECT_EQ(talk.answer(world, "POSES"),
              "OK POSES t=0.000 n=3 poses=r1,0.000,0.000,0.000;r2,2.000,1.500,0.000;"
              "robot1,-2.000,1.000,0.000 people=h1,2.000,-2.000,0.000\n");
    EXPECT_EQ(talk.answer(world, "DELETE robot1 h1"), "OK DELETE t=0.000\n");
    EXPECT_EQ(talk.answer(world, "LIST"),
              "OK LIST robots=r1,r2 lasers=l1,l2 people= sensors=l1,l2\n");
}

/// Sends these requests as a client does that does not wait for answers; returns the answers.
std::string together(Changing& talk, Session& client, std::vector<std::string> lines) {
    std::string text;
    while (!lines.empty()) {
        std::size_t joined = std::min(client.mayJoin(lines[0]), lines.size() - 1);
        for (std::size_t i = 1; i <= joined; ++i) client.join(lines[i]);
        text += talk.answer(client, lines[0]);
        lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(joined) + 1);
    }
    return text;
}

TEST(SessionChange, RequestsThatFollowAtOnceShareAChange) {
    std::vector<std::string> lines;
    std::string answers;
    for (int i = 0; i < 200; ++i) {
        lines.push_back("ADD tag at=" + std::to_string(i % 3) + ",1,1");
        answers += "OK ADD id=tag" + std::to_string(i + 1) + " t=0.000\n";
    }
    Changing talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(together(talk, world, lines), answers);
    EXPECT_LT(talk.room.world.changes(), 40) << "changes for 200 requests";
    EXPECT_EQ(talk.room.world.scene().records.back().keyword(), "tag");
    EXPECT_EQ(talk.answer(world, "DELETE tag*"), "OK DELETE t=0.000\n");
}

TEST(SessionChange, ARefusalAmongThemIsAloneInItsTurn) {
    std::vector<std::string> lines;
    lines.reserve(41);
    for (int i = 0; i < 40; ++i) lines.push_back("ADD cube at=" + std::to_string(i - 20) + ",5");
    lines[20] = "ADD cube at=1";
    lines[25] = "ADD cub at=1,1";
    lines[30] = "ADD cube";
    lines[35] = "ADD cube id=cube3 at=1,1";
    lines.insert(lines.begin() + 38, "TIME");
    Changing joined, single;
    Session& client = single.client("WORLD");
    std::string wanted;
    for (const std::string& line : lines) wanted += single.answer(client, line);
    EXPECT_EQ(together(joined, joined.client("WORLD"), lines), wanted);
    EXPECT_EQ(std::count(wanted.begin(), wanted.end(), '\n'), 41);
    EXPECT_LT(joined.room.world.changes(), single.room.world.changes());
}

TEST(SessionChange, RequestsSetThatFollowAtOnceShareAChange) {
    Changing talk;
    Session& world = talk.client("WORLD");
    std::vector<std::string> lines;
    std::string answers;
    lines.reserve(200);
    for (int i = 0; i < 200; ++i) {
        ASSERT_TRUE(talk.answer(world, "ADD tag id=m" + std::to_string(i) + " at=1,1,1")
                        .starts_with("OK ADD "));
        lines.push_back("SET m" + std::to_string(i) + ".at=2,1,1");
        answers += "OK SET t=0.000\n";
    }
    const auto before = talk.room.world.changes();
    EXPECT_EQ(together(talk, world, lines), answers);
    EXPECT_LT(talk.room.world.changes(), before + 40) << "changes for 200 requests";
    for (const Record& record : talk.room.world.scene().records) {
        if (record.keyword() == "tag") {
            EXPECT_EQ(record.tuple("at")[0], 2);
        }
    }
}

/// Requests about few sensors, robots, nodes and sums. A third of them fails or depends on others.
std::vector<std::string> randomSets(std::mt19937_64& random) {
    const std::vector<std::string> good = {"m#.at=2,1,1",       "m#.at=#,1,2",  "l1#.range=#",
                                           "l1#.rate=#",        "l1#.step=0.#", "c#.period=0.#",
                                           "c#.pixels=900,700", "m#.at=-1,#,1"};
    const std::vector<std::string> others = {
        "m#.at=0",          "m#.power=#",    "m#.on=r1",      "m#.on=r9",
        "m#.id=m1#",        "l#.range=-#",   "l1#.step=0.02", "l1#.rate=#00",
        "c#.pixels=7000,9", "r1.heading=#0", "m*.at=1,#,1",   "c#.pixels=7500,7500",
        "n1.sensors=m1#",   "x#.at=1,1",     "l1#.fov=360",   "m#"};
    std::vector<std::string> lines;
    lines.reserve(80);
    for (int i = 0; i < 80; ++i) {
        const std::vector<std::string>& texts = random() % 3 == 0 ? others : good;
        std::string line = "SET ";
        for (const char c : texts[random() % texts.size()])
            line += c == '#' ? static_cast<char>('1' + random() % 9) : c;
        lines.push_back(line);
    }
    return lines;
}

TEST(SessionChange, RequestsSetAreAnsweredAsOneByOne) {
    std::mt19937_64 random(7);
    int refused = 0, saved = 0;
    for (int i = 0; i < 4; ++i) {
        Changing joined, single;
        Session *const together_client = &joined.client("WORLD"), *client = &single.client("WORLD");
        const auto add = [&](const std::string& line) {
            EXPECT_EQ(joined.answer(*together_client, line), single.answer(*client, line));
        };
        for (int k = 1; k < 10; ++k) {
            const std::string n = std::to_string(k);
            for (const std::string& line :
                 {"ADD tag id=m" + n + " at=1,1,1", "ADD laser id=l1" + n + " at=0,1 rate=1",
                  "ADD camera id=c" + n + " at=0,1,1 pixels=1000,700"})
                add(line);
        }
        add("ADD node id=n1 sensors=m1");
        const std::vector<std::string> lines = randomSets(random);
        std::string wanted;
        for (const std::string& line : lines) wanted += single.answer(*client, line);
        EXPECT_EQ(together(joined, *together_client, lines), wanted);
        EXPECT_TRUE(joined.room.world.scene().records == single.room.world.scene().records);
        for (std::size_t at = 0; (at = wanted.find("ERR", at)) != std::string::npos; ++at)
            ++refused;
        saved += static_cast<int>(single.room.world.changes() - joined.room.world.changes());
    }
    EXPECT_GT(refused, 20);
    EXPECT_GT(saved, 15);
}

TEST(SessionChange, RequestsSetExceedNoSumAmongThem) {
    Changing talk;
    Session& world = talk.client("WORLD");
    talk.answer(world, "ADD camera id=c1 at=0,1,1 pixels=7500,7500");
    talk.answer(world, "ADD camera id=c2 at=0,1,1 pixels=900,700");
    for (const char* const id : {"m1", "m2", "m3"})
        talk.answer(world, std::string("ADD tag at=1,1,1 id=") + id);
    EXPECT_GT(world.mayJoin("SET m1.at=2,1,1"), 0U);
    const std::string answers = together(
        talk, world, {"SET c2.pixels=7500,7500", "SET c1.pixels=900,700", "SET m1.at=2,1,1"});
    EXPECT_TRUE(answers.starts_with("ERR 409 the world would have ")) << answers;
    EXPECT_TRUE(answers.ends_with("\nOK SET t=0.000\nOK SET t=0.000\n")) << answers;
}

TEST(SessionChange, EventsOfEachChangeFollowItsAnswer) {
    Changing talk;
    Session& world = talk.client("WORLD");
    talk.answer(world, "EVENTS change");
    for (int i = 0; i < 4; ++i) talk.answer(world, "ADD cube at=1,1");
    EXPECT_EQ(world.mayJoin("ADD cube at=1,1"), 0U);
}

TEST(SessionChange, ActsSetStates) {
    Changing talk;
    Session& world = talk.client("WORLD");
    talk.answer(world, "ADD lamp id=lamp at=1,1");
    EXPECT_EQ(talk.answer(world, "ACT lamp on=0 level=50%"), "OK ACT t=0.000\n");
    EXPECT_EQ(talk.answer(world, "ACT lamp on=1 on=0").substr(0, 8), "ERR 400 ");
    talk.answer(world, "ADD mat id=s1 at=1,1 size=1,1");
    EXPECT_EQ(talk.ask(world, "STATE"),
              "OK STATE t=0.000 lamp.on=0 lamp.level=0.5 lamp.color=1,1,0.97 s1.n=0 s1.on=-\n");
    EXPECT_EQ(talk.ask(world, "STATE s1"), "OK STATE t=0.000 s1.n=0 s1.on=-\n");
    EXPECT_EQ(talk.ask(world, "STATE r1"), "ERR 404 no sensor or actuator `r1` has a state\n");
    talk.ask(world, "EVENTS state,change");
    EXPECT_EQ(talk.answer(world, "ACT lamp on=1"), "OK ACT t=0.000\n");
    talk.step(1);
    EXPECT_EQ(world.take(),
              "EVENT change t=0.000 what=SET lamp.on=yes\nEVENT state t=0.100 id=lamp on=1\n");
    EXPECT_EQ(talk.answer(world, "ACT lamp level=200%").substr(0, 8), "ERR 400 ");
    EXPECT_EQ(talk.answer(world, "ACT lamp at=1,1").substr(0, 8), "ERR 400 ");
    EXPECT_EQ(talk.answer(world, "ACT nobody on=1").substr(0, 8), "ERR 404 ");
    EXPECT_EQ(talk.answer(world, "ACT lamp"),
              "ERR 400 ACT wants an argument: ACT id key=value...\n");
}

TEST(SessionChange, WarnsOfWhatIsOutsideTheRoom) {
    Changing talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.answer(world, "ADD robot id=far at=50,50"),
              "OK ADD id=far t=0.000 warning=robot far stands outside the room at (50.0, 50.0)\n");
    EXPECT_EQ(
        talk.answer(world, "ADD human id=h1 at=2,-2 path=2,0;9,0"),
        "OK ADD id=h1 t=0.000 warning=human h1 has a path that leaves the room at (9.0, 0.0)\n");
    EXPECT_EQ(talk.answer(world, "SET far.at=-2,2"), "OK SET t=0.000\n");
    EXPECT_EQ(talk.answer(world, "SET r2.at=0,7"),
              "OK SET t=0.000 warning=robot r2 stands outside the room at (0.0, 7.0)\n");
    EXPECT_EQ(talk.answer(world, "SET r1.path=1,1;1,-8"),
              "OK SET t=0.000 warning=robot r1 has a path that leaves the room at (1.0, -8.0)\n");
    EXPECT_EQ(talk.answer(world, "SET l1.rate=5"), "OK SET t=0.000\n") << "is about no robot";
    EXPECT_EQ(talk.answer(world, "ADD cube at=-3,0 size=0.1,0.1,1"), "OK ADD id=cube1 t=0.000\n");
    for (const char* at : {"60,0", "61,0", "62,0", "63,0"})
        talk.answer(world, std::string("ADD human at=") + at);
    const std::string many = talk.answer(world, "SET human*.speed=1");
    EXPECT_EQ(std::count(many.begin(), many.end(), ';'), 3) << many;
    EXPECT_TRUE(many.ends_with("; and more\n")) << many;
}

TEST(SessionChange, WhatFailsLeavesTheWorldAsItWas) {
    Changing talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.answer(world, "ADD robot at=0,0.1"),
              "ERR 409 robot r1 overlaps robot1 near (0.0, 0.05); move one, e.g. by 0.45 m\n");
    EXPECT_EQ(talk.answer(world, "ADD human at=2,-1"), "OK ADD id=human1 t=0.000\n");
    EXPECT_EQ(talk.answer(world, "ADD human at=2,-1.1"),
              "ERR 409 human1 overlaps human2 near (2.0, -1.05); move one, e.g. by 0.41 m\n");
    EXPECT_TRUE(talk.answer(world, "DELETE human1").starts_with("OK "));
    EXPECT_EQ(talk.answer(world, "ADD robt at=0,0.1"),
              "ERR 400 unknown keyword `robt`, did you mean `robot`?\n");
    EXPECT_EQ(talk.answer(world, "SET r1.hat=2"),
              "ERR 400 SET r1.hat=2: a robot has no key `hat`, did you mean `at`?\n");
    EXPECT_EQ(talk.answer(world, "SET r1"), "ERR 400 `r1` is not ID.KEY=VALUE\n");
    EXPECT_EQ(talk.answer(world, "SET r7.at=1,1"), "ERR 404 no record `r7`, did you mean `r1`?\n");
    EXPECT_EQ(talk.answer(world, "DELETE r1"),
              "ERR 400 DELETE r1: `l2` has `on=r1`; delete it, too, or set that anew\n");
    EXPECT_EQ(talk.answer(world, "DELETE *a*b*c*"),
              "ERR 404 no record `*a*b*c*`; there is ispace1, r1, r2, l1, l2\n");
    EXPECT_TRUE(talk.answer(world, "DELETE *" + std::string(256, 'a'))
                    .ends_with(" has more than 256 bytes, which a glob may have\n"));
    EXPECT_EQ(talk.answer(world, "DELETE *a *b *c *d *e *f *g *h *i"),
              "ERR 400 a request has at most 8 globs\n");
    EXPECT_EQ(talk.answer(world, "ADD cube at=3,2 size=1 texture=/etc/passwd"),
              "ERR 400 files are out of reach\n");
    EXPECT_EQ(talk.answer(world, "LOAD missing.env"),
              "ERR 409 missing.env: error: No such file or directory\n");
    EXPECT_EQ(talk.answer(world, "SET"), "ERR 400 SET wants an argument: SET id.key=value\n");
    EXPECT_EQ(talk.room.world.changes(), 2);
}

TEST(SessionChange, SumsAreBounded) {
    Changing talk;
    Session& world = talk.client("WORLD");
    std::string answer;
    int lasers = 0;
    // 360 001 beams each.
    const std::string laser = "ADD laser at=0,1 fov=360 step=0.001 rate=";
    for (; lasers < 20; ++lasers) {
        answer = talk.answer(world, laser + "1");
        if (!answer.starts_with("OK ADD ")) break;
    }
    EXPECT_EQ(lasers, 11) << answer;
    EXPECT_TRUE(answer.starts_with("ERR 409 the world would have ")) << answer;
    EXPECT_TRUE(answer.ends_with(" beams of lasers and sonars, more than 4000000\n")) << answer;
    EXPECT_TRUE(talk.answer(world, "DELETE laser2").starts_with("OK DELETE"));
    answer = talk.answer(world, laser + "400");
    EXPECT_TRUE(answer.starts_with("ERR 409 ")) << answer;
    EXPECT_NE(answer.find(" beams a second, more than 100000000\n"), std::string::npos) << answer;
    EXPECT_TRUE(talk.answer(world, "ADD camera at=0,1,1 pixels=4000,4000").starts_with("OK ADD "));
    answer = talk.answer(world, "ADD camera at=0,1,1 pixels=8000,8000");
    EXPECT_NE(answer.find(" pixels of cameras and rangers, more than 64000000\n"),
              std::string::npos)
        << answer;
}

TEST(SessionChange, RecordsOfFilesAreNotAdded) {
    Changing talk;
    Session& world = talk.client("WORLD");
    talk.answer(world, "ADD zone id=z at=0,0 size=1,1");
    for (const std::string record : {"environment", "environment file=hall.env", "result value=1"})
        EXPECT_EQ(talk.answer(world, "ADD " + record),
                  "ERR 400 a record `" + record.substr(0, record.find(' ')) +
                      "` tells of a file: a running world has none\n");
    EXPECT_EQ(talk.room.world.changes(), 1);
}

TEST(SessionChange, ControlCharactersAreRefused) {
    Changing talk;
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.answer(world, std::string("LOAD hall.env\0x", 15)),
              "ERR 400 the name of a file holds no control characters\n");
    EXPECT_EQ(talk.answer(world, "MARK \x1b[31mred"),
              "ERR 400 a mark is text in UTF-8 without control characters\n");
    talk.ask(world, "EVENTS mark");
    EXPECT_EQ(talk.ask(world, "MARK gr\xc3\xbcn\tblau"),
              "OK MARK t=0.000\nEVENT mark t=0.000 text=gr\xc3\xbcn blau\n");
}

TEST(SessionChange, ARobotThatIsDeletedLosesItsClient) {
    Changing talk;
    Session& world = talk.client("WORLD");
    Session& r1 = talk.client("ROBOT r1");
    Session& r2 = talk.client("ROBOT r2");
    talk.ask(r1, "FORWARD 1");
    talk.ask(r2, "BACKWARD 1");
    EXPECT_EQ(talk.answer(world, "DELETE l2 r1"), "OK DELETE t=0.000\n");
    r1.stepped();
    EXPECT_EQ(r1.take(), "FAIL id=1 reason=deleted t=0.000\nEVENT gone t=0.000 id=r1\n");
    EXPECT_EQ(talk.ask(r1, "STATUS"), "ERR 404 r1 is no more: open another connection\n");
    EXPECT_EQ(talk.ask(r1, "QUIT"), "OK QUIT\n");
    // The other one goes on under another index.
    talk.step(60);
    EXPECT_EQ(r2.take().substr(0, 10), "DONE id=1 ");
    EXPECT_EQ(talk.ask(r2, "STATUS").substr(0, 43), "OK STATUS t=6.000 x=2.000 y=0.500 heading=9");
}

TEST(SessionChange, ARobotOfTheSameNameIsAnother) {
    Changing talk;
    Session& world = talk.client("WORLD");
    Session& r2 = talk.client("ROBOT r2");
    talk.answer(world, "DELETE r2");
    talk.answer(world, "ADD robot id=r2 at=2,2");
    EXPECT_EQ(talk.ask(r2, "STATUS"),
              "EVENT gone t=0.000 id=r2\nERR 404 r2 is no more: open another connection\n");
    Session& other = talk.client("ROBOT r2");
    talk.ask(other, "SPEED 0.1");
    talk.ask(r2, "QUIT");
    talk.step(10);
    EXPECT_NE(talk.ask(other, "STATUS").find("speed=0.100"), std::string::npos);
}

TEST(SessionChange, SensorsGoAndCome) {
    Changing talk;
    Session& world = talk.client("WORLD");
    Session& laser = talk.client("LASER l1");
    talk.ask(laser, "STREAM");
    talk.answer(world, "DELETE l1");
    talk.step(1);
    EXPECT_EQ(laser.take(), "EVENT gone t=0.100 id=l1\n");
    EXPECT_EQ(streamed(laser), "");
    EXPECT_EQ(talk.ask(laser, "SCAN"), "ERR 404 l1 is no more: open another connection\n");
    talk.answer(world, "ADD laser id=l1 at=-3,-2 fov=2 step=1 range=9");
    EXPECT_EQ(talk.ask(laser, "SCAN"),
              "SCAN l1 t=0.100 seq=1 angle_min=-1 angle_max=1 step=1 n=3 r=7.001,7.000,7.001\n");
}

TEST(SessionChange, ANewScanIsNotTheOldText) {
    Changing talk;
    Session& world = talk.client("WORLD");
    Session& laser = talk.client("LASER l1");
    const std::string before = talk.ask(laser, "SCAN");
    talk.answer(world, "SET l1.at=-2,-2");
    const std::string after = talk.ask(laser, "SCAN");
    EXPECT_NE(before.find("r=-,7.000,-"), std::string::npos);
    EXPECT_NE(after.find("r=6.004,6.000,6.004"), std::string::npos) << after;
}

TEST(SessionChange, ResetAndLoad) {
    Changing talk;
    Session& world = talk.client("WORLD");
    Session& r1 = talk.client("ROBOT r1");
    talk.ask(r1, "FORWARD 1");
    talk.step(20);
    EXPECT_EQ(talk.answer(world, "RESET"), "OK RESET t=2.000\n");
    r1.stepped();
    EXPECT_EQ(r1.take(), "FAIL id=1 reason=stopped t=2.000\n");
    EXPECT_EQ(talk.ask(r1, "STATUS").substr(0, 41), "OK STATUS t=2.000 x=0.000 y=0.000 heading");
    EXPECT_EQ(talk.answer(world, "LOAD hall.env hall.3dm"), "OK LOAD t=2.000\n");
    EXPECT_EQ(talk.ask(r1, "STATUS").substr(0, 33), "OK STATUS t=2.000 x=9.000 y=9.000");
    EXPECT_EQ(talk.ask(world, "LIST"), "OK LIST robots=r1 lasers= people= sensors=\n");
    EXPECT_EQ(talk.ask(r1, "BACKWARD 1"), "OK BACKWARD id=2 distance=1\n");
}

TEST(SessionChange, ChangesTakeTurns) {
    Changing talk;
    Session& world = talk.client("WORLD");
    talk.state.changes().spend(WallTime{}, std::chrono::steady_clock::now() + testing::kLong);
    EXPECT_EQ(talk.ask(world, "SET r1.at=1,1"), "");
    EXPECT_TRUE(world.waiting());
    EXPECT_TRUE(world.waitsToChange());
    talk.step(1);
    EXPECT_TRUE(world.waiting());
    talk.state.changes().spend(WallTime{}, WallTime{});
    world.proceed();
    EXPECT_EQ(world.take(), "OK SET t=0.100\n");
    // A client that leaves meanwhile has no effect.
    talk.state.changes().spend(WallTime{}, std::chrono::steady_clock::now() + testing::kLong);
    talk.ask(world, "SET r1.at=0,0");
    talk.clients.pop_back();
    EXPECT_EQ(talk.room.world.changes(), 1);
}

TEST(SessionChange, MayBeForbidden) {
    ServerLimits limits = changing();
    limits.changes = false;
    Changing talk(limits);
    Session& world = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "RESET"), "ERR 403 clients may not change the world of this run\n");
    EXPECT_EQ(talk.ask(world, "HELP").find("RESET"), std::string::npos);
}

TEST(SessionChange, NeedsTheToken) {
    ServerLimits limits = changing();
    limits.token = "s3cret";
    Changing talk(limits);
    Session& world = talk.client("WORLD");
    constexpr const char* kNeeds = " needs the token of this run: TOKEN x comes before it\n";
    for (const std::string verb : {"RESET", "SET", "ADD", "DELETE", "LOAD", "SHUTDOWN"})
        EXPECT_EQ(talk.ask(world, verb + " x"), "ERR 401 " + verb + kNeeds);
    EXPECT_EQ(talk.ask(world, "TOKEN secret"), "ERR 401 this is not the token of this run\n");
    EXPECT_EQ(talk.ask(world, "TOKEN s3cret"), "OK TOKEN\n");
    EXPECT_EQ(talk.answer(world, "RESET"), "OK RESET t=0.000\n");
    talk.client("ROBOT r1");  // needs none
    Session& guesser = talk.client();
    talk.ask(guesser, "TOKEN 1");
    talk.ask(guesser, "TOKEN 2");
    EXPECT_FALSE(guesser.closing());
    talk.ask(guesser, "TOKEN 3");
    EXPECT_TRUE(guesser.closing());
}

TEST(SessionChange, TheTokenMayComeFirst) {
    ServerLimits limits = changing();
    limits.token = "s3cret";
    limits.token_first = true;
    Changing talk(limits);
    Session& client = talk.client();
    EXPECT_EQ(talk.ask(client, "ROBOT r1").substr(0, 8), "ERR 401 ");
    EXPECT_EQ(talk.ask(client, "HELP").substr(0, 19), "OK HELP TOKEN x | R");
    EXPECT_EQ(talk.ask(client, "TOKEN s3cret"), "OK TOKEN\n");
    EXPECT_EQ(talk.ask(client, "ROBOT r1").substr(0, 8), "OK ROBOT");
}

TEST(SessionChange, GuessesAreLimited) {
    ServerLimits limits = changing();
    limits.token = "s3cret";
    limits.wrong_tokens = {0.001, 4};
    Changing talk(limits);
    for (int i = 0; i < 4; ++i) talk.ask(talk.client(), "TOKEN x");
    EXPECT_EQ(talk.ask(talk.client(), "TOKEN x").substr(0, 8), "ERR 429 ");
    EXPECT_EQ(talk.ask(talk.client(), "TOKEN s3cret"), "OK TOKEN\n") << "the owner gets in";
}

TEST(WrongTokens, AreCountedByAddressAndInSumOverStrangers) {
    WrongTokens wrong({0.001, 4});
    const WallTime now = std::chrono::steady_clock::now();
    wrong.trust("192.168.1.2", now);
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(wrong.count("192.168.1.7", now));
    EXPECT_FALSE(wrong.count("192.168.1.7", now));
    EXPECT_FALSE(wrong.count("192.168.1.8", now)) << "strangers share a sum";
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(wrong.count("192.168.1.2", now));
    EXPECT_FALSE(wrong.count("192.168.1.2", now));
    for (int i = 0; i < 5000; ++i) wrong.count("10.0.0." + std::to_string(i), now);
    EXPECT_FALSE(wrong.count("192.168.1.2", now)) << "not forgotten among many";
}

TEST(SessionChange, EventsAreTold) {
    Changing talk;
    Session& world = talk.client("WORLD");
    Session& other = talk.client("WORLD");
    EXPECT_EQ(talk.ask(world, "EVENTS collision,mark change"),
              "OK EVENTS kinds=collision,mark,change\n");
    EXPECT_EQ(talk.ask(world, "EVENTS colision"),
              "ERR 400 no kind of event is called `colision`, did you mean `collision`?\n");
    EXPECT_EQ(talk.ask(world, "MARK here  it begins"),
              "OK MARK t=0.000\nEVENT mark t=0.000 text=here  it begins\n");
    EXPECT_EQ(talk.ask(other, "MARK there"), "OK MARK t=0.000\n");
    talk.answer(other, "SET r1.at=3,0");
    Session& robot = talk.client("ROBOT r1");
    talk.ask(robot, "FORWARD 5");
    talk.step(30);
    const std::string told = world.take();
    EXPECT_EQ(told.substr(0, 80),
              std::string("EVENT mark t=0.000 text=there\nEVENT change t=0.000 what=SET r1.at=3,0\n"
                          "EVENT collision t=2.200 id=r1 into=ispace1 x=3.7 y=0.000\n")
                  .substr(0, 80));
    EXPECT_NE(told.find(" into=ispace1 x=3."), std::string::npos) << told;
    EXPECT_EQ(talk.ask(world, "EVENTS off"), "OK EVENTS kinds=off\n");
    talk.ask(other, "MARK more");
    world.stepped();
    EXPECT_EQ(world.take(), "");
    EXPECT_EQ(talk.ask(world, "EVENTS").substr(0, 32), "OK EVENTS kinds=collision,stall,");
}

TEST(SessionChange, EventsComeBeforeTheAnswersToLaterRequests) {
    Changing talk;
    Session& world = talk.client("WORLD");
    ASSERT_EQ(talk.answer(world, "EVENTS change,mark"), "OK EVENTS kinds=mark,change\n");
    talk.client("WORLD").request("MARK theirs");
    world.request("TIME");
    EXPECT_EQ(world.take().substr(0, 41), "EVENT mark t=0.000 text=theirs\nOK TIME t=");
}

TEST(SessionChange, WhoHasNoRoomMissesEvents) {
    Changing talk;
    Session& world = talk.client("WORLD");
    Session& other = talk.client("WORLD");
    talk.ask(world, "EVENTS mark");
    for (int i = 0; i < 40000; ++i) talk.ask(other, "MARK x");
    world.stepped(false);
    EXPECT_EQ(world.take(), "");
    world.stepped();
    const std::string told = world.take();
    EXPECT_EQ(told.substr(0, 23), "EVENT missed t=0.000 n=");
    EXPECT_LT(told.size(), 100'000U);
}

TEST(SessionChange, SilenceStopsWhatIsHeld) {
    Changing talk;
    Session& robot = talk.client("ROBOT r1");
    talk.ask(robot, "FORWARD 2");
    talk.step(10);
    robot.silent();
    EXPECT_EQ(robot.take(), "FAIL id=1 reason=stopped t=1.000\n");
    talk.step(30);
    EXPECT_NE(talk.ask(robot, "STATUS").find(" speed=0.000"), std::string::npos);
    EXPECT_EQ(talk.ask(robot, "FORWARD 1"), "OK FORWARD id=2 distance=1\n");
}

TEST(SessionChange, OdometryBeginsWhereTheRobotDoes) {
    Changing talk;
    Session& robot = talk.client("ROBOT r2");
    EXPECT_EQ(talk.ask(robot, "ODOMETRY"),
              "OK ODOMETRY t=0.000 x=0.000 y=0.000 heading=0.000 speed=0.000 rotspeed=0.000\n");
    talk.ask(robot, "FORWARD 0.5");
    talk.step(50);
    robot.take();
    EXPECT_EQ(talk.ask(robot, "ODOMETRY"),
              "OK ODOMETRY t=5.000 x=0.500 y=0.000 heading=0.000 speed=0.000 rotspeed=0.000\n");
}

TEST(SessionChange, APersonIsDriven) {
    Changing talk;
    Session& world = talk.client("WORLD");
    talk.answer(world, "ADD human id=h1 at=-2,2 heading=-90");
    Session& person = talk.client();
    EXPECT_EQ(talk.ask(person, "PERSON h2"), "ERR 404 no person `h2`, did you mean `h1`?\n");
    EXPECT_EQ(talk.ask(person, "PERSON r1"), "ERR 404 no person `r1`, did you mean `h1`?\n");
    EXPECT_TRUE(talk.ask(person, "PERSON h1")
                    .starts_with("OK PERSON h1 height=1.7 radius=0.255 speed=1.2 "));
    EXPECT_EQ(talk.ask(talk.client(), "PERSON h1"),
              "ERR 409 person h1 is held by another client\n");
    EXPECT_EQ(talk.ask(person, "FORWARD 1"), "OK FORWARD id=1 distance=1\n");
    talk.step(100);
    EXPECT_EQ(person.take().substr(0, 10), "DONE id=1 ");
    EXPECT_EQ(talk.ask(person, "STATUS").substr(0, 52),
              "OK STATUS t=10.000 x=-2.000 y=1.000 heading=-90.000 ");
    EXPECT_EQ(talk.ask(person, "SCAN l1"),
              "ERR 405 SCAN is for the role ROBOT or LASER or SENSOR, this connection has the role "
              "PERSON h1: open another one\n");
}

}  // namespace session_change_test

}  // namespace ispace
