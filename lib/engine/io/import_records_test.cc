// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/import_records.h"

#include <gtest/gtest.h>

namespace ispace {
namespace import_records_test {

TEST(ImportRecords, TranscribesLettersInIds) {
    using Letters = ImportRecords::Letters;
    EXPECT_EQ(ImportRecords::idWord("Küche/Straße 2", Letters::Lower), "kueche-strasse-2");
    EXPECT_EQ(ImportRecords::idWord("L\u2019Haÿ", Letters::Lower), "l-hay");
}

}  // namespace import_records_test
}  // namespace ispace
