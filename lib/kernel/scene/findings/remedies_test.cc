// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/findings/remedies.h"

#include <gtest/gtest.h>

#include "support/test_scenes.h"

namespace ispace {
namespace remedies_test {

std::vector<Remedy> remediesIn(const Scene& scene, std::size_t most = 10) {
    return remediesOf(scene, checkScene(scene), {}, most, DeviceCatalogue());
}

/// Applies each remedy alone, and expects the number of findings that it tells.
void expectApplied(const Scene& scene, const std::vector<Remedy>& remedies) {
    const std::size_t all = checkScene(scene).size();
    for (const Remedy& remedy : remedies) {
        const Scene after =
            makeScene(edited(scene.records, std::span(&remedy.edit, 1), sceneSchemas()), scene,
                      DeviceCatalogue());
        EXPECT_EQ(checkScene(after).size(), all - remedy.resolved) << remedy.text;
        EXPECT_GT(remedy.resolved, 0U) << remedy.text;
    }
}

TEST(Remedies, MoveRecordsIntoTheRoomAndApart) {
    const Scene scene = sceneOf(
        "#env 1\n"
        "ispace id=room at=4,3 size=8,6\n"
        "cube id=a at=2,2 size=1\n"
        "cube id=b at=2.9,2 size=1\n"
        "laser id=out at=39,3\n"
        "laser id=low at=6,5,-0.1\n"
        "laser id=spare\n"
        "robot id=r at=6,2\n"
        "human id=h at=6.2,2\n");
    const std::vector<Remedy> remedies = remediesIn(scene);
    expectApplied(scene, remedies);
    std::vector<std::string> texts;
    for (const Remedy& remedy : remedies) texts.push_back(remedy.text);
    ASSERT_EQ(remedies.size(), 4U);
    EXPECT_EQ(texts[0], "move a by (-0.10, 0.00) m");
    EXPECT_EQ(texts[1], "move out by (-31.05, 0.00) m");
    EXPECT_EQ(texts[2], "move low by (0.00, 0.00, 0.10) m");
    EXPECT_EQ(remediesIn(scene, 1).size(), 1U);
}

TEST(Remedies, LeaveRoomForPaths) {
    const Scene scene = sceneOf("#env 1\nispace at=4,3 size=8,6\nhuman id=h at=6,3 path=6,3;9,3\n");
    const std::vector<Finding> findings = checkScene(scene);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(remediesIn(scene).front().text, "move h by (-1.00, 0.00) m") << "onto the wall";
    // As by checkCourses(): a point needs half a metre.
    const auto paths = [](const Scene& one) -> std::size_t {
        const double x = one.people.front().course.path.back().x;
        return x > 7.5 && x <= 8 ? 1 : 0;
    };
    const auto remedies = remediesOf(scene, findings, {}, 1, DeviceCatalogue(), paths);
    ASSERT_EQ(remedies.size(), 1U);
    EXPECT_EQ(remedies.front().text, "move h by (-2.00, 0.00) m");
    EXPECT_EQ(remedies.front().resolved, 1U);
}

TEST(Remedies, AreNoneWhereAllIsWellOrNoMoveHelps) {
    EXPECT_TRUE(remediesIn(sceneOf("#env 1\nispace size=8,6\nlaser id=l at=1,1\n")).empty());
    // Walls have no position of their own, and no mounted sensor moves without its carrier.
    EXPECT_TRUE(remediesIn(sceneOf("#env 1\nispace id=room at=0,0 size=8,6\n"
                                   "wall id=a from=-2,0 to=2,0\nwall id=b from=0,-2 to=0,2\n"
                                   "laser id=spare\n"))
                    .empty());
    // A cube as large as the room shares space with its walls wherever it stands.
    const Scene full = sceneOf("#env 1\nispace size=2,2\ncube id=c at=0,0 size=2.5\n");
    EXPECT_FALSE(checkScene(full).empty());
    EXPECT_TRUE(remediesIn(full).empty());
}

}  // namespace remedies_test
}  // namespace ispace
