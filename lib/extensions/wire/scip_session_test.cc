// SPDX-License-Identifier: GPL-3.0-or-later
// Conversations as programs for real devices have them.
#include "extensions/wire/scip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "extensions/wire/tests/test_laser_host.h"

namespace ispace::wire {
namespace scip_session_test {

using testing::answered;
using testing::stepped;

constexpr auto kStep = std::chrono::milliseconds(25);

/// A URG-04LX at the middle of a room of 8 m by 6 m, a UTM-30LX, a bare laser, a UTM-30LX-EW.
struct Room : testing::LaserHost {
    Room()
        : LaserHost("ispace size=8,6\n",
                    "laser id=l1 model=urg-04lx at=0,0\n"
                    "laser id=l2 model=utm-30lx at=1,0 heading=90\n"
                    "laser id=l3 at=3,0 fov=4 step=2 range=0.5,2\n"
                    "laser id=l4 model=utm-30lx-ew at=1,0 heading=90\n",
                    kStep) {}
};

std::string reply(const std::string& echo, const std::string& status) {
    return echo + "\n" + status + "\n\n";
}

/// Every line but echoes carries its check character; each packet ends in an empty line.
void expectWhole(const std::string& bytes) {
    std::istringstream in(bytes);
    bool is_echo = true;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || is_echo) {
            is_echo = line.empty();
            continue;
        }
        std::string content = line.substr(0, line.size() - 1);
        const bool is_field = content.find(':') == 4 && content.ends_with(';');
        if (is_field) content.pop_back();
        EXPECT_EQ(line.back(), scipCheck(content)) << line;
    }
    EXPECT_TRUE(bytes.empty() || bytes.ends_with("\n\n"));
}

/// The values of the only packet, of three characters each.
std::vector<int> valuesOf(const std::string& packet) {
    std::istringstream in(packet);
    std::string echo, status, time, values;
    std::getline(in, echo);
    std::getline(in, status);
    std::getline(in, time);
    for (std::string line; std::getline(in, line) && !line.empty();)
        values += line.substr(0, line.size() - 1);
    std::vector<int> out;
    for (std::size_t i = 0; i + 2 < values.size(); i += 3)
        out.push_back((values[i] - 0x30) * 4096 + (values[i + 1] - 0x30) * 64 + values[i + 2] -
                      0x30);
    return out;
}

TEST(ScipSession, SaysWhatItIs) {
    Room room;
    ScipSession session(room, "l1");
    EXPECT_EQ(answered(session, "PP\n"),
              "PP\n00P\nMODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\nDMIN:20;4\nDMAX:5600;_\n"
              "ARES:1024;\\\nAMIN:44;7\nAMAX:725;o\nAFRT:384;6\nSCAN:600;e\n\n");
    const std::string product = answered(session, "VV\n"), state = answered(session, "II\n");
    expectWhole(product);
    expectWhole(state);
    // Echo, status, five or seven fields, and the empty line.
    EXPECT_EQ(std::count(product.begin(), product.end(), '\n'), 8);
    EXPECT_EQ(std::count(state.begin(), state.end(), '\n'), 10);
    EXPECT_NE(product.find("\nPROT:SCIP 2.0;N\n"), std::string::npos);
    EXPECT_NE(state.find("\nLASR:OFF;7\n"), std::string::npos);
    answered(session, "BM\n");
    EXPECT_NE(answered(session, "II\n").find("\nLASR:ON;"), std::string::npos);
    ScipSession other(room, "l2");
    EXPECT_NE(answered(other, "VV\n"), product);
}

TEST(ScipSession, Statuses) {
    Room room;
    ScipSession session(room, "l1");
    const std::vector<std::pair<std::string, std::string>> conversation{
        {"GD0044072501", "10Q"},
        {"BM", "00P"},
        {"BM", "02R"},
        {"QT", "00P"},
        {"SCIP2.0", "00P"},
        {"XX", "0Ee"},
        {"ND0044072501000", "0Ee"},
        {"ME0044072501000", "0Ee"},
        {"V", "0Ee"},
        {"VV1", "0Ee"},
        {"SS019200", "00P"},
        {"SS019200", "03S"},
        {"SS000000", "02R"},
        {"SSx", "01Q"},
        {"CR00", "00P"},
        {"CR05", "04T"},
        {"CR11", "02R"},
        {"CR", "01Q"},
        {"HS0", "02R"},
        {"HS1", "00P"},
        {"HS1", "02R"},
        {"HS2", "01Q"},
        {"TM1", "04T"},
        {"TM2", "03S"},
        {"TM0", "00P"},
        {"TM0", "02R"},
        {"QT", "0Ee"},
        {"BM", "0Ee"},
        {"MD0044072501000", "0Ee"},
        {"TM2", "00P"},
        {"TM9", "01Q"},
        {"MD0044072601000", "04T"},
        {"MD0100005001000", "05U"},
        {"RS", "00P"},
        {"RT", "00P"},
        {"QT;a text", "00P"},
        {"QT;a-text", "0Hh"},
        {"%SL1", "0Ee"},
        {"%XX", "0Ee"},
        {"QT;01234567890123456", "0Gg"}};
    for (const auto& [request, status] : conversation)
        EXPECT_EQ(answered(session, request + "\n"), reply(request, status));
}

TEST(ScipSession, TellsTheTime) {
    Room room;
    room.offset = std::chrono::milliseconds(16000000);
    ScipSession session(room, "l1");
    answered(session, "TM0\n");
    EXPECT_EQ(answered(session, "TM1\n"),
              "TM1\n00P\nm2@0" + std::string(1, scipCheck("m2@0")) + "\n\n");
    // It begins again after 24 bits of milliseconds.
    room.offset = std::chrono::milliseconds(1 << 24);
    EXPECT_EQ(answered(session, "TM1\n"),
              "TM1\n00P\n0000" + std::string(1, scipCheck("0000")) + "\n\n");
}

TEST(ScipSession, ACountedStream) {
    Room room;
    ScipSession session(room, "l1");
    EXPECT_EQ(answered(session, "MD0044004601002\n"), reply("MD0044004601002", "00P"));
    EXPECT_EQ(stepped(room, session, 6), "");
    // Begun after 0.1 s and 0.2 s, and there with the last beam, 67 ms later; three steps to the
    // right of the front, 30 degrees behind the side.
    const std::string first = stepped(room, session, 1), second = stepped(room, session, 4);
    EXPECT_TRUE(first.starts_with("MD0044004601001\n99b\n001T")) << first;
    EXPECT_TRUE(second.starts_with("MD0044004601000\n99b\n0038")) << second;
    expectWhole(first);
    expectWhole(second);
    const std::vector<int> values = valuesOf(first);
    ASSERT_EQ(values.size(), 3U);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Angle bearing = Angle::degrees((44.0 + static_cast<double>(i) - 384) * 360 / 1024);
        EXPECT_NEAR(values[i], 3000 / -std::sin(bearing.radians()), 1) << i;
    }
    EXPECT_EQ(stepped(room, session, 12), "");
    // The laser stays on.
    EXPECT_EQ(answered(session, "BM\n"), reply("BM", "02R"));
}

TEST(ScipSession, AllOfAScan) {
    Room room;
    ScipSession session(room, "l1");
    answered(session, "BM\n");
    const std::string packet = answered(session, "GD0044072501\n");
    EXPECT_TRUE(packet.starts_with("GD0044072501\n00P\n0000")) << packet.substr(0, 40);
    expectWhole(packet);
    const std::vector<int> values = valuesOf(packet);
    const std::vector<float>& ranges = room.world().reading(0).scan().ranges;
    ASSERT_EQ(values.size(), ranges.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(values[i],
                  std::isfinite(ranges[i]) ? std::lround(1000 * static_cast<double>(ranges[i])) : 0)
            << i;
    // Two characters; merged; beyond the first beam.
    EXPECT_EQ(answered(session, "GS0384038401\n").substr(0, 16), "GS0384038401\n00P");
    EXPECT_EQ(valuesOf(answered(session, "GD0044072503\n")).size(), 228U);
    EXPECT_EQ(valuesOf(answered(session, "GD0000004401\n")).front(), 19);
}

TEST(ScipSession, TwoCharactersEndAt4095) {
    Room room;
    ScipSession session(room, "l2");
    answered(session, "BM\n");
    // Beams of l2 that look back along x meet the wall at 5 m, those along y at 3 m.
    EXPECT_NE(answered(session, "GS0900090001\n").find("\noo"), std::string::npos);
    EXPECT_EQ(valuesOf(answered(session, "GD0900090001\n")), std::vector<int>{5000});
    EXPECT_EQ(valuesOf(answered(session, "GE0540054001\n")), (std::vector<int>{3000, 1000}));
}

TEST(ScipSession, TellsItsState) {
    Room room;
    ScipSession session(room, "l1");
    const auto state = [&] { return answered(session, "%ST\n"); };
    const auto coded = [](const std::string& code) {
        return "%ST\n00P\n" + code + scipCheck(code) + "\n\n";
    };
    EXPECT_EQ(state(), coded("000"));
    EXPECT_TRUE(session.understood());
    const std::vector<std::pair<std::string, std::string>> conversation{
        {"TM0", "002"}, {"TM2", "000"}, {"BM", "003"}, {"MD0044072501001", "004"},
        {"QT", "000"},  {"%SL", "005"}, {"QT", "000"}, {"MD0044072501000", "004"},
        {"%SL", "005"}, {"BM", "003"},  {"%SL", "005"}};
    for (const auto& [request, code] : conversation) {
        EXPECT_EQ(answered(session, request + "\n"), reply(request, "00P"));
        EXPECT_EQ(state(), coded(code)) << request;
    }
    EXPECT_EQ(stepped(room, session, 40), "") << "it sleeps";
    EXPECT_EQ(answered(session, "GD0044072501\n"), reply("GD0044072501", "10Q"));
    answered(session, "MD0044072501001\n");
    stepped(room, session, 40);
    EXPECT_EQ(state(), coded("003")) << "all scans have been sent";
    answered(session, "TM0\n");
    EXPECT_EQ(answered(session, "%SL\n"), reply("%SL", "0Ee"));
}

TEST(ScipSession, OneEchoOfModelsWithSeveral) {
    Room room;
    ScipSession session(room, "l4");
    answered(session, "BM\n");
    EXPECT_EQ(valuesOf(answered(session, "HD0900090001\n")), std::vector<int>{5000});
    EXPECT_EQ(valuesOf(answered(session, "HE0540054001\n")), (std::vector<int>{3000, 1000}));
    // Packets are those of GD and MD but for their first letter.
    std::string echoes = answered(session, "HD0000108001\n");
    expectWhole(echoes);
    echoes[0] = 'G';
    EXPECT_EQ(echoes, answered(session, "GD0000108001\n"));
    EXPECT_EQ(answered(session, "ND0540054101001\n"), reply("ND0540054101001", "00P"));
    const std::string stream = stepped(room, session, 3);
    EXPECT_TRUE(stream.starts_with("ND0540054101000\n99b\n")) << stream;
    EXPECT_EQ(valuesOf(stream).size(), 2U);
    EXPECT_EQ(answered(session, "NE0540054101000\n"), reply("NE0540054101000", "00P"));
    EXPECT_EQ(valuesOf(stepped(room, session, 1)).size(), 4U);
    for (const char* request : {"HS0540054001", "NS0540054101000"})
        EXPECT_FALSE(answered(session, std::string(request) + "\n").find("\n00P\n") !=
                     std::string::npos)
            << request;
    for (const char* model : {"l1", "l2", "l3"}) {
        ScipSession other(room, model);
        EXPECT_EQ(answered(other, "HD0001000201\n"), reply("HD0001000201", "0Ee")) << model;
    }
}

TEST(ScipSession, NoReturn) {
    Room room;
    ScipSession bare(room, "l3");
    answered(bare, "BM\n");
    // 1 m to the wall; the next one keeps its distance from walls farther than its range.
    EXPECT_EQ(valuesOf(answered(bare, "GD0001000301\n")).at(1), 1000);
    ScipSession urg(room, "l1");
    answered(urg, "BM\n");
    EXPECT_EQ(valuesOf(answered(urg, "GD0384038401\n")), std::vector<int>{4000});
}

TEST(ScipSession, IntervalsAndSlowReaders) {
    Room room;
    ScipSession session(room, "l1");
    const auto scansIn = [&](int steps, std::size_t unsent) {
        const std::string out = stepped(room, session, steps, unsent);
        std::size_t count = 0;
        for (auto at = out.find("\n99b\n"); at != std::string::npos;
             at = out.find("\n99b\n", at + 1))
            ++count;
        return count;
    };
    answered(session, "MD0044072501000\n");
    EXPECT_EQ(scansIn(40, 0), 9U) << "the tenth has begun";
    answered(session, "MD0044072501400\n");  // replaces it
    EXPECT_EQ(scansIn(40, 0), 2U);
    answered(session, "MD0044072501005\n");
    EXPECT_EQ(scansIn(40, 1 << 20), 0U);
    // Those that found no room are not counted.
    EXPECT_EQ(scansIn(40, 0), 5U);
}

TEST(ScipSession, GoesOnAtALowerRateAndAfterGoingBack) {
    Room room;
    ScipSession session(room, "l1");
    const auto scansIn = [&](int steps) {
        const std::string out = stepped(room, session, steps);
        std::size_t count = 0;
        for (auto at = out.find("\n99b\n"); at != std::string::npos;
             at = out.find("\n99b\n", at + 1))
            ++count;
        return count;
    };
    answered(session, "MD0044072501000\n");
    EXPECT_EQ(scansIn(200), 49U);
    room.world().change(
        testing::scene("ispace size=8,6\n", "laser id=l1 model=urg-04lx rate=5 at=0,0\n"));
    EXPECT_EQ(scansIn(40), 4U);
    room.world().rewind();
    EXPECT_NEAR(static_cast<double>(scansIn(40)), 10, 1);
}

TEST(ScipSession, QtStopsTheStream) {
    Room room;
    ScipSession session(room, "l1");
    answered(session, "MD0044072501000\n");
    EXPECT_NE(stepped(room, session, 8), "");
    EXPECT_EQ(answered(session, "QT\n"), reply("QT", "00P"));
    EXPECT_EQ(stepped(room, session, 40), "");
    EXPECT_EQ(answered(session, "GD0044072501\n"), reply("GD0044072501", "10Q"));
}

TEST(ScipSession, RebootsWhenAskedTwice) {
    Room room;
    ScipSession session(room, "l1");
    EXPECT_EQ(answered(session, "RB\nQT\nRB\n"),
              reply("RB", "01Q") + reply("QT", "00P") + reply("RB", "01Q"));
    EXPECT_FALSE(session.closing());
    EXPECT_EQ(answered(session, "RB\nVV\n"), reply("RB", "00P"));
    EXPECT_TRUE(session.closing());
}

TEST(ScipSession, EndsWithItsLaser) {
    Room room;
    ScipSession session(room, "l2");
    answered(session, "MD0000108001000\n");
    room.world().change(
        testing::scene("ispace size=8,6\n", "laser id=l1 at=0,0\nlaser id=l2 at=1,0\n"));
    session.stepped(0);
    EXPECT_FALSE(session.closing());
    // Another laser of that name, which has fewer steps.
    EXPECT_EQ(stepped(room, session, 40), "");
    EXPECT_NE(answered(session, "PP\n").find("ARES:360;"), std::string::npos);
    room.world().change(testing::scene("ispace size=8,6\n", "laser id=l1 at=0,0\n"));
    session.stepped(0);
    EXPECT_TRUE(session.closing());
}

TEST(ScipSession, KnowsWhoSpeaksItsLanguage) {
    Room room;
    ScipSession session(room, "l1");
    for (const char* other : {"x", "\n", "GET / HTTP/1.1\r\n\r\n", "HELLO\n"}) {
        answered(session, other);
        EXPECT_FALSE(session.understood()) << other;
    }
    answered(session, "VV\n");
    EXPECT_TRUE(session.understood());
}

/// What programs send to begin with, as logs of them have it.
const std::vector<std::string> kConversations{
    // urg_library, get_distance
    "\nQT\nPP\nVV\nBM\nGD0044072500\nMD0044072501010\nQT\n",
    // MRPT's CHokuyoURG
    "QT\nQT\nSCIP2.0\nBM\nHS0\nPP\nVV\nMD0044072501000\nQT\nQT\nSCIP2.0\nBM\nHS0\nPP\nVV\n"
    "MD0044072501000\nQT\n",
    // ARIA's urg2.0
    "RS\nSCIP2.0\nVV\nPP\nMD0044072503000\nRS\nSS000000\n",
    // ROS' urg_node
    "\r\nQT\r\nPP\r\nVV\r\nII\r\nME0044072501101\r\nND0044072501000\r\nTM0\r\nTM1\r\nTM2\r\n"
    "RB\r\nRB\r\n",
    // hokuyolx: synchronizes its clock, reads the parameters, takes scans
    "%ST\nTM0\nTM1\nTM1\nTM1\nTM2\nPP\nBM\nGD0044072500\nGE0044072500\nMD0044072500002\nQT\n"
    "%ST\n%SL\n",
    // urg_library, get_multiecho and get_multiecho_intensity
    "\nQT\nPP\nND0044072501010\nQT\nNE0044072501010\nBM\nHD0044072501\nQT\n"};

TEST(ScipSession, PiecesDoNotMatter) {
    for (const std::string& conversation : kConversations) {
        Room room;
        ScipSession whole(room, "l1");
        const std::string wanted = answered(whole, conversation);
        expectWhole(wanted);
        for (std::size_t cut = 1; cut < conversation.size(); ++cut) {
            ScipSession session(room, "l1");
            std::string out = answered(session, conversation.substr(0, cut));
            out += answered(session, conversation.substr(cut));
            EXPECT_EQ(out, wanted) << "cut at " << cut;
        }
        ScipSession session(room, "l1");
        EXPECT_EQ(answered(session, conversation, 1), wanted);
    }
}

}  // namespace scip_session_test
}  // namespace ispace::wire
