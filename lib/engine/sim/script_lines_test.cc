// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/script_lines.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "base/error.h"
#include "sim/simulation.h"
#include "support/test_layout.h"

namespace ispace {
namespace script_lines_test {

/// Marks each step.
class Teller final : public Director {
  public:
    void stepped(Simulation& simulation) override {
        simulation.events().add(EventKind::Mark, "told", "");
    }
    [[nodiscard]] bool hasOpened(const std::string& door) const override { return door == "d"; }
};

std::shared_ptr<Director> readTales(std::string_view text, const std::string& /*file*/,
                                    const World& /*world*/) {
    return text.find("tell") == std::string_view::npos ? nullptr : std::make_shared<Teller>();
}

TEST(ScriptLines, AreReadByTheirExtension) {
    addScriptLines({.words = {"tell"}, .read = readTales});
    const Scene room = testing::scene("ispace size=9,9\n", "robot id=r at=0,0\n");
    World world(room, std::chrono::milliseconds(100));
    const std::string script = "tell a tale # of old\n0 r FORWARD 1\n";
    EXPECT_TRUE(isDirectorsLine("  tell a tale"));
    EXPECT_FALSE(isDirectorsLine("telling a tale"));
    EXPECT_FALSE(isDirectorsLine(""));
    EXPECT_TRUE(readDirectors("0 r FORWARD 1\n", "s.txt", world).empty());
    auto directors = readDirectors(script, "s.txt", world);
    ASSERT_EQ(directors.size(), 1U);

    Simulation simulation(world, readScript(script, "s.txt", world), {Clock::Kind::Step, 1}, {});
    EXPECT_FALSE(simulation.isOpenForPeople("d"));
    simulation.events().want({EventKind::Mark});
    simulation.follow(std::move(directors.front()));
    EXPECT_TRUE(simulation.isOpenForPeople("d"));
    EXPECT_FALSE(simulation.isOpenForPeople("e"));
    simulation.allow(3);
    while (simulation.owed() > 0)
        simulation.run(std::chrono::steady_clock::now(), std::chrono::seconds(10));
    EXPECT_EQ(simulation.events().next() - simulation.events().first(), 3);
}

TEST(ScriptLines, NameTheExtensionThatTheBuildLacks) {
    addMissingScriptLine("sing", "choirs");
    const Scene room = testing::scene("ispace size=9,9\n", "robot id=r at=0,0\n");
    const World world(room, std::chrono::milliseconds(100));
    try {
        readScript("0 r FORWARD 1\n  sing r loudly\n", "s.txt", world);
        FAIL();
    } catch (const FormatError& error) {
        EXPECT_STREQ(error.what(),
                     "s.txt:2:3: error: `sing` begins a line that the extension choirs reads: this "
                     "build lacks that extension");
    }
    EXPECT_EQ(missingScriptLine("tell"), "");
}

}  // namespace script_lines_test
}  // namespace ispace
