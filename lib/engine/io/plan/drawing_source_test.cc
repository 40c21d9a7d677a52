// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/drawing_source.h"

#include <gtest/gtest.h>

namespace ispace {
namespace drawing_source_test {

TEST(WallNames, OfManyLanguages) {
    for (const char* name :
         {"WALL",  "A-WALL-EXT", "Innenwände", "MUROS", "A-Mur-Ext", "Pareti", "PAREDES",
          "Muren", "Ściany",     "ŚCIANY",     "Stěny", "STĚNY",     "Väggar", "VÄGGAR",
          "Vægge", "Seinät",     "Стены",      "СТЕНЫ", "СТІНИ",     "Τοίχοι", "DUVARLAR",
          "Falak", "Pereți",     "Zidovi",     "Murs",  "墙体",      "壁",     "벽"})
        EXPECT_TRUE(isWallName(name)) << name;
    for (const char* name :
         {"", "0", "WALLS-HATCH", "A-DOOR-WALL", "Möbel", "murmel", "стол", "窗", "\xe4\xff"})
        EXPECT_FALSE(isWallName(name)) << name;
}

TEST(MatchesLayer, InEitherCase) {
    EXPECT_TRUE(matchesLayer({"wände"}, "WÄNDE"));
    EXPECT_TRUE(matchesLayer({"СТЕНЫ*"}, "стены_1"));
    EXPECT_TRUE(matchesLayer({"ŽIDY"}, "židy"));
    EXPECT_FALSE(matchesLayer({"wande"}, "WÄNDE"));
    EXPECT_FALSE(matchesLayer({"A×B"}, "A÷B"));
}

}  // namespace drawing_source_test
}  // namespace ispace
