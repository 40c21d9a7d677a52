// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/command.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/number.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {

namespace command_test {

using Kind = CommandError::Kind;

constexpr Verb kAll[] = {Verb::Forward,  Verb::Backward,  Verb::Left, Verb::Right, Verb::Speed,
                         Verb::Rotspeed, Verb::Sidespeed, Verb::Stop, Verb::Path,  Verb::Goto};

void expectRefused(std::string_view text, Kind kind, std::string_view message) {
    const ParsedCommand parsed = parseCommand(text);
    EXPECT_FALSE(parsed.command) << text;
    EXPECT_EQ(parsed.error.kind, kind) << text;
    EXPECT_EQ(parsed.error.message, message) << text;
}

TEST(Verb, NamesReadBack) {
    for (const Verb verb : kAll) EXPECT_EQ(verbNamed(nameOf(verb)), verb);
    EXPECT_FALSE(verbNamed("forward"));
    EXPECT_FALSE(verbNamed(""));
    EXPECT_EQ(valueNameOf(Verb::Backward), "distance");
    EXPECT_EQ(valueNameOf(Verb::Left), "angle");
    EXPECT_EQ(valueNameOf(Verb::Speed), "speed");
    EXPECT_EQ(valueNameOf(Verb::Rotspeed), "rotspeed");
    EXPECT_EQ(valueNameOf(Verb::Stop), "");
}

TEST(Verb, SomeComeToAnEnd) {
    for (const Verb verb : kAll)
        EXPECT_EQ(comesToAnEnd(verb), verb <= Verb::Right || verb >= Verb::Path) << nameOf(verb);
}

TEST(ParseCommand, TakesAVerbAndItsValue) {
    EXPECT_EQ(parseCommand("FORWARD 1.5").command, (Command{Verb::Forward, 1.5}));
    EXPECT_EQ(parseCommand("BACKWARD 0").command, (Command{Verb::Backward, 0}));
    EXPECT_EQ(parseCommand("LEFT +90").command, (Command{Verb::Left, 90}));
    EXPECT_EQ(parseCommand("RIGHT 1e6").command, (Command{Verb::Right, 1e6}));
    EXPECT_EQ(parseCommand("SPEED -0.3").command, (Command{Verb::Speed, -0.3}));
    EXPECT_EQ(parseCommand("ROTSPEED -30").command, (Command{Verb::Rotspeed, -30}));
    EXPECT_EQ(parseCommand("STOP").command, (Command{Verb::Stop, 0}));
    EXPECT_EQ(parseCommand(" \tFORWARD \t 1.5\t ").command, (Command{Verb::Forward, 1.5}));
}

TEST(ParseCommand, HasNoMinusZero) {
    for (const char* text : {"FORWARD -0", "SPEED -0.0"}) {
        const auto command = parseCommand(text).command;
        ASSERT_TRUE(command) << text;
        EXPECT_FALSE(std::signbit(command->value)) << text;
    }
}

TEST(ParseCommand, HelpsWithUnknownOnes) {
    expectRefused("forward 1", Kind::Unknown, "unknown command `forward`, did you mean `FORWARD`?");
    expectRefused("FORWRAD 1", Kind::Unknown, "unknown command `FORWRAD`, did you mean `FORWARD`?");
    expectRefused("Stop", Kind::Unknown, "unknown command `Stop`, did you mean `STOP`?");
    expectRefused("JUMP 1", Kind::Unknown,
                  "unknown command `JUMP`, wanted one of FORWARD BACKWARD LEFT RIGHT SPEED "
                  "ROTSPEED SIDESPEED STOP PATH GOTO");
    expectRefused("FORWARD1.5", Kind::Unknown,
                  "unknown command `FORWARD1.5`, did you mean `FORWARD`?");
}

TEST(ParseCommand, WantsExactlyOneNumber) {
    expectRefused("", Kind::Syntax, "no command, wanted one like FORWARD 1.5");
    expectRefused(" \t", Kind::Syntax, "no command, wanted one like FORWARD 1.5");
    expectRefused("FORWARD", Kind::Syntax,
                  "FORWARD wants its distance in metres, like FORWARD 1.5");
    expectRefused("LEFT 1 2", Kind::Syntax, "LEFT takes one number, found `2` behind it");
    expectRefused("STOP 0", Kind::Syntax, "STOP takes no value, found `0` behind it");
    expectRefused("FORWARD 1m", Kind::Syntax,
                  "`1m` is no number, FORWARD wants its distance in metres, like FORWARD 1.5");
    for (const char* bad : {"nan", "inf", "-inf", "0x10", "1,5", "1e999", ".", "--1", "1.5x"})
        EXPECT_EQ(parseCommand(std::string("SPEED ") + bad).error.kind, Kind::Syntax) << bad;
}

TEST(ParseCommand, RefusesWhatIsOutOfRange) {
    expectRefused("FORWARD -1", Kind::Range, "FORWARD takes no negative distance, use BACKWARD");
    expectRefused("BACKWARD -1", Kind::Range, "BACKWARD takes no negative distance, use FORWARD");
    expectRefused("LEFT -1e9", Kind::Range, "LEFT takes no negative angle, use RIGHT");
    expectRefused("RIGHT -0.001", Kind::Range, "RIGHT takes no negative angle, use LEFT");
    expectRefused("FORWARD 1000000.1", Kind::Range,
                  "FORWARD takes at most 1000000 metres, found `1000000.1`");
}

TEST(ParseCommand, EchoesInputPrintable) {
    const std::string_view nul("STOP\0", 5);
    EXPECT_EQ(parseCommand(nul).error.message, "unknown command `STOP?`, did you mean `STOP`?");
    EXPECT_EQ(parseCommand("SPEED \x1b[2J\xff").error.message,
              "`?[2J?` is no number, SPEED wants its speed in metres a second, like SPEED 0.3");
}

TEST(ParseCommand, AnswersHugeLinesShortly) {
    const std::string word(1 << 20, 'F'), digits(1 << 20, '1');
    std::string words = "FORWARD";
    for (int i = 0; i < 100000; ++i) words += " 1";
    for (const std::string& text : {word, "FORWARD " + word, "FORWARD " + digits, words})
        EXPECT_LT(parseCommand(text).error.message.size(), 200U);
}

TEST(ParseCommand, NeverThrowsAndNeverBreaksTheLine) {
    constexpr std::string_view kPieces[] = {"FORWARD", "STOP", "LEFT", "SPEED", " ",  "\t",
                                            "1",       "-1",   "1e9",  "nan",   "\n", "\r",
                                            "\xc3",    "\x1b", "#",    "left",  "\v", "\xc2\x85"};
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) {
        std::string text;
        for (std::size_t n = random() % 6; n > 0; --n)
            text += kPieces[random() % std::size(kPieces)];
        const ParsedCommand parsed = parseCommand(text);
        ASSERT_NE(parsed.command.has_value(), !parsed.error.message.empty()) << text;
        for (const char c : parsed.error.message)
            ASSERT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) << text;
        if (!parsed.command) continue;
        std::string again(nameOf(parsed.command->verb));
        if (parsed.command->verb != Verb::Stop)
            again.append(" ").append(formatDouble(parsed.command->value));
        ASSERT_EQ(parseCommand(again).command, parsed.command) << text;
    }
}

using std::chrono::milliseconds;
using testing::findings;

constexpr const char* kRoom = "ispace size=8,6\n";

class ScriptTest : public ::testing::Test {
  protected:
    ScriptTest()
        : scene_(testing::scene(kRoom, "robot id=r1 at=1,1\nrobot id=r2 at=-1,-1\n")),
          world_(scene_, milliseconds(5)) {}

    [[nodiscard]] std::vector<TimedCommand> read(std::string_view text) const {
        return readScript(text, "run.txt", world_);
    }
    /// One finding a line, without the "run.txt:".
    [[nodiscard]] std::string errors(std::string_view text) const {
        return findings([&] { return read(text); });
    }

    Scene scene_;
    World world_;
};

void expectCommand(const TimedCommand& timed, SimTime time, std::size_t robot, Command command) {
    EXPECT_EQ(timed.time, time);
    EXPECT_EQ(timed.robot, robot);
    EXPECT_EQ(timed.command, command);
}

TEST_F(ScriptTest, ReadsCommands) {
    const auto script = read("0 r1 FORWARD 1.5\n2.5 r2 LEFT 90\n3000ms r1 STOP\n");
    ASSERT_EQ(script.size(), 3U);
    expectCommand(script[0], milliseconds(0), 0, {Verb::Forward, 1.5});
    expectCommand(script[1], milliseconds(2500), 1, {Verb::Left, 90});
    expectCommand(script[2], milliseconds(3000), 0, {Verb::Stop, 0});
}

TEST_F(ScriptTest, IsInTheOrderOfTimeThenOfTheFile) {
    const auto script = read("2 r1 STOP\n1 r1 SPEED 0.1\n1 r1 SPEED 0.2\n0 r2 STOP\n1s r1 STOP\n");
    ASSERT_EQ(script.size(), 5U);
    expectCommand(script[0], milliseconds(0), 1, {Verb::Stop, 0});
    expectCommand(script[1], milliseconds(1000), 0, {Verb::Speed, 0.1});
    expectCommand(script[2], milliseconds(1000), 0, {Verb::Speed, 0.2});
    expectCommand(script[3], milliseconds(1000), 0, {Verb::Stop, 0});
    expectCommand(script[4], milliseconds(2000), 0, {Verb::Stop, 0});
}

TEST_F(ScriptTest, KeepsTheOrderOfManyOfOneTime) {
    std::string text;
    for (int i = 0; i < 500; ++i) text.append("1 r1 LEFT ").append(std::to_string(i)).append("\n");
    const auto script = read(text);
    ASSERT_EQ(script.size(), 500U);
    for (std::size_t i = 0; i < script.size(); ++i)
        ASSERT_EQ(script[i].command.value, static_cast<double>(i));
}

TEST_F(ScriptTest, AllowsCommentsBlanksAndForeignLineEnds) {
    const auto script = read(
        "\xef\xbb\xbf# a run\r\n\r\n \t\r\n"
        "  0\tr1  STOP  # halt\r\n"
        "1 r1 STOP#now\r\n"
        "#2 r1 STOP\n"
        "3 r1 STOP");
    ASSERT_EQ(script.size(), 3U);
    expectCommand(script[1], milliseconds(1000), 0, {Verb::Stop, 0});
    expectCommand(script[2], milliseconds(3000), 0, {Verb::Stop, 0});
    EXPECT_TRUE(read("").empty());
    EXPECT_TRUE(read("# nothing\n").empty());
}

TEST_F(ScriptTest, NamesBadTimes) {
    EXPECT_EQ(errors("x r1 STOP\n"),
              "run.txt:1:1: error: `x` is no time, wanted seconds from the start of the run, like "
              "2.5 or 500ms\n");
    EXPECT_EQ(errors("\n  -1 r1 STOP\n"),
              "run.txt:2:3: error: `-1` is no time, wanted seconds from the start of the run, like "
              "2.5 or 500ms\n");
}

TEST_F(ScriptTest, NamesUnknownRobots) {
    EXPECT_EQ(errors("0 r3 STOP\n"),
              "run.txt:1:3: error: unknown robot or person `r3`, did you mean `r1`?\n");
    EXPECT_EQ(errors("0 turtle STOP\n"), "run.txt:1:3: error: unknown robot or person `turtle`\n");
    const Scene empty = testing::scene(kRoom);
    const World world(empty, milliseconds(5));
    EXPECT_EQ(findings([&] { return readScript("0 r1 STOP\n", "-", world); }),
              "stdin:1:3: error: unknown robot or person `r1`: the scene has none\n");
}

TEST_F(ScriptTest, NamesWhatIsMissing) {
    EXPECT_EQ(errors("1.5\n"),
              "run.txt:1:1: error: a robot and a command are missing, wanted TIME ROBOT COMMAND, "
              "like 2.5 r1 FORWARD 1\n");
    EXPECT_EQ(errors("1.5 r1 # STOP\n"),
              "run.txt:1:5: error: a command is missing, wanted TIME ROBOT COMMAND, like 2.5 r1 "
              "FORWARD 1\n");
}

TEST_F(ScriptTest, NamesBadCommands) {
    EXPECT_EQ(errors("0 r1 forward 1\n"),
              "run.txt:1:6: error: unknown command `forward`, did you mean `FORWARD`?\n");
    EXPECT_EQ(errors("0 r1 \t FORWARD\t-1\n"),
              "run.txt:1:16: error: FORWARD takes no negative distance, use BACKWARD\n");
    EXPECT_EQ(errors("0 r1 STOP 1\n"),
              "run.txt:1:11: error: STOP takes no value, found `1` behind it\n");
    EXPECT_EQ(errors("0 r1 LEFT\n"),
              "run.txt:1:6: error: LEFT wants its angle in degrees, like LEFT 90\n");
}

TEST_F(ScriptTest, NamesWhatTheRobotCannotDo) {
    const std::string refusal = world_.refusal(1, {Verb::Speed, 500});
    ASSERT_FALSE(refusal.empty());
    EXPECT_EQ(errors("0 r2 SPEED 500\n"), "run.txt:1:12: error: " + refusal + "\n");
}

TEST_F(ScriptTest, ReportsAllFindingsTogether) {
    EXPECT_EQ(errors("x r9 fly\n0 r1 STOP\n0 r1\n"),
              "run.txt:1:1: error: `x` is no time, wanted seconds from the start of the run, like "
              "2.5 or 500ms\n"
              "run.txt:1:3: error: unknown robot or person `r9`, did you mean `r1`?\n"
              "run.txt:1:6: error: unknown command `fly`, wanted one of FORWARD BACKWARD LEFT "
              "RIGHT SPEED ROTSPEED SIDESPEED STOP PATH GOTO\n"
              "run.txt:3:3: error: a command is missing, wanted TIME ROBOT COMMAND, like 2.5 r1 "
              "FORWARD 1\n");
    std::string many;
    for (int i = 0; i < 30; ++i) many += "x\n";
    const std::string all = errors(many);
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 20);
    EXPECT_NE(all.find("(40 more errors not shown)"), std::string::npos) << all;
}

TEST_F(ScriptTest, RefusesWhatIsNoText) {
    const std::string found = errors(std::string_view("0 r1 STOP\n0 r1 ST\0OP\n", 21));
    EXPECT_TRUE(found.starts_with("run.txt:2:8: error: ")) << found;
}

TEST_F(ScriptTest, SurvivesGarbage) {
    constexpr std::string_view kPieces[] = {"0",       "1.5",  "r1", "r2",  "STOP",
                                            "FORWARD", " ",    "\t", "\n",  "#",
                                            "SPEED 1", "\r\n", "-",  "\xff"};
    std::mt19937_64 random(1);
    int good = 0;
    for (int i = 0; i < 5000; ++i) {
        std::string text;
        for (std::size_t n = random() % 12; n > 0; --n)
            text += kPieces[random() % std::size(kPieces)];
        try {
            const auto script = read(text);
            ++good;
            for (std::size_t k = 1; k < script.size(); ++k)
                ASSERT_LE(script[k - 1].time, script[k].time);
        } catch (const FormatError& error) {
            ASSERT_FALSE(error.diagnostics().empty());
            ASSERT_GT(error.diagnostics().front().line, 0);
        }
    }
    EXPECT_GT(good, 100);
}

}  // namespace command_test

}  // namespace ispace
