// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/command.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/number.h"

namespace ispace {
namespace {

using Kind = CommandError::Kind;

constexpr Verb kAll[] = {Verb::Forward, Verb::Backward, Verb::Left, Verb::Right,
                         Verb::Speed,   Verb::Rotspeed, Verb::Stop};

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

TEST(Verb, FourOfThemComeToAnEnd) {
    for (const Verb verb : kAll) EXPECT_EQ(comesToAnEnd(verb), verb <= Verb::Right) << nameOf(verb);
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
                  "ROTSPEED STOP");
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

}  // namespace
}  // namespace ispace
