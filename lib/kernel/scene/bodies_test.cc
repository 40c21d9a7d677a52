// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/bodies.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "env/body.h"
#include "env/slice.h"
#include "scene/sensor/field_of_view.h"
#include "support/test_layout.h"

namespace ispace {

using testing::scene;

namespace bodies_test {

/// Six times the volume that the triangles enclose, positive if they are seen from outside.
double sixVolumes(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [i, j, k] : mesh.triangles)
        sum += dot(mesh.vertices[i] - Point3(),
                   cross(mesh.vertices[j] - Point3(), mesh.vertices[k] - Point3()));
    return sum;
}

/// Each edge has a triangle on both sides; triangles face outwards wherever its parts are.
void expectSolid(const Mesh& mesh, const std::string& what) {
    EXPECT_FALSE(mesh.triangles.empty()) << what;
    EXPECT_TRUE(isWatertight(mesh)) << what;
    EXPECT_FALSE(mesh.open) << what;
    EXPECT_GT(sixVolumes(mesh), 0) << what;
}

struct Box3 {
    Point3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
};

Box3 boundsOf(const std::vector<Mesh>& body) {
    Box3 box;
    for (const Mesh& mesh : body)
        for (const Point3& p : mesh.vertices) {
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y),
                       std::min(box.low.z, p.z)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y),
                        std::max(box.high.z, p.z)};
        }
    return box;
}

std::vector<Mesh> bodyOfLine(const std::string& line) {
    const Scene made = scene("ispace size=8,6\n" + line + "\n");
    return bodyOf(made, made.placed.at(0));
}

TEST(BodyOf, AreClosedAndFaceOutwards) {
    for (const char* line :
         {"laser at=1,1", "ranger at=1,1", "camera at=1,1 tilt=-30",
          "ultrasound at=1,1,2.4 tilt=-90", "tag at=0,0,0.3", "mat", "mat size=2,0.5", "gate",
          "gate width=0.01 height=0.01", "robot", "robot size=0.6,0.4,0.3",
          "robot model=pioneer-2dx", "human", "human height=1.2"}) {
        const auto meshes = bodyOfLine(line);
        ASSERT_FALSE(meshes.empty()) << line;
        for (const Mesh& mesh : meshes) expectSolid(mesh, line);
    }
}

TEST(BodyOf, RobotIsWhatSensorsSeeWithANose) {
    RobotModel box;
    box.length = 0.6;
    box.width = 0.4;
    box.height = 0.3;
    const double nose = 0.05, base = 2 * nose * 0.25 * box.height;
    EXPECT_NEAR(sixVolumes(robotMesh(box)) / 6, 0.6 * 0.4 * 0.3 + base * 2 * nose / 3, 1e-12);
    expectSolid(robotMesh(box), "box");
    expectSolid(robotMesh(RobotModel()), "cylinder");
    EXPECT_EQ(robotMesh(box).material, Material::Robot);
    const Box3 extent = boundsOf(bodyOfLine("robot size=0.6,0.4,0.3 center=0.1"));
    EXPECT_NEAR(extent.low.x, -0.2, 1e-12);
    EXPECT_NEAR(extent.high.x, 0.4 + nose, 1e-12);
    EXPECT_NEAR(extent.high.z, 0.3, 1e-12);
    EXPECT_EQ(extent.low.z, 0);
}

TEST(BodyOf, EachRobotHasItsOwnModel) {
    const Scene made =
        scene("ispace size=8,6\n", "robot at=1,1 height=0.5\nlaser on=robot1\nrobot height=0.9\n");
    ASSERT_EQ(made.placed.size(), 3U);
    EXPECT_EQ(boundsOf(bodyOf(made, made.placed[0])).high.z, 0.5);
    EXPECT_EQ(boundsOf(bodyOf(made, made.placed[2])).high.z, 0.9);
}

TEST(BodyOf, SensorsShowWhereTheyFace) {
    expectSolid(noseBox(), "laser");
    EXPECT_EQ(noseBox().material, Material::Sensor);
    for (const char* line : {"ranger at=0,0", "camera at=0,0", "ultrasound at=0,0"}) {
        // The front is at the optical centre, and smaller than what lies behind.
        const auto meshes = bodyOfLine(line);
        const Box3 all = boundsOf(meshes), front = boundsOf({meshes.back()});
        EXPECT_EQ(all.high.x, 0) << line;
        EXPECT_EQ(front.high.x, 0) << line;
        EXPECT_LT(all.low.x, -0.02) << line;
        EXPECT_LT(front.high.z, all.high.z) << line;
        EXPECT_NE(meshes.front().material, meshes.back().material) << line;
    }
    const Box3 ball = boundsOf(bodyOfLine("tag at=0,0"));
    EXPECT_DOUBLE_EQ(ball.high.z, 0.025);
    EXPECT_DOUBLE_EQ(ball.low.z, -0.025);
}

TEST(BodyOf, MatAndGateHaveTheirMeasures) {
    const Box3 mat = boundsOf(bodyOfLine("mat size=2,0.5"));
    EXPECT_EQ(mat.low, (Point3{-1, -0.25, 0}));
    EXPECT_EQ(mat.high.onFloor(), (Point2{1, 0.25}));
    EXPECT_LT(mat.high.z, 0.02);
    const auto gate = bodyOfLine("gate width=1.5 height=0.4");
    for (const Mesh& mesh : gate)
        for (const Point3& p : mesh.vertices) {
            EXPECT_GE(std::abs(p.y), 0.75) << "free between the posts";
            EXPECT_LE(std::abs(p.y), 0.85);
            EXPECT_GE(p.z, 0);
        }
    const Box3 heads = boundsOf({gate.back()});
    EXPECT_NEAR((heads.low.z + heads.high.z) / 2, 0.4, 1e-12);
}

TEST(BodyOf, HumanIsAsHighAsWritten) {
    for (const double height : {0.5, 1.2, 1.7, 2.1}) {
        const Box3 box = boundsOf(humanBodyOf(height));
        EXPECT_EQ(box.low.z, 0);
        EXPECT_NEAR(box.high.z, height, 1e-12);
        EXPECT_NEAR(box.high.y, humanRadius(height), 1e-12);
        EXPECT_NEAR(box.low.y, -humanRadius(height), 1e-12);
        EXPECT_LT(box.high.x, humanRadius(height));
        for (const Mesh& mesh : humanBodyOf(height)) expectSolid(mesh, "human");
    }
    EXPECT_EQ(boundsOf(bodyOfLine("human height=1.2")).high.z, boundsOf(humanBodyOf(1.2)).high.z);
    EXPECT_NEAR(2 * humanRadius(1.7), 0.51, 1e-9);
}

TEST(BodyOf, LegsAreTwoCirclesAtScanningHeight) {
    Body body;
    body.meshes = humanBodyOf(1.7);
    Slice slice;
    cutMeshes(body, kScanHeight, slice);
    ASSERT_EQ(slice.solids.size(), 2U);
    EXPECT_TRUE(slice.sheets.empty());
    // Right and left, apart from each other.
    EXPECT_LT(bounds(slice.solids[0]).high.y * bounds(slice.solids[1]).high.y, 0);
    for (const Polygon& solid : slice.solids)
        EXPECT_NEAR(signedArea(solid), std::numbers::pi * 0.0595 * 0.0595, 2e-5);
}

TEST(HumanParts, LimbsSwingAboutTheirJointsAndFeetStayOnTheFloor) {
    const double ahead = std::tan(Angle::degrees(15).radians());
    const std::vector<BodyPart> still = humanParts(1.7);
    const std::vector<BodyPart> parts = humanParts(1.7, Angle::degrees(15));
    ASSERT_EQ(parts.size(), still.size());
    int slanted = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const BodyPart& part = parts[i];
        EXPECT_EQ(part.bottom, still[i].bottom);
        EXPECT_EQ(part.top, still[i].top);
        EXPECT_EQ(part.center.y, still[i].center.y);
        if (part.lean == 0) continue;
        ++slanted;
        const bool is_leg = part.bottom == 0;
        EXPECT_NEAR(part.lean, (part.center.y > 0) == is_leg ? -ahead : ahead, 1e-12);
        // Sleeve and hand are one straight arm that hangs from the shoulder.
        const double joint = (is_leg ? 0.48 : 0.87) * 1.7;
        const double up = joint - (part.bottom + part.top) / 2;
        EXPECT_NEAR(part.center.x + part.lean * up, 0, 1e-12);
    }
    EXPECT_EQ(slanted, 6);
}

TEST(BodyOf, NothingForWhatHasNone) {
    const Scene made = scene("ispace size=8,6\n");
    PlacedRecord wrong;
    EXPECT_TRUE(bodyOf(made, wrong).empty());
}

TEST(PersonFigure, KeepsPartsAndAddsOthers) {
    const Angle swing = Angle::degrees(10);
    PersonFigure figure;
    figure.kept.set(0).set(6);
    figure.fixed.push_back({.center = {0.5, 0},
                            .radius = 0.1,
                            .bottom = 1.8,
                            .top = 2,
                            .is_ball = true,
                            .material = Material::Skin});
    const std::vector<BodyPart> parts = personParts(1.7, &figure, swing);
    const std::vector<BodyPart> usual = humanParts(1.7, swing);
    ASSERT_EQ(usual.size(), kHumanParts);
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_EQ(parts[0].center, usual[0].center);
    EXPECT_EQ(parts[0].lean, usual[0].lean);
    EXPECT_EQ(parts[1].half_width, usual[6].half_width);
    EXPECT_EQ(personParts(1.7, nullptr, swing).size(), kHumanParts);
    // A ball has a mesh although no box or cylinder is of its material.
    const std::vector<Mesh> meshes = humanBodyOf(parts);
    ASSERT_EQ(meshes.size(), 2U);
    EXPECT_NEAR(boundsOf(meshes).high.z, 2, 1e-9);
    EXPECT_EQ(figure.carried({0.1, 0.2, 1.3}), (Point3{0.1, 0.2, 1.3}));
    figure.from.z = -2;
    EXPECT_EQ(figure.carried({0.1, 0.2, 1.3}), (Point3{0.1, 0.2, 0}));
}

}  // namespace bodies_test
}  // namespace ispace
