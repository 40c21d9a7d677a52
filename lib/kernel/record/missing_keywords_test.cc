// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/missing_keywords.h"

#include <gtest/gtest.h>

#include "record/record.h"
#include "record/text.h"

namespace ispace {
namespace missing_keywords_test {

TEST(MissingKeywords, AreNamedWithTheirExtension) {
    addMissingKeyword("sundial", "clocks");
    EXPECT_EQ(missingExtension("sundial"), "clocks");
    EXPECT_EQ(missingExtension("wall"), "");
    EXPECT_EQ(spellingHint("sundial", {"wall", "door"}),
              ", which the extension clocks reads: this build lacks that extension");
    EXPECT_EQ(spellingHint("dor", {"wall", "door"}), ", did you mean `door`?");
}

TEST(MissingKeywords, AreKeysToo) {
    addMissingKeyword("pot.lid", "kitchens");
    const Schemas schemas({{.keyword = "pot",
                            .type = RecordType::Other,
                            .help = "a pot",
                            .keys = {{.name = "id", .type = KeyType::Word, .help = "its name"}}}});
    try {
        readRecordText("#env 1\npot lid=yes\npot ld=yes\n", "p.env", schemas);
        FAIL() << "unknown keys";
    } catch (const FormatError& error) {
        ASSERT_EQ(error.diagnostics().size(), 2U);
        EXPECT_EQ(error.diagnostics()[0].message,
                  "unknown key `lid`, which the extension kitchens reads: this build lacks that "
                  "extension");
        EXPECT_EQ(error.diagnostics()[1].message, "unknown key `ld`, did you mean `id`?");
    }
}

}  // namespace missing_keywords_test
}  // namespace ispace
