// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/material.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "support/test_layout.h"
#include "support/test_scenes.h"

namespace ispace::pages {
namespace material_test {

using testing::findings;

const std::string kRoom =
    "ispace size=8,6,2.5\npanel id=p1 at=-3.9,0 cost=2\n"
    "camera id=down at=0,0,2.4 tilt=-90 cost=80\ncamera id=wall at=-3.9,2,2.2 tilt=-20 cost=90\n"
    "laser id=l at=1,1\nrobot id=r at=2,2\nlaser id=rider on=r\n";

/// In the corner of a wall and the ceiling a camera hangs from the nearer one.
TEST(Material, TheNearerSurfaceHoldsACamera) {
    const auto mounts_of = [](const std::string& at) {
        const Scene scene = sceneOf("ispace size=8,6,3.1\ncamera at=" + at + " tilt=-45\n");
        return materialOf(scene, {}, {}).at(1).item;
    };
    EXPECT_EQ(mounts_of("-3.8,0,3.05"), "ceiling mount");
    EXPECT_EQ(mounts_of("-3.95,0,2.9"), "wall mount");
    EXPECT_EQ(mounts_of("-3.95,0,2.4"), "wall mount");
    EXPECT_EQ(mounts_of("0,0,3.05"), "ceiling mount");
    EXPECT_EQ(mounts_of("0,0,2.4"), "stand");
}

TEST(Material, CountsDevicesMountsAndCables) {
    const Scene scene = sceneOf(kRoom);
    const auto items = materialOf(scene, cablesOf(scene), {});
    std::string names;
    for (const MaterialItem& item : items) names += item.item + ';';
    EXPECT_EQ(names, "camera;laser;ceiling mount;stand;wall mount;cable;");
    EXPECT_EQ(items[0].number, 2);
    EXPECT_EQ(items[0].price, std::nullopt);  // 80 and 90
    EXPECT_EQ(items[0].cost, 170);
    EXPECT_EQ(items[1].number, 2);  // with the one that rides, which needs no mount
    EXPECT_EQ(items[1].cost, std::nullopt);
    EXPECT_EQ(items[3].number, 1);
    EXPECT_TRUE(items[5].is_length);
    EXPECT_NEAR(items[5].price.value(), 2, 1e-9);
    const PageTable table = materialTable(items);
    EXPECT_EQ(table.caption, "without the 4 items of which no price is known");
    EXPECT_EQ(table.rows.front(), (TextRow{"camera", "2", "-", "170"}));
}

TEST(Material, PricesOfAListCountBeforeThoseOfRecords) {
    const Scene scene = sceneOf(kRoom);
    const PriceList prices = readPrices(
        "item;price;seller\nCamera;100;x\n\"wall mount\";12.5\nceiling mount;9\r\nstand;0\n"
        "cable;0.5\nlaser;300\nspare part;7\n",
        "p.csv");
    EXPECT_EQ(prices.of("camera"), 100);
    const auto items = materialOf(scene, {{2, "p1", 4, 8}}, prices);
    EXPECT_EQ(materialCsv(items),
              "item,number,unit,price,cost\ncamera,2,piece,100,200\nlaser,2,piece,300,600\n"
              "ceiling mount,1,piece,9,9\nstand,1,piece,0,0\nwall mount,1,piece,12.5,12.5\n"
              "cable,4.00,m,0.5,2\n");
    const PageTable table = materialTable(items);
    EXPECT_EQ(table.caption, "");
    EXPECT_EQ(table.rows.back(), (TextRow{"together", "", "", "823.5"}));
}

TEST(Material, TellsOfPricesThatNoItemHas) {
    const auto items = materialOf(sceneOf(kRoom), {}, {});
    EXPECT_EQ(unusedPrices(readPrices("camera,1\nlaser,2\nstand,3\ncable,1\n", ""), items), "");
    EXPECT_EQ(unusedPrices(readPrices("camera,1\ncamrea,9\n", ""), items),
              "the material has no camrea, which has a price; its items: camera, laser, ceiling "
              "mount, stand, wall mount");
    const std::string many = unusedPrices(readPrices("a,1\nb,1\nc,1\nd,1\ne,1\nf,1\n", ""), items);
    EXPECT_TRUE(
        many.starts_with("the material has no a, b, c, d, e and 1 more, which have prices"));
}

TEST(Material, CountsSeveralRooms) {
    const Scene scene = sceneOf(kRoom);
    const CabledRoom rooms[] = {{scene, {}}, {scene, {}}};
    const auto items = materialOf(rooms, {});
    EXPECT_EQ(items[0].number, 4);
    EXPECT_EQ(items[0].cost, 340);
}

TEST(Material, HasNoPricesWithoutAny) {
    const Scene scene = sceneOf("ispace size=4,4\nlaser id=l at=1,1\n");
    const PageTable table = materialTable(materialOf(scene, {}, {}));
    EXPECT_EQ(table.heads, (TextRow{"item", "number"}));
    EXPECT_EQ(table.rows.size(), 2U);
}

TEST(Material, BadPricesAreFindings) {
    EXPECT_EQ(findings([] { static_cast<void>(readPrices("a,1\nb,x\n,3\nc,-1\nd\n", "p.csv")); }),
              "p.csv:2:1: error: `b,x` is no ITEM,PRICE, as in dome-2.8-4k,129.90\n"
              "p.csv:3:1: error: `,3` is no ITEM,PRICE, as in dome-2.8-4k,129.90\n"
              "p.csv:4:1: error: `c,-1` is no ITEM,PRICE, as in dome-2.8-4k,129.90\n"
              "p.csv:5:1: error: `d` is no ITEM,PRICE, as in dome-2.8-4k,129.90\n");
    EXPECT_TRUE(readPrices("# none\n\n", "p.csv").prices.empty());
    // Never a part of a number.
    for (const char* line : {"a,\"1,299.00\"\n", "a,7,50\n", "a;1.299,00\n", "a,1e308\n"})
        EXPECT_NE(findings([&] { static_cast<void>(readPrices(line, "p.csv")); }), "") << line;
    EXPECT_EQ(readPrices("a;129,90\n", "p.csv").of("a"), 129.9);
    EXPECT_EQ(readPrices("\"a, \"\"b\"\"\",5\n", "p.csv").of("a, \"b\""), 5);
    EXPECT_EQ(readPrices("item,number,price\na,3,7\n", "p.csv").of("a"), 7);
    EXPECT_EQ(readPrices("item,number,Price EUR\na,3,7\n", "p.csv").of("a"), 7);
}

TEST(Material, TheHeadOfPricesNamesTheCurrency) {
    const auto currency = [](const std::string& head) {
        return readPrices(head + "\na,7\n", "p.csv").currency;
    };
    EXPECT_EQ(currency("item,price"), "");
    EXPECT_EQ(currency("item,price per piece"), "");
    EXPECT_EQ(currency("item,price EUR"), "EUR");
    EXPECT_EQ(currency("ARTIKEL,Preis in CHF"), "CHF");
    EXPECT_EQ(currency("item,price (€)"), "€");
    EXPECT_EQ(currency("a,7"), "");
    const std::vector<MaterialItem> items = {{"camera", 2, false, 80, 160}};
    EXPECT_EQ(materialTable(items, "EUR").heads,
              (TextRow{"item", "number", "price of one, EUR", "cost, EUR"}));
    EXPECT_EQ(materialCsv(items, "€"),
              "item,number,unit,price,cost,currency\ncamera,2,piece,80,160,€\n");
}

}  // namespace material_test
}  // namespace ispace::pages
