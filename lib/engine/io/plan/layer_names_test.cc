// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/layer_names.h"

#include <gtest/gtest.h>

namespace ispace {
namespace layer_names_test {

TEST(LayerNames, DoorsAndWindows) {
    for (const char* name :
         {"A-DOOR", "Doors", "Innentüren", "TÜREN", "PORTES", "puertas", "Deuren", "drzwi", "двери",
          "门", "A-32----E-", "Serramenti", "ovet"}) {
        EXPECT_TRUE(isDoorName(name)) << name;
        EXPECT_FALSE(isWindowName(name)) << name;
    }
    for (const char* name : {"A-GLAZ", "Windows", "FENSTER", "fenêtres", "Ventanas", "janelas",
                             "okna", "окна", "窗", "A-31----E-"}) {
        EXPECT_TRUE(isWindowName(name)) << name;
        EXPECT_FALSE(isDoorName(name)) << name;
    }
    for (const char* name : {"A-DOOR-IDEN", "door text", "Outdoor", "0", "A-WALL", "A-32----T-"})
        EXPECT_FALSE(isDoorName(name)) << name;
}

TEST(LayerNames, WallsOfManyLanguages) {
    for (const char* name :
         {"墙",        "外墙",      "承重墙体",    "牆",          "壁",      "外壁",     "벽",
          "외벽",      "СТЕНЫ",     "перегородки", "Стени",       "جدار",    "جدران",    "קירות",
          "دیوار",     "दीवार",     "ผนัง",         "tường",       "dinding", "sienas",   "sienos",
          "seinad",    "Innervägg", "ulkoseinä",   "binnenmuren", "příčky",  "cloisons", "tabiques",
          "alvenaria", "tramezzi",  "A-WALL-PRTN"})
        EXPECT_TRUE(isWallName(name)) << name;
    for (const char* name : {"墙体填充", "墙纸", "外墙标注", "벽체 해치", "门窗", "家具", "壁柜",
                             "轴网", "A-WALL-PATT"})
        EXPECT_FALSE(isWallName(name)) << name;
    for (const char* name : {"أبواب", "דלתות", "ประตู", "durvis"})
        EXPECT_TRUE(isDoorName(name)) << name;
    for (const char* name : {"建筑标注", "室内家具", "墙体填充", "墙面标注", "Wandschraffur",
                             "Mauertext", "murs_hachures", "Wandfliesen", "I-EQPM", "通り芯"}) {
        EXPECT_TRUE(isNoWallName(name)) << name;
        EXPECT_FALSE(isWallName(name)) << name;
    }
    for (const char* name : {"أثاث", "ריהוט", "เฟอร์นิเจอร์", "أبعاد", "מידות"})
        EXPECT_TRUE(isNoWallName(name)) << name;
}

TEST(LayerNames, OfStandards) {
    for (const char* name : {"A-21----E-", "A-22----E-", "AR210000E-", "I-WALL", "A-WALL-FULL"})
        EXPECT_TRUE(isWallName(name)) << name;
    for (const char* name :
         {"A-21----D-", "A-82----E-", "E-63----E-", "A-------G-", "A-24----E-", "E-LITE-EQPM",
          "P-SANR-FIXT", "M-DUCT", "A-FLOR-STRS", "A-ANNO-TTLB", "A-CLNG", "I-FURN", "S-GRID",
          "Blattrahmen", "CADRE", "Treppen", "escaleras", "楼梯"}) {
        EXPECT_TRUE(isNoWallName(name)) << name;
        EXPECT_FALSE(isWallName(name)) << name;
    }
    for (const char* name :
         {"A-28----E-", "S-COLS", "Partitions", "E-Cloison", "Structural - Bearing"})
        EXPECT_FALSE(isNoWallName(name)) << name;
}

TEST(LayerNames, OfBs1192) {
    for (const char* name : {"A210G701_WALL_L1", "A220G3", "A-Wall-G"})
        EXPECT_TRUE(isWallName(name)) << name;
    for (const char* name : {"A210D2", "A210T2", "A760G3", "A350H1", "A-Wall-D", "A-Wall-H"}) {
        EXPECT_FALSE(isWallName(name)) << name;
        EXPECT_TRUE(isNoWallName(name)) << name;
    }
    EXPECT_TRUE(isDoorName("A315G3"));
    EXPECT_TRUE(isWindowName("A314G3"));
    EXPECT_TRUE(isDoorName("A-Door-G"));
    for (const char* name : {"A101", "A210", "A1234", "L760G3"})
        EXPECT_FALSE(isNoWallName(name)) << name;
}

TEST(LayerNames, NumberedWallsAreNoCodes) {
    for (const char* const name : {"A-01-WALLS", "A-01-WALLS-EXT", "A_00_WALLS"})
        EXPECT_TRUE(isWallName(name)) << name;
    EXPECT_FALSE(isNoWallName("A-02-PARTITION"));
    EXPECT_FALSE(isWallName("A-320---E-"));
    EXPECT_TRUE(isWallName("A-210---E-"));
}

TEST(LayerNames, OfFurtherLanguages) {
    for (const char* name : {"Tường", "TUONG XAY", "दीवार"}) EXPECT_TRUE(isWallName(name)) << name;
    for (const char* name : {"Cửa đi", "CUA DI", "दरवाजा", "durvis"})
        EXPECT_TRUE(isDoorName(name)) << name;
    for (const char* name : {"Cửa sổ", "CUA SO", "खिड़की", "LOGI", "FINESTRES"}) {
        EXPECT_TRUE(isWindowName(name)) << name;
        EXPECT_FALSE(isDoorName(name)) << name;
    }
    for (const char* name :
         {"Nội thất", "Kích thước", "KICH THUOC", "फर्नीचर", "माप", "INRICHTING", "MOBLES"})
        EXPECT_TRUE(isNoWallName(name)) << name;
}

TEST(LayerNames, WallsAndDoorsOnOneLayerAreWalls) {
    for (const char* const name :
         {"Wände und Türen", "Murs et portes", "Muros y puertas", "Interior walls and doors"})
        EXPECT_FALSE(isDoorName(name)) << name;
}

TEST(LayerNames, OfBlocks) {
    for (const char* name : {"Bed-Double", "SOFA_3_SEATS", "M_Chair", "Schrank", "马桶", "A-FURN"})
        EXPECT_TRUE(isThingName(name)) << name;
    for (const char* name : {"", "*U12", "Bedroom", "Wall-table", "Block3", "Bath"})
        EXPECT_FALSE(isThingName(name)) << name;
}

}  // namespace layer_names_test
}  // namespace ispace
