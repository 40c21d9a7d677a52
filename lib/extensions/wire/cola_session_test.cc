// SPDX-License-Identifier: GPL-3.0-or-later
// Conversations as drivers of SICK's lasers have them.
#include "extensions/wire/cola.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "extensions/wire/tests/test_laser_host.h"

namespace ispace::wire {
namespace cola_session_test {

using testing::answered;
using testing::stepped;

struct Room : testing::LaserHost {
    Room()
        : LaserHost("ispace size=8,6\n",
                    "laser id=l1 model=lms111 at=0,0\n"
                    "laser id=l2 model=tim551 at=1,0 heading=90\n"
                    "laser id=l3 model=lms200 at=0,1\n",
                    std::chrono::milliseconds(10)) {}
};

std::string text(const std::string& content) { return colaFrame(content, false); }

/// The content of the only telegram in A.
std::string askText(WireSession& session, const std::string& request) {
    const std::string out = answered(session, text(request));
    EXPECT_TRUE(out.starts_with("\2") && out.ends_with("\3")) << out;
    return out.size() < 2 ? "" : out.substr(1, out.size() - 2);
}

std::vector<std::string> words(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}

TEST(ColaSession, AnswersInText) {
    Room room;
    ColaSession session(room, "l1");
    const std::vector<std::pair<std::string, std::string>> conversation{
        {"sMN SetAccessMode 03 F4724744", "sAN SetAccessMode 1"},
        {"sRN LMPscancfg", "sRA LMPscancfg 1388 1 1388 FFF92230 225510"},
        {"sRN LMPoutputRange", "sRA LMPoutputRange 1 1388 FFF92230 225510"},
        {"sMN mLMPsetscancfg +5000 +1 +5000 -450000 +2250000",
         "sAN mLMPsetscancfg 0 1388 1 1388 FFF92230 225510"},
        {"sMN mLMPsetscancfg +2500 +1 +5000 -450000 +2250000",
         "sAN mLMPsetscancfg 1 1388 1 1388 FFF92230 225510"},
        {"sMN mLMPsetscancfg +2500 +1 +2500 -450000 +2250000",
         "sAN mLMPsetscancfg 3 1388 1 1388 FFF92230 225510"},
        {"sMN mLMPsetscancfg +5000 +1 +5000 0 +1800000",
         "sAN mLMPsetscancfg 4 1388 1 1388 FFF92230 225510"},
        {"sWN LMDscandatacfg 01 00 1 1 0 00 00 0 0 0 1 +2", "sWA LMDscandatacfg"},
        {"sRN LMDscandatacfg", "sRA LMDscandatacfg 1 0 1 1 0 0 0 0 0 0 1 2"},
        {"sWN LMPoutputRange 1 1388 FFF92230 225510", "sWA LMPoutputRange"},
        {"sWN LMPoutputRange 1 1388 0 DBBA0", "sWA LMPoutputRange"},
        {"sRN LMPoutputRange", "sRA LMPoutputRange 1 1388 0 DBBA0"},
        {"sWN LMPoutputRange 1 1388 +10 +9990", "sWA LMPoutputRange"},
        {"sRN LMPoutputRange", "sRA LMPoutputRange 1 1388 1388 1388"},
        {"sWN LMPoutputRange 1 1388 +10 +20", "sFA 5"},
        {"sWN LMPoutputRange 1 9C4 0 DBBA0", "sFA 5"},
        {"sWN LMPoutputRange 1 1388 +9000000 +9100000", "sFA 5"},
        {"sRN LMPoutputRange", "sRA LMPoutputRange 1 1388 1388 1388"},
        {"sMN LMCstopmeas", "sAN LMCstopmeas 0"},
        {"sRN STlms", "sRA STlms 3 0 8 00:00:00 A 01.01.1970 0 0 0"},
        {"sMN LMCstartmeas", "sAN LMCstartmeas 0"},
        {"sRN STlms", "sRA STlms 7 0 8 00:00:00 A 01.01.1970 0 0 0"},
        {"sMN Run", "sAN Run 1"},
        {"sMN mEEwriteall", "sAN mEEwriteall 1"},
        {"sRI0", "sRA 0 6 LMS111 5 V1.00"},
        {"sRI 0", "sRA 0 6 LMS111 5 V1.00"},
        {"sRN DeviceIdent", "sRA DeviceIdent 6 LMS111 5 V1.00"},
        {"sRN SerialNumber", "sRA SerialNumber 2 l1"},
        {"sRN FirmwareVersion", "sRA FirmwareVersion 5 V1.00"},
        {"sRN SCdevicestate", "sRA SCdevicestate 1"},
        {"sRN LIDinputstate", "sRA LIDinputstate 0 0 0 0 0 0 0"},
        {"sRN field000", "sRA field000 3F800000 00000000 1388 FFF92230 2 0 0 0 0 0 1 0 0"},
        {"sEN LFErec 1", "sEA LFErec 1"},
        {"sEN LIDoutputstate 1", "sEA LIDoutputstate 1"},
        {"sEN LIDinputstate 0", "sEA LIDinputstate 0"},
        {"sEN LIDinputstate", "sFA 5"},
        {"sRN field", "sFA 3"},
        {"sRN field00x", "sFA 3"},
        {"sRN nothing", "sFA 3"},
        {"sWN nothing 1", "sFA 3"},
        {"sMN nothing", "sFA 2"},
        {"sEN nothing 1", "sFA 3"},
        {"sEN LMDscandata", "sFA 5"},
        {"hello", "sFA 2"},
        {"", "sFA 2"},
        {"sEN LMDscandata 1", "sEA LMDscandata 1"},
        {"sEN LMDscandata 0", "sEA LMDscandata 0"}};
    for (const auto& [request, wanted] : conversation)
        EXPECT_EQ(askText(session, request), wanted) << request;
    EXPECT_EQ(askText(session, "sMN mSCreboot"), "sAN mSCreboot");
    EXPECT_TRUE(session.closing());
}

TEST(ColaSession, AnOutputRangeCutsScans) {
    Room room;
    ColaSession session(room, "l1");
    constexpr std::size_t kRanges = 26, kFirst = 90,
                          kCount = 181;  // of 541 beams, from 0 to 90 degrees
    const std::vector<std::string> whole = words(askText(session, "sRN LMDscandata"));
    EXPECT_EQ(askText(session, "sWN LMPoutputRange 1 1388 0 DBBA0"), "sWA LMPoutputRange");
    const std::vector<std::string> cut = words(askText(session, "sRN LMDscandata"));
    ASSERT_EQ(cut.size(), kRanges + kCount + 6);
    EXPECT_EQ(cut[23], "0");
    EXPECT_EQ(cut[24], "1388");
    EXPECT_EQ(cut[25], "B5");
    for (std::size_t i = 0; i < kCount; ++i)
        EXPECT_EQ(cut[kRanges + i], whole[kRanges + kFirst + i]) << i;
}

TEST(ColaSession, AScanInText) {
    Room room;
    ColaSession session(room, "l1");
    const std::vector<std::string> fields = words(askText(session, "sRN LMDscandata"));
    ASSERT_EQ(fields.size(), 26U + 541 + 6);
    EXPECT_EQ(fields[0], "sRA");
    EXPECT_EQ(fields[15], "0");
    EXPECT_EQ(fields[16], "1388");  // 50 Hz
    EXPECT_EQ(fields[17], "168");   // 36000 beams a second
    EXPECT_EQ(fields[19], "1");
    EXPECT_EQ(fields[20], "DIST1");
    EXPECT_EQ(fields[21], "3F800000");
    EXPECT_EQ(fields[22], "00000000");
    EXPECT_EQ(fields[23], "FFF92230");
    EXPECT_EQ(fields[24], "1388");
    EXPECT_EQ(fields[25], "21D");
    const std::vector<float>& ranges = room.world().reading(0).scan().ranges;
    for (std::size_t i = 0; i < ranges.size(); ++i)
        EXPECT_EQ(std::stol(fields[26 + i], nullptr, 16),
                  std::isfinite(ranges[i]) ? std::lround(1000 * static_cast<double>(ranges[i])) : 0)
            << i;
    for (std::size_t i = 26 + 541; i < fields.size(); ++i) EXPECT_EQ(fields[i], "0");
}

TEST(ColaSession, RemissionsAndDates) {
    Room room;
    room.offset = std::chrono::hours(24 * 31) + std::chrono::milliseconds(3723004);
    ColaSession session(room, "l2");
    askText(session, "sWN LMDscandatacfg 01 00 1 0 0 00 00 0 0 0 1 +1");
    std::vector<std::string> fields = words(askText(session, "sRN LMDscandata"));
    const std::size_t rssi = 26 + 271;
    EXPECT_EQ(fields.at(rssi), "1");
    EXPECT_EQ(fields.at(rssi + 1), "RSSI1");
    EXPECT_EQ(fields.at(rssi + 6), "10F");
    EXPECT_EQ(fields.at(rssi + 7 + 135), "C8");
    const std::vector<std::string> end(fields.end() - 12, fields.end());
    EXPECT_EQ(end, (std::vector<std::string>{"0", "0", "0", "1", "7B2", "2", "1", "1", "2", "3",
                                             "FA0", "0"}));
    askText(session, "sWN LMDscandatacfg 01 00 1 1 0 00 00 0 0 0 0 +1");
    fields = words(askText(session, "sRN LMDscandata"));
    EXPECT_EQ(fields.at(19), "2");
    EXPECT_EQ(fields.at(rssi), "RSSI1");
}

TEST(ColaSession, LongRangesHaveAScale) {
    Room room;
    ColaSession session(room, "l3");
    const std::vector<std::string> fields = words(askText(session, "sRN LMDscandata"));
    EXPECT_EQ(fields.at(21), "40000000");
    // 2 m to the wall at its left, in steps of 2 mm.
    EXPECT_EQ(fields.at(26 + 180), "3E8");
}

TEST(ColaSession, Streams) {
    Room room;
    ColaSession session(room, "l1");
    EXPECT_EQ(stepped(room, session, 4), "");
    askText(session, "sEN LMDscandata 1");
    const auto scansIn = [&](int steps, std::size_t unsent = 0) {
        const std::string out = stepped(room, session, steps, unsent);
        const std::string begin = "\2sSN LMDscandata 1 1 ";
        int count = 0;
        for (auto at = out.find(begin); at != std::string::npos; at = out.find(begin, at + 1))
            ++count;
        return count;
    };
    EXPECT_EQ(scansIn(100), 50);
    EXPECT_EQ(scansIn(100, 1 << 20), 0);
    askText(session, "sWN LMDscandatacfg 01 00 0 1 0 00 00 0 0 0 0 +5");
    EXPECT_NEAR(scansIn(100), 10, 1);
    askText(session, "sMN LMCstopmeas");
    EXPECT_EQ(scansIn(100), 0);
    askText(session, "sMN LMCstartmeas");
    EXPECT_NEAR(scansIn(100), 10, 1);
    askText(session, "sEN LMDscandata 0");
    EXPECT_EQ(scansIn(100), 0);
}

TEST(ColaSession, InBytes) {
    Room room;
    ColaSession session(room, "l1");
    const auto ask = [&](const std::string& request) {
        ColaTelegrams telegrams;
        telegrams.append(answered(session, colaFrame(request, true)));
        const auto one = telegrams.next();
        EXPECT_TRUE(one && one->is_binary);
        return one ? one->content : "";
    };
    // Access mode 3 and its password.
    EXPECT_EQ(ask("sMN SetAccessMode \3\xF4\x72\x47\x44"), "sAN SetAccessMode \1");
    EXPECT_EQ(ask("sRN nothing"), std::string("sFA\0\3", 5));
    EXPECT_EQ(ask("sRN LMPscancfg"),
              std::string(
                  "sRA LMPscancfg \0\0\x13\x88\0\1\0\0\x13\x88\xFF\xF9\x22\x30\0\x22\x55\x10", 33));
    EXPECT_EQ(ask("sEN LMDscandata \1"), "sEA LMDscandata \1");
    const std::string packet = stepped(room, session, 4);
    ColaTelegrams telegrams;
    // The longest telegram that is read is shorter than this one: look at its bytes.
    const std::string begin("\2\2\2\2\0\0", 6);
    ASSERT_TRUE(packet.starts_with(begin));
    const std::string content = packet.substr(8, packet.size() - 9);
    EXPECT_EQ(colaFrame(content, true), packet);
    EXPECT_TRUE(content.starts_with("sSN LMDscandata "));
    // As the telegram in sick_scan_xd's test/emulator has it.
    EXPECT_EQ(content.substr(16 + 32, 4), std::string("\0\0\x01\x68", 4));
    EXPECT_EQ(content.substr(16 + 36, 4), std::string("\0\0\0\1", 4));
    EXPECT_EQ(content.substr(16 + 40, 5), "DIST1");
    EXPECT_EQ(content.substr(16 + 45, 4), "\x3F\x80" + std::string(2, '\0'));
    EXPECT_EQ(content.substr(16 + 53, 4), "\xFF\xF9\x22\x30");
    EXPECT_EQ(content.substr(16 + 57, 4), "\x13\x88\x02\x1D");
    EXPECT_EQ(content.size(), 16U + 61 + 2 * 541 + 2 + 5 * 2);
    // The middle beam looks at the wall at 4 m.
    EXPECT_EQ(content.substr(16 + 61 + 2 * 270, 2), "\x0F\xA0");
}

TEST(ColaSession, GoesOnAtALowerRateAndAfterGoingBack) {
    Room room;
    ColaSession session(room, "l1");
    const auto scansIn = [&](int steps) {
        const std::string out = stepped(room, session, steps);
        return static_cast<double>(std::count(out.begin(), out.end(), '\2'));
    };
    askText(session, "sEN LMDscandata 1");
    EXPECT_NEAR(scansIn(500), 250, 1);
    room.world().change(
        testing::scene("ispace size=8,6\n", "laser id=l1 model=lms111 rate=5 at=0,0\n"));
    EXPECT_NEAR(scansIn(100), 5, 1);
    room.world().rewind();
    EXPECT_NEAR(scansIn(100), 50, 1);
}

TEST(ColaSession, StepsThatItCannotTell) {
    for (const char* step : {"7", "0.00001"}) {
        Room room;
        room.world().change(
            testing::scene("ispace size=8,6\n",
                           "laser id=l1 at=0,0 first=0 beams=3 step=" + std::string(step) + "\n"));
        EXPECT_EQ(kCola.refusal(room.world(), "l1"),
                  "l1: its step is not from 0.0001 to 6.5535 degrees, as CoLa wants it");
    }
}

TEST(ColaSession, EndsWithItsLaser) {
    Room room;
    ColaSession session(room, "l2");
    askText(session, "sEN LMDscandata 1");
    room.world().change(testing::scene("ispace size=8,6\n", "laser id=l1 at=0,0\n"));
    session.stepped(0);
    EXPECT_TRUE(session.closing());
}

/// What sick_scan_xd sends an LMS1xx by its sick_lms_1xx.launch, and how each answer begins. It
/// waits until the answer that it expects has come, and takes sFA for another one.
std::vector<std::pair<std::string, std::string>> startOfSickScan() {
    using namespace std::string_literals;
    const std::string range = "\0\1\0\0\x13\x88\xFF\xF9\x22\x30\0\x22\x55\x10"s;
    const std::string config = "\0\0\x13\x88"s + range;
    std::vector<std::pair<std::string, std::string>> out{
        {"sRN SCdevicestate", "sRA SCdevicestate \1"},
        {"sMN SetAccessMode \3\xF4\x72\x47\x44", "sAN SetAccessMode \1"},
        {"sWN EIHstCola \1", "sWA EIHstCola "},
        {"sRN FirmwareVersion", "sRA FirmwareVersion \0\5V1.00"s},
        {"sRN SCdevicestate", "sRA SCdevicestate \1"},
        {"sRN ODoprh", "sRA ODoprh \0\0\0\0"s},
        {"sRN ODpwrc", "sRA ODpwrc \0\0\0\1"s},
        {"sRN LocationName", "sRA LocationName \0\2l1"s},
        {"sRN LMPoutputRange", "sRA LMPoutputRange " + range},
        {"sWN LMPoutputRange " + range, "sWA LMPoutputRange "},
        {"sRN LMPoutputRange", "sRA LMPoutputRange " + range}};
    // As the device has it whose telegrams are in its test/emulator, but for scale and angles.
    const std::string field =
        "\x3F\x80\0\0\0\0\0\0\0\0\x13\x88\xFF\xF9\x22\x30\2\0"s + "\0\0\0\0\0\0\0\0\0\1\0\0\0\0"s;
    for (int i = 0; i < 30; ++i) {
        const std::string name = (i < 10 ? "field00" : "field0") + std::to_string(i);
        out.emplace_back("sRN " + name, "sRA " + name + " " + field);
    }
    const std::string inputs = "\0\0\0\0\0\0\0\0\0\0\0\0"s;
    const std::vector<std::pair<std::string, std::string>> rest{
        {"sRN LIDinputstate", "sRA LIDinputstate " + inputs},
        {"sWN LMDscandatacfg \1\0\0\0\0\0\0\0\0\0\1\0\1"s, "sWA LMDscandatacfg "},
        {"sRN LMDscandatacfg", "sRA LMDscandatacfg \1\0\0\0\0\0\0\0\0\0\1\0\1"s},
        {"sMN mLMPsetscancfg " + config, "sAN mLMPsetscancfg \0"s + config},
        {"sRN LMPscancfg", "sRA LMPscancfg " + config},
        {"sEN LFErec \1", "sEA LFErec \1"},
        {"sEN LIDoutputstate \1", "sEA LIDoutputstate \1"},
        {"sEN LIDinputstate \1", "sEA LIDinputstate \1"},
        {"sMN LMCstartmeas", "sAN LMCstartmeas \0"s},
        {"sMN Run", "sAN Run \1"},
        {"sRN SCdevicestate", "sRA SCdevicestate \1"},
        {"sEN LMDscandata \1", "sEA LMDscandata \1"}};
    out.insert(out.end(), rest.begin(), rest.end());
    return out;
}

TEST(ColaSession, StartsAsSickScanDoes) {
    Room room;
    ColaSession session(room, "l1");
    for (const auto& [request, wanted] : startOfSickScan())
        EXPECT_EQ(answered(session, colaFrame(request, true)), colaFrame(wanted, true)) << request;
    // Scans come, and only those.
    const std::string scans = stepped(room, session, 10);
    EXPECT_EQ(scans.find("sSN LMDscandata "), 8U);
    for (const char* event : {"sSN LFErec", "sSN LID"})
        EXPECT_EQ(scans.find(event), std::string::npos);
}

/// What drivers send to begin with.
const std::vector<std::string> kConversations{
    // libLMS1xx
    text("sMN SetAccessMode 03 F4724744") + text("sRN LMPscancfg") + text("sRN LMPoutputRange") +
        text("sWN LMDscandatacfg 01 00 1 1 0 00 00 0 0 0 0 +1") + text("sMN LMCstartmeas") +
        text("sRN STlms") + text("sMN Run") + text("sEN LMDscandata 1") +
        text("sEN LMDscandata 0") + text("sMN LMCstopmeas"),
    // sick_tim
    text("sRI0") + text("sRN SerialNumber") + text("sRN FirmwareVersion") +
        text("sRN SCdevicestate") + text("sEN LMDscandata 1"),
    // MRPT
    text("sMN SetAccessMode 03 F4724744") +
        text("sMN mLMPsetscancfg +2500 +1 +2500 -450000 +2250000") +
        text("sWN LMDscandatacfg 01 00 0 1 0 00 00 0 0 0 0 +1") + text("sMN LMCstartmeas") +
        text("sRN STlms") + text("sRN LMDscandata"),
    // sick_scan_xd, in B
    colaFrame("sMN SetAccessMode \3\xF4\x72\x47\x44", true) + colaFrame("sWN EIHstCola \1", true) +
        colaFrame("sRN FirmwareVersion", true) + colaFrame("sRN SCdevicestate", true) +
        colaFrame("sRN ODoprh", true) + colaFrame("sRN ODpwrc", true) +
        colaFrame("sRN LocationName", true) + colaFrame("sRN LMPoutputRange", true) +
        colaFrame("sMN LMCstartmeas", true) + colaFrame("sMN Run", true) +
        colaFrame("sEN LMDscandata \1", true)};

TEST(ColaSession, PiecesDoNotMatter) {
    for (const std::string& conversation : kConversations) {
        Room room;
        ColaSession whole(room, "l2");
        const std::string wanted = answered(whole, conversation);
        EXPECT_EQ(wanted.find("sFA"), std::string::npos);
        for (std::size_t piece = 1; piece < 40; ++piece) {
            ColaSession session(room, "l2");
            EXPECT_EQ(answered(session, conversation, piece), wanted) << piece;
        }
    }
}

}  // namespace cola_session_test
}  // namespace ispace::wire
