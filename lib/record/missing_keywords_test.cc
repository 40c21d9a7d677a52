// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/missing_keywords.h"

#include <gtest/gtest.h>

#include "record/record.h"

namespace ispace {
namespace {

TEST(MissingKeywords, AreNamedWithTheirExtension) {
    addMissingKeyword("sundial", "clocks");
    EXPECT_EQ(missingExtension("sundial"), "clocks");
    EXPECT_EQ(missingExtension("wall"), "");
    EXPECT_EQ(spellingHint("sundial", {"wall", "door"}),
              ", which the extension clocks reads: this build lacks that extension");
    EXPECT_EQ(spellingHint("dor", {"wall", "door"}), ", did you mean `door`?");
}

}  // namespace
}  // namespace ispace
