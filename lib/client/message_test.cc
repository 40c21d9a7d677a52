// SPDX-License-Identifier: GPL-3.0-or-later
#include <ispace_client/message.h>
#include <ispace_client/reading.h>
#include <ispace_client/socket.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace ispace {
namespace client {
namespace {

TEST(ClientMessage, ReadsNumbersInAnyLocale) {
    EXPECT_EQ(numberOf("12.300"), 12.3);
    EXPECT_EQ(numberOf("-0.5"), -0.5);
    EXPECT_EQ(numberOf("7"), 7);
    EXPECT_EQ(numberOf("1e-07"), 1e-7);
    EXPECT_EQ(numberOf("0.12345678901234567"), 0.12345678901234567);
    EXPECT_TRUE(std::isinf(numberOf("-")));
    for (const char* text : {"", "x", "1.2.3", "1,5", "--1", "1 ", "."})
        EXPECT_THROW(numberOf(text), ProtocolError) << text;
}

TEST(ClientMessage, IntegersAndCountsHaveTheirRange) {
    const Fields fields = parseMessage("OK a=-3 b=- c=1e30 d=x").fields;
    EXPECT_EQ(fields.integer("a"), -3);
    for (const char* key : {"b", "c", "d"}) EXPECT_THROW(fields.integer(key), ProtocolError) << key;
    EXPECT_EQ(countOf("0"), 0U);
    EXPECT_EQ(countOf("1000000000"), 1000000000U);
    for (const char* text : {"-1", "-", "1.5", "1e30", "x", ""})
        EXPECT_THROW(countOf(text), ProtocolError) << text;
}

TEST(ClientMessage, WritesNumbersThatAreReadAgain) {
    EXPECT_EQ(textOf(0.3), "0.3");
    EXPECT_EQ(textOf(-90), "-90");
    EXPECT_THROW(textOf(NAN), Error);
    std::mt19937_64 random(1);
    for (int i = 0; i < 10000; ++i) {
        const double value = std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random),
                                        std::uniform_int_distribution<int>(-40, 40)(random));
        EXPECT_EQ(numberOf(textOf(value)), value);
    }
}

TEST(ClientMessage, SplitsAtEverySeparator) {
    EXPECT_EQ(split("", ','), std::vector<std::string>());
    EXPECT_EQ(split("a", ','), std::vector<std::string>({"a"}));
    EXPECT_EQ(split("a,,b,", ','), std::vector<std::string>({"a", "", "b", ""}));
}

TEST(ClientMessage, TakesLinesApart) {
    const Message message = parseMessage("SCAN l1 t=12.300 seq=123 r=1.5,-,2");
    EXPECT_EQ(message.words, std::vector<std::string>({"SCAN", "l1"}));
    EXPECT_EQ(message.fields.number("t"), 12.3);
    EXPECT_EQ(message.fields.integer("seq"), 123);
    ASSERT_EQ(message.fields.numbers("r").size(), 3U);
    EXPECT_TRUE(std::isinf(message.fields.numbers("r")[1]));
    EXPECT_FALSE(message.fields.has("n"));
    EXPECT_THROW(message.fields.text("n"), ProtocolError);
    EXPECT_EQ(message.fields.text("n", "-"), "-");
}

TEST(ClientMessage, TheTextOfAMarkGoesToTheEnd) {
    const Message message = parseMessage("EVENT mark t=1.500 text=the door = open");
    EXPECT_EQ(message.fields.text("text"), "the door = open");
    const Message change = parseMessage("EVENT change t=1.500 what=SET r1.speed=0.2");
    EXPECT_EQ(change.fields.text("what"), "SET r1.speed=0.2");
}

TEST(ClientMessage, DecodesBase64) {
    EXPECT_EQ(fromBase64(""), "");
    EXPECT_EQ(fromBase64("Zg=="), "f");
    EXPECT_EQ(fromBase64("Zm9vYmFy"), "foobar");
    EXPECT_EQ(fromBase64("AP8B/g=="), std::string("\0\xff\x01\xfe", 4));
    EXPECT_THROW(fromBase64("Z*=="), ProtocolError);
}

TEST(ClientAddress, IsAHostAndAPort) {
    const Address address("[::1]:7001");
    EXPECT_EQ(address.host, "::1");
    EXPECT_EQ(address.port, 7001);
    for (const char* text : {"", "localhost", ":7001", "a:", "a:0", "a:65536", "a:70x", "a:999999"})
        EXPECT_THROW(Address{text}, Error) << text;
}

Message frame(const std::string& line, const std::string& data) {
    Message message = parseMessage(line);
    message.data = data;
    return message;
}

TEST(ClientReading, ScansComeAsTextAndAsBytes) {
    const std::string head = "SCAN l1 t=0.100 seq=1 angle_min=-90 angle_max=90 step=90 n=3 ";
    const Scan text = Scan::from(parseMessage(head + "r=1.500,-,0.250"));
    const Scan bytes = Scan::from(
        frame(head + "bytes=12", std::string("\0\0\xc0\x3f\0\0\x80\x7f\0\0\x80\x3e", 12)));
    EXPECT_EQ(text.ranges, bytes.ranges);
    EXPECT_EQ(text.ranges[0], 1.5F);
    EXPECT_TRUE(std::isinf(text.ranges[1]));
    EXPECT_EQ(text.angle(2), 90);
    EXPECT_THROW(Scan::from(parseMessage(head + "r=1.500")), ProtocolError);
}

TEST(ClientReading, DepthsComeAsFloatsAndAsMillimetres) {
    const std::string head = "SCAN k t=0 seq=0 pose=1,2,3,90,-10,0 width=2 height=1 ";
    const Depths mm =
        Depths::from(frame(head + "format=depth16 bytes=4", std::string("\xdc\5\0\0", 4)));
    const Depths m = Depths::from(
        frame(head + "format=depth32 bytes=8", std::string("\0\0\xc0\x3f\0\0\x80\x7f", 8)));
    EXPECT_EQ(mm.depths, m.depths);
    EXPECT_EQ(m.at(0, 0), 1.5F);
    EXPECT_EQ(m.pose().heading, 90);
    EXPECT_THROW(Depths::from(frame(head + "format=depth16 bytes=2", "ab")), ProtocolError);
}

TEST(ClientReading, EveryKindIsRead) {
    const Burst burst = Burst::from(parseMessage("SCAN u1 t=1 seq=2 tags=t1,t2 tof=0.012345,-"));
    EXPECT_EQ(burst.tags, std::vector<std::string>({"t1", "t2"}));
    EXPECT_EQ(burst.times_of_flight[0], 0.012345);
    EXPECT_TRUE(std::isinf(burst.times_of_flight[1]));
    EXPECT_THROW(Burst::from(parseMessage("SCAN u1 t=1 seq=2 tags=t1,t2 tof=0.012345")),
                 ProtocolError);
    EXPECT_FALSE(
        Fix::from(parseMessage("SCAN t1 t=1 seq=2 heard=2 x=- y=- z=- residual=-")).solved);
    EXPECT_EQ(Fix::from(parseMessage("SCAN t1 t=1 seq=2 heard=4 x=1 y=2 z=0.5 residual=0.01")).y,
              2);
    EXPECT_EQ(Load::from(parseMessage("SCAN m1 t=1 seq=2 n=2 on=h1,r1")).on.size(), 2U);
    EXPECT_TRUE(Load::from(parseMessage("SCAN m1 t=1 seq=2 n=0 on=")).on.empty());
    const Passages passages =
        Passages::from(parseMessage("SCAN g1 t=1 seq=2 in=3 out=2 last=h1 way=in broken=1"));
    EXPECT_EQ(passages.in, 3);
    EXPECT_EQ(passages.way, "in");
    EXPECT_TRUE(passages.broken);
    EXPECT_EQ(
        Passages::from(parseMessage("SCAN g1 t=1 seq=2 in=0 out=0 last=- way=- broken=0")).last,
        "");
}

}  // namespace
}  // namespace client
}  // namespace ispace
