// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/element_schemas.h"

#include <gtest/gtest.h>

#include <set>

#include "support/test_scene.h"

namespace ispace {
namespace schemas_test {

using testing::findings;
using testing::record;

TEST(EnvironmentSchemas, HasTheKeywordsOfTheHeader) {
    std::set<std::string> keywords;
    for (const Schema& schema : environmentSchemas()) {
        EXPECT_TRUE(keywords.insert(schema.keyword).second) << schema.keyword;
        EXPECT_TRUE(schema.isEnvironment());
        EXPECT_FALSE(schema.help.empty());
    }
    EXPECT_EQ(keywords,
              (std::set<std::string>{
                  "ispace", "inside",  "zone",    "door",   "window",   "infra",  "boxes",
                  "screen", "mesh",    "floor",   "wall",   "fence",    "pillar", "table",
                  "desk",   "chair",   "barrier", "cube",   "cylinder", "lamp",   "projector",
                  "switch", "speaker", "panel",   "heater", "weather"}));
}

TEST(EnvironmentSchemas, KeysAreWhole) {
    for (const Schema& schema : environmentSchemas()) {
        ASSERT_FALSE(schema.keys.empty());
        EXPECT_EQ(schema.keys.front().name, "id") << schema.keyword;
        std::set<std::string> names;
        for (const KeySpec& key : schema.keys) {
            EXPECT_TRUE(names.insert(key.name).second) << schema.keyword << ' ' << key.name;
            EXPECT_FALSE(key.help.empty()) << schema.keyword << ' ' << key.name;
            if (!key.default_value) continue;
            EXPECT_NO_THROW(checkValue(key, *key.default_value))
                << schema.keyword << ' ' << key.name;
        }
    }
}

TEST(EnvironmentSchemas, DefaultsAreThoseOfTheManual) {
    EXPECT_EQ(record("desk").tuple("at"), (Tuple{0, 0}));
    EXPECT_EQ(record("desk").tuple("size"), (Tuple{1.2, 0.8}));
    EXPECT_EQ(record("desk").text("kind"), "legs");
    EXPECT_EQ(record("table").number("height"), 0.7);
    EXPECT_EQ(record("pillar").number("height"), 2.5);
    EXPECT_EQ(record("chair").number("height"), 0.85);
    EXPECT_EQ(record("barrier").number("height"), 1);
    EXPECT_EQ(record("cylinder").number("height"), 0.5);
    EXPECT_EQ(record("wall from=0,0 to=1,0").number("thickness"), 0);
    EXPECT_EQ(record("wall from=0,0 to=1,0").number("height"), kWallHeight);
    EXPECT_EQ(record("floor").number("friction"), 0);
    EXPECT_FALSE(record("ispace").flag("ceiling"));
    EXPECT_FALSE(record("fence path=0,0;1,0").flag("closed"));
    EXPECT_EQ(record("infra").number("height"), 2.4);
    EXPECT_EQ(record("infra").number("rows"), 3);
    EXPECT_EQ(record("infra").tuple("size"), (Tuple{4, 4}));
    EXPECT_EQ(record("boxes").number("count"), 3);
    EXPECT_EQ(record("screen").number("height"), 2);
    EXPECT_EQ(record("mesh file=a.obj").text("unit"), "m");
    EXPECT_EQ(record("mesh file=a.obj").text("up"), "auto");
    EXPECT_EQ(record("mesh file=a.obj").number("scale"), 1);
    EXPECT_EQ(record("cube").find("height"), nullptr);
}

TEST(EnvironmentSchemas, RefusesWhatIsOutOfBounds) {
    const std::string room = "ispace\n";
    for (const char* line : {"desk size=0,0.8",
                             "desk size=1.2,-0.8",
                             "desk size=1.2",
                             "cube size=0",
                             "cylinder size=0",
                             "pillar height=0",
                             "table size=1,1,0",
                             "floor friction=1.1",
                             "floor friction=-0.1",
                             "wall size=4,-0.1",
                             "wall from=0,0 to=1,0 thickness=-1",
                             "desk at=1e7,0",
                             "desk at=1",
                             "desk at=1,2,3,4",
                             "inside",
                             "inside at=0,0,0",
                             "floor kind=brick",
                             "wall from=0,0 to=1e7,0",
                             "fence path=0,0,0;1,1,1",
                             "desk heading=nan",
                             "zone size=1",
                             "infra rows=0",
                             "infra cols=1.5",
                             "infra rows=1001",
                             "infra size=4",
                             "infra at=0,0,2",
                             "boxes count=0",
                             "boxes count=101",
                             "boxes count=2.5",
                             "screen size=0,1",
                             "mesh",
                             "mesh file=a.obj unit=mile",
                             "mesh file=a.obj up=-y",
                             "mesh file=a.obj scale=0"})
        EXPECT_NE(findings(room + line + "\n"), "") << line;
    for (const char* line :
         {"wall from=-1,0 to=1,0 thickness=0", "wall size=4,0", "wall at=0,0,1 size=4,0.1,2",
          "floor friction=1 kind=checker", "cube size=10cm", "infra rows=1 cols=1000",
          "boxes count=100", "screen height=3", "desk heading=-30deg",
          "zone id=z path=0,0;1,0;0,1"})
        EXPECT_EQ(findings(room + line + "\n"), "") << line;
}

}  // namespace schemas_test
}  // namespace ispace
