// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "coverage/target.h"
#include "env/element_schemas.h"
#include "record/text.h"

namespace ispace {
namespace target_test {

Environment yard() {
    static const Schemas kSchemas(environmentSchemas());
    const Document document = readRecordText(
        "#env 1\nfence path=-4,-3;4,-3;4,1;0,1;0,3;-4,3 closed=yes\ninside at=-1,0\n", "room.env",
        kSchemas);
    return {document.records, assignIds(document.records)};
}

TEST(CellWeights, IsOneIndoorsByDefault) {
    const Target target = makeTarget(yard(), CellCount{16, 12}, kScanHeight);
    EXPECT_TRUE(FloorWeights().isUniform());
    const auto weights = weightsOfCells(target, {});
    ASSERT_EQ(weights.size(), target.grid.size());
    for (std::size_t cell = 0; cell < weights.size(); ++cell)
        EXPECT_EQ(weights[cell], target.indoor.test(cell) ? 1 : 0);
}

TEST(CellWeights, GoesByTargetsAndTheLastWeight) {
    const Environment environment = yard();
    const auto zone = [&environment](const char* text) { return readZone(text, environment); };
    const Target target = makeTarget(environment, CellCount{37, 29}, kScanHeight);
    FloorWeights floor;
    floor.targets = {zone("rect:-3,-2,1,2"), zone("poly:0,-3;4,-3;4,3")};
    floor.weights = {{zone("rect:-3,-2,0,0"), 2.5},
                     {zone("rect:-1,-1,3,0.5"), 0},
                     {zone("rect:-0.5,-3,0.5,3"), 4}};
    EXPECT_FALSE(floor.isUniform());
    const auto weights = weightsOfCells(target, floor);
    const auto holds = [](const NamedZone& one, Point2 p) {
        return locate(one.outline, p) == Side::Inside;
    };
    for (std::size_t cell = 0; cell < weights.size(); ++cell) {
        const Point2 p = target.grid.center(cell);
        double wanted = holds(floor.targets[0], p) || holds(floor.targets[1], p) ? 1 : 0;
        if (environment.indoor().locate(p) != Side::Inside) wanted = 0;
        for (const auto& [one, weight] : floor.weights)
            if (wanted != 0 || weight == 0) wanted = holds(one, p) ? weight : wanted;
        // A weight of 0 hides cells that a later one raises again.
        if (holds(floor.weights[2].first, p) && environment.indoor().locate(p) == Side::Inside)
            wanted = holds(floor.targets[0], p) || holds(floor.targets[1], p) ? 4 : 0;
        EXPECT_EQ(weights[cell], wanted) << p.x << ' ' << p.y;
    }
}

TEST(CellWeights, OfCentresOnAnEdgeIsNotChanged) {
    const Environment environment = yard();
    const Target target =
        makeTarget(environment, CellCount{8, 6}, kScanHeight);  // centres at halves
    FloorWeights floor;
    floor.weights = {{readZone("rect:-3.5,-2.5,-1.5,-0.5", environment), 7}};
    const auto weights = weightsOfCells(target, floor);
    EXPECT_EQ(weights[target.grid.cell(0, 0)], 1);
    EXPECT_EQ(weights[target.grid.cell(1, 1)], 7);
    EXPECT_EQ(weights[target.grid.cell(2, 1)], 1);
}

TEST(CellWeights, OfATargetOutsideIsNothing) {
    const Environment environment = yard();
    const Target target = makeTarget(environment, CellCount{10, 10}, kScanHeight);
    FloorWeights floor;
    floor.targets = {readZone("rect:10,10,12,12", environment)};
    for (const double one : weightsOfCells(target, floor)) EXPECT_EQ(one, 0);
}

}  // namespace target_test
}  // namespace ispace
