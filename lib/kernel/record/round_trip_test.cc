// SPDX-License-Identifier: GPL-3.0-or-later
// Random documents are written and read back.
#include <gtest/gtest.h>

#include "record/text.h"
#include "record/yaml/yaml.h"
#include "support/test_random_records.h"
#include "support/test_schemas.h"

namespace ispace {
namespace round_trip_test {

TEST(RoundTrip, DocumentsReadBackEqual) {
    RandomDocuments random(testSchemas(), 7);
    for (int i = 0; i < 3000; ++i) {
        const Document document = random.document();
        const std::string text = writeRecordText(document);
        const Document again = readRecordText(text, "a.env", testSchemas());
        EXPECT_EQ(again.kind, document.kind);
        EXPECT_EQ(again.history, document.history);
        ASSERT_EQ(again.records, document.records) << text;
        ASSERT_EQ(writeRecordText(again), text);
        for (const Record& record : document.records)
            EXPECT_EQ(readRecord(formatRecord(record), "x", testSchemas()), record);
    }
}

TEST(RoundTrip, YamlReadsBackEqual) {
    RandomDocuments random(testSchemas(), 8);
    for (int i = 0; i < 3000; ++i) {
        const Document document = random.document();
        const std::string text = writeYaml(document);
        const Document again = readYaml(text, "a.yaml", testSchemas());
        EXPECT_EQ(again.kind, document.kind);
        EXPECT_EQ(again.history, document.history);
        ASSERT_EQ(again.records, document.records) << text;
        ASSERT_EQ(writeYaml(again), text);
    }
}

TEST(RoundTrip, YamlAndTextGiveEachOther) {
    RandomDocuments random(testSchemas(), 9);
    for (int i = 0; i < 3000; ++i) {
        const std::string yaml = writeYaml(random.document());
        const Document first = readYaml(yaml, "a.yaml", testSchemas());
        const std::string text = writeRecordText(first);
        const Document second = readRecordText(text, "a.env", testSchemas());
        ASSERT_EQ(writeYaml(second), yaml) << text;
        const Document third = readYaml(writeYaml(second), "b.yaml", testSchemas());
        ASSERT_EQ(writeRecordText(third), text) << yaml;
        EXPECT_EQ(environmentDigest(third.records), environmentDigest(first.records));
    }
}

}  // namespace round_trip_test
}  // namespace ispace
