// SPDX-License-Identifier: GPL-3.0-or-later
// Whole dialogues of programs with a Pioneer, from the first byte to the last.
#include <gtest/gtest.h>

#include <charconv>
#include <string>
#include <string_view>

#include "extensions/wire/p2os_session.h"
#include "extensions/wire/tests/test_host.h"

namespace ispace::wire {

namespace p2os_transcript_test {

using testing::TestHost;

/// Lines `> bytes` of the program, `< bytes` the beginning of all the answers since, `= bytes` all
/// of them, `. seconds` that pass, `! x` the robot's true x in millimetres then; # begins a
/// comment. Bytes are in hexadecimal, as text in quotes.
class Transcript {
  public:
    Transcript(TestHost& host, std::string_view text) : host_(&host), session_(host, "r1") {
        while (!text.empty()) {
            const std::string_view line = text.substr(0, text.find('\n'));
            text.remove_prefix(std::min(line.size() + 1, text.size()));
            if (!line.empty())
                play(line.front(), line.substr(std::min<std::size_t>(2, line.size())));
        }
    }
    [[nodiscard]] bool isClosing() const { return session_.closing(); }

  private:
    static std::string bytesOf(std::string_view text) {
        std::string out;
        for (std::size_t i = 0; i < text.size() && text[i] != '#';) {
            if (text[i] == '"') {
                const std::size_t end = text.find('"', i + 1);
                out += text.substr(i + 1, end - i - 1);
                i = end + 1;
            } else if (text[i] == ' ') {
                ++i;
            } else {
                int value = 0;
                std::from_chars(text.data() + i, text.data() + i + 2, value, 16);
                out += static_cast<char>(value);
                i += 2;
            }
        }
        return out;
    }
    void play(char kind, std::string_view rest) {
        switch (kind) {
            case '>':
                session_.receive(bytesOf(rest));
                answers_ += session_.take();
                return;
            case '<':
                EXPECT_TRUE(answers_.starts_with(bytesOf(rest))) << rest;
                return answers_.clear();
            case '=':
                EXPECT_EQ(answers_, bytesOf(rest)) << rest;
                return answers_.clear();
            case '.':
                host_->run(session_, std::stod(std::string(rest)));
                answers_ += session_.take();
                return;
            case '!':
                EXPECT_NEAR(1000 * host_->world().status(0).pose.position.x,
                            std::stod(std::string(rest)), 0.5);
                return;
            default:
                EXPECT_EQ(kind, '#');
        }
    }

    TestHost* host_;
    P2osSession session_;
    std::string answers_;
};

constexpr const char* kRobot = "robot id=r1 model=pioneer-3dx at=-2,0\n";

TEST(P2osTranscript, OfAria) {
    TestHost host(kRobot);
    const Transcript aria(host, R"(
> fa fb 03 00 00 00
= fa fb 03 00 00 00
> fa fb 03 01 00 01
= fa fb 03 01 00 01
> fa fb 03 02 00 02
= fa fb 16 02 "r1" 00 "Pioneer" 00 "p3dx-sh" 00 34 cc
# OPEN: the first status at once, 86 bytes: at 0,0, at rest, 12.5 V, sonars on
> fa fb 06 01 3b 01 00 02 3b
< fa fb 56 32 00 00 00 00 00 00 00 00 00 00 7d 00 00 00 00 1e 00 00 10 00
# CONFIG, then BATTERYINFO, which is not answered
> fa fb 06 12 3b 01 00 13 3b
< fa fb 7c 20 "Pioneer" 00 "p3dx-sh" 00 "SIM" 00 00 2c 01 b0 04
> fa fb 06 3e 3b 01 00 3f 3b
# SETV 750, SETA 300 and -300, SETRV 100, SETRA 100 and -100
> fa fb 06 06 3b ee 02 f4 39 fa fb 06 05 3b 2c 01 31 3c fa fb 06 05 1b 2c 01 31 1c
> fa fb 06 0a 3b 64 00 6e 3b fa fb 06 17 3b 64 00 7b 3b fa fb 06 17 1b 64 00 7b 1b
# The laser: from -1 to 1 degrees by 1, on; a status, then one packet of three readings
> fa fb 06 24 1b 01 00 25 1b fa fb 06 25 3b 01 00 26 3b
> fa fb 06 26 3b 64 00 8a 3b fa fb 06 23 3b 02 00 25 3b
=
. 0.09
=
. 0.01
< fa fb 56 32
# ENABLE, VEL 300, and again after half a second; MOVE has gone 750 mm when it is at its speed for 2 s
> fa fb 06 04 3b 01 00 05 3b
> fa fb 06 0b 3b 2c 01 37 3c
. 0.5
> fa fb 06 0b 3b 2c 01 37 3c
. 2.5
! -1250
# VEL -300: a second to stand, another to go back as fast
> fa fb 06 0b 1b 2c 01 37 1c
. 2
! -1250
# ENABLE 0, CLOSE
> fa fb 06 04 3b 00 00 04 3b
. 1
> fa fb 06 02 3b 01 00 03 3b
)");
    EXPECT_TRUE(aria.isClosing());
}

TEST(P2osTranscript, OfPlayer) {
    TestHost host(kRobot);
    const Transcript player(host, R"(
> fa fb 03 00 00 00
= fa fb 03 00 00 00
> fa fb 03 01 00 01
= fa fb 03 01 00 01
> fa fb 03 02 00 02
= fa fb 16 02 "r1" 00 "Pioneer" 00 "p3dx-sh" 00 34 cc
# OPEN and PULSE, both without a word
> fa fb 03 01 00 01
< fa fb 56 32
> fa fb 03 00 00 00
=
# SONAR 0, then 1
> fa fb 06 1c 3b 00 00 1c 3b
. 0.1
< fa fb 26 32 00 00 00 00 00 00 00 00 00 00 7d 00 00 00 00 00 00 00 00 00
> fa fb 06 1c 3b 01 00 1d 3b
. 0.1
< fa fb 56 32 00 00 00 00 00 00 00 00 00 00 7d 00 00 00 00 1e 00 00 10 00
# ENABLE 0, SETO with its type alone, ENABLE 1
> fa fb 06 04 3b 00 00 04 3b fa fb 04 07 3b 07 3b fa fb 06 04 3b 01 00 05 3b
. 0.1
< fa fb 56 32 00 00 00 00 00 00 00 00 00 00 7d 00 00 00 00 1f 00 00 10 00
# VEL2: both wheels 200 mm/s, ten units of 20
> fa fb 06 20 3b 0a 0a 2a 45
. 1.5
! -1766.667
# STOP without a word, then nothing more: the connection ends
> fa fb 03 1d 00 1d
. 1
! -1700
)");
    EXPECT_FALSE(player.isClosing());
}

}  // namespace p2os_transcript_test

}  // namespace ispace::wire
