// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/scip.h"

#include <gtest/gtest.h>

#include <vector>

namespace ispace::wire {
namespace scip_test {

// The values of this file are those of Hokuyo's specification and of logs of devices.

TEST(Scip, CheckCharacters) {
    const std::vector<std::pair<std::string, char>> known{
        {"00", 'P'},           {"01", 'Q'},       {"02", 'R'},        {"03", 'S'},
        {"04", 'T'},           {"05", 'U'},       {"06", 'V'},        {"07", 'W'},
        {"0A", 'a'},           {"0B", 'b'},       {"0C", 'c'},        {"0D", 'd'},
        {"0E", 'e'},           {"0F", 'f'},       {"10", 'Q'},        {"98", 'a'},
        {"99", 'b'},           {"DMIN:20", '4'},  {"DMAX:5600", '_'}, {"ARES:1024", '\\'},
        {"AMIN:44", '7'},      {"AMAX:725", 'o'}, {"AFRT:384", '6'},  {"SCAN:600", 'e'},
        {"PROT:SCIP 2.0", 'N'}};
    for (const auto& [content, check] : known) EXPECT_EQ(scipCheck(content), check) << content;
}

TEST(Scip, Numbers) {
    const auto number = [](std::uint32_t value, int characters) {
        std::string out;
        appendScipNumber(out, value, characters);
        return out;
    };
    EXPECT_EQ(number(1234, 2), "CB");
    EXPECT_EQ(number(5432, 3), "1Dh");
    EXPECT_EQ(number(16000000, 4), "m2@0");
    EXPECT_EQ(number(1, 3), "001");
    EXPECT_EQ(number(65533, 3), "?om");
    EXPECT_EQ(number(0, 2), "00");
    EXPECT_EQ(number(4095, 2), "oo");
    EXPECT_EQ(number(0xFFFFFF, 4), "oooo");
}

TEST(Scip, FieldsAndLines) {
    std::string out;
    appendScipField(out, "DMIN", "20");
    appendScipLine(out, "00");
    EXPECT_EQ(out, "DMIN:20;4\n00P\n");
}

TEST(Scip, DataIsCutEvery64CharactersWhereverThatIs) {
    const auto lines = [](std::size_t size) {
        std::string out;
        appendScipData(out, std::string(size, '0'));
        return out;
    };
    // 64 * 0x30 has the low bits 0.
    const std::string full = std::string(64, '0') + "0\n";
    EXPECT_EQ(lines(0), "");
    EXPECT_EQ(lines(3), "000@\n");
    EXPECT_EQ(lines(64), full);
    EXPECT_EQ(lines(65), full + "0`\n");
    EXPECT_EQ(lines(128), full + full);
}

TEST(Scip, LinesEndInAnyWay) {
    ScipLines lines;
    lines.append("\n\r\nVV\rPP\nII\r\n\nM");
    EXPECT_EQ(lines.next(), "VV");
    EXPECT_EQ(lines.next(), "PP");
    EXPECT_EQ(lines.next(), "II");
    EXPECT_EQ(lines.next(), std::nullopt);
    lines.append("D\n");
    EXPECT_EQ(lines.next(), "MD");
    EXPECT_EQ(lines.next(), std::nullopt);
}

TEST(Scip, AnEndlessLineTakesNoMemory) {
    ScipLines lines;
    for (int i = 0; i < 1000; ++i) {
        lines.append(std::string(1000, 'x'));
        EXPECT_EQ(lines.next(), std::nullopt);
        EXPECT_LE(lines.size(), ScipLines::kMaxLength + 1);
    }
    lines.append("\nVV\n");
    const auto cut = lines.next();
    ASSERT_TRUE(cut);
    EXPECT_EQ(ScipRequest::of(*cut).fault, "0F");
    EXPECT_EQ(lines.next(), "VV");
}

TEST(Scip, Requests) {
    const std::string line = "MD0044072501000;hello +@_.1";
    const ScipRequest request = ScipRequest::of(line);
    EXPECT_EQ(request.command, "MD");
    EXPECT_EQ(request.parameters, "0044072501000");
    EXPECT_EQ(request.text, ";hello +@_.1");
    EXPECT_EQ(request.fault, "");
    EXPECT_EQ(ScipRequest::of("SCIP2.0").command, "SCIP2.0");
    EXPECT_EQ(ScipRequest::of("VV;0123456789abcdef").fault, "");
    EXPECT_EQ(ScipRequest::of("VV;0123456789abcdefg").fault, "0G");
    EXPECT_EQ(ScipRequest::of("VV;a-b").fault, "0H");
    EXPECT_EQ(ScipRequest::of("V").command, "V");
    EXPECT_EQ(ScipRequest::of("").command, "");
}

std::string statusOf(std::string_view parameters, bool streams) {
    std::string status;
    static_cast<void>(parseScipSweep(parameters, streams, 725, status));
    return status;
}

TEST(Scip, Sweeps) {
    std::string status;
    const ScipSweep sweep = parseScipSweep("0044072503412", true, 725, status);
    EXPECT_EQ(status, "00");
    EXPECT_EQ(sweep.start, 44);
    EXPECT_EQ(sweep.end, 725);
    EXPECT_EQ(sweep.cluster, 3);
    EXPECT_EQ(sweep.interval, 4);
    EXPECT_EQ(sweep.count, 12);
    EXPECT_EQ(parseScipSweep("0000000000", false, 725, status).cluster, 1);
    EXPECT_EQ(status, "00");
    for (const auto& [parameters, wanted] :
         std::vector<std::pair<std::string, std::string>>{{"x044072501000", "01"},
                                                          {"0044x72501000", "02"},
                                                          {"00440725 1000", "03"},
                                                          {"0044072501x00", "06"},
                                                          {"004407250100-", "07"},
                                                          {"0044072601000", "04"},
                                                          {"0045004401000", "05"},
                                                          {"004407250100", "0C"},
                                                          {"00440725010000", "0D"},
                                                          {"", "0C"}})
        EXPECT_EQ(statusOf(parameters, true), wanted) << parameters;
    EXPECT_EQ(statusOf("0044072501", false), "00");
    EXPECT_EQ(statusOf("0044072501000", false), "0D");
}

}  // namespace scip_test
}  // namespace ispace::wire
