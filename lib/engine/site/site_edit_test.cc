// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/site_edit.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "record/text.h"
#include "site/site_scene.h"

namespace ispace {
namespace site_edit_test {

/// Three storeys of one room: a fence, two desks and a laser on one of them, without ids.
StoreyedDocument tower() {
    return readBuilding(
        "- storey: {id: a, records: &room ["
        "{fence: {path: [[0, 0], [8, 0], [8, 6], [0, 6]], closed: yes}}, {desk: {at: [2, 2]}}, "
        "{desk: {at: [5, 2]}}, {laser: {on: desk2}}]}\n"
        "- storey: {id: b, z: 3, records: *room}\n"
        "- storey: {id: c, z: 6, records: *room}\n"
        "- lift: {id: l, storeys: 'a,b,c', at: [1, 5], size: [1.2, 1.2], speed: 1}\n",
        "tower.yaml", {});
}

std::vector<Edit> edits(const std::vector<std::pair<Edit::Kind, std::string>>& texts) {
    std::vector<Edit> all;
    all.reserve(texts.size());
    for (const auto& [kind, text] : texts) all.push_back(parseEdit(kind, text));
    return all;
}

std::string recordsOf(const StoreyedDocument& building, std::size_t storey) {
    std::string text;
    for (const Record& record : building.storeys[storey].room->records)
        text += formatRecord(record) + '\n';
    return text;
}

const std::string kFence = "fence path=0,0;8,0;8,6;0,6 closed=yes\n";

TEST(BuildingEdit, ChangesOneOfTheStoreysThatShareARoom) {
    StoreyedDocument building = tower();
    const std::string was = recordsOf(building, 0);
    editSite(building, edits({{Edit::Kind::Move, "b/desk2:1,0"}}));
    EXPECT_EQ(building.storeys[0].room, building.storeys[2].room);
    EXPECT_EQ(recordsOf(building, 0), was);
    EXPECT_EQ(recordsOf(building, 1), kFence + "desk at=2,2\ndesk at=6,2\nlaser on=desk2\n");
}

TEST(BuildingEdit, WritesTheAutomaticIdsThatShift) {
    StoreyedDocument building = tower();
    editSite(building, edits({{Edit::Kind::Delete, "b/desk1"}}));
    EXPECT_EQ(recordsOf(building, 1), kFence + "desk id=desk2 at=5,2\nlaser on=desk2\n");
    EXPECT_EQ(building.storeys[0].room, building.storeys[2].room);
}

TEST(BuildingEdit, GlobsReachAllStoreysAndPassages) {
    StoreyedDocument building = tower();
    editSite(building, edits({{Edit::Kind::Rotate, "*/desk1:90"},
                              {Edit::Kind::Set, "l.speed=2"},
                              {Edit::Kind::Add, "laser id=c/l2 at=1,1"}}));
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NE(recordsOf(building, i).find("desk at=2,2 heading=90\n"), std::string::npos) << i;
    EXPECT_NE(recordsOf(building, 2).find("\nlaser id=l2 at=1,1\n"), std::string::npos);
    ASSERT_EQ(building.passages.size(), 1U);
    EXPECT_EQ(building.passages[0].record.number("speed"), 2);
    EXPECT_EQ(building.passages[0].storeys.size(), 3U);
}

TEST(BuildingEdit, RefusesWhatHasNoStorey) {
    StoreyedDocument building = tower();
    const auto refused = [&](Edit::Kind kind, const std::string& text) {
        EXPECT_THROW(editSite(building, edits({{kind, text}})), FormatError) << text;
    };
    refused(Edit::Kind::Delete, "desk1");
    refused(Edit::Kind::Delete, "d/desk1");
    refused(Edit::Kind::Delete, "a/desk2");  // carries a laser
    refused(Edit::Kind::Add, "laser at=1,1");
    refused(Edit::Kind::Set, "a/desk1.id=b/desk1");
    refused(Edit::Kind::Set, "a/desk1.id=desk");
    EXPECT_EQ(building.storeys[0].room, building.storeys[1].room);
}

}  // namespace site_edit_test
}  // namespace ispace
