// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml/yaml.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "record/text.h"
#include "support/test_schemas.h"

namespace ispace {
namespace yaml_test {

using Texts = std::vector<std::string>;

Document read(std::string_view text) { return readYaml(text, "a.yaml", testSchemas()); }

Texts findings(std::string_view text) {
    return findingsOf([&] { (void)read(text); });
}

/// The records in canonical form.
Texts records(std::string_view text) {
    Texts lines;
    for (const Record& record : read(text).records) lines.push_back(formatRecord(record));
    return lines;
}

const Texts kTwo = {"fence id=f1 path=0,0;8,0.5 closed=yes", "desk at=2,3 heading=30"};

TEST(ReadYaml, TakesAListOfRecords) {
    EXPECT_EQ(records("- fence: {id: f1, path: [[0, 0], [8, 50cm]], closed: true}\n"
                      "- desk: {at: [2, 3], heading: 30}\n"),
              kTwo);
}

TEST(ReadYaml, TakesAMapOfKeywords) {
    EXPECT_EQ(records("fence:\n  id: f1\n  path: \"0,0; 8,0.5\"\n  closed: on\n"
                      "desk:\n  - at: 2, 3\n    heading: 30deg\n"),
              kTwo);
    EXPECT_EQ(records("desk:\n- {}\n- {height: 1}\nlaser: {}\n"),
              (Texts{"desk", "desk height=1", "laser"}));
}

TEST(ReadYaml, TakesAListUnderRecords) {
    EXPECT_EQ(records("records:\n- fence: {id: f1, path: [[0, 0], [8, 0.5]], closed: yes}\n"
                      "- desk:\n    at: [2, 3]\n    heading: 30\n"),
              kTwo);
}

TEST(ReadYaml, KeepsFileOrderOfMixedForms) {
    EXPECT_EQ(records("laser: {id: a}\nrecords: [{desk: {id: b}}, {laser: {id: c}}]\n"
                      "desk: [{id: d}]\n"),
              (Texts{"laser id=a", "desk id=b", "laser id=c", "desk id=d"}));
}

TEST(ReadYaml, TakesScalarsAsTheTextLanguageDoes) {
    EXPECT_EQ(
        records("- result: {coverage: 97.4%, area: 1e1m2, factor: -.5}\n"
                "- desk: {name: 'two # words', kind: \"closed\", closed: FALSE}\n"
                "- desk: {name: \"null\", id: 007}\n- desk: {name: ''}\n"
                "- laser: {range: 5, period: 100ms}\n"),
        (Texts{"result coverage=97.4% area=10 factor=-0.5", "desk kind=closed name=\"two # words\"",
               "desk id=007 name=null", "desk name=\"\"", "laser range=5 period=0.1"}));
}

TEST(ReadYaml, TakesAnchorsAndStandardTags) {
    EXPECT_EQ(records("- desk: &d {at: [1, 2]}\n- desk: *d\n- desk: !!map {name: !!str 5}\n"),
              (Texts{"desk at=1,2", "desk at=1,2", "desk name=5"}));
    EXPECT_EQ(findings("- desk: {name: !secret x}\n"),
              Texts{"a.yaml:1:16: error: unknown tag `!secret`"});
}

TEST(ReadYaml, TakesCommentsDirectivesAndOtherLineEnds) {
    EXPECT_EQ(records("# x\n%YAML 1.2\n---\n- desk: {} # y\n...\n"), Texts{"desk"});
    EXPECT_EQ(records("\xef\xbb\xbf- desk:\r\n    at: [1, 2]\r\n"), Texts{"desk at=1,2"});
    EXPECT_EQ(records("[]"), Texts{});
    EXPECT_EQ(records("{}"), Texts{});
}

TEST(ReadYaml, TakesHistoryBehindItsMagicLine) {
    EXPECT_EQ(read("# ispace yaml 1\n# envc a.env\n# b\n#c\n# d\n- desk: {}\n").history,
              (History{"envc a.env", "b"}));
    EXPECT_EQ(read("# envc a.env\n- desk: {}\n").history, History{});
    EXPECT_EQ(
        findings("# ispace yaml 2\n- desk: {}\n"),
        Texts{"a.yaml:1:15: error: version `2` found, wanted `# ispace yaml 1` or `# ispace yaml "
              "1 layout`"});
}

TEST(ReadYaml, GivesTheDigestOfTheSameText) {
    const Document text = readRecordText(
        "#env 1\nfence id=f1 path=0,0;8,0.5 closed=yes\ndesk at=2,3 heading=30\nlaser\n", "a.env",
        testSchemas());
    const Document yaml = read(
        "fence: {closed: yes, path: [[0, 0], [800cm, 0.50]], id: f1}\n"
        "desk: {heading: 30.0, at: [2.0, 3], height: 0.7}\n");
    EXPECT_EQ(environmentDigest(yaml.records), environmentDigest(text.records));
    EXPECT_EQ(yaml.kind, DocumentKind::Environment);
}

TEST(ReadYaml, HintsAtUnknownWords) {
    EXPECT_EQ(findings("- desk: {at: [1, 2], heigth: 3}\n- desc: {}\n- lamp:\n"),
              (Texts{"a.yaml:1:22: error: unknown key `heigth`, did you mean `height`?",
                     "a.yaml:2:3: error: unknown keyword `desc`, did you mean `desk`?",
                     "a.yaml:3:3: error: unknown keyword `lamp`, known: desk, fence, laser, "
                     "result"}));
}

TEST(ReadYaml, PointsAtTheValue) {
    EXPECT_EQ(
        findings("- desk:\n    height: tall\n    at: [1, x, .nan]\n- desk: {at: [1, .nan]}\n"),
        (Texts{"a.yaml:2:13: error: `height`: `tall` is not a number",
               "a.yaml:3:13: error: `at`: `x` is not a number",
               "a.yaml:4:18: error: `at`: NaN (not a number) is given, a number is wanted"}));
    EXPECT_EQ(findings("- desk: {at: [1]}\n- desk: {height: -.inf}\n- laser: {fov: -3}\n"),
              (Texts{"a.yaml:1:14: error: `at`: 1 number given, 2 or 3 wanted",
                     "a.yaml:2:18: error: `height`: `-.inf` is infinite, a finite number is wanted",
                     "a.yaml:3:16: error: `fov`: -3 is below 0"}));
    EXPECT_EQ(findings("- desk: {name: \xc3\xb6, height: x}\n"),
              Texts{"a.yaml:1:28: error: `height`: `x` is not a number"})
        << "columns count bytes";
}

TEST(ReadYaml, MergeKeysAreNamed) {
    EXPECT_EQ(findings("- desk: &d {height: 0.7}\n- desk: {<<: *d, at: [1, 2]}\n"),
              Texts{"a.yaml:2:10: error: merge keys (<<) are not read, anchors and aliases are: "
                    "write the keys themselves, or `defaults` for all records of a keyword"});
}

TEST(ReadYaml, WantsValuesOfTheRightForm) {
    const std::string null = ": nothing (null) is given, ";
    EXPECT_EQ(
        findings("- desk: {height: }\n- desk:\n    height:\n    name: ~\n- desk: {height: [1]}\n"
                 "- desk: {at: {x: 1}}\n- desk: {name: [a]}\n- fence: {path: [0, 0, 8, 0]}\n"
                 "- fence: {path: []}\n"),
        (Texts{"a.yaml:1:10: error: `height`" + null + "a number is wanted",
               "a.yaml:3:5: error: `height`" + null + "a number is wanted",
               "a.yaml:4:5: error: `name`" + null + "a text is wanted",
               "a.yaml:5:18: error: `height`: a list is given, a number is wanted",
               "a.yaml:6:14: error: `at`: a map with 1 key is given, a list of numbers such as " +
                   std::string("[2, 3] is wanted"),
               "a.yaml:7:16: error: `name`: a list is given, a text is wanted",
               "a.yaml:8:18: error: `path`: `0` is given, a list of lists such as " +
                   std::string("[[0, 0], [8, 0]] is wanted"),
               "a.yaml:9:17: error: `path`: an empty list is given"}));
    EXPECT_EQ(findings("- desk: {at: ['1,2', 3]}\n"),
              Texts{"a.yaml:1:15: error: `at`: `1,2` is not a number"});
}

TEST(ReadYaml, WantsRecords) {
    const std::string a_record = " is given, a record such as `desk: {at: [2, 3]}` is wanted";
    const std::string a_map = " is given, a map of keys such as {at: [2, 3]} is wanted";
    EXPECT_EQ(
        findings("- desk\n- desk: {}\n  laser: {}\n- desk:\n- desk: [{}]\n- [1]\n- ? [a]\n  : b"),
        (Texts{"a.yaml:1:3: error: `desk`" + a_record,
               "a.yaml:2:3: error: a map with 2 keys" + a_record,
               "a.yaml:4:3: error: nothing (null)" + a_map, "a.yaml:5:9: error: a list" + a_map,
               "a.yaml:6:3: error: a list" + a_record,
               "a.yaml:7:5: error: a list is given, a keyword is wanted"}));
    EXPECT_EQ(findings("records: {desk: {}}"),
              Texts{"a.yaml:1:10: error: a map with 1 key is given, a list of records is wanted"});
    EXPECT_EQ(findings("records:\ndesk: {}\n"),
              Texts{"a.yaml:1:1: error: nothing (null) is given, a list of records is wanted"});
    EXPECT_EQ(
        findings("just words"),
        Texts{"a.yaml:1:1: error: `just words` is given, a list or map of records is wanted"});
    const Texts none{"a.yaml: error: no records found, wanted a list or map of records"};
    for (const char* text : {"", "\n", "# x\n", "---\n", "~"}) EXPECT_EQ(findings(text), none);
    const std::string more = "the YAML document has ended, but more text follows";
    EXPECT_EQ(findings("- desk: {}\n---\n- desk: {}\n"), Texts{"a.yaml:2:1: error: " + more});
    EXPECT_EQ(findings("[], x\n"), Texts{"a.yaml:1:3: error: " + more});
    EXPECT_EQ(findings(",\n"), Texts{"a.yaml:1:1: error: " + more}) << "endless in YAML::LoadAll";
}

TEST(ReadYaml, RefusesDoubledKeysAndIds) {
    EXPECT_EQ(findings("- desk:\n    height: 1\n    height: 1\n"),
              Texts{"a.yaml:3:5: error: doubled key `height`, first in line 2"});
    EXPECT_EQ(findings("desk: {}\nlaser: {}\ndesk: {}\n"),
              Texts{"a.yaml:3:1: error: doubled key `desk`, first in line 1"});
    EXPECT_EQ(findings("- desk: {id: a}\n- laser:\n    id: a\n"),
              Texts{"a.yaml:3:9: error: doubled id `a`, first used in line 1"});
    EXPECT_EQ(findings("- fence: {closed: yes}\n"),
              Texts{"a.yaml:1:3: error: `fence` wants the key `path` (help on path)"});
}

TEST(ReadYaml, RefusesBadSyntax) {
    const Texts tabs = findings("desk:\n\theight: 1\n    # x\n\t# y\n  \tat: [1, 2]\n");
    EXPECT_EQ(tabs, (Texts{"a.yaml:2:1: error: a tab in the indentation, YAML wants blanks",
                           "a.yaml:5:3: error: a tab in the indentation, YAML wants blanks"}));
    for (const char* text :
         {"- desk: {at: [1, 2\n", "- desk: {at: 1]}\n", "a: b: c\n", "- desk: *nobody\n",
          "- desk: \"open\n", "- desk: 'open", "- desk: [\n", "- desk: {name: \"\\q\"}\n",
          "desk:\n   at: 1\n  height: 2\n", "%YAML 1.2\n%YAML 1.2\n---\n[]\n", "- &a &b desk\n",
          "@\n"}) {
        const Texts found = findings(text);
        ASSERT_EQ(found.size(), 1U) << text;
        EXPECT_NE(found[0].find(": error: bad YAML: "), std::string::npos) << found[0];
        EXPECT_TRUE(found[0].starts_with("a.yaml:")) << found[0];
    }
    EXPECT_EQ(findings("- desk: {name: \"a\\eb\"}\n"),
              Texts{"a.yaml:1:16: error: `name`: the text holds a control character"});
}

TEST(ReadYaml, RefusesBytesThatAreNoText) {
    EXPECT_EQ(findings(std::string_view("desk:\n \0", 8)),
              Texts{"a.yaml:2:2: error: found a NUL byte, wanted a text file in UTF-8"});
    EXPECT_EQ(findings("\xff\xfe-\0 \0").size(), 1U);
    std::mt19937_64 random(8);
    for (int i = 0; i < 300; ++i) {
        std::string bytes;
        for (int k = 0; k < 400; ++k) bytes += static_cast<char>(random() % 256);
        EXPECT_EQ(findings(bytes).size(), 1U);
    }
}

TEST(ReadYaml, RefusesLongFiles) {
    const auto found = findings("desk: \"" + std::string(64'000'000, 'x') + "\"\n");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NE(found[0].find("64000009 bytes of YAML, wanted at most 64000000"), std::string::npos)
        << found[0];
}

TEST(ReadYaml, RefusesDeepNesting) {
    const auto times = [](int n, const std::string& text) {
        std::string all;
        for (int i = 0; i < n; ++i) all += text;
        return all;
    };
    std::string stairs;
    for (int i = 0; i < 2000; ++i) stairs += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
    constexpr int kDeep = 200000;
    for (const std::string& text :
         {times(kDeep, "["), times(kDeep, "{"), times(kDeep, "[{"), times(kDeep, "{a: ["),
          times(kDeep, "- ") + "x", times(kDeep, "? "), times(kDeep, "[\n"), stairs,
          "- desk: {at: " + times(kDeep, "[") + times(kDeep, "]") + "}"}) {
        const Texts found = findings(text);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_NE(found[0].find("nested too deep"), std::string::npos) << found[0];
    }
}

TEST(ReadYaml, BoundsWhatAliasesExpandTo) {
    std::string laughs = "a: &a [lol, lol]\n";
    for (char c = 'b'; c < 'k'; ++c) {
        laughs += std::string(1, c) + ": &" + c + " [";
        for (int i = 0; i < 9; ++i) laughs += std::string("*") + static_cast<char>(c - 1) + ", ";
        laughs += "]\n";
    }
    EXPECT_EQ(findings(laughs).size(), 10U);
    EXPECT_EQ(findings(laughs + "records: *j\n").size(), 19U);
    std::string fences = "- &f\n  fence: {path: [";
    for (int i = 0; i < 20000; ++i) fences += "[1, 2], ";
    fences += "]}\n";
    EXPECT_EQ(records(fences + "- *f\n- *f\n").size(), 3U);
    for (int i = 0; i < 5000; ++i) fences += "- *f\n";
    const Texts found = findings(fences);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NE(found[0].find("aliases expand to more than 1000000 nodes"), std::string::npos);
    EXPECT_EQ(findings("- &x [*x]\n").size(), 1U) << "an alias of what it stands in";
    EXPECT_EQ(findings("&x {records: *x}\n").size(), 1U);
    EXPECT_EQ(findings("- desk: &x {at: *x}\n").size(), 1U);
}

TEST(ReadYaml, LargeFilesWithoutAliasesPass) {
    std::string fence = "fence: {path: [";
    for (int i = 0; i < 360000; ++i) fence += "[1,2],";
    EXPECT_EQ(read(fence + "]}\n").records.at(0).list("path").size(), 360000U);
}

TEST(ReadYaml, DamagedYamlIsReadOrRefused) {
    const std::string good =
        "# ispace yaml 1\n# a\nrecords:\n- desk: &d {id: d, at: [1, 2], name: \"x \\\" y\"}\n"
        "- laser: *d\n- fence:\n    path: [[0, 0], [8, 0]]\n    closed: yes\nresult:\n"
        "  coverage: 97.4%\n";
    std::mt19937_64 random(9);
    const std::string signs = "\"'\\#=;, \n0-e.m%[]{}:&*!|>?@`~";
    for (int i = 0; i < 20000; ++i) {
        std::string text = good;
        for (std::uint64_t n = random() % 6 + 1; n > 0; --n) {
            const auto at = static_cast<std::size_t>(random() % text.size());
            if (random() % 2 == 0)
                text[at] = signs[random() % signs.size()];
            else
                text.insert(at, 1, signs[random() % signs.size()]);
        }
        try {
            (void)read(text);
        } catch (const FormatError& error) {
            EXPECT_LE(error.diagnostics().size(), Diagnostics::kMax);
        }
    }
}

}  // namespace yaml_test
}  // namespace ispace
