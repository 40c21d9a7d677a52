// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/text_table.h"

#include <gtest/gtest.h>

namespace ispace {
namespace text_table_test {

TEST(TextTable, AlignsByCharacters) {
    EXPECT_EQ(aligned({{"Küche", "1.5 m²"}, {"hall", "12 m"}}, "lr"),
              "Küche  1.5 m²\n"
              "hall     12 m\n");
}

}  // namespace text_table_test
}  // namespace ispace
