// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "base/error.h"
#include "extensions/passages/passages_test.h"
#include "extensions/postures/posture.h"
#include "extensions/postures/postures_test.h"
#include "scene/room_state.h"
#include "server/server_state.h"
#include "server/session.h"
#include "sim/simulation.h"

namespace ispace::postures {
namespace postures_with_passages_test {

/// A run of two storeys, and a client of it.
class House {
  public:
    explicit House(const std::string& layout)
        : building_(buildingOf(layout)), run_(building_, testing::optionsOf()) {
        ServerLimits limits;
        limits.source = std::make_shared<testing::ShippedSource>();
        for (const RunRoom& room : run_.rooms()) {
            states_.emplace_back(*room.simulation, limits);
            room.simulation->events().want({EventKind::Unreached, EventKind::State});
            served_.states.push_back(&states_.back());
        }
        served_.worlds = &run_;
        for (ServerState& state : states_) state.joinRooms(served_);
        client_.emplace(states_.front());
        ask("WORLD");
    }
    std::string ask(const std::string& line) {
        client_->request(line);
        std::string answer = client_->take();
        // Changes leave the run time.
        for (int i = 0; i < 2000 && answer.empty(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            client_->proceed();
            answer = client_->take();
        }
        // Times are told to milliseconds.
        return answer.substr(0, answer.find(" t="));
    }
    passages::BuildingRun& run() { return run_; }
    [[nodiscard]] const PersonFigure* figure() const {
        return run_.world(run_.roomOf("ground/ann").value()).people().front().figure.get();
    }
    [[nodiscard]] std::string unreached() const {
        std::string text;
        const EventLog& log = run_.rooms().front().simulation->events();
        for (std::int64_t i = log.first(); i < log.next(); ++i)
            if (log.at(i).kind == EventKind::Unreached) text += log.at(i).text;
        return text;
    }

  private:
    static SiteScene buildingOf(const std::string& layout) {
        testing::addPosturesOnce();
        return testing::buildingOf(layout);
    }

    SiteScene building_;
    passages::BuildingRun run_;
    std::deque<ServerState> states_;
    ServedRooms served_;
    std::optional<Session> client_;
};

TEST(Postures, AreSetInBuildings) {
    House house("human id=ground/ann at=6,4\nrobot id=ground/r at=9,6\n");
    EXPECT_EQ(house.ask("SET ground/ann.right_arm=0,20"), "OK SET");
    ASSERT_NE(house.figure(), nullptr);
    // Arms stay raised upstairs.
    ASSERT_EQ(house.run().travel("ground/ann", {{{1, {9, 6}}}}).refusal, "");
    const auto end = testing::await(house.run(), "ground/ann", 60);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Done);
    EXPECT_EQ(house.run().roomOf("ground/ann"), 1U);
    ASSERT_NE(house.figure(), nullptr);
    EXPECT_EQ(house.figure()->rest, "");
    EXPECT_EQ(house.ask("ACT ground/ann posture=fallen right_arm=0,-90"), "OK ACT");
    EXPECT_EQ(house.figure()->rest, "has fallen");
    EXPECT_EQ(house.run().travel("ground/ann", {{{0, {6, 4}}}}).refusal,
              "ground/ann has fallen, and does not go");
    EXPECT_EQ(house.ask("SET ground/ann.posture=stand"), "OK SET");
    EXPECT_EQ(house.ask("SET ground/ann.support=0.3"), "OK SET");
    // A fall ends a trip.
    ASSERT_EQ(house.run().travel("ground/ann", {{{0, {6, 4}}}}).refusal, "");
    for (int i = 0; i < 50; ++i) testing::step(house.run());
    EXPECT_EQ(house.ask("SET ground/ann.posture=fallen"), "OK SET");
    testing::step(house.run());
    ASSERT_EQ(house.run().tripEnds().size(), 1U);
    EXPECT_EQ(house.run().tripEnds().front().outcome, Outcome::Stopped);
    // Other keys are as before.
    for (const char* const request : {"SET ground/ann.height=1.8", "SET ground/r.radius=0.3"})
        EXPECT_TRUE(house.ask(request).starts_with("ERR 403 ")) << request;
    EXPECT_TRUE(house.ask("ACT ground/ann posture=sitting").starts_with("ERR 400 "));
}

/// The thing is one of the room, and the person one of the layout.
TEST(Postures, ThingsOfStoreysAreInHands) {
    testing::addPosturesOnce();
    std::string text = testing::kBuilding;
    const std::string last = "[2.2, 5]]}}";
    ASSERT_NE(text.find(last), std::string::npos);
    text.insert(text.find(last) + last.size(),
                ", {cube: {id: cup, at: [7, 4], size: [0.1], carried: ann}}");
    const SiteScene building =
        testing::buildingOf("human id=ground/ann at=6,4\nhuman id=upper/ann at=6,4\n", text);
    const passages::BuildingRun run(building, testing::optionsOf());
    for (const std::size_t storey : {0U, 1U})
        EXPECT_EQ(run.world(storey).people().front().figure->load_parts, 1U);
    EXPECT_THROW(testing::buildingOf("human id=ground/ann at=6,4\n", text), FormatError);
}

TEST(Postures, ThingsInHandsGoAlong) {
    House house(
        "human id=ground/ann at=6,4\ncube id=ground/cup at=7,4 size=0.1 carried=ground/ann\n"
        "cube id=ground/jug at=8,5 size=0.1\n");
    ASSERT_NE(house.figure(), nullptr);
    EXPECT_EQ(house.figure()->load_parts, 1U);
    ASSERT_EQ(house.run().travel("ground/ann", {{{1, {9, 6}}}}).refusal, "");
    auto end = testing::await(house.run(), "ground/ann", 60);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Done);
    ASSERT_EQ(house.run().roomOf("ground/ann"), 1U);
    ASSERT_NE(house.figure(), nullptr);
    EXPECT_EQ(house.figure()->load_parts, 1U);
    EXPECT_EQ(house.ask("SET upper/cup.carried="), "OK SET");
    EXPECT_EQ(house.figure(), nullptr);
    EXPECT_EQ(house.ask("SET ground/cup.size=0.2").substr(0, 4), "ERR ") << "it is upstairs";
    // And back, by a change, with a tag on it.
    EXPECT_EQ(house.ask("ADD tag id=upper/t on=cup"), "OK ADD id=upper/t");
    EXPECT_EQ(house.ask("SET upper/cup.carried=ground/ann"), "OK SET");
    EXPECT_EQ(house.ask("SET ground/ann.at=ground/6,5"), "OK SET");
    ASSERT_EQ(house.run().roomOf("ground/ann"), 0U);
    EXPECT_EQ(house.figure()->load_parts, 1U);
    EXPECT_EQ(house.run().world(0).sensors().size(), 1U);
    EXPECT_EQ(house.run().world(1).sensors().size(), 0U);
}

/// A storey with a thing of that name has no room for another.
TEST(Postures, ThingsInHandsStayWhereTheirNameIsTaken) {
    House house(
        "human id=ground/ann at=6,4\ncube id=ground/cup at=7,4 size=0.1 carried=ground/ann\n"
        "cube id=upper/cup at=8,5 size=0.1\ncube id=ground/jug at=8,5 size=0.1\n"
        "cube id=upper/jug at=8,4 size=0.1\n");
    const std::string reason =
        "ground/ann carries cup, and upper has another cup: it first sets it down";
    EXPECT_EQ(house.run().travel("ground/ann", {{{1, {9, 6}}}}).refusal, reason);
    EXPECT_NE(house.ask("SET ground/ann.at=upper/9,6").find(reason), std::string::npos);
    EXPECT_EQ(house.run().travel("ground/ann", {{{0, {9, 6}}}}).refusal, "");
    EXPECT_EQ(house.ask("SET ground/cup.carried="), "OK SET");
    // Taken on the way.
    ASSERT_EQ(house.run().travel("ground/ann", {{{1, {9, 6}}}}).refusal, "");
    for (int i = 0; i < 20; ++i) testing::step(house.run());
    EXPECT_EQ(house.ask("SET ground/jug.carried=ground/ann"), "OK SET");
    const auto end = testing::await(house.run(), "ground/ann", 5);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->outcome, Outcome::Unreached);
    EXPECT_EQ(house.unreached(),
              "ground/ann carries jug, and upper has another jug: it first sets it down");
    EXPECT_EQ(house.run().roomOf("ground/ann"), 0U);
}

}  // namespace postures_with_passages_test
}  // namespace ispace::postures
