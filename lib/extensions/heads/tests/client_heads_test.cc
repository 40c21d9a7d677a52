// SPDX-License-Identifier: GPL-3.0-or-later
// Heads that turn: the C++ client of the role HEAD against a robot with two heads.
#include <gtest/gtest.h>
#include <ispace_client.h>

#include <cmath>
#include <fstream>
#include <string>

#include "client/test_server.h"
#include "support/test_folder.h"

namespace ispace {
namespace client {
namespace client_heads_test {

std::string roomIn(const ispace::testing::TestFolder& folder) {
    std::string file = folder.file("heads.env");
    std::ofstream(file) << "#env 1\n"
                           "ispace size=6,4\n"
                           "robot id=r at=0,0\n"
                           "head id=h on=r at=0,0,0.5 pan_range=-90,90 speed=90\n"
                           "head id=slow on=r at=0,0,0.8 pan_range=-90,90 speed=45\n";
    return file;
}

class HeadsThatTurn : public ::testing::Test {
  protected:
    ispace::testing::TestFolder folder;
    TestServer server{{roomIn(folder), "--clock", "step", "-q"}};
    World world{server.address()};
    Heads heads{server.address()};
    void simulate(double seconds) { world.step(std::lround(seconds / world.dt())); }
};

TEST_F(HeadsThatTurn, WaitIsForTheLastTurn) {
    EXPECT_EQ(heads.turn("h", 90, 0), 1);
    simulate(1.5);
    EXPECT_EQ(heads.turn("h", 0, 0), 1);
    EXPECT_FALSE(heads.wait("h", 0.2));
    simulate(1.5);
    EXPECT_TRUE(heads.wait("h", 10));
    EXPECT_EQ(heads.read("h").pan, 0);
}

TEST_F(HeadsThatTurn, WaitKeepsTheEndsOfOthers) {
    heads.turn("slow", 90, 0);
    heads.turn("h", 90, 0);
    simulate(3);
    EXPECT_TRUE(heads.wait("slow", 10));
    EXPECT_TRUE(heads.wait("h", 0.2));
    EXPECT_FALSE(heads.wait("h", 0.2));
}

}  // namespace client_heads_test
}  // namespace client
}  // namespace ispace
