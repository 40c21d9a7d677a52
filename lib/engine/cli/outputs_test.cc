// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/error.h"
#include "base/run_files.h"
#include "support/test_folder.h"

namespace ispace {

namespace outputs_test {

TEST(FileStream, WritesWhatGoesThrough) {
    const testing::TestFolder folder;
    const std::string file = folder.file("out.txt");
    std::string expected;
    {
        FileStream out(file);
        for (int i = 0; i < 300000; ++i) {  // more than its buffer
            out.stream() << i << '\n';
            expected.append(std::to_string(i)).append("\n");
        }
        out.commit();
    }
    EXPECT_EQ(readAll(file), expected);
}

TEST(FileStream, LeavesNothingWithoutCommit) {
    const testing::TestFolder folder;
    const std::string file = folder.file("none");
    { FileStream(file).stream() << "half"; }
    EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(FileStream, AFullDiskIsAnError) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    FileStream out("/dev/full");
    const auto fill = [&out] {
        const std::string line(1000, 'x');
        for (int i = 0; i < 3000; ++i) out.stream() << line;
        out.commit();
    };
    EXPECT_THROW(fill(), std::system_error);
}

TEST(DependencyRule, NamesEachFileOnceAndNoStream) {
    const std::vector<std::string> sources{"room.yaml", "-", "parts/desk.yaml", "room.yaml"};
    EXPECT_EQ(dependencyRule("out/room.glb", sources),
              "out/room.glb: \\\n  room.yaml \\\n  parts/desk.yaml\n\nroom.yaml:\n\n"
              "parts/desk.yaml:\n");
    EXPECT_EQ(dependencyRule("room.glb", {}), "room.glb:\n");
}

TEST(DependencyRule, WritesNamesAsMakeReadsThem) {
    const std::vector<std::string> sources{"my room#1.env", "a$b"};
    EXPECT_EQ(dependencyRule("r", sources),
              "r: \\\n  my\\ room\\#1.env \\\n  a$$b\n\nmy\\ room\\#1.env:\n\na$$b:\n");
}

TEST(DependencyRule, QuotesWhatMakeWouldTakeForSomethingElse) {
    const std::vector<std::string> sources{"a%b", "a\\b", "a\\ b"};
    EXPECT_EQ(dependencyRule("r%", sources),
              "r\\%: \\\n  a%b \\\n  a\\b \\\n  a\\\\\\ b\n\na\\%b:\n\na\\b:\n\na\\\\\\ b:\n");
    EXPECT_EQ(dependencyRule("a|b", std::vector<std::string>{"a |b", "a*b", "c?[d]"}),
              "a|b: \\\n  a\\ \\|b \\\n  a\\*b \\\n  c\\?\\[d]\n\n"
              "a\\ |b:\n\na\\*b:\n\nc\\?\\[d]:\n");
    EXPECT_EQ(dependencyRule("r&", std::vector<std::string>{"s~", "a&"}),
              "r& : \\\n  s~ \\\n  a&\n\ns~:\n\na& :\n");
    for (const char* name : {"a=b", "a;b", "a\nb", "a\tb", "a%b%", "a\\b*", "a ", "a\\",
                             "lib(member)", "~", ".//~root/x"})
        EXPECT_THROW((void)dependencyRule("r", std::vector<std::string>{name}), UsageError);
}

TEST(CheckDependencies, WantsAProductWithAName) {
    EXPECT_NO_THROW(checkDependencies({}, "-"));
    EXPECT_NO_THROW(checkDependencies({true, ""}, "room.glb"));
    EXPECT_THROW(checkDependencies({true, ""}, "-"), UsageError);
    EXPECT_THROW(checkDependencies({true, "x.d"}, "-"), UsageError);
    EXPECT_THROW(checkDependencies({false, "x.d"}, "room.glb"), UsageError);
}

TEST(ClaimOutputs, RefusesARuleInThePlaceOfTheProduct) {
    const auto claim = [](const DependencyOptions& dependencies, const std::string& output) {
        const FileGuard files;
        CommonOptions options;
        options.output = output;
        options.dependencies = dependencies;
        claimOutputs(options);
    };
    EXPECT_NO_THROW(claim({true, ""}, "room.glb"));
    EXPECT_NO_THROW(claim({true, ""}, "room.d"));
    EXPECT_THROW(claim({true, "./room.glb"}, "room.glb"), UsageError);
}

TEST(WriteDependencies, NamesTheRuleAfterTheWholeProduct) {
    const testing::TestFolder folder;
    CommonOptions options;
    options.dependencies.wanted = true;
    for (const char* name : {"office.glb", "office.3dm", "office"}) {
        options.output = folder.file(name);
        writeDependencies(options, std::vector<std::string>{"office.yaml"});
        EXPECT_TRUE(std::filesystem::exists(options.output + ".d")) << name;
    }
}

const std::vector<std::string> kPng = {".png", "-color.png", ".yaml"};

std::string refusal(const std::string& output, const std::vector<std::string>& ids, bool frames,
                    const std::vector<std::string>& endings = {".csv"}) {
    try {
        OutputSet::of(output)->prepare(ids, frames, endings);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(OutputSet, OneFileIsNoSet) {
    EXPECT_FALSE(OutputSet::of("-"));
    EXPECT_FALSE(OutputSet::of("scan.csv"));
    EXPECT_TRUE(OutputSet::of("folder/"));
    EXPECT_TRUE(OutputSet::of("."));
    EXPECT_TRUE(OutputSet::of("scan-%d.csv"));
}

TEST(OutputSet, NamesInAFolder) {
    const OutputSet set = *OutputSet::of("a/b/");
    EXPECT_EQ(set.fileOf("l1", 7, ".csv"), "a/b/l1-0007.csv");
    EXPECT_EQ(set.fileOf("l1", 123456, ".csv"), "a/b/l1-123456.csv");
    EXPECT_EQ(set.fileOf("../x", 0, ".csv"), "a/b/_._x-0000.csv") << "no other folder";
    EXPECT_EQ(set.fileBeside("k", 0, "-color.png"), "a/b/k-0000-color.png");
}

TEST(OutputSet, NamesOfAPattern) {
    EXPECT_EQ(OutputSet::of("x/%s-%03d.pcd")->fileOf("l1", 7, ".pcd"), "x/l1-007.pcd");
    EXPECT_EQ(OutputSet::of("%d")->fileOf("l1", 7, ".pcd"), "7.pcd");
    EXPECT_EQ(OutputSet::of("100%%-%d.f32")->fileOf("l1", 7, ".raw"), "100%-7.f32")
        << "the suffix that was written";
    EXPECT_EQ(OutputSet::of("%s.x/%d.png")->fileBeside("k", 1, ".yaml"), "k.x/1.yaml");
}

TEST(OutputSet, MakesTheFoldersOfAPattern) {
    const testing::TestFolder temporary;
    const std::filesystem::path folder = temporary / "film";
    EXPECT_EQ(refusal((folder / "%s" / "%04d.png").string(), {"a", "b"}, true), "");
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a"));
    EXPECT_TRUE(std::filesystem::is_directory(folder / "b"));
    std::filesystem::remove_all(folder);
    std::ofstream(folder) << "a file";
    EXPECT_THROW(OutputSet::of((folder / "%d.png").string())->prepare({"a"}, true, {".png"}),
                 std::system_error);
}

TEST(OutputSet, IdsNeitherEscapeNorHide) {
    const OutputSet set = *OutputSet::of("%s/x.csv");
    for (const auto& [id, name] : {std::pair("..", "_."),
                                   {".", "_"},
                                   {".hidden", "_hidden"},
                                   {"-rf", "_rf"},
                                   {"a\nb\x1b\x7f", "a_b__"},
                                   {"\xff", "_"},
                                   {"a.b-c", "a.b-c"},
                                   {"türe", "türe"}})
        EXPECT_EQ(set.fileOf(id, 0, ".csv"), std::string(name) + "/x.csv");
    EXPECT_EQ(OutputSet::of(".%s/x.csv")->fileOf(".", 0, ".csv"), "._/x.csv");
    EXPECT_NE(refusal("%s.csv", {"..", "_."}, false), "") << "one name for two";
    EXPECT_NE(refusal("%s.csv", {"-a", "_a"}, false), "");
    EXPECT_EQ(refusal("%s.csv", {std::string(251, 'x')}, false), "");
    EXPECT_NE(refusal("%s.csv", {std::string(252, 'x')}, false), "") << "more than 255 bytes";
}

TEST(OutputSet, RefusesWhatDoesNotTellReadingsApart) {
    EXPECT_NE(refusal("x-%d.csv", {"a", "b"}, false), "");
    EXPECT_NE(refusal("x-%s.csv", {"a"}, true), "");
    EXPECT_NE(refusal("x.%d", {"a"}, true), "") << "its suffix would hide the number";
    EXPECT_EQ(refusal("x-%d.csv", {"a"}, true), "");
    // l1 and frame 0 of l1: l10; l and frame 10.
    EXPECT_NE(refusal("%s%d.csv", {"l", "l1"}, true), "");
    EXPECT_NE(refusal("%s-1%d.csv", {"l", "l1"}, true), "");
    EXPECT_NE(refusal("%d2%s.csv", {"l", "l1"}, true), "");
    EXPECT_EQ(refusal("%d-%s.csv", {"l", "l1"}, true), "");
    EXPECT_EQ(refusal("%s%d.csv", {"l"}, true), "");
    EXPECT_EQ(refusal("%s.csv", {"l", "l1"}, false), "");
    EXPECT_NE(refusal("%s.csv", {"a/b", "a_b"}, false), "");
    EXPECT_NE(refusal("%s.png", {"r1", "r1-color"}, false, kPng), "");
    EXPECT_NE(refusal("%s.yaml", {"r1"}, false, kPng), "") << "the picture and its camera_info";
    EXPECT_EQ(refusal("%s.png", {"r1", "r2"}, false, kPng), "");
}

TEST(OutputSet, RefusesBadPatterns) {
    for (const char* pattern : {"%x.csv", "%n.csv", "%5d.csv", "%05s.csv", "a%", "%0d.csv",
                                "%-3d.csv", "%0000000012d.csv"})
        EXPECT_NE(refusal(pattern, {"a"}, false), "") << pattern;
    EXPECT_EQ(refusal("%%.csv", {"a"}, false), "");
}

}  // namespace outputs_test

}  // namespace ispace
