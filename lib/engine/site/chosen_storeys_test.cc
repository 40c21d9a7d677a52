// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/chosen_storeys.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/placement_schemas.h"

namespace ispace {
namespace chosen_storeys_test {

/// Three storeys, stairs between the lower two, and a lift through all.
StoreyedDocument tower() {
    const std::string room = ", records: [{ispace: {size: 8 x 6}}]}\n";
    return readBuilding("- storey: {id: low, name: Hall, height: 3" + room +
                            "- storey: {id: mid, z: 3, height: 3" + room +
                            "- storey: {id: top, z: 6, height: 3" + room +
                            "- stairs: {id: s, storeys: 'low,mid', at: [0, 0], size: [1, 3]}\n"
                            "- lift: {id: l, storeys: 'low,mid,top', at: [3, 2], size: [1, 1]}\n",
                        "tower.yaml", {});
}

StoreyedDocument chosen(std::vector<std::string> words) {
    return chosenStoreys(tower(), {std::move(words)}, "tower.yaml");
}

TEST(ChosenStoreys, KeepHeightsAndWhatJoinsThem) {
    const StoreyedDocument outer = chosen({"top", "hall"});
    EXPECT_EQ(outer.storeyList(), "low, top") << "by a name in any case, lowest first";
    EXPECT_EQ(outer.storeys[1].floor, 6);
    ASSERT_EQ(outer.passages.size(), 1U) << "the stairs lead to no storey that is left";
    EXPECT_EQ(outer.passages[0].id, "l");
    EXPECT_EQ(outer.passages[0].record.text("storeys"), "low,top");
    EXPECT_EQ(chosen({"low", "m*"}).passages.size(), 2U);
    EXPECT_EQ(chosen({"ALL"}).digest(), tower().digest());
    EXPECT_THROW(chosen({"low", ""}), UsageError);
    EXPECT_THROW(chosen({"cellar*"}), UsageError);
}

TEST(ChosenStoreys, AWordWithoutAPatternIsARoom) {
    EXPECT_TRUE(StoreyChoice{{"low"}}.isOne());
    for (const char* const word : {"l*", "all", "All", ""})
        EXPECT_FALSE(StoreyChoice{{word}}.isOne()) << word;
    EXPECT_FALSE((StoreyChoice{{"low", "mid"}}.isOne()));
}

TEST(ChosenStoreys, TakeTheirPartOfALayout) {
    const StoreyedDocument whole = tower(), part = chosen({"low", "mid"});
    const std::string text = "#3dm 1\nenvironment file=tower.yaml digest=" + whole.digest() +
                             "\nlaser id=low/a at=1,1\nlaser id=top/b at=1,1\n";
    const Document layout = parseDocument(text, "l.3dm", {}, sceneSchemas());
    std::vector<Diagnostic> told;
    const Document own = layoutOfStoreys(layout, whole, part, told);
    ASSERT_EQ(own.records.size(), 2U);
    EXPECT_EQ(own.records[0].text("digest"), part.digest());
    EXPECT_EQ(own.records[1].writtenId(), "low/a");
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].message, "1 record of another storey is left out of the layout");
    told.clear();
    EXPECT_EQ(layoutOfStoreys(layout, whole, whole, told).records, layout.records);
    EXPECT_TRUE(told.empty());
}

}  // namespace chosen_storeys_test
}  // namespace ispace
