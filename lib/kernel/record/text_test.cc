// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/text.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "support/test_schemas.h"

namespace ispace {

namespace text_test {

TEST(ByteOrderMark, IsTakenOffTheStartOnce) {
    EXPECT_EQ(withoutBom("\xef\xbb\xbf#env 1"), "#env 1");
    EXPECT_EQ(withoutBom("\xef\xbb\xbf"), "");
    EXPECT_EQ(withoutBom("\xef\xbb\xbf\xef\xbb\xbfx"), "\xef\xbb\xbfx");
    for (const std::string_view other : {"", "#env 1", "\xef\xbb", "\xbb\xbf\xef", "x\xef\xbb\xbf"})
        EXPECT_EQ(withoutBom(other), other);
}

Document read(std::string_view text) { return readRecordText(text, "a.env", testSchemas()); }

/// Findings about records: lines after the magic line, the first of them number 2.
std::vector<std::string> findings(const std::string& lines) {
    return findingsOf([&] { (void)read("#env 1\n" + lines); });
}

using Texts = std::vector<std::string>;

/// The one record of a line, in canonical form.
std::string canonical(const std::string& line) {
    const Document document = read("#env 1\n" + line);
    EXPECT_EQ(document.records.size(), 1U);
    return document.records.empty() ? "" : formatRecord(document.records.front());
}

TEST(ReadText, ReadsTheExampleOfTheManual) {
    const Document document = read(
        "#env 1\n"
        "# envc plan.yaml\n"
        "# arrange -\n"
        "fence   id=f1 path=0,0;8,0;8,6;0,6 closed=yes\n"
        "\n"
        "# a comment\n"
        "desk    id=d1 at=2,3 heading=30 # another\n");
    EXPECT_EQ(document.kind, DocumentKind::Environment);
    EXPECT_EQ(document.history, (History{"envc plan.yaml", "arrange -"}));
    ASSERT_EQ(document.records.size(), 2U);
    EXPECT_EQ(document.records[0].list("path"), (TupleList{{0, 0}, {8, 0}, {8, 6}, {0, 6}}));
    EXPECT_TRUE(document.records[0].flag("closed"));
    EXPECT_EQ(document.records[1].number("heading"), 30);
    EXPECT_EQ(writeRecordText(document),
              "#env 1\n# envc plan.yaml\n# arrange -\n"
              "fence id=f1 path=0,0;8,0;8,6;0,6 closed=yes\ndesk id=d1 at=2,3 heading=30\n");
}

TEST(ReadText, KnowsItsMagicLines) {
    EXPECT_TRUE(isRecordText("#env 1\n"));
    EXPECT_TRUE(isRecordText("#3dm"));
    EXPECT_TRUE(isRecordText("\xef\xbb\xbf#env 1\n"));
    for (const char* other : {"", "#", "#en", " #env 1", "# env 1", "env 1", "glTF"})
        EXPECT_FALSE(isRecordText(other)) << other;
    EXPECT_EQ(read("#3dm 1").kind, DocumentKind::Layout);
    EXPECT_EQ(read("#env \t1 \n").kind, DocumentKind::Environment);
    EXPECT_EQ(read("\xef\xbb\xbf#env 1\ndesk\n").records.size(), 1U);
    const auto magic = [](const char* text) {
        const Texts found = findingsOf([&] { (void)read(text); });
        return found.size() == 1 ? found[0] : "";
    };
    const std::string wanted = "wanted the magic line `#env 1` or `#3dm 1`";
    EXPECT_EQ(magic(""), "a.env: error: empty file, " + wanted);
    EXPECT_EQ(magic("\n"), "a.env:1:1: error: an empty line found, " + wanted);
    EXPECT_EQ(magic("desk\nx\ny\n"), "a.env:1:1: error: `desk` found, " + wanted);
    EXPECT_EQ(magic("#environment 1\n"), "a.env:1:1: error: `#environment 1` found, " + wanted);
    EXPECT_EQ(magic("#env1\n"), "a.env:1:1: error: `#env1` found, " + wanted);
    EXPECT_EQ(magic("#env 2\nbad\n"), "a.env:1:1: error: version `2` found, wanted `#env 1`");
    EXPECT_EQ(magic("#3dm 1 x\n"), "a.env:1:1: error: version `1 x` found, wanted `#3dm 1`");
    EXPECT_EQ(magic("#3dm"), "a.env:1:1: error: no version found, wanted `#3dm 1`");
}

TEST(ReadText, TakesFilesThatWereJoined) {
    const Document document = read(
        "#env 1\n# envc room.yaml\ndesk id=d1\n#3dm 1\n# arrange room.glb\nlaser id=l1 at=1,2\n");
    EXPECT_EQ(document.kind, DocumentKind::Environment);
    EXPECT_EQ(document.history, History{"envc room.yaml"});
    EXPECT_EQ(document.records.size(), 2U);
}

TEST(ReadText, HistoryEndsWithItsRun) {
    EXPECT_EQ(read("#env 1\n# a\n#b\n# c\n").history, History{"a"});
    EXPECT_EQ(read("#env 1\n\n# c\n").history, History{});
    EXPECT_EQ(read("#env 1\n# a  'b c' \n# \n").history, (History{"a  'b c' ", ""}));
}

TEST(ReadText, TakesEveryLineEnd) {
    const std::string text = "#env 1\n# a\ndesk id=d name=x\nlaser\n";
    std::string crlf;
    for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(writeRecordText(read(crlf)), text);
    EXPECT_EQ(writeRecordText(read(text.substr(0, text.size() - 1))), text);
    EXPECT_EQ(findingsOf([] { (void)read("#env 1\rdesk\r"); }),
              Texts{"a.env:1:7: error: found the control character 0x0d, wanted a text file in "
                    "UTF-8"});
}

TEST(ReadText, TakesQuotesAndEscapes) {
    EXPECT_EQ(canonical(R"(desk name="two words")"), R"(desk name="two words")");
    EXPECT_EQ(canonical(R"(desk name="plain")"), "desk name=plain");
    EXPECT_EQ(canonical(R"(desk name="")"), R"(desk name="")");
    EXPECT_EQ(canonical(R"(desk name="a # b" height="5cm")"), R"(desk height=0.05 name="a # b")");
    EXPECT_EQ(canonical(R"(desk name=a\nb)"), R"(desk name=a\nb)") << "no escapes outside";
    EXPECT_EQ(canonical("desk name=a=b"), "desk name=a=b");
    EXPECT_EQ(canonical("\tdesk\t name=h\xc3\xb6he\t# x"), "desk name=h\xc3\xb6he");
    EXPECT_EQ(read("#env 1\n"
                   R"(desk name="a\"b\\n\n\t")")
                  .records.at(0)
                  .text("name"),
              "a\"b\\n\n\t");
}

TEST(ReadText, RefusesBadQuotes) {
    EXPECT_EQ(findings(R"(desk name="open height=2)"),
              Texts{"a.env:2:11: error: the quote that opens here is not closed"});
    EXPECT_EQ(findings(R"(desk name="a\)"),
              Texts{"a.env:2:11: error: the quote that opens here is not closed"});
    EXPECT_EQ(findings(R"(desk name="a\x b" heigth=2)"),
              (Texts{R"(a.env:2:13: error: unknown escape `\x`, wanted \" \\ \n or \t)",
                     "a.env:2:19: error: unknown key `heigth`, did you mean `height`?"}));
    EXPECT_EQ(findings(R"(desk name="a"height=2)"),
              Texts{"a.env:2:14: error: no blank after a closing quote"});
    EXPECT_EQ(findings(R"(desk name=a"b c")"),
              Texts{"a.env:2:12: error: `\"` inside a value, put the value in quotes"});
    EXPECT_EQ(findings("desk name=a#b"), Texts{"a.env:2:12: error: `#` inside a value, put the "
                                               "value in quotes or a blank before a comment"});
}

TEST(ReadText, RefusesWhatIsNoField) {
    EXPECT_EQ(findings("desk height"),
              Texts{"a.env:2:6: error: `height` found, wanted `key=value`"});
    EXPECT_EQ(findings("desk =2"), Texts{"a.env:2:6: error: `=2` found, wanted `key=value`"});
    const Texts spaced{"a.env:2:6: error: blanks around `=` after `height`, wanted `key=value`"};
    EXPECT_EQ(findings("desk height = 2 at=1,2"), spaced);
    EXPECT_EQ(findings("desk height =2 at=1,2"), spaced);
    const Texts empty{
        "a.env:2:6: error: no value right after `height=`, an empty text is written \"\""};
    EXPECT_EQ(findings("desk height="), empty);
    EXPECT_EQ(findings("desk height= 2"), empty);
    EXPECT_EQ(findings("desk height= at=1,2"), empty);
    EXPECT_EQ(findings("desk height= # at=1,2"), empty);
    EXPECT_EQ(findings("height=2 at=1,2"),
              Texts{"a.env:2:1: error: `height=2` found, wanted a keyword before the first key"});
}

TEST(ReadText, HintsAtUnknownWords) {
    EXPECT_EQ(findings("desk at=1,2 heigth=3"),
              Texts{"a.env:2:13: error: unknown key `heigth`, did you mean `height`?"});
    EXPECT_EQ(findings("fence path=0,0;1,1 colour=red"),
              Texts{"a.env:2:20: error: unknown key `colour`, known: id, path, closed"});
    EXPECT_EQ(findings("  desc at=1,2 heigth=3"),
              Texts{"a.env:2:3: error: unknown keyword `desc`, did you mean `desk`?"});
    EXPECT_EQ(findings("lamp"),
              Texts{"a.env:2:1: error: unknown keyword `lamp`, known: desk, fence, laser, result"});
}

TEST(ReadText, PointsAtTheValue) {
    EXPECT_EQ(findings("desk height=tall"),
              Texts{"a.env:2:13: error: `height`: `tall` is not a number"});
    EXPECT_EQ(findings("desk  height=NaN at=1"),
              (Texts{"a.env:2:14: error: `height`: NaN (not a number) is given, a number is wanted",
                     "a.env:2:21: error: `at`: 1 number given, 2 or 3 wanted"}));
    EXPECT_EQ(findings("desk name=\xc3\xb6 height=-1"),
              Texts{"a.env:2:21: error: `height`: -1 is given, must be above 0"})
        << "columns count bytes";
}

TEST(ReadText, WantsKeysOnceAndAllThatAreRequired) {
    EXPECT_EQ(findings("desk at=1,2 height=1 at=1,2"),
              Texts{"a.env:2:22: error: doubled key `at`, first in column 6"});
    EXPECT_EQ(findings("desk height=0.7 height=1"),
              Texts{"a.env:2:17: error: doubled key `height`, first in column 6"})
        << "a default is written, too";
    EXPECT_EQ(findings("desk\n fence closed=yes"),
              Texts{"a.env:3:2: error: `fence` wants the key `path` (help on path)"});
    EXPECT_EQ(findings("fence path=x"), Texts{"a.env:2:12: error: `path`: `x` is not a number"})
        << "given, if badly";
}

TEST(ReadText, RefusesDoubledIds) {
    EXPECT_EQ(findings("desk id=a\n\nlaser id=a\nlaser  id=a"),
              (Texts{"a.env:4:10: error: doubled id `a`, first used in line 2",
                     "a.env:5:11: error: doubled id `a`, first used in line 2"}));
    EXPECT_TRUE(findings("desk id=a\ndesk id=A\ndesk\ndesk").empty());
}

TEST(ReadText, CollectsTwentyFindingsInOrder) {
    std::string lines;
    for (int i = 0; i < 30; ++i) lines += "desk heigth=1 at=x\n";
    const Texts found = findings(lines);
    ASSERT_EQ(found.size(), 20U);
    EXPECT_EQ(found[0], "a.env:2:6: error: unknown key `heigth`, did you mean `height`?");
    EXPECT_EQ(found[1], "a.env:2:18: error: `at`: `x` is not a number");
    EXPECT_EQ(found[19],
              "a.env:11:18: error: `at`: `x` is not a number (40 more errors not shown)");
}

TEST(ReadText, RefusesBytesThatAreNoText) {
    const auto junk = [](std::string_view text) {
        return findingsOf([&] { (void)readRecordText(text, "a.env", testSchemas()); });
    };
    const std::string wanted = ", wanted a text file in UTF-8";
    EXPECT_EQ(junk(std::string_view("#env 1\ndesk\0at=1\0\n", 18)),
              Texts{"a.env:2:5: error: found a NUL byte" + wanted});
    EXPECT_EQ(junk("#env 1\n# caf\xe9\n"),
              Texts{"a.env:2:6: error: found the byte 0xe9, which is not UTF-8" + wanted});
    EXPECT_EQ(junk("\x89PNG\r\n\x1a\n"),
              Texts{"a.env:1:1: error: found the byte 0x89, which is not UTF-8" + wanted});
    EXPECT_EQ(junk("#env 1\ndesk \x1b[31m\n"),
              Texts{"a.env:2:6: error: found the control character 0x1b" + wanted});
    EXPECT_EQ(junk("#env 1\ndesk \xe2\x82"),
              Texts{"a.env:2:6: error: found the byte 0xe2, which is not UTF-8" + wanted});
}

TEST(ReadText, RandomBytesNeverGetThrough) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 300; ++i) {
        std::string bytes = i % 2 == 0 ? "" : "#env 1\n";
        for (int k = 0; k < 400; ++k) bytes += static_cast<char>(random() % 256);
        EXPECT_EQ(findingsOf([&] { (void)read(bytes); }).size(), 1U);
    }
}

TEST(ReadText, DamagedTextIsReadOrRefused) {
    const std::string good =
        "#env 1\n# a\ndesk id=d at=1,2 name=\"x \\\" y\" height=5cm # z\n"
        "fence path=0,0;8,0;8,6 closed=yes\nresult coverage=97.4%\n";
    std::mt19937_64 random(6);
    const std::string signs = "\"\\#=;, \t\n0-e.m%";
    int accepted = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = good;
        for (std::uint64_t n = random() % 4 + 1; n > 0; --n) {
            const auto at = 7 + static_cast<std::size_t>(random() % (text.size() - 7));
            if (random() % 2 == 0)
                text[at] = signs[random() % signs.size()];
            else
                text.erase(at, random() % 5);
            if (text.size() < 20) text += good;
        }
        try {
            const Document document = read(text);
            ++accepted;
            const std::string again = writeRecordText(document);
            EXPECT_EQ(writeRecordText(read(again)), again) << text;
        } catch (const FormatError& error) {
            EXPECT_LE(error.diagnostics().size(), Diagnostics::kMax);
        }
    }
    EXPECT_GT(accepted, 1000);
    EXPECT_LT(accepted, 19000);
}

double secondsFor(const std::string& text) {
    const auto begin = std::chrono::steady_clock::now();
    (void)findingsOf([&] { (void)read(text); });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(ReadText, TakesLongLinesAndManyErrorsInLinearTime) {
    std::string path = "#env 1\nfence path=0,0";
    for (int i = 0; i < 300000; ++i) path += ";" + std::to_string(i) + ".25,1";
    EXPECT_EQ(read(path).records.at(0).list("path").size(), 300001U);
    std::string unknown = "#env 1\n", doubled = "#env 1\ndesk", ids = "#env 1\n";
    std::string quotes = "#env 1\ndesk", junk = "#env 1\n" + std::string(4000000, 'x');
    for (int i = 0; i < 100000; ++i) {
        unknown += "dseks heigth=1\n";
        doubled += " at=1,2 heigth=2";
        ids += "desk id=a\n";
        quotes += " name=\"\\x \\\" a=\"b";
    }
    for (const std::string& text : {path, unknown, doubled, ids, quotes, junk})
        EXPECT_LT(secondsFor(text), 10) << text.substr(0, 30);
}

TEST(ReadText, MessagesStayShort) {
    const std::string junk(100000, 'x');
    for (const std::string& line :
         {junk, "desk " + junk, "desk " + junk + "=1", "desk height=" + junk, "desk kind=" + junk,
          "desk closed=" + junk, "desk id=" + junk + ",", junk + "=1", "desk " + junk + "="})
        for (const std::string& text : findings(line)) EXPECT_LT(text.size(), 300U);
}

TEST(ReadText, BoundsTheNumberOfRecords) {
    std::string bytes = "#env 1\n";
    for (int i = 0; i < 1'000'002; ++i) bytes += "desk at=1,1\n";
    const Texts found = findingsOf([&] { (void)readRecordText(bytes, "a.env", testSchemas()); });
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0],
              "a.env:1000002:1: error: more than 1000000 records, the most that an input may have");
}

/// So many lines that they are read in parts.
std::string longText(std::size_t lines) {
    std::string text = "#env 1\n# a\n# b\n";
    for (std::size_t i = 0; i < lines; ++i)
        text += i % 7 == 3 ? "# desk\r\n" : "desk id=d" + std::to_string(i) + " at=1,1\n";
    return text;
}

TEST(ReadText, ReadsLongTextsInPartsAsOthers) {
    constexpr std::size_t kLines = 30000;
    const Document document = read(longText(kLines));
    EXPECT_EQ(document.history, (History{"a", "b"}));
    std::size_t next = 0;
    for (std::size_t i = 0; i < kLines; ++i) {
        if (i % 7 == 3) continue;
        ASSERT_LT(next, document.records.size());
        const Record& record = document.records[next++];
        ASSERT_EQ(record.text("id"), "d" + std::to_string(i));
        ASSERT_EQ(record.place().line, static_cast<int>(i) + 4);
        ASSERT_EQ(*record.place().file, "a.env");
    }
    EXPECT_EQ(next, document.records.size());
}

TEST(ReadText, FindsErrorsOfLongTextsInTheirOrder) {
    const std::string good = longText(30000);
    const auto found = [](const std::string& text) {
        return findingsOf([&] { (void)read(text); });
    };
    EXPECT_EQ(found(good + "desk heigth=1"),
              Texts{"a.env:30004:6: error: unknown key `heigth`, did you mean `height`?"});
    std::string early = good;
    early.replace(early.find("id=d9 "), 2, "it");
    EXPECT_EQ(found(early + "desk heigth=1\n"),
              (Texts{"a.env:13:6: error: unknown key `it`, did you mean `id`?",
                     "a.env:30004:6: error: unknown key `heigth`, did you mean `height`?"}));
    EXPECT_EQ(found(good + "desk id=d5\n"),
              Texts{"a.env:30004:9: error: doubled id `d5`, first used in line 9"});
    std::string many = good;
    for (std::size_t at = 0; (at = many.find(" id=", at)) != std::string::npos;) many[at + 1] = 'x';
    const Texts all = found(many);
    ASSERT_EQ(all.size(), 20U);
    EXPECT_TRUE(all[0].starts_with("a.env:4:6: ")) << all[0];
    EXPECT_TRUE(all[19].ends_with(" (25694 more errors not shown)")) << all[19];
}

TEST(ReadRecord, ReadsOneRecord) {
    const Record record = readRecord("desk at=1,2", "--add", testSchemas());
    EXPECT_EQ(record.tuple("at"), (Tuple{1, 2}));
    EXPECT_EQ(findingsOf([] { (void)readRecord("desk heigth=1", "--add", testSchemas()); }),
              Texts{"--add:1:6: error: unknown key `heigth`, did you mean `height`?"});
    const Texts none{"--add:1: error: no record found, wanted `keyword key=value ...`"};
    for (const char* text : {"", " ", "# desk"})
        EXPECT_EQ(findingsOf([&] { (void)readRecord(text, "--add", testSchemas()); }), none);
    EXPECT_EQ(findingsOf([] { (void)readRecord("desk\ndesk", "--add", testSchemas()); }),
              Texts{"--add:1: error: more than one line found, wanted one record"});
}

TEST(WriteText, KeepsHistoryToItsLines) {
    Document document;
    document.kind = DocumentKind::Layout;
    document.history = {"arrange 'a\nb'"};
    EXPECT_EQ(writeRecordText(document), "#3dm 1\n# arrange 'a?b'\n");
}

}  // namespace text_test

}  // namespace ispace
