// SPDX-License-Identifier: GPL-3.0-or-later
// How late steps are, and for how much of that the program was at work itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <thread>

#include "sim/simulation.h"
#include "support/test_layout.h"

namespace ispace {
namespace lateness_test {

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
    // A quarter of a second is forgiven, and on a busy machine little work may take as long: then
    // it is less work's turn, as often as needed.
    constexpr milliseconds kStep(5), kRounding(1), kMinValue(20);
    milliseconds work(60);
    for (int tries = 0; tries < 100; ++tries) {
        const nanoseconds lost = simulation_.lost();
        const std::clock_t begin = std::clock();
        while (std::clock() - begin < work.count() * (CLOCKS_PER_SEC / 1000)) continue;
        simulation_.run(steady_clock::now(), kLong);
        if (simulation_.lost() == lost) break;
        work = std::max(work / 2, kMinValue);
    }
    EXPECT_GE(simulation_.lateness().own, work - kStep - kRounding);
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

}  // namespace lateness_test
}  // namespace ispace
