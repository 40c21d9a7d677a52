// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extensions.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "base/error.h"
#include "cli/building_runs.h"

namespace ispace {
namespace extensions_test {

std::vector<Diagnostic> found(const SiteScene& /*building*/) { return {}; }
std::unique_ptr<BuildingWorlds> opened(const SiteScene& /*building*/,
                                       const BuildingRunOptions& /*options*/) {
    return nullptr;
}

TEST(Extensions, NameTheOneThatRunsBuildings) {
    const std::array built = {Extension{.name = "walls"},
                              Extension{.name = "lifts", .buildings = {opened, found}}};
    const Extensions all(built, {});
    EXPECT_EQ(all.buildings().open, &opened);
    EXPECT_EQ(all.buildings().findings, &found);
    EXPECT_EQ(all.buildings().extension, "lifts");
}

TEST(Extensions, NameTheOneThatWouldRunBuildings) {
    const std::array missing = {MissingOffer{"lifts", "run", "building"}};
    const Extensions none({}, missing);
    EXPECT_EQ(none.buildings().open, nullptr);
    EXPECT_EQ(none.buildings().findings, nullptr);
    EXPECT_EQ(none.buildings().extension, "lifts");
}

}  // namespace extensions_test
}  // namespace ispace
