// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "extensions/contacts/contacts_test.h"
#include "extensions/expect/expect.h"
#include "support/test_layout.h"

namespace ispace::expect {
namespace expect_with_contacts_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(Expect, JudgesWhatAContactReports) {
    const auto flat = [](const std::string& window, const std::string& heater) {
        return testing::scene("ispace size=8,6\nwindow id=w1 at=0,3 " + window +
                                  "\nheater id=h1 at=-3,0 watts=1800 " + heater + '\n',
                              "contact id=k1 at=0,3,2 door=w1\n");
    };
    const Scene start = flat("", "on=yes");
    World world(start, milliseconds(100));
    ExpectationJudge judge(world, {parseExpectation("h1 never on while k1 open for more than 3s"),
                                   parseExpectation("h1 never on while k1 open for more than 5s")});
    judge.observe();
    while (world.time() < seconds(10)) {
        if (world.time() == seconds(2)) world.change(flat("open=yes", "on=yes"));
        if (world.time() == seconds(6)) world.change(flat("open=yes", ""));
        world.step();
        judge.observe();
    }
    const auto verdicts = judge.verdicts();
    EXPECT_FALSE(verdicts[0].is_met);
    EXPECT_EQ(verdicts[0].reason.substr(0, 9), "h1 was on");
    EXPECT_TRUE(verdicts[1].is_met) << verdicts[1].reason;
}

}  // namespace expect_with_contacts_test
}  // namespace ispace::expect
