// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/dependencies.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/run_files.h"

namespace ispace {
namespace {

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
        const RunFiles files;
        CommonOptions options;
        options.output = output;
        options.dependencies = dependencies;
        claimOutputs(options);
    };
    EXPECT_NO_THROW(claim({true, ""}, "room.glb"));
    EXPECT_NO_THROW(claim({false, ""}, "room.d"));
    EXPECT_THROW(claim({true, ""}, "room.d"), UsageError);
    EXPECT_THROW(claim({true, "./room.glb"}, "room.glb"), UsageError);
}

}  // namespace
}  // namespace ispace
