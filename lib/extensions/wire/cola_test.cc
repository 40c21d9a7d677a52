// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/cola.h"

#include <gtest/gtest.h>

#include <vector>

namespace ispace::wire {
namespace cola_test {

std::string bytes(std::initializer_list<int> values) {
    std::string out;
    for (const int value : values) out += static_cast<char>(value);
    return out;
}

std::vector<ColaTelegram> all(ColaTelegrams& telegrams) {
    std::vector<ColaTelegram> out;
    while (auto one = telegrams.next()) out.push_back(*one);
    return out;
}

TEST(Cola, Frames) {
    EXPECT_EQ(colaFrame("sRN STlms", false), "\2sRN STlms\3");
    // As recorded of a device in sick_scan_xd's test/emulator.
    EXPECT_EQ(colaFrame(std::string("sAN SetAccessMode ") + '\1', true),
              bytes({2,    2,    2,    2,    0,    0,    0,    0x13, 0x73, 0x41,
                     0x4e, 0x20, 0x53, 0x65, 0x74, 0x41, 0x63, 0x63, 0x65, 0x73,
                     0x73, 0x4d, 0x6f, 0x64, 0x65, 0x20, 0x01, 0x38}));
    EXPECT_EQ(colaFrame(std::string("sEA LMDscandata ") + '\1', true).back(), '\x3c');
    EXPECT_EQ(colaFrame("sWA LMDscandatacfg ", true).back(), '\x4d');
}

TEST(Cola, TelegramsOfBothDialects) {
    const std::string a = colaFrame("sRN STlms", false), b = colaFrame("sRN LMPscancfg", true);
    const std::vector<ColaTelegram> wanted{
        {"sRN STlms", false}, {"sRN LMPscancfg", true}, {"sRN STlms", false}};
    ColaTelegrams whole;
    whole.append(a + b + a);
    EXPECT_EQ(all(whole), wanted);
    const std::string stream = a + b + a;
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
        ColaTelegrams telegrams;
        telegrams.append(stream.substr(0, cut));
        std::vector<ColaTelegram> found = all(telegrams);
        telegrams.append(stream.substr(cut));
        for (const ColaTelegram& one : all(telegrams)) found.push_back(one);
        EXPECT_EQ(found, wanted) << cut;
    }
}

TEST(Cola, GarbageIsLeftOut) {
    const std::string a = colaFrame("sRN STlms", false);
    std::string wrong = colaFrame("sRN LMPscancfg", true);
    wrong.back() = static_cast<char>(wrong.back() ^ 1);
    const std::vector<ColaTelegram> wanted{{"sRN STlms", false}};
    for (const std::string& garbage :
         {std::string("hello"), std::string("\3\3"), std::string("\2half a telegram"), wrong,
          bytes({2, 2, 2, 2, 0xFF, 0xFF, 0xFF, 0xFF}), bytes({2, 2, 2, 0, 0}),
          "\2" + std::string(2000, 'x') + "\3"}) {
        ColaTelegrams telegrams;
        telegrams.append(garbage + a);
        EXPECT_EQ(all(telegrams), wanted) << garbage;
    }
}

TEST(Cola, AnEndlessTelegramTakesNoMemory) {
    ColaTelegrams telegrams;
    telegrams.append("\2");
    for (int i = 0; i < 1000; ++i) {
        telegrams.append(std::string(256, 'x'));
        EXPECT_EQ(telegrams.next(), std::nullopt);
        EXPECT_LE(telegrams.size(), ColaTelegrams::kMaxLength + 256);
    }
}

TEST(Cola, NumbersInA) {
    EXPECT_EQ(ColaWriter("sRA x", false)
                  .u16(0)
                  .u32(0xABC)
                  .i32(-450000)
                  .f32(1)
                  .f32(0)
                  .name("DIST1")
                  .text("V1.00")
                  .frame(),
              "\2sRA x 0 ABC FFF92230 3F800000 00000000 DIST1 5 V1.00\3");
    ColaReader in("+2500 9C4 -450000 FFF92230 +2250000 x", false);
    EXPECT_EQ(in.u32(), 2500);
    EXPECT_EQ(in.u16(), 2500);
    EXPECT_EQ(in.i32(), -450000);
    EXPECT_EQ(in.i32(), -450000);
    EXPECT_EQ(in.i32(), 2250000);
    EXPECT_EQ(in.u8(), std::nullopt);
    EXPECT_EQ(in.u8(), std::nullopt);
}

TEST(Cola, NumbersInB) {
    EXPECT_EQ(ColaWriter("sRA x", true).u8(1).u16(2).i32(-450000).text("ab").frame(),
              colaFrame("sRA x " + bytes({1, 0, 2, 0xFF, 0xF9, 0x22, 0x30, 0, 2}) + "ab", true));
    const std::string arguments = bytes({1, 0, 2, 0xFF, 0xF9, 0x22, 0x30, 7});
    ColaReader in(arguments, true);
    EXPECT_EQ(in.u8(), 1);
    EXPECT_EQ(in.u16(), 2);
    EXPECT_EQ(in.i32(), -450000);
    EXPECT_EQ(in.u16(), std::nullopt);
}

}  // namespace cola_test
}  // namespace ispace::wire
