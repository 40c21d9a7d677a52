// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "building/building_scene.h"
#include "building/storeys.h"

namespace ispace {
namespace {

/// Returns the number of findings of two storeys around a courtyard, with a shaft.
std::size_t findingsAtCourtyard(const std::string& path) {
    const std::string room =
        "records: [{fence: {path: [[0, 0], [8, 0], [8, 8], [0, 8]], closed: yes}}, {fence: {path: "
        "[[2, 2], [6, 2], [6, 6], [2, 6]], closed: yes}}, {inside: {at: [1, 1]}}]}\n";
    const std::string building = "- storey: {id: a, " + room + "- storey: {id: b, z: 3, " + room +
                                 "- shaft: {storeys: 'a,b', path: " + path + "}\n";
    return checkBuilding(makeBuildingScene(readBuilding(building, "house.yaml", {}), {}, {}))
        .size();
}

TEST(BuildingCheck, FindsShaftsInCourtyards) {
    EXPECT_EQ(findingsAtCourtyard("[[3, 3], [5, 3], [5, 5], [3, 5]]"), 2U) << "of both storeys";
    EXPECT_EQ(findingsAtCourtyard("[[3, 3], [3, 5], [5, 5], [5, 3]]"), 2U) << "clockwise";
    EXPECT_EQ(findingsAtCourtyard("[[3, 3], [7, 3], [7, 5], [3, 5]]"), 0U) << "in part";
    EXPECT_EQ(findingsAtCourtyard("[[1, 1], [7, 1], [7, 7], [1, 7]]"), 0U) << "around it";
}

}  // namespace
}  // namespace ispace
