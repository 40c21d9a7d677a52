// SPDX-License-Identifier: GPL-3.0-or-later
// Defaults, parts, placements and repetitions.
#include <gtest/gtest.h>

#include <ctime>
#include <random>

#include "record/text.h"
#include "record/yaml/yaml.h"
#include "support/test_schemas.h"

namespace ispace {
namespace yaml_parts_test {

using Texts = std::vector<std::string>;

Texts records(std::string_view text) {
    Texts lines;
    for (const Record& record : readYaml(text, "a.yaml", placedSchemas()).records)
        lines.push_back(formatRecord(record));
    return lines;
}

Texts findings(std::string_view text) {
    return findingsOf([&] { (void)readYaml(text, "a.yaml", placedSchemas()); });
}

TEST(YamlDefaults, FillKeysOfRecordsThatFollow) {
    EXPECT_EQ(records("- desk: {}\n"
                      "- defaults: {desk: {height: 0.72, size: [1, 2]}, laser: {heading: 5}}\n"
                      "- desk: {id: a}\n- desk: {height: 1}\n- desk: {height: 0.7}\n- laser: {}\n"
                      "- defaults: {desk: {height: 2}}\n- desk: {}\n"),
              (Texts{"desk", "desk id=a size=1,2 height=0.72", "desk size=1,2 height=1",
                     "desk size=1,2", "laser heading=5", "desk size=1,2 height=2"}));
    EXPECT_EQ(records("defaults: {desk: {height: 2}}\nparts: {p: [desk: {}]}\n"
                      "place: {part: p}\ndesk: [{}, {height: 70cm}]\n"),
              (Texts{"desk height=2", "desk height=2", "desk"}));
    EXPECT_EQ(records("- defaults: {desk: {height: 2}}\n- defaults: {desk: {height: 0.7}}\n"
                      "- desk: {}\n"),
              Texts{"desk"})
        << "what the schema has is a default as any other";
}

TEST(YamlDefaults, AreChecked) {
    EXPECT_EQ(
        findings("- defaults: {desc: {}, desk: {heigth: 2, height: x, id: a}, laser: 3}\n"
                 "- defaults: 5\n- desk: {}\n"),
        (Texts{"a.yaml:1:14: error: unknown keyword `desc`, did you mean `desk`?",
               "a.yaml:1:31: error: unknown key `heigth`, did you mean `height`?",
               "a.yaml:1:50: error: `height`: `x` is not a number",
               "a.yaml:1:53: error: an id is of one record, not a default",
               std::string(
                   "a.yaml:1:68: error: `3` is given, a map of keys such as {height: 0.72} is ") +
                   "wanted",
               std::string(
                   "a.yaml:2:13: error: `5` is given, a map such as {desk: {height: 0.72}} is ") +
                   "wanted"}));
}

TEST(YamlParts, ArePlacedWithTheirPose) {
    const std::string parts =
        "parts:\n  workplace:\n  - desk: {id: desk, heading: 10}\n  - desk: {at: [0, 1, 0.5]}\n"
        "  - fence: {path: [[0, 0], [1, 0]]}\n  - laser: {on: desk, at: [0.1, 0]}\n"
        "  - laser: {on: other}\n";
    EXPECT_EQ(records(parts + "place:\n- {part: workplace, at: [2, 3], heading: 90, id: w1}\n"
                              "- {part: workplace}\n"),
              (Texts{"desk id=w1/desk at=2,3 heading=100", "desk at=1,3,0.5 heading=90",
                     "fence path=2,3;2,4", "laser at=0.1,0 on=w1/desk", "laser on=other",
                     "desk id=workplace1/desk heading=10", "desk at=0,1,0.5", "fence path=0,0;1,0",
                     "laser at=0.1,0 on=workplace1/desk", "laser on=other"}));
    EXPECT_EQ(records("- place: {part: p, at: [1, 0]}\n- parts: {p: {desk: {}, laser: {}}}\n"),
              (Texts{"desk at=1,0", "laser"}))
        << "known before they are written, sensors to be placed stay so";
    EXPECT_EQ(
        records("parts: {p: [desk: {}, laser: {at: [0, 0]}]}\nplace: {part: p, at: [0, 0, 1]}"),
        (Texts{"desk at=0,0,1", "laser at=0,0,1.15"}));
}

TEST(YamlParts, MayPlaceParts) {
    EXPECT_EQ(records("parts:\n  row: [place: {part: seat, at: [1, 0], id: a},\n"
                      "        place: {part: seat, at: [2, 0]}, laser: {on: a/chair}]\n"
                      "  seat: [desk: {id: chair, at: [0, 1]}]\n"
                      "place: {part: row, at: [10, 0], heading: 90, id: r}\n"),
              (Texts{"desk id=r/a/chair at=9,1 heading=90",
                     "desk id=r/seat1/chair at=9,2 heading=90", "laser on=r/a/chair"}));
}

TEST(YamlParts, NumbersSkipWhatIsTaken) {
    EXPECT_EQ(records("parts: {p: [desk: {id: d}]}\n"
                      "records: [desk: {id: p1}, place: {part: p}, place: {part: p, id: p3},\n"
                      "          place: {part: p}, desk: {id: p4/x}, place: {part: p}]\n"),
              (Texts{"desk id=p1", "desk id=p2/d", "desk id=p3/d", "desk id=p5/d", "desk id=p4/x",
                     "desk id=p6/d"}));
}

TEST(YamlParts, ErrorsNameWhatIsWrong) {
    EXPECT_EQ(findings("parts: {p: [place: {part: q}], q: [place: {part: r}],\n"
                       "        r: [desk: {}, place: {part: p}]}\n"),
              Texts{"a.yaml:2:37: error: parts place each other in a circle: p -> q -> r -> p"});
    EXPECT_EQ(findings("parts: {p: [place: {part: p}]}\n"),
              Texts{"a.yaml:1:27: error: parts place each other in a circle: p -> p"});
    EXPECT_EQ(
        findings("parts: {seat: [desk: {}]}\nplace: [{part: saet}, {at: [1, 2]}, {part: zz}]\n"
                 "seat: {at: [1, 2]}\n"),
        (Texts{"a.yaml:2:23: error: `place` wants the key `part` (name of the part)",
               std::string(
                   "a.yaml:3:1: error: unknown keyword `seat`, write `place: {part: seat}` to ") +
                   "place the part",
               "a.yaml:2:16: error: unknown part `saet`, did you mean `seat`?",
               "a.yaml:2:44: error: unknown part `zz`, known: seat"}));
    EXPECT_EQ(findings("- place: {part: p}\n"),
              Texts{"a.yaml:1:17: error: unknown part `p`, `parts` has none"});
    EXPECT_EQ(
        findings("parts: {desk: [], 'a b': [], p: [parts: {}, defaults: {}], q: , r: 3}\n"
                 "records: [parts: {p: []}]\n"),
        (Texts{"a.yaml:1:9: error: `desk` is a keyword, a part needs another name",
               std::string(
                   "a.yaml:1:19: error: `a b` is not the name of a part: letters, digits and ") +
                   "_-./+:@ are wanted",
               std::string(
                   "a.yaml:1:34: error: `parts` in a part, it is wanted beside `parts`, at the ") +
                   "top of the file",
               std::string(
                   "a.yaml:1:45: error: `defaults` in a part, it is wanted beside `parts`, at ") +
                   "the top of the file",
               std::string(
                   "a.yaml:1:60: error: nothing (null) is given, a list or map of records is ") +
                   "wanted",
               "a.yaml:1:68: error: `3` is given, a list or map of records is wanted",
               "a.yaml:2:19: error: doubled part `p`, first in line 1"}));
    EXPECT_EQ(findings("parts: {p: [fence: {path: [[0, 0], [1, 0]]}]}\n"
                       "place: {part: p, at: [0, 0, 1]}\n"),
              Texts{"a.yaml:2:1: error: `fence` stands on the floor and cannot be lifted"});
    EXPECT_EQ(findings("parts: {p: [desk: {at: [9e5, 0]}]}\nplace: {part: p, at: [9e5, 0]}\n"),
              Texts{"a.yaml:1:24: error: `at`: 1800000 is above 1000000"});
    EXPECT_EQ(findings("parts: {p: [desk: {id: d}]}\nrecords: [place: {part: p, id: x},\n"
                       "desk: {id: x/d}, place: {part: p, id: x}]\n"),
              (Texts{"a.yaml:3:12: error: doubled id `x/d`, first used in line 1",
                     "a.yaml:1:24: error: doubled id `x/d`, read from here a second time"}));
}

TEST(YamlRepeat, GoesAlongALine) {
    EXPECT_EQ(records("desk: {id: d, at: [0.1, 0], repeat: {count: 4, step: [0.1, 0]}}\n"),
              (Texts{"desk id=d-1 at=0.1,0", "desk id=d-2 at=0.2,0", "desk id=d-3 at=0.3,0",
                     "desk id=d-4 at=0.4,0"}));
    EXPECT_EQ(records("desk: {repeat: {count: 3, step: [1, 0, 0.5], heading: 90}}\n"),
              (Texts{"desk", "desk at=0,1,0.5", "desk at=0,2,1"}));
    EXPECT_EQ(records("fence: {path: [[0, 0], [0, 1]], repeat: {count: 2, step: [1, 1]}}\n"),
              (Texts{"fence path=0,0;0,1", "fence path=1,1;1,2"}));
    EXPECT_EQ(records("laser: {repeat: {count: 2}}\n"), (Texts{"laser", "laser"}));
    EXPECT_EQ(records("laser: {on: r1, repeat: {count: 2, step: [0.2, 0]}}\n"),
              (Texts{"laser at=0,0 on=r1", "laser at=0.2,0 on=r1"}));
}

TEST(YamlRepeat, Turns) {
    EXPECT_EQ(records("desk: {at: [5, 5], repeat: {count: 3, step: [2, 0], turn: 10}}\n"),
              (Texts{"desk at=5,5", "desk at=7,5 heading=10", "desk at=9,5 heading=20"}))
        << "about its own place";
    EXPECT_EQ(records("desk: {at: [2, 1], heading: 180, repeat: {count: 4, turn: 90, "
                      "about: [1, 1]}}\n"),
              (Texts{"desk at=2,1 heading=180", "desk at=1,2 heading=-90", "desk at=0,1",
                     "desk at=1,0 heading=90"}));
    EXPECT_EQ(records("fence: {path: [[1, 1], [2, 1]], repeat: {count: 2, turn: 90}}\n"),
              (Texts{"fence path=1,1;2,1", "fence path=1,1;1,2"}));
}

TEST(YamlRepeat, FillsAGrid) {
    EXPECT_EQ(records("desk: {id: d, at: [1, 1], repeat: {rows: 2, cols: 3, step: [0.1, 2]}}\n"),
              (Texts{"desk id=d-1 at=1,1", "desk id=d-2 at=1.1,1", "desk id=d-3 at=1.2,1",
                     "desk id=d-4 at=1,3", "desk id=d-5 at=1.1,3", "desk id=d-6 at=1.2,3"}));
    EXPECT_EQ(records("desk: {repeat: {rows: 2, cols: 2, step: [1, 2], heading: 90}}\n"),
              (Texts{"desk", "desk at=0,1", "desk at=-2,0", "desk at=-2,1"}));
}

TEST(YamlRepeat, PlacesPartsManyTimes) {
    EXPECT_EQ(
        records("parts: {p: [desk: {id: d, at: [0, 1]}]}\n"
                "place: [{part: p, id: w, at: [1, 0], heading: 90, repeat: {count: 2, step: [3, "
                "0]}},\n  {part: p, repeat: {count: 2, turn: 180}}]\n"),
        (Texts{"desk id=w-1/d heading=90", "desk id=w-2/d at=3,0 heading=90", "desk id=p1/d at=0,1",
               "desk id=p2/d at=0,-1 heading=180"}));
    EXPECT_EQ(
        records("parts: {row: [desk: {id: d, repeat: {count: 2, step: [1, 0]}},\n"
                "  laser: {on: d-2}]}\nplace: {part: row, id: r, heading: 90}\n"),
        (Texts{"desk id=r/d-1 heading=90", "desk id=r/d-2 at=0,1 heading=90", "laser on=r/d-2"}));
}

TEST(YamlRepeat, ErrorsNameWhatIsWrong) {
    const std::string either = "error: `repeat`: either `count` is wanted, or `rows` and `cols`";
    EXPECT_EQ(
        findings("- desk: {repeat: {step: [1, 0]}}\n- desk: {repeat: {rows: 2, step: [1, 1]}}\n"
                 "- desk: {repeat: {count: 2, rows: 2, cols: 2, step: [1, 1]}}\n"),
        (Texts{"a.yaml:1:18: " + either, "a.yaml:2:18: " + either, "a.yaml:3:18: " + either}));
    EXPECT_EQ(
        findings("- desk: {repeat: {count: 2.5, steps: [1, 1], turn: 1}}\n"
                 "- desk: {repeat: {count: 2}}\n- desk: {repeat: 3}\n"
                 "- laser: {repeat: {count: 2, step: [1, 0]}}\n"
                 "- desk: {repeat: {rows: 1, cols: 1, step: [1, 0, 1]}}\n"
                 "- desk: {repeat: {count: 2, step: [1, 0]}, repeat: {}}\n"
                 "- fence: {path: [[0, 0], [1, 0]], repeat: {count: 2, step: [1, 0, 1]}}\n"),
        (Texts{
            "a.yaml:1:26: error: `count`: 2.5 is given, a whole number is wanted",
            "a.yaml:1:31: error: unknown key `steps`, did you mean `step`?",
            std::string(
                "a.yaml:2:18: error: `repeat`: `step` or `turn` is wanted, or all copies are ") +
                "at one place",
            std::string(
                "a.yaml:3:18: error: `3` is given, a map such as {count: 5, step: [1.2, 0]} ") +
                "is wanted",
            std::string("a.yaml:4:19: error: `repeat`: `laser` has no place here that `step` or ") +
                "`turn` could change",
            std::string(
                "a.yaml:5:18: error: `repeat`: three numbers in the step of a grid, two are ") +
                "wanted",
            "a.yaml:6:44: error: doubled key `repeat`, first in column 10",
            "a.yaml:7:43: error: `fence` stands on the floor and cannot be lifted"}));
}

/// Of the processor, so that other work does not count.
double secondsFor(const std::string& text, Texts& found) {
    const std::clock_t begin = std::clock();
    found = findings(text);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

TEST(YamlExpansion, IsBounded) {
    std::string nested = "parts:\n  p0: [desk: {id: d}]\n";
    for (int i = 1; i < 20; ++i)
        nested += "  p" + std::to_string(i) + ": [place: {part: p" + std::to_string(i - 1) +
                  ", repeat: {count: 1000, step: [1, 0]}}]\n";
    std::string empty =
        "parts: {e: [], f: [place: {part: e, repeat: {count: 1e6, turn: 1}}]}\n"
        "place: {part: f, repeat: {count: 1e6, turn: 1}}\n";
    const std::string word(5000, 'x');
    const std::string long_ids = "desk: {id: " + word + ", repeat: {count: 1e6, turn: 1}}\n";
    const std::string long_prefix =
        "parts: {p: [desk: {id: d, repeat: {count: 1e5, turn: 1}}]}\n"
        "place: {part: p, id: " +
        word + "}\n";
    std::string path = "fence: {repeat: {count: 1e5, turn: 1}, path: [";
    for (int i = 0; i < 1000; ++i) path += "[1, 2], ";
    for (const std::string& text :
         {nested + "place: {part: p19}\n",
          std::string("desk: {repeat: {rows: 1e6, cols: 1e6, step: [0, 0]}}\n"), empty, long_ids,
          long_prefix, path + "]}\n"}) {
        Texts found;
        EXPECT_LT(secondsFor(text, found), 20) << text.substr(0, 100);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_NE(found[0].find("parts and repetitions make more than 10"), std::string::npos)
            << found[0];
        EXPECT_TRUE(found[0].starts_with("a.yaml:")) << found[0];
        EXPECT_LT(found[0].size(), 300U);
    }
}

TEST(YamlExpansion, BoundsDefaultsAndTextsOfAliases) {
    std::string list = "[";
    for (int i = 0; i < 1000; ++i) list += "[1, 2], ";
    std::string defaults = "- defaults: {fence: {path: " + list + "]}}\n";
    for (int i = 0; i < 5000; ++i) defaults += "- fence: {}\n";
    std::string texts = "- desk: {name: &n \"" + std::string(100000, 'x') + "\"}\n";
    for (int i = 0; i < 5000; ++i) texts += "- desk: {name: *n}\n";
    for (const std::string& text : {defaults, texts}) {
        const Texts found = findings(text);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_NE(found[0].find("aliases expand to more than 64 MB, together with defaults"),
                  std::string::npos)
            << found[0];
    }
}

TEST(YamlExpansion, BoundsTheDepthOfParts) {
    const auto chain = [](int length) {
        std::string text = "parts:\n  p0: [desk: {}]\n";
        for (int i = 1; i < length; ++i)
            text +=
                "  p" + std::to_string(i) + ": [place: {part: p" + std::to_string(i - 1) + "}]\n";
        return text + "place: {part: p" + std::to_string(length - 1) + "}\n";
    };
    constexpr int kMax = static_cast<int>(kMaxPartDepth);
    EXPECT_EQ(records(chain(kMax)), Texts{"desk"});
    for (const int length : {kMax + 1, 20000}) {
        const Texts found = findings(chain(length));
        ASSERT_EQ(found.size(), 1U);
        EXPECT_NE(found[0].find("parts are placed in each other too deep, more than 32"),
                  std::string::npos);
    }
}

TEST(YamlExpansion, DamagedYamlIsReadOrRefused) {
    const std::string good =
        "- defaults: {desk: {height: 1}}\n- include: [b.yaml, c.env]\n"
        "- parts: {p: [desk: {id: d, repeat: {count: 2, step: [1, 0]}}, laser: {on: d-1}],\n"
        "    q: [place: {part: p, at: [1, 2]}]}\n"
        "- place: {part: q, id: w, heading: 30, repeat: {rows: 2, cols: 3, step: [1, 2]}}\n";
    const auto read_file = [&](const std::string& path) -> std::string {
        if (path == "c.env") return "#env 1\ndesk id=c\n";
        return path == "b.yaml" ? "- include: c.env\n- parts: {p: []}\n" : good;
    };
    std::mt19937_64 random(13);
    const std::string signs = "\"'\\#=;, \n0-e.m%[]{}:&*!|>?@`~pqbcdw129";
    int accepted = 0;
    for (int i = 0; i < 5000; ++i) {
        std::string text = good;
        text.replace(text.find("b.yaml, "), i % 2 == 0 ? 8 : 0, "");
        for (std::uint64_t n = random() % 4; n > 0; --n) {
            const auto at = static_cast<std::size_t>(random() % text.size());
            if (random() % 2 == 0)
                text[at] = signs[random() % signs.size()];
            else
                text.insert(at, 1, signs[random() % signs.size()]);
        }
        try {
            const Document document = readYaml(text, "a.yaml", placedSchemas(), read_file);
            ++accepted;
            EXPECT_EQ(readYaml(writeYaml(document), "b", placedSchemas()).records,
                      document.records);
        } catch (const FormatError& error) {
            EXPECT_LE(error.diagnostics().size(), Diagnostics::kMax);
        }
    }
    EXPECT_GT(accepted, 500);
    EXPECT_LT(accepted, 4500);
}

TEST(YamlExpansion, ManyCopiesAreMade) {
    EXPECT_EQ(readYaml("desk: {repeat: {rows: 200, cols: 250, step: [0.5, 0.5]}}\n", "a.yaml",
                       placedSchemas())
                  .records.size(),
              50000U);
}

}  // namespace yaml_parts_test
}  // namespace ispace
