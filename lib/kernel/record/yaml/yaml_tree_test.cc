// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml/yaml.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <system_error>

#include "base/file.h"
#include "record/text.h"
#include "support/test_folder.h"
#include "support/test_schemas.h"

namespace ispace {

namespace yaml_tree_test {

using Texts = std::vector<std::string>;
namespace fs = std::filesystem;

/// A folder of its own for each test, which is the current one in it.
class YamlInclude : public ::testing::Test {
  protected:
    void SetUp() override {
        before_ = fs::current_path();
        fs::create_directories(folder_ / "sub" / "deep");
        fs::current_path(folder_.path());
    }
    void TearDown() override { fs::current_path(before_); }

    static Document read(const std::string& name, IncludeFiles includes = IncludeFiles::InFolder) {
        return readYaml(readAll(name), name, placedSchemas(), {}, {}, includes);
    }
    static Texts records(const std::string& name, IncludeFiles includes = IncludeFiles::InFolder) {
        Texts lines;
        for (const Record& record : read(name, includes).records)
            lines.push_back(formatRecord(record));
        return lines;
    }
    static Texts findings(const std::string& name) {
        return findingsOf([&] { (void)read(name); });
    }

  private:
    testing::TestFolder folder_;
    fs::path before_;
};

TEST_F(YamlInclude, PutsRecordsInPlace) {
    writeAll("room.yaml", "- desk: {id: a}\n- include: sub/b.yaml\n- desk: {id: c}\n");
    writeAll("sub/b.yaml", "desk: {id: b}\ninclude: [deep/d.env, e.yaml]\n");
    writeAll("sub/deep/d.env", "#env 1\n# tool\ndesk id=d\n");
    writeAll("sub/e.yaml", "# ispace yaml 1 layout\n# tool\n- desk: {id: e}\n");
    EXPECT_EQ(records("room.yaml"),
              (Texts{"desk id=a", "desk id=b", "desk id=d", "desk id=e", "desk id=c"}));
    const Document document = read("room.yaml");
    EXPECT_EQ(document.sources, (Texts{"sub/b.yaml", "sub/deep/d.env", "sub/e.yaml"}));
    EXPECT_EQ(document.kind, DocumentKind::Environment);
    EXPECT_TRUE(document.history.empty());
    EXPECT_EQ(readYaml("include: sub/b.yaml\n", "-", placedSchemas()).records.size(), 3U);
    EXPECT_EQ(readYaml("include: b.yaml\n", "sub/-", placedSchemas()).records.size(), 3U);
    EXPECT_EQ(readYaml("include: " + fs::current_path().string() + "/sub/e.yaml\n", "sub/y",
                       placedSchemas())
                  .records.size(),
              1U);
}

TEST_F(YamlInclude, StaysInTheFolder) {
    writeAll("secret.env", "#env 1\ndesk id=d\n");
    writeAll("sub/up.yaml", "include: ../secret.env\n");
    writeAll("sub/absolute.yaml", "include: " + fs::current_path().string() + "/secret.env\n");
    fs::create_symlink("../secret.env", "sub/link.env");
    writeAll("sub/link.yaml", "include: link.env\n");
    writeAll("sub/deep/up.yaml", "include: ../../secret.env\n");
    writeAll("sub/nested.yaml", "include: deep/up.yaml\n");
    for (const char* name :
         {"sub/up.yaml", "sub/absolute.yaml", "sub/link.yaml", "sub/nested.yaml"}) {
        const Texts found = findings(name);
        ASSERT_EQ(found.size(), 1U) << name;
        EXPECT_NE(found[0].find("it lies outside the folder of `" + std::string(name) +
                                "`: put it there, or allow it with --include-files anywhere"),
                  std::string::npos)
            << found[0];
        EXPECT_EQ(records(name, IncludeFiles::Anywhere), Texts{"desk id=d"});
    }
    writeAll("sub/missing.yaml", "include: ../missing.env\n");
    EXPECT_NE(findings("sub/missing.yaml").at(0).find("No such file"), std::string::npos);
    fs::current_path("sub");
    EXPECT_NE(findings("up.yaml").at(0).find("outside the folder of `up.yaml`"), std::string::npos);
    EXPECT_THROW(readYaml("include: ../secret.env\n", "-", placedSchemas()), FormatError);
    fs::current_path("..");
    fs::create_directory_symlink("sub", "other");
    EXPECT_EQ(findings("other/up.yaml").size(), 1U);
    writeAll("top.yaml", "include: sub/deep/up.yaml\n");
    EXPECT_EQ(records("top.yaml"), Texts{"desk id=d"}) << "an include of an include in the folder";
}

TEST_F(YamlInclude, RebasesFiles) {
    writeAll("room.yaml", "- mesh: {file: a.obj}\n- include: sub/b.yaml\n");
    writeAll("sub/b.yaml",
             "- mesh: {file: b.obj}\n- mesh: {file: /b.obj}\n- include: deep/c.env\n");
    writeAll("sub/deep/c.env", "#env 1\nmesh file=../c.obj\n");
    const Texts from_here{"mesh file=a.obj", "mesh file=sub/b.obj", "mesh file=/b.obj",
                          "mesh file=sub/deep/../c.obj"};
    EXPECT_EQ(records("room.yaml"), from_here);
    fs::current_path("sub");
    EXPECT_EQ(records("../room.yaml"), from_here) << "relative to the operand's folder";
    writeAll("up.yaml", "include: ../room.yaml\n");
    EXPECT_EQ(records("up.yaml", IncludeFiles::Anywhere).at(1), "mesh file=../sub/b.obj");
}

TEST_F(YamlInclude, SharesPartsButNoDefaults) {
    writeAll("lib.yaml",
             "defaults: {desk: {height: 2}}\nparts: {seat: [desk: {}], two: [place: {part: seat}, "
             "place: {part: seat, at: [1, 0]}]}\n");
    writeAll("other.yaml", "- include: lib.yaml\n- place: {part: seat, at: [5, 0]}\n- desk: {}\n");
    writeAll("room.yaml",
             "- defaults: {desk: {height: 3}}\n- place: {part: two}\n- include: [lib.yaml, "
             "other.yaml]\n- desk: {}\n");
    EXPECT_EQ(records("room.yaml"), (Texts{"desk height=2", "desk at=1,0 height=2",
                                           "desk at=5,0 height=2", "desk", "desk height=3"}));
    EXPECT_EQ(read("room.yaml").sources, (Texts{"lib.yaml", "other.yaml"}));
    writeAll("blind.yaml", "- parts: {mine: []}\n- include: user.yaml\n");
    writeAll("user.yaml", "- place: {part: mine}\n");
    EXPECT_EQ(findings("blind.yaml"),
              Texts{"user.yaml:1:17: error: unknown part `mine`, `parts` has none (included from "
                    "blind.yaml:2:12)"});
    writeAll("twice.yaml", "- parts: {seat: []}\n- include: lib.yaml\n");
    EXPECT_EQ(findings("twice.yaml"),
              Texts{"twice.yaml:2:12: error: doubled part `seat`, first in line 1"});
}

TEST_F(YamlInclude, MakesAFileAPart) {
    writeAll("seat.env", "#env 1\ndesk id=d at=0,1\nlaser on=d\n");
    writeAll("room.yaml",
             "parts: {seat: [include: seat.env]}\nplace: [{part: seat, id: a}, {part: seat, "
             "heading: 90}]\n");
    EXPECT_EQ(records("room.yaml"),
              (Texts{"desk id=a/d at=0,1", "laser on=a/d", "desk id=seat1/d at=-1,0 heading=90",
                     "laser on=seat1/d"}));
}

TEST_F(YamlInclude, InsertsAFileEachTime) {
    writeAll("d.yaml", "- desk: {}\n");
    writeAll("id.yaml", "- desk: {id: a}\n");
    writeAll("room.yaml", "include: [d.yaml, d.yaml]\n");
    EXPECT_EQ(records("room.yaml"), (Texts{"desk", "desk"}));
    EXPECT_EQ(read("room.yaml").sources, Texts{"d.yaml"});
    writeAll("ids.yaml", "include: [id.yaml, id.yaml]\n");
    EXPECT_EQ(findings("ids.yaml"),
              Texts{"id.yaml:1:14: error: doubled id `a`, read from here a second time (included "
                    "from ids.yaml:1:20)"});
    writeAll("both.yaml", "- include: id.yaml\n- desk: {id: a}\n");
    EXPECT_EQ(findings("both.yaml"),
              Texts{"both.yaml:2:14: error: doubled id `a`, first used in id.yaml line 1"});
}

TEST_F(YamlInclude, NamesCircles) {
    writeAll("a.yaml", "- include: sub/b.yaml\n");
    writeAll("sub/b.yaml", "- include: ../a.yaml\n");
    EXPECT_EQ(findings("a.yaml"),
              Texts{"sub/b.yaml:1:12: error: files include each other in a circle: a.yaml -> "
                    "sub/b.yaml -> a.yaml (included from a.yaml:1:12)"});
    writeAll("self.yaml", "include: self.yaml\n");
    EXPECT_EQ(findings("self.yaml"),
              Texts{"self.yaml:1:10: error: files include each other in a circle: self.yaml -> "
                    "self.yaml"});
    fs::create_symlink("a.yaml", "link.yaml");
    writeAll("sub/b.yaml", "- include: ../link.yaml\n");
    EXPECT_EQ(findings("a.yaml").size(), 1U) << "a link hides nothing";
}

TEST_F(YamlInclude, ErrorsCarryTheChain) {
    writeAll("a.yaml", "- include: b.yaml\n- desk: {heigth: 1}\n");
    writeAll("b.yaml", "- desk: {}\n- include: [c.yaml, d.yaml, e.env, gone.yaml, sub, f.yaml]\n");
    writeAll("c.yaml", "- desk: {height: x}\n");
    writeAll("d.yaml", "- desk: {height: 1\n");
    writeAll("e.env", "#env 1\ndesk heigth=1\ndesk height=x\n");
    writeAll("f.yaml", "# nothing\n");
    const auto chain = [](int column) {
        return " (included from b.yaml:2:" + std::to_string(column) + ", from a.yaml:1:12)";
    };
    const Texts found = findings("a.yaml");
    ASSERT_EQ(found.size(), 8U);
    EXPECT_EQ(found[0], "c.yaml:1:18: error: `height`: `x` is not a number" + chain(13));
    EXPECT_TRUE(found[1].starts_with("d.yaml:2:1: error: bad YAML: ")) << found[1];
    EXPECT_TRUE(found[1].ends_with(chain(21))) << found[1];
    EXPECT_EQ(found[2],
              "e.env:2:6: error: unknown key `heigth`, did you mean `height`?" + chain(29));
    EXPECT_EQ(found[3], "e.env:3:13: error: `height`: `x` is not a number" + chain(29));
    const std::string relative =
        "; names are relative to the folder of the file that includes (included from "
        "a.yaml:1:12)";
    EXPECT_EQ(found[4],
              "b.yaml:2:36: error: cannot read the included file `gone.yaml`: No such "
              "file or directory" +
                  relative);
    EXPECT_EQ(found[5],
              "b.yaml:2:47: error: cannot read the included file `sub`: Is a directory" + relative);
    EXPECT_EQ(found[6],
              "f.yaml: error: no records found, wanted a list or map of records" + chain(52));
    EXPECT_EQ(found[7], "a.yaml:2:10: error: unknown key `heigth`, did you mean `height`?");
    writeAll("ok.yaml", "include: g.env\n");
    writeAll("g.env", "#env 1\ndesk at=1,1\n");
    const Record desk = read("ok.yaml").records.at(0);
    EXPECT_EQ(desk.finding("at", "x").text(), "g.env:2:9: error: x (included from ok.yaml:1:10)");
    EXPECT_EQ(desk.finding("x").text(), "g.env:2:1: error: x (included from ok.yaml:1:10)");
}

TEST_F(YamlInclude, TakesFilesFromMemory) {
    const std::map<std::string, std::string> files = {
        {"x/b.yaml", "- include: ./c.env\n"},
        {"x/./c.env", "#env 1\ndesk id=c\n"},
        {"x/d.yaml", "- include: ../x/d.yaml\n"},
    };
    const auto read_file = [&](const std::string& path) {
        const auto found = files.find(path);
        if (found == files.end())
            throw std::system_error(std::make_error_code(std::errc::no_such_file_or_directory));
        return found->second;
    };
    const Document document = readYaml("include: b.yaml\n", "x/a.yaml", placedSchemas(), read_file);
    EXPECT_EQ(document.records.size(), 1U);
    EXPECT_EQ(document.sources, (Texts{"x/b.yaml", "x/./c.env"}));
    const auto found = findingsOf([&] {
        (void)readYaml("include: [d.yaml, a.yaml, e.yaml]\n", "x/a.yaml", placedSchemas(),
                       read_file);
    });
    ASSERT_EQ(found.size(), 3U);
    EXPECT_NE(found[0].find("circle: x/d.yaml -> x/d.yaml"), std::string::npos) << found[0];
    EXPECT_NE(found[1].find("circle: x/a.yaml -> x/a.yaml"), std::string::npos) << found[1];
    EXPECT_NE(found[2].find("`x/e.yaml`: No such file"), std::string::npos) << found[2];
}

TEST_F(YamlInclude, WantsNames) {
    writeAll("a.yaml",
             "- include:\n- include: {a: b}\n- include: [[b]]\n- include: ''\n- include: "
             "\"a\\nb\"\n- include: /dev/zero\n- include: /proc/self/pagemap\n");
    const Texts found = findingsOf([&] { (void)read("a.yaml", IncludeFiles::Anywhere); });
    ASSERT_EQ(found.size(), 7U);
    EXPECT_EQ(found[0],
              "a.yaml:1:3: error: nothing (null) is given, the name of a file or a list "
              "of them is wanted");
    EXPECT_EQ(found[2], "a.yaml:3:13: error: a list is given, the name of a file is wanted");
    EXPECT_EQ(found[3], "a.yaml:4:12: error: the name of the file to include is empty");
    EXPECT_EQ(found[4],
              "a.yaml:5:12: error: the name of the file to include holds a control "
              "character: `a?b`");
    EXPECT_NE(found[5].find("it is no regular file"), std::string::npos);
    EXPECT_NE(found[6].find("it holds more than its size says"), std::string::npos) << found[6];
}

TEST_F(YamlInclude, IsBounded) {
    for (int i = 0; i < 40; ++i)
        writeAll("n" + std::to_string(i) + ".yaml",
                 "- desk: {}\n- include: n" + std::to_string(i + 1) + ".yaml\n");
    writeAll("n40.yaml", "[]\n");
    Texts found = findings("n0.yaml");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NE(found[0].find("n32.yaml:2:12: error: includes are nested too deep, more than 32 in "
                            "each other (included from n31.yaml:2:12, from n30.yaml:2:12, "),
              std::string::npos)
        << found[0];
    EXPECT_TRUE(found[0].ends_with(" and 27 more)")) << found[0];
    EXPECT_EQ(records("n8.yaml").size(), 32U);

    writeAll("leaf.yaml", "- desk: {}\n");
    std::string many = "include: [";
    for (int i = 0; i < 100; ++i) many += "leaf.yaml, ";
    writeAll("many.yaml", many + "]\n");
    std::string more = "include: [";
    for (int i = 0; i < 12; ++i) more += "many.yaml, ";
    writeAll("more.yaml", more + "]\n");
    found = findings("more.yaml");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NE(found[0].find("more than 1000 files are included"), std::string::npos);

    std::string large = "#env 1\n";
    for (int i = 0; i < 1000; ++i) large += '#' + std::string(10000, 'x') + '\n';
    writeAll("large.env", large);
    writeAll("again.yaml", "include: [large.env, large.env, large.env]\n");
    found = findings("again.yaml");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NE(found[0].find("files included more than once hold more than 6 MB"),
              std::string::npos);
}

}  // namespace yaml_tree_test

}  // namespace ispace
