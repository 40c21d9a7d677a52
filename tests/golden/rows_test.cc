// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows.h"

#include <gtest/gtest.h>

namespace golden {
namespace {

constexpr const char* kRows =
    "# Rows (of a test).\n"
    "ispace_golden(leaky_too \"envc )\")\n"
    "ispace_golden(leaky\n  \"envc \\\"a) ERR\" STATUS 1\n  ERR \"error: old\")\n"
    "ispace_golden(last \"envc\" STATUS 1)\n";

TEST(ErrorLine, ReplacesWhatTheRowHas) {
    EXPECT_EQ(withErrorLine(kRows, "leaky", "error: new; \"$\\\""),
              "# Rows (of a test).\n"
              "ispace_golden(leaky_too \"envc )\")\n"
              "ispace_golden(leaky\n  \"envc \\\"a) ERR\" STATUS 1\n"
              "  ERR \"error: new; \\\"\\$\\\\\\\"\")\n"
              "ispace_golden(last \"envc\" STATUS 1)\n");
    EXPECT_EQ(withErrorLine(kRows, "leaky", "error: old"), kRows);
}

TEST(ErrorLine, IsPutInAndTakenOut) {
    const std::string added = withErrorLine(kRows, "last", "warning: x").value_or("");
    EXPECT_TRUE(added.ends_with("ispace_golden(last \"envc\" STATUS 1\n  ERR \"warning: x\")\n"));
    EXPECT_EQ(withErrorLine(added, "last", ""), kRows);
    EXPECT_EQ(withErrorLine(kRows, "last", ""), kRows);
}

TEST(ErrorLine, NeedsTheRow) { EXPECT_EQ(withErrorLine(kRows, "leak", "x"), std::nullopt); }

}  // namespace
}  // namespace golden
