// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/model.h"

#include <gtest/gtest.h>

#include "layout/schemas.h"
#include "record/text.h"

namespace ispace {
namespace {

Scene sceneOf(const std::string& text) {
    return makeScene(readRecordText("#env 1\n" + text, "room.env", sceneSchemas()), nullptr,
                     DeviceCatalogue());
}

std::vector<std::string> idsOf(const std::vector<ModelNode>& nodes) {
    std::vector<std::string> ids;
    for (const ModelNode& node : nodes) ids.push_back(node.id);
    return ids;
}

TEST(Model, ElementsThenFloorThenWhatIsPlaced) {
    const Scene scene = sceneOf(
        "laser id=l1 at=1,0\nispace id=room size=8,6\ninside at=1,1\n"
        "zone id=z at=2,1 size=2,2\ndesk at=2,1\nrobot id=r1 at=0,1\ntable at=-2,-1\n");
    const std::vector<ModelNode> nodes = modelOf(scene);
    EXPECT_EQ(idsOf(nodes),
              (std::vector<std::string>{"room", "desk1", "table1", "floor", "l1", "r1"}));
    EXPECT_EQ(nodes[1].keyword, "desk");
    EXPECT_EQ(nodes[3].keyword, "");
    for (const ModelNode& node : nodes) {
        const bool is_element = node.id != "floor" && node.id != "l1" && node.id != "r1";
        EXPECT_EQ(node.element != nullptr, is_element) << node.id;
        EXPECT_EQ(node.pose.has_value(), node.id == "l1" || node.id == "r1") << node.id;
        ASSERT_FALSE(node.meshes.empty());
        for (const Mesh& mesh : node.meshes) EXPECT_FALSE(mesh.triangles.empty()) << node.id;
    }
    EXPECT_EQ(nodes[0].element->id, "room");
}

TEST(Model, PlacedThingsStandInFramesOfTheirOwn) {
    const Scene scene =
        sceneOf("ispace size=8,6\nlaser at=1,2,0.5 heading=90 tilt=-10\nrobot at=2,1 heading=45\n");
    const std::vector<ModelNode> nodes = modelOf(scene);
    ASSERT_EQ(nodes.size(), 4U);
    const ModelNode& laser = nodes[2];
    EXPECT_EQ(laser.pose->position, (Point3{1, 2, 0.5}));
    EXPECT_EQ(laser.pose->heading, Angle::degrees(90));
    EXPECT_EQ(laser.pose->tilt, Angle::degrees(-10));
    EXPECT_EQ(laser.meshes[0].material, Material::Sensor);
    const ModelNode& robot = nodes[3];
    EXPECT_EQ(robot.pose->position, (Point3{2, 1, 0}));
    EXPECT_EQ(robot.pose->heading, Angle::degrees(45));
    EXPECT_EQ(robot.meshes[0].material, Material::Robot);
    for (const Point3& p : robot.meshes[0].vertices) EXPECT_LT(length(p.onFloor() - Point2()), 1);
}

}  // namespace
}  // namespace ispace
