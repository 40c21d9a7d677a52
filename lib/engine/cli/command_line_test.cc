// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_line.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <system_error>

#include "base/error.h"
#include "cli/common_options.h"
#include "cli/objective_extension.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "support/test_folder.h"

namespace ispace {
namespace command_line_test {

/// A tool with one option of each sort.
struct Tool {
    CommandLine line{"tool", "ENV",
                     "Do a thing to a room, and say so in words that are many "
                     "enough to need more than one line of the help text."};
    CommonOptions common;
    std::vector<std::string> operands, words;
    std::string strategy;
    std::optional<int> x;
    double height = 0.15;
    CellWords cells;
    double density = 0;
    bool json = false;
    std::vector<std::string> edits;

    Tool() {
        line.operands(operands, 2);
        line.texts("--sensor", "SPEC", words, "place one", Enters::History);
        line.choice("--strategy", strategy, {"grid", "wall"}, "how", Enters::History);
        line.count("-X", "N", x, 1, 100, "lines", Enters::History);
        line.meters("--height", height, 0, 10, "where", Enters::History);
        addCellOptions(line, cells, "that count");
        addDensityOption(line, density);
        for (const char* edit : {"--move", "--rotate"})
            line.ordered(
                edit, "ID:BY",
                [this, edit](const std::string& text) {
                    if (text == "bad") throw UsageError("it is bad");
                    edits.push_back(std::string(edit) + ' ' + text);
                },
                "change it");
        line.flag("--json", json, "as JSON", Enters::Nothing);
        addCommonOptions(line, common, "there");
    }
    void parse(std::vector<const char*> words_given) {
        words_given.insert(words_given.begin(), "tool");
        line.parse(static_cast<int>(words_given.size()), words_given.data());
    }
    std::string errorOf(const std::vector<const char*>& words_given) {
        try {
            parse(words_given);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    }
};

TEST(CommandLine, OptionsAndOperandsInAnyOrder) {
    Tool tool;
    tool.parse({"room.glb", "--sensor", "a:2", "-X", "7", "--sensor=b", "-", "--height", "50cm",
                "-qo", "out.3dm", "--grid", "20,30", "--density", "observe"});
    EXPECT_EQ(tool.operands, (std::vector<std::string>{"room.glb", "-"}));
    EXPECT_EQ(tool.words, (std::vector<std::string>{"a:2", "b"}));
    EXPECT_EQ(tool.x, 7);
    EXPECT_EQ(tool.height, 0.5);
    EXPECT_EQ(tool.density, 62.5);
    const auto cells = tool.cells.choice();
    ASSERT_TRUE(cells && std::holds_alternative<CellCount>(*cells));
    EXPECT_EQ(std::get<CellCount>(*cells).columns, 20);
    EXPECT_EQ(std::get<CellCount>(*cells).rows, 30);
    EXPECT_EQ(tool.common.output, "out.3dm");
    EXPECT_TRUE(tool.common.quiet);
    EXPECT_TRUE(tool.line.given("--output"));
    EXPECT_FALSE(tool.line.given("--threads"));
}

TEST(CommandLine, AnOptionThatTheBuildLacksIsNotGiven) {
    Tool tool;
    tool.parse({"--json"});
    EXPECT_TRUE(tool.line.given("--json"));
    EXPECT_FALSE(tool.line.given("--strategy"));
    EXPECT_FALSE(tool.line.given("--of-an-extension"));
}

TEST(CommandLine, FlagsTakeNoValue) {
    EXPECT_NE(Tool().errorOf({"--json=false"}), "");
    EXPECT_NE(Tool().errorOf({"--progress=false"}), "");
}

TEST(CommandLine, PipesAreStreamsInHistory) {
    Tool tool;
    tool.parse({"/dev/null"});
    EXPECT_EQ(tool.line.historyLine(tool.operands), "tool -");
}

TEST(CommandLine, TwoDashesEndOptions) {
    Tool tool;
    tool.parse({"--json", "--", "--strategy", "-X"});
    EXPECT_EQ(tool.operands, (std::vector<std::string>{"--strategy", "-X"}));
    EXPECT_TRUE(tool.json);
    EXPECT_EQ(tool.strategy, "");
}

TEST(CommandLine, HistoryHoldsWhatChangesTheResultInTheTablesOrder) {
    Tool tool;
    tool.parse({"-X", "3", "--json", "-o", "x", "-j", "2", "--seed", "5", "--strategy", "grid",
                "dir/room one.glb", "--sensor", "laser,range=4:3"});
    EXPECT_EQ(tool.line.historyLine(tool.operands),
              "tool 'room one.glb' --sensor laser,range=4:3 --strategy grid -X 3 --seed 5");
    EXPECT_EQ(tool.line.historyLine({"-"}).substr(0, 6), "tool -");
}

TEST(CommandLine, HistoryNamesFilesWithoutTheirFolders) {
    for (const auto& [given, named] : {std::pair("/tmp/dir/go.txt", "go.txt"), {"-", "-"}}) {
        CommandLine line("tool", "ENV", "A tool.");
        std::string file;
        line.text("--script", "FILE", file, "commands", Enters::BaseName);
        const std::vector<const char*> words = {"tool", "--script", given};
        line.parse(static_cast<int>(words.size()), words.data());
        EXPECT_EQ(file, given);
        EXPECT_EQ(line.historyLine({}), std::string("tool --script ") + named);
    }
}

TEST(CommandLine, HistoryNamesTheFilesOfAListWithoutTheirFolders) {
    for (const auto& [given, named] :
         {std::pair("rooms:/tmp/a.env,b/c d.env", "'rooms:a.env,c d.env'"),
          {"rooms:a.env", "rooms:a.env"},
          {"failures:1", "failures:1"},
          {"mounting:5cm,3deg", "mounting:5cm,3deg"},
          {"runs/of/today", "today"},
          {"none", "none"},
          {"none:", "none:"}}) {
        CommandLine line("tool", "ENV", "A tool.");
        std::string list;
        line.text("--robust", "WHAT", list, "cases", Enters::BaseNames);
        const std::vector<const char*> words = {"tool", "--robust", given};
        line.parse(static_cast<int>(words.size()), words.data());
        EXPECT_EQ(line.historyLine({}), std::string("tool --robust ") + named);
    }
}

TEST(CommandLine, UsageErrorsHintAtWhatWasMeant) {
    EXPECT_NE(Tool().errorOf({"--stratgy", "grid"}).find("did you mean `--strategy`"),
              std::string::npos);
    EXPECT_NE(Tool().errorOf({"--density", "identity"}).find("did you mean `identify`"),
              std::string::npos);
    EXPECT_NE(Tool().errorOf({"--strategy", "gird"}).find("did you mean `grid`"),
              std::string::npos);
    EXPECT_NE(Tool().errorOf({"-X", "0"}).find("from 1 to 100"), std::string::npos);
    EXPECT_NE(Tool().errorOf({"-X", "3x"}).find("`3x`"), std::string::npos);
    EXPECT_NE(Tool().errorOf({"--height", "nan"}), "");
    EXPECT_NE(Tool().errorOf({"--height", "3deg"}), "");
    EXPECT_NE(Tool().errorOf({"--height", "-1"}), "");
    EXPECT_NE(Tool().errorOf({"--grid", "3,0"}), "");
    // Old names, and options of other tools.
    for (const char* word : {"--reso", "--reso=100"})
        EXPECT_NE(Tool().errorOf({word, "100"}).find("give cells as --grid P,Q or --cell M"),
                  std::string::npos)
            << Tool().errorOf({word, "100"});
    EXPECT_NE(Tool().errorOf({"--seed", "-1"}), "");
    EXPECT_NE(Tool().errorOf({"a", "b", "c"}).find("too many operands: c"), std::string::npos);
    EXPECT_NE(Tool().errorOf({"a", "b.3dm", "c.3dm"}).find("one layout is read"),
              std::string::npos);
    EXPECT_NE(Tool().errorOf({""}), "");
    EXPECT_NE(Tool().errorOf({"-X"}), "");
    EXPECT_EQ(Tool().errorOf({"--height", "0"}), "");
}

TEST(CommandLine, HelpFitsEightyColumnsAndNamesEveryOption) {
    Tool tool;
    std::string help;
    try {
        tool.parse({"--help", "--json"});
        FAIL() << "--help was not taken";
    } catch (const TextRequested& request) {
        help = request.text;
    }
    for (const char* name : {"--help", "--version", "--sensor", "--strategy", "-X", "--height",
                             "--grid", "--cell", "--json", "--output", "--quiet", "--verbose",
                             "--threads", "--seed", "--progress", "--no-progress"})
        EXPECT_NE(help.find(name), std::string::npos) << name;
    std::size_t begin = 0;
    for (std::size_t end = help.find('\n'); end != std::string::npos;
         end = help.find('\n', begin)) {
        EXPECT_LE(end - begin, 79U) << help.substr(begin, end - begin);
        begin = end + 1;
    }
    EXPECT_THROW(Tool().parse({"-V"}), TextRequested);
}

TEST(CommandLine, TakesOrderedOptionsAsTheyCome) {
    Tool tool;
    tool.parse(
        {"--rotate", "a:1", "--move=b:2", "room.glb", "--strategy", "grid", "--rotate", "c:3"});
    EXPECT_EQ(tool.edits, (std::vector<std::string>{"--rotate a:1", "--move b:2", "--rotate c:3"}));
    EXPECT_EQ(tool.line.historyLine(tool.operands),
              "tool room.glb --strategy grid --rotate a:1 --move b:2 --rotate c:3");
    EXPECT_EQ(Tool().errorOf({"--move", "bad"}), "--move: it is bad (see tool --help)");
}

TEST(CommandLine, KnowsTheDependencyOptionsOfCompilers) {
    Tool tool;
    tool.parse({"room.glb", "-MD", "-MF", "room.d", "-o", "x.3dm"});
    EXPECT_TRUE(tool.common.dependencies.wanted);
    EXPECT_EQ(tool.common.dependencies.file, "room.d");
    EXPECT_EQ(tool.line.historyLine(tool.operands), "tool room.glb");
    Tool joined;
    joined.parse({"-MFx.d", "room.glb", "-MD", "-o", "x"});
    EXPECT_EQ(joined.common.dependencies.file, "x.d");
    EXPECT_EQ(joined.operands, std::vector<std::string>{"room.glb"});
    const std::string help = joined.line.helpText("all");
    EXPECT_NE(help.find("\n  -MD "), std::string::npos) << help;
    EXPECT_NE(help.find("\n  -MF FILE "), std::string::npos) << help;
    EXPECT_NE(Tool().errorOf({"-MD"}).find("-o FILE"), std::string::npos);
    // Behind -- they are operands.
    Tool behind;
    behind.parse({"--", "-MD"});
    EXPECT_EQ(behind.operands, std::vector<std::string>{"-MD"});
}

TEST(CommandLine, HelpListsTheEssentialOptionsAndGroupsOfTheOthers) {
    CommandLine line("tool", "", "does something.");
    bool flag = false;
    line.flag("--first", flag, "the first", Enters::Nothing);
    line.group("Maps, and pictures");
    line.flag("--draw", flag, "the picture", Enters::Nothing);
    line.flag("--width", flag, "its width", Enters::Nothing);
    line.extension("judge");
    line.group("Tracks of a run");
    line.flag("--tracks", flag, "the tracks, beside --width", Enters::Nothing);
    line.extension("");
    line.group("The run");
    line.flag("--until", flag, "its end", Enters::Nothing);
    // All of them, unless some are essential.
    for (const char* const name : {"--first", "--draw", "--width", "--tracks", "--until"})
        EXPECT_NE(line.helpText().find(name), std::string::npos);
    line.essential({"--first", "--draw", "--until"});
    const std::string page = line.helpText();
    for (const char* const text :
         {"--first", "--draw", "--until", "\n  maps          maps, and pictures\n",
          "\n  tracks        tracks of a run (extension judge)\n"})
        EXPECT_NE(page.find(text), std::string::npos) << page;
    // A group without further options is not listed.
    for (const char* const text : {"--width", "--tracks", "the run\n"})
        EXPECT_EQ(page.find(text), std::string::npos) << page;
    for (const char* const word : {"maps", "and", "pictures", "pict"}) {
        EXPECT_NE(line.helpText(word).find("--width"), std::string::npos) << word;
        EXPECT_EQ(line.helpText(word).find("--first"), std::string::npos) << word;
    }
    EXPECT_EQ(line.helpText("judge"), line.helpText("tracks"));
    EXPECT_NE(line.helpText("width").find("its width"), std::string::npos);
    EXPECT_EQ(line.helpText("width").find("--draw"), std::string::npos);
    EXPECT_NE(line.helpText("width").find("--tracks"), std::string::npos) << "it speaks of it";
    EXPECT_EQ(line.helpText("draw").find("--tracks"), std::string::npos);
    // The heading that begins with the word comes before those that contain it.
    EXPECT_NE(line.helpText("run").find("--until"), std::string::npos);
    // A heading of one word is that group; another group with the word has one of its own.
    line.group("Run of many");
    line.flag("--many", flag, "many", Enters::Nothing);
    line.group("Maps");
    line.flag("--tiles", flag, "tiles", Enters::Nothing);
    EXPECT_NE(line.helpText("maps").find("--tiles"), std::string::npos);
    EXPECT_EQ(line.helpText("maps").find("--width"), std::string::npos);
    EXPECT_NE(line.helpText().find("\n  many          run of many\n"), std::string::npos)
        << line.helpText();
    EXPECT_THROW(static_cast<void>(line.helpText("walls")), UsageError);
    EXPECT_THROW(static_cast<void>(line.helpText("-")), UsageError);
}

TEST(CommandLine, TakesTheWordBehindHelp) {
    const auto asked = [](std::vector<const char*> words) {
        CommandLine line("tool", "", "does something.");
        bool flag = false;
        line.flag("--first", flag, "the first", Enters::Nothing);
        line.group("Maps");
        line.flag("--draw", flag, "the picture", Enters::Nothing);
        std::string style;
        line.text("--style", "NAME", style, "how it is drawn", Enters::Nothing);
        line.essential({"--first"});
        words.insert(words.begin(), "tool");
        try {
            line.parse(static_cast<int>(words.size()), words.data());
        } catch (const TextRequested& text) {
            return text.text;
        }
        return std::string();
    };
    const std::string page = asked({"--help"}), all = asked({"--help", "all"});
    EXPECT_EQ(page.find("--draw"), std::string::npos);
    EXPECT_NE(all.find("--draw"), std::string::npos);
    EXPECT_EQ(asked({"-h"}), page);
    EXPECT_EQ(asked({"-h", "all"}), all);
    EXPECT_EQ(asked({"--first", "--help=all"}), all);
    EXPECT_EQ(asked({"--help", "--first"}), page);
    EXPECT_EQ(asked({"room.env", "--help", "room.env"}), page);
    EXPECT_EQ(asked({"--help", "./room"}), page);
    EXPECT_NE(asked({"--help", "maps"}), all);
    EXPECT_NE(asked({"--help", "style"}).find("how it is drawn"), std::string::npos);
    EXPECT_EQ(asked({"--help", "--style"}), asked({"--help", "style"}));
    EXPECT_EQ(asked({"--style", "fine", "--help"}), page);
    EXPECT_THROW(asked({"--help", "mops"}), UsageError);
}

TEST(CommandLine, FindsAnOptionBeforeAGroupThatMerelyHasItsWord) {
    const auto asked = [](std::vector<const char*> words) {
        CommandLine line("tool", "", "does something.");
        std::string run, films;
        line.group("Films of a run");
        line.text("--fps", "N", films, "pictures a second", Enters::Nothing);
        line.group("Trackers of a run");
        line.text("--run", "DIR", run, "the record", Enters::Nothing);
        line.text("--films", "N", films, "how many", Enters::Nothing);
        words.insert(words.begin(), "tool");
        try {
            line.parse(static_cast<int>(words.size()), words.data());
        } catch (const TextRequested& text) {
            return text.text;
        }
        return std::string();
    };
    EXPECT_NE(asked({"--help", "run"}).find("the record"), std::string::npos);
    // The word of a group alone stands for the group; the option has its dashes.
    EXPECT_NE(asked({"--help", "films"}).find("pictures a second"), std::string::npos);
    EXPECT_NE(asked({"--help", "--films"}).find("how many"), std::string::npos);
    EXPECT_EQ(asked({"--help", "--films"}).find("pictures a second"), std::string::npos);
}

TEST(CommandLine, NamesTheExtensionOfAnObjectiveThatTheBuildLacks) {
    constexpr ObjectiveRow kRows[] = {{"evenness", nullptr, "even"}, {"goals", nullptr, "path"}};
    const ObjectiveExtensions objectives("--objective", kRows);
    EXPECT_EQ(objectives.find("coverage"), nullptr);
    EXPECT_EQ(objectives.find("pathfinder"), nullptr);
    const auto refusal = [&objectives](std::string_view word) {
        try {
            static_cast<void>(objectives.find(word));
        } catch (const UsageError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal("even"),
              "`even`: it belongs to the extension evenness, which this build lacks");
    EXPECT_EQ(refusal("path:a,b"),
              "`path:a,b`: it belongs to the extension goals, which this build lacks");
}

TEST(CommandLine, ListsTheExtensionsOfTheBuildWithItsVersion) {
    const auto version = [](std::vector<std::string_view> extensions, const char* form) {
        CommandLine line("tool", "", "does something.");
        line.built(extensions);
        const char* const words[] = {"tool", "--version", form};
        try {
            line.parse(form == nullptr ? 2 : 3, words);
        } catch (const TextRequested& text) {
            return text.text;
        }
        return std::string();
    };
    EXPECT_TRUE(version({"cad", "locks"}, nullptr).ends_with("\nExtensions: cad locks\n"));
    EXPECT_TRUE(version({}, nullptr).ends_with("\nExtensions: none\n"));
    EXPECT_NE(version({"cad"}, "--json").find(R"("extensions":["cad"])"), std::string::npos);
    CommandLine line("tool", "", "does something.");
    line.built(std::vector<std::string_view>{"cad", "locks"});
    EXPECT_NE(line.helpText("all").find("\nExtensions: cad locks\n"), std::string::npos);
}

TEST(CommandLine, TakesTimesWithUnits) {
    const auto limit = [](const char* text) {
        CommandLine line("tool", "", "");
        std::optional<double> seconds;
        line.duration("--limit", seconds, 0, 3600, "how long", Enters::History);
        const char* const argv[] = {"tool", "--limit", text};
        line.parse(3, argv);
        return seconds.value();
    };
    EXPECT_EQ(limit("2"), 2);
    EXPECT_EQ(limit("2s"), 2);
    EXPECT_EQ(limit("500ms"), 0.5);
    EXPECT_EQ(limit("1.5min"), 90);
    EXPECT_EQ(limit("1h"), 3600);
    for (const char* bad : {"", "1m", "2 s", "61min", "-1", "soon"})
        EXPECT_THROW(limit(bad), UsageError) << bad;
}

TEST(IsStream, KnowsWhatCannotBeReadAgain) {
    for (const char* stream : {"-", "/dev/stdin", "/dev/fd/3", "/proc/self/fd/0", "/dev/null"})
        EXPECT_TRUE(isStream(stream)) << stream;
    for (const char* file : {"room.env", "/dev/shm/no_such_room.env", "/proc/version"})
        EXPECT_FALSE(isStream(file)) << file;
}

TEST(OutputFormat, IsToldByOptionThenSuffixThenDefault) {
    const std::vector<std::string> known{"glb", "env", "yaml"};
    EXPECT_EQ(outputFormat("", "x.ENV", known), "env");
    EXPECT_EQ(outputFormat("", "x.yml", known), "yaml");
    EXPECT_EQ(outputFormat("glb", "x.csv", known), "glb");
    EXPECT_EQ(outputFormat("glb", "x.mcap", known), "glb");
    EXPECT_EQ(outputFormat("env", "x.glb", known), "env");
    for (const char* plain : {"-", "x", "x.", ".glb", "out.d/x", "/dev/stdout", "/dev/null"})
        EXPECT_EQ(outputFormat("", plain, known), "glb") << plain;
    const testing::TestFolder folder;
    std::filesystem::create_directory(folder / "readings.d");
    EXPECT_EQ(outputFormat("", folder.file("readings.d"), known), "glb");
}

TEST(OutputFormat, RefusesASuffixThatNoFormatHas) {
    const std::vector<std::string> known{"png", "ros", "carmen"};
    const std::vector<SuffixOf> others{{"", "ros"}, {"log", "carmen"}};
    EXPECT_EQ(outputFormat({}, "x.log", known, others), "carmen");
    EXPECT_EQ(outputFormat({}, "x.carmen", known, others), "carmen");
    EXPECT_EQ(outputFormat({}, "x.ros", known, others), "ros");
    for (const char* other : {"x.csv", "x.mcap", "x.sdf", "x.foo", "x.png.gz", "x.yaml", "x.5"})
        EXPECT_THROW(outputFormat({}, other, known, others), UsageError) << other;
    const auto message = [&](const std::optional<std::string>& to, const char* output) {
        try {
            outputFormat(to, output, known, others);
        } catch (const UsageError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(message({}, "a/x.mcap"),
              "a/x.mcap: no format has the suffix `.mcap`, wanted .png or .log");
    EXPECT_EQ(message("", "x.pgn"),
              "x.pgn: no format has the suffix `.pgn`, wanted .png or .log, or --to FORMAT, did "
              "you mean `.png`?");
}

TEST(RunTool, ChoosesTheExitStatus) {
    const auto status = [](const std::function<void()>& body) { return runTool("tool", body); };
    EXPECT_EQ(status([] {}), 0);
    EXPECT_EQ(status([] { throw UsageError("x"); }), 2);
    EXPECT_EQ(status([] { throw UnmetError("x"); }), 3);
    EXPECT_EQ(status([] { throw FormatError({"f", 1, 2, "x"}); }), 1);
    EXPECT_EQ(status([] { throw std::bad_alloc(); }), 1);
    EXPECT_EQ(status([] { throw std::runtime_error("x"); }), 1);
}

TEST(RunTool, PrintsOneLineAnError) {
    ::testing::internal::CaptureStderr();
    runTool("envc", [] {
        throw FormatError({{"room.env", 14, 7, "wall has zero length"}, {"room.env", 0, 0, "y"}});
    });
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "envc: room.env:14:7: error: wall has zero length\nenvc: room.env: error: y\n");
    ::testing::internal::CaptureStderr();
    runTool("scan", [] { throw std::system_error(ENOENT, std::generic_category(), "a: b.glb"); });
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "scan: a: b.glb: error: No such file or directory\n");
}

}  // namespace command_line_test
}  // namespace ispace
