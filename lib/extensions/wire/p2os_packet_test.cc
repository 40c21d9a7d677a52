// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/p2os_packet.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace ispace::wire {

namespace p2os_packet_test {

std::string bytes(std::initializer_list<int> values) {
    std::string out;
    for (const int value : values) out += static_cast<char>(value);
    return out;
}

std::vector<P2osPacket> allOf(P2osParser& parser) {
    std::vector<P2osPacket> packets;
    while (auto packet = parser.take()) packets.push_back(std::move(*packet));
    return packets;
}

std::vector<P2osPacket> parse(std::string_view stream) {
    P2osParser parser;
    parser.append(stream);
    return allOf(parser);
}

const std::string kSync0 = bytes({0xfa, 0xfb, 3, 0, 0, 0});
const std::string kSync1 = bytes({0xfa, 0xfb, 3, 1, 0, 1});
const std::string kSync2 = bytes({0xfa, 0xfb, 3, 2, 0, 2});
const std::string kVelAhead = bytes({0xfa, 0xfb, 6, 0x0b, 0x3b, 0x2c, 1, 0x37, 0x3c});
const std::string kVelBack = bytes({0xfa, 0xfb, 6, 0x0b, 0x1b, 0x2c, 1, 0x37, 0x1c});
const std::string kOpen = bytes({0xfa, 0xfb, 6, 1, 0x3b, 1, 0, 2, 0x3b});
const std::string kEnable = bytes({0xfa, 0xfb, 6, 4, 0x3b, 1, 0, 5, 0x3b});

TEST(P2osPacket, MakesTheBytesThatRobotsAndProgramsSend) {
    EXPECT_EQ(p2osBytes(0), kSync0);
    EXPECT_EQ(p2osBytes(1), kSync1);
    EXPECT_EQ(p2osBytes(2), kSync2);
    EXPECT_EQ(p2osBytes(0x0b, bytes({0x3b, 0x2c, 1})), kVelAhead);
    EXPECT_EQ(p2osBytes(0x0b, bytes({0x1b, 0x2c, 1})), kVelBack);
    EXPECT_EQ(p2osBytes(1, bytes({0x3b, 1, 0})), kOpen);
    EXPECT_EQ(p2osBytes(4, bytes({0x3b, 1, 0})), kEnable);
    const std::string names("MobileSim\0Pioneer\0p3dx-sh\0", 26);
    const std::string reply =
        bytes({0xfa, 0xfb, 0x1d, 2,    0x4d, 0x6f, 0x62, 0x69, 0x6c, 0x65, 0x53,
               0x69, 0x6d, 0,    0x50, 0x69, 0x6f, 0x6e, 0x65, 0x65, 0x72, 0,
               0x70, 0x33, 0x64, 0x78, 0x2d, 0x73, 0x68, 0,    0x06, 0xda});
    EXPECT_EQ(p2osBytes(2, names), reply);
    P2osWriter out;
    EXPECT_EQ(out.text("MobileSim").text("Pioneer").text("p3dx-sh").packet(2), reply);
}

TEST(P2osPacket, ReadsThemHoweverTheyAreCut) {
    const std::string stream = kSync0 + kSync1 + kSync2 + kOpen + kEnable + kVelAhead + kVelBack;
    const std::vector<P2osPacket> all = parse(stream);
    ASSERT_EQ(all.size(), 7U);
    EXPECT_EQ(all[5], (P2osPacket{0x0b, bytes({0x3b, 0x2c, 1})}));
    for (std::size_t first = 0; first <= stream.size(); ++first) {
        for (std::size_t second = first; second <= stream.size(); ++second) {
            P2osParser parser;
            std::vector<P2osPacket> found;
            for (const std::string& part :
                 {stream.substr(0, first), stream.substr(first, second - first),
                  stream.substr(second)}) {
                parser.append(part);
                for (P2osPacket& packet : allOf(parser)) found.push_back(std::move(packet));
            }
            ASSERT_EQ(found, all) << first << ' ' << second;
            EXPECT_EQ(parser.pending(), 0U);
        }
    }
}

TEST(P2osPacket, PassesOverWhatIsNone) {
    std::string wrong = kVelAhead;
    wrong.back() ^= 1;
    EXPECT_TRUE(parse(wrong).empty());
    EXPECT_EQ(parse(wrong + kVelBack), parse(kVelBack));
    EXPECT_EQ(parse("GET / HTTP/1.1\r\n" + kVelBack), parse(kVelBack));
    // Half of a packet, then a whole one.
    for (std::size_t size = 0; size < kVelAhead.size(); ++size)
        EXPECT_EQ(parse(kVelAhead.substr(0, size) + kVelBack + kVelAhead).back(),
                  parse(kVelAhead).back())
            << size;
    // Lengths that no packet has: too short for an id, longer than any.
    EXPECT_EQ(parse(bytes({0xfa, 0xfb, 2, 0, 0}) + kSync1), parse(kSync1));
    EXPECT_EQ(parse(bytes({0xfa, 0xfb, 201, 0, 0}) + kSync1), parse(kSync1));
    EXPECT_EQ(parse(bytes({0xfa, 0xfa}) + kSync1.substr(1)), parse(kSync1));
}

TEST(P2osPacket, FindsWholeOnesBehindADamagedLength) {
    std::string damaged = kVelAhead;
    damaged[2] = 40;
    std::string stream = damaged;
    for (int i = 0; i < 10; ++i) stream += kVelBack;
    const auto found = parse(stream);
    ASSERT_EQ(found.size(), 10U);
    EXPECT_EQ(found.front(), parse(kVelBack).front());
}

TEST(P2osPacket, SkipsOneThatDoesNotGoOn) {
    P2osParser parser;
    parser.append(bytes({0xfa, 0xfb, 200}) + kVelBack);
    EXPECT_FALSE(parser.take());
    parser.skip();
    EXPECT_EQ(parser.take(), parse(kVelBack).front());
    parser.skip();
    EXPECT_FALSE(parser.take());
}

TEST(P2osPacket, KeepsNoMoreThanAPacket) {
    std::mt19937 random(7);
    P2osParser parser;
    for (int i = 0; i < 20'000; ++i) {
        std::string noise(1 + random() % 50, '\0');
        for (char& c : noise) {
            constexpr std::string_view kLikely = "\xFA\xFB\x03";
            c = random() % 3 == 0 ? static_cast<char>(random()) : kLikely[random() % 3];
        }
        parser.append(noise);
        while (parser.take()) continue;
        ASSERT_LE(parser.pending(), 203U);
    }
}

TEST(P2osPacket, GoesThereAndBack) {
    std::mt19937 random(11);
    P2osParser parser;
    for (int i = 0; i < 2000; ++i) {
        P2osPacket packet{static_cast<std::uint8_t>(random()),
                          std::string(random() % (kMaxP2osData + 1), '\0')};
        for (char& c : packet.data) c = static_cast<char>(random());
        parser.append(p2osBytes(packet.id, packet.data));
        ASSERT_EQ(parser.take(), packet);
    }
}

TEST(P2osPacket, SumsWords) {
    EXPECT_EQ(p2osChecksum(""), 0);
    EXPECT_EQ(p2osChecksum("\x01"), 1);
    EXPECT_EQ(p2osChecksum("\x01\x02\x04"), 0x0102 ^ 4);
    EXPECT_EQ(p2osChecksum(std::string("\xFF\xFF\x00\x02", 4)), 1);
}

TEST(P2osPacket, ReadsNumbers) {
    const auto number = [](std::initializer_list<int> data) {
        return p2osNumber({11, bytes(data)});
    };
    EXPECT_EQ(number({0x3b, 0x2c, 1}), 300);
    EXPECT_EQ(number({0x1b, 0x2c, 1}), -300);
    EXPECT_EQ(number({0x3b, 0xff, 0xff}), 65535);
    EXPECT_EQ(number({0x1b, 0, 0x80}), -32768);
    EXPECT_EQ(number({0x00, 5, 0}), 5);
    EXPECT_EQ(number({}), std::nullopt);
    EXPECT_EQ(number({0x3b}), std::nullopt);
    EXPECT_EQ(number({0x3b, 1}), std::nullopt);
    const std::string data = bytes({0xff, 0xfe, 0xff, 0xff, 0xff, 0x7f});
    EXPECT_EQ(p2osInteger(data, 0, 1), -1);
    EXPECT_EQ(p2osInteger(data, 1, 2), -2);
    EXPECT_EQ(p2osInteger(data, 1, 4), -2);
    EXPECT_EQ(p2osInteger(data, 4, 2), 0x7fff);
}

}  // namespace p2os_packet_test

}  // namespace ispace::wire
