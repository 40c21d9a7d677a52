// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "record/text.h"
#include "record/yaml/yaml.h"
#include "support/test_schemas.h"

namespace ispace {
namespace yaml_write_test {

std::string yamlOf(const std::string& lines) {
    return writeYaml(readRecordText(lines, "a.env", testSchemas()));
}

TEST(WriteYaml, IsARecordALine) {
    EXPECT_EQ(
        yamlOf("#env 1\n# envc a.env\n# b 'c d'\n"
               "fence id=f1 path=0,0;8,0.5 closed=yes\ndesk at=2,3,0.5 heading=30 height=70cm\n"
               "laser\nresult coverage=97.4% area=12.5\n"),
        "# ispace yaml 1\n# envc a.env\n# b 'c d'\n"
        "- fence: {id: f1, path: [[0, 0], [8, 0.5]], closed: yes}\n"
        "- desk: {at: [2, 3, 0.5], heading: 30}\n- laser: {}\n"
        "- result: {coverage: 97.4%, area: 12.5}\n");
    EXPECT_EQ(yamlOf("#3dm 1\nlaser range=4\n"), "# ispace yaml 1 layout\n- laser: {range: [4]}\n");
}

TEST(WriteYaml, HoldsAnEmptyDocument) {
    const std::string text = yamlOf("#3dm 1\n# tool\n");
    EXPECT_EQ(text, "# ispace yaml 1 layout\n# tool\n[]\n");
    const Document again = readYaml(text, "a.yaml", testSchemas());
    EXPECT_EQ(again.kind, DocumentKind::Layout);
    EXPECT_EQ(again.history, History{"tool"});
    EXPECT_TRUE(again.records.empty());
}

TEST(WriteYaml, QuotesWhatYamlMightTakeForSomethingElse) {
    const auto name = [](const std::string& text) {
        Document document;
        document.records.emplace_back(*testSchemas().find("desk"));
        document.records[0].set("name", text);
        const std::string yaml = writeYaml(document);
        const std::string before = "# ispace yaml 1\n- desk: {name: ", after = "}\n";
        return yaml.substr(before.size(), yaml.size() - before.size() - after.size());
    };
    for (const char* plain : {"a", "desk-1", "w1/desk_2", "a.b+c", "yesterday", "nullable", "e5"})
        EXPECT_EQ(name(plain), plain);
    for (const char* quoted :
         {"",     "yes", "No",  "TRUE", "off", "null", "y",   "NaN", "12",  "1e5", "-a",
          ".inf", "+1",  "a:b", "a b",  "#a",  "a,b",  "{a}", "~",   "'a'", "@a",  "h\xc3\xb6he"})
        EXPECT_EQ(name(quoted), '"' + std::string(quoted) + '"');
    EXPECT_EQ(name("a\n\t\"\\"), R"("a\n\t\"\\")");
    EXPECT_EQ(name("\xc2\x85\xc2\xa0\xe2\x80\xa8\xef\xbb\xbf\xf0\x9f\xbf\xbf"),
              R"("\u0085\u00A0\u2028\uFEFF\U0001FFFF")");
}

TEST(WriteYaml, QuotesKeysThatAreFlagsToOthers) {
    Document document;
    document.records.emplace_back(*placedSchemas().find("laser"));
    document.records[0].set("on", std::string("r1"));
    EXPECT_EQ(writeYaml(document), "# ispace yaml 1\n- laser: {\"on\": r1}\n");
    EXPECT_EQ(readYaml(writeYaml(document), "a", placedSchemas()).records, document.records);
}

TEST(WriteYaml, KeepsHistoryToItsLines) {
    Document document;
    document.history = {"arrange 'a\nb'"};
    EXPECT_EQ(writeYaml(document), "# ispace yaml 1\n# arrange 'a?b'\n[]\n");
}

TEST(ReadYaml, TakesTheKindOfItsMagicLine) {
    const auto kind = [](const char* text) { return readYaml(text, "a", testSchemas()).kind; };
    EXPECT_EQ(kind("# ispace yaml 1 layout\r\n- laser: {}\r\n"), DocumentKind::Layout);
    EXPECT_EQ(kind("# ispace yaml 1\n- laser: {}\n"), DocumentKind::Environment);
    EXPECT_EQ(kind("- laser: {}\n"), DocumentKind::Environment);
    EXPECT_EQ(
        findingsOf([&] { (void)kind("# ispace yaml 1 plan\n- laser: {}\n"); }),
        std::vector<std::string>{"a:1:15: error: version `1 plan` found, wanted `# ispace yaml "
                                 "1` or `# ispace yaml 1 layout`"});
}

}  // namespace yaml_write_test
}  // namespace ispace
