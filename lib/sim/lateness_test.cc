// SPDX-License-Identifier: GPL-3.0-or-later
// How late steps are, and for how much of that the program was at work itself.
#include <gtest/gtest.h>

#include <ctime>
#include <thread>

#include "layout/test_layout.h"
#include "sim/simulation.h"

namespace ispace {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

constexpr nanoseconds kLong = std::chrono::hours(1);

class LatenessTest : public ::testing::Test {
  protected:
    LatenessTest()
        : scene_(testing::scene("ispace size=8,6\n", "robot id=r1 at=0,0\n")),
          world_(scene_, milliseconds(5)),
          simulation_(world_, {}, {Clock::Kind::Real, 1}, {}) {
        simulation_.run(steady_clock::now(), kLong);
    }
    Scene scene_;
    World world_;
    Simulation simulation_;
};

TEST_F(LatenessTest, WhoSleepsIsLateWithoutWork) {
    std::this_thread::sleep_for(milliseconds(60));
    simulation_.run(steady_clock::now(), kLong);
    EXPECT_GE(simulation_.lateness().steps, 12);
    EXPECT_GE(simulation_.lateness().late, 1);
    EXPECT_GE(simulation_.lateness().most, milliseconds(55));
    EXPECT_LT(simulation_.lateness().own, milliseconds(30));
}

TEST_F(LatenessTest, WhoWorksIsLateByIt) {
    const std::clock_t begin = std::clock();
    while (std::clock() - begin < CLOCKS_PER_SEC / 20) continue;
    simulation_.run(steady_clock::now(), kLong);
    EXPECT_GE(simulation_.lateness().own, milliseconds(40));
    EXPECT_LE(simulation_.lateness().own, simulation_.lateness().most);
}

TEST_F(LatenessTest, TheNextStepIsDueUnlessPaused) {
    ASSERT_TRUE(simulation_.due());
    EXPECT_LE(*simulation_.due(), steady_clock::now() + milliseconds(5));
    simulation_.pause(steady_clock::now());
    EXPECT_FALSE(simulation_.due());
    Simulation fast(world_, {}, {Clock::Kind::Fast, 1}, {});
    fast.run(steady_clock::now(), nanoseconds(0));
    EXPECT_FALSE(fast.due());
}

}  // namespace
}  // namespace ispace
