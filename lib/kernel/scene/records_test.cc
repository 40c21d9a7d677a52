// SPDX-License-Identifier: GPL-3.0-or-later
// All records there are, through the two forms of text.
#include <gtest/gtest.h>

#include "record/text.h"
#include "record/yaml/yaml.h"
#include "scene/placement_schemas.h"
#include "support/test_random_records.h"

namespace ispace {
namespace records_test {

TEST(Records, SurviveYamlAndEnvAndYamlAgain) {
    RandomDocuments random(sceneSchemas(), 20261120);
    for (int i = 0; i < 60; ++i) {
        const Document first = random.document();
        const std::string yaml = writeYaml(first);
        const Document from_yaml = readYaml(yaml, "a.yaml", sceneSchemas());
        const std::string env = writeRecordText(from_yaml);
        const Document from_env = readRecordText(env, "a.env", sceneSchemas());
        const std::string again = writeYaml(from_env);
        EXPECT_EQ(again, yaml);
        EXPECT_EQ(writeRecordText(readYaml(again, "b.yaml", sceneSchemas())), env);
        EXPECT_EQ(from_env.records, first.records);
        EXPECT_EQ(from_env.kind, first.kind);
        EXPECT_EQ(from_env.history, first.history);
        EXPECT_EQ(environmentDigest(from_env.records), environmentDigest(first.records));
    }
}

}  // namespace records_test
}  // namespace ispace
