// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report_group.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace ispace {
namespace report_group_test {

/// Writes the title of a page as a slide, and a list on request.
class Slides : public ReportGroup {
  public:
    [[nodiscard]] std::span<const std::string_view> formats() const override {
        static constexpr std::string_view kFormats[] = {"slide"};
        return kFormats;
    }
    void declare(CommandLine& line) override {
        line.file("--list", "FILE", list_, "", Enters::Nothing);
    }
    void take(const std::string& report) override {
        if (!list_.empty() && report.empty()) throw UsageError("--list: give --report");
    }
    [[nodiscard]] std::vector<SideFile> files() const override { return {{"--list", &list_}}; }
    [[nodiscard]] bool isAsked() const override { return !list_.empty(); }
    [[nodiscard]] std::string writeFiles(
        std::span<const std::shared_ptr<const Scene>> scenes) const override {
        return list_ + " has " + std::to_string(scenes.size()) + " rooms";
    }
    [[nodiscard]] ReportPage page(const SiteReport& report,
                                  const std::string& /*file*/) const override {
        return {report.name, ""};
    }
    [[nodiscard]] ReportPage page(const RoomReport& report) const override {
        return {report.name, ""};
    }
    [[nodiscard]] std::string bytesOf(const ReportPage& page,
                                      const std::string& file) const override {
        return page.title + " in " + file;
    }

  private:
    std::string list_;
};

const std::vector<ReportRow>& rows() {
    static const std::vector<ReportRow> all = {
        {"slides", []() -> std::unique_ptr<ReportGroup> { return std::make_unique<Slides>(); }},
        {"books", nullptr, "book"}};
    return all;
}

std::string refusalOf(const ReportExtensions& reports, const std::string& report) {
    try {
        reports.take(report);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(ReportExtensions, FindTheFormOfAFile) {
    ReportExtensions reports(rows());
    reports.take("a.slide");
    ASSERT_NE(reports.of("a.slide"), nullptr);
    EXPECT_EQ(reports.of("a.slide")->bytesOf({"hall", ""}, "a.slide"), "hall in a.slide");
    EXPECT_EQ(reports.of("noSuffix"), reports.of("a.slide"));
    EXPECT_EQ(reports.of("a.json"), nullptr);
    EXPECT_EQ(reports.of(""), nullptr);
    EXPECT_EQ(refusalOf(reports, "a.json"), "");
    EXPECT_EQ(refusalOf(reports, ""), "");
}

TEST(ReportExtensions, NameTheExtensionOfAMissingForm) {
    const ReportExtensions reports(rows());
    EXPECT_EQ(refusalOf(reports, "a.book"),
              "a.book: `.book` belongs to the extension books, which this build lacks");
    EXPECT_EQ(refusalOf(reports, "a.txt"),
              "a.txt: no format has the suffix `.txt`, wanted .json, .slide or .book");
    const std::vector<ReportRow> missing = {{"books", nullptr, "book"}};
    EXPECT_EQ(refusalOf(ReportExtensions(missing), "report"),
              "report: `.book` belongs to the extension books, which this build lacks");
}

TEST(ReportExtensions, HaveOptionsAndFilesBeside) {
    ReportExtensions reports(rows());
    CommandLine line("coverage", "", "");
    reports.declare(line);
    EXPECT_EQ(reports.options(), std::vector<std::string>{"--list"});
    EXPECT_FALSE(reports.isAsked());
    EXPECT_TRUE(reports.writeFiles({}).empty());
    const char* const words[] = {"coverage", "--list", "l.csv"};
    line.parse(3, words);
    EXPECT_EQ(refusalOf(reports, ""), "--list: give --report");
    ASSERT_EQ(reports.files().size(), 1U);
    EXPECT_EQ(*reports.files().front().file, "l.csv");
    EXPECT_EQ(reports.writeFiles({}), std::vector<std::string>{"l.csv has 0 rooms"});
}

}  // namespace report_group_test
}  // namespace ispace
