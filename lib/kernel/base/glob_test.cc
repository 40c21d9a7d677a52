// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/glob.h"

#include <fnmatch.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <string>

namespace ispace {
namespace glob_test {

TEST(Glob, MatchesNamesAsShellsDo) {
    struct Case {
        const char *glob, *name;
        bool matches;
    };
    constexpr Case kCases[] = {{"l1", "l1", true},
                               {"l1", "l12", false},
                               {"l*", "l12", true},
                               {"l*", "l", true},
                               {"*", "", true},
                               {"", "", true},
                               {"?", "", false},
                               {"l?", "l1", true},
                               {"l?", "l12", false},
                               {"*l*2", "hall-l12", true},
                               {"*l*2", "hall-l13", false},
                               {"room/*", "room/a/b", true},
                               {"[a-c]1", "b1", true},
                               {"[!a-c]1", "b1", false},
                               {"[^a-c]1", "d1", true},
                               {"[]x]", "]", true},
                               {"[a-]", "-", true},
                               {"a[b", "a[b", true},
                               {"a[b]", "a[b]", true},
                               {"a[b]", "ab", true},
                               {"\\*", "*", true},
                               {"\\*", "x", false},
                               {"[[:digit:]]", "7", true},
                               {"[[:alpha:]-]", "7", false},
                               {"[[:upper:]_]x", "_x", true}};
    for (const Case& each : kCases)
        EXPECT_EQ(Glob(each.glob).matches(each.name), each.matches)
            << each.glob << ' ' << each.name;
    EXPECT_TRUE(Glob("l*").isPattern());
    EXPECT_FALSE(Glob("l1").isPattern());
}

/// Of random patterns and names, longer ones than a word has bits as well.
TEST(Glob, AgreesWithFnmatch) {
    std::mt19937 random(7);
    const auto text_of = [&random](std::string_view letters, std::size_t longest) {
        std::string text(random() % (longest + 1), ' ');
        for (char& c : text) c = letters[random() % letters.size()];
        return text;
    };
    int matching = 0;
    for (int i = 0; i < 200'000; ++i) {
        const std::size_t longest = i % 10 == 0 ? 200 : 9;
        const std::string glob = text_of(longest > 9 ? "aab**?" : "aabB**?[]!-\\", longest);
        const std::string name = text_of("aabB-", longest);
        const bool is_same = glob == name;
        const bool wanted = is_same || ::fnmatch(glob.c_str(), name.c_str(), 0) == 0;
        matching += wanted && !is_same ? 1 : 0;
        ASSERT_EQ(Glob(glob).matches(name), wanted) << glob << ' ' << name;
    }
    EXPECT_GT(matching, 5'000);
}

/// Minutes for fnmatch: each star tries all ends of the one before it.
TEST(Glob, TakesLinearTimeOfHostilePatterns) {
    const std::string name(4000, 'a');
    std::string pattern;
    for (int i = 0; i < 6; ++i) pattern += "*" + std::string(300, 'a') + "?";
    const Glob glob(pattern + "b*");
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 100; ++i) EXPECT_FALSE(glob.matches(name));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
}

}  // namespace glob_test
}  // namespace ispace
