// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_site.h"

#include <gtest/gtest.h>

#include "support/test_world.h"

namespace ispace::ros {
namespace ros_site_test {

TEST(RosSite, PagesOfThisMachineAreLocal) {
    for (const char* origin : {"", "file://", "http://localhost", "http://localhost:8080",
                               "https://127.0.0.1:1", "http://[::1]:9", "http://[::1]"})
        EXPECT_TRUE(isLocalOrigin(origin)) << origin;
    for (const char* origin : {"null", "http://evil.example", "http://localhost.evil.example",
                               "http://localhost:80@evil.example", "https://app.foxglove.dev",
                               "http://127.0.0.1.evil.example:80", "ftp://localhost", "localhost",
                               "file://evil", "http://", "http://:80"})
        EXPECT_FALSE(isLocalOrigin(origin)) << origin;
}

TEST(RosSite, TokensComeInTheQuery) {
    EXPECT_EQ(tokenOf("/"), std::nullopt);
    EXPECT_EQ(tokenOf("/?a=b"), std::nullopt);
    EXPECT_EQ(tokenOf("/?token=x"), "x");
    EXPECT_EQ(tokenOf("/any?a=b&token=x%2By&c"), "x+y");
    EXPECT_EQ(tokenOf("/?token="), "");
    EXPECT_EQ(tokenOf("/?token=%"), "%");
    EXPECT_EQ(tokenOf("/?token=%zz%4"), "%zz%4");
}

class RosSites : public ::testing::Test {
  protected:
    static unsigned open(const ServerLimits& limits, const web::WebRequest& request,
                         bool is_loopback = true, RosLanguage language = RosLanguage::Foxglove) {
        testing::TestWorld room;
        ServerState state(room.simulation, limits);
        RosFeed feed(state, {});
        RosSite site(state, feed, language, "room", is_loopback);
        site.settle("127.0.0.1", 8765);
        const web::WebAdmission admission = site.open(request);
        return admission.dialogue ? 101 : admission.status;
    }
    static constexpr const char* kBoth = "foxglove.sdk.v1, foxglove.websocket.v1";
};

TEST_F(RosSites, ChooseAProtocol) {
    EXPECT_EQ(open({}, {.target = "/", .origin = "", .protocols = kBoth}), 101U);
    EXPECT_EQ(open({}, {.target = "/", .origin = "", .protocols = "x,\tfoxglove.websocket.v1"}),
              101U);
    for (const char* protocols : {"", "foxglove", "foxglove.sdk.v10", ",", " , "})
        EXPECT_EQ(open({}, {.target = "/", .origin = "", .protocols = protocols}), 400U);
    EXPECT_EQ(
        open({}, {.target = "/", .origin = "", .protocols = ""}, true, RosLanguage::Rosbridge),
        101U);
}

TEST_F(RosSites, OtherPagesNeedTheToken) {
    const web::WebRequest stranger{
        .target = "/", .origin = "http://evil.example", .protocols = kBoth};
    EXPECT_EQ(open({}, stranger), 403U);
    web::WebRequest known = stranger;
    known.target = "/?token=x";
    EXPECT_EQ(open({}, known), 403U) << "the run has no token";
    ServerLimits limits;
    limits.token = "x";
    EXPECT_EQ(open(limits, known), 101U);
    known.target = "/?token=y";
    EXPECT_EQ(open(limits, known), 401U);
    EXPECT_EQ(open(limits, stranger), 403U);
    EXPECT_EQ(open(limits, {.target = "/", .origin = "", .protocols = kBoth}), 101U);
}

TEST_F(RosSites, TooManyWrongTokensAreToldAndTheRightOnePasses) {
    ServerLimits limits;
    limits.token = "x";
    limits.wrong_tokens = {0.001, 2};
    testing::TestWorld room;
    ServerState state(room.simulation, limits);
    RosFeed feed(state, {});
    RosSite site(state, feed, RosLanguage::Foxglove, "room", true);
    const auto open = [&site](const char* target) {
        const web::WebAdmission admission =
            site.open({.target = target, .origin = "", .protocols = kBoth});
        return admission.dialogue ? 101 : admission.status;
    };
    EXPECT_EQ(open("/?token=y"), 401U);
    EXPECT_EQ(open("/?token="), 401U);
    EXPECT_EQ(open("/?token=y"), 429U);
    EXPECT_EQ(open("/?token=x"), 101U);
}

TEST_F(RosSites, OtherMachinesNeedTheToken) {
    ServerLimits limits;
    limits.token = "x";
    EXPECT_EQ(open(limits, {.target = "/", .origin = "", .protocols = kBoth}, false), 401U);
    EXPECT_EQ(open(limits, {.target = "/?token=x", .origin = "", .protocols = kBoth}, false), 101U);
    limits.token_first = true;
    EXPECT_EQ(open(limits, {.target = "/", .origin = "", .protocols = kBoth}), 401U);
}

TEST_F(RosSites, AreAskedByTheirOwnName) {
    testing::TestWorld room;
    ServerState state(room.simulation);
    RosFeed feed(state, {});
    RosSite site(state, feed, RosLanguage::Foxglove, "room", true);
    site.settle("127.0.0.1", 8765);
    EXPECT_TRUE(site.isHost("127.0.0.1:8765"));
    EXPECT_TRUE(site.isHost("localhost:8765"));
    EXPECT_FALSE(site.isHost("evil.example:8765")) << "a name that points here";
    EXPECT_EQ(site.file("/"), nullptr);
}

}  // namespace ros_site_test
}  // namespace ispace::ros
