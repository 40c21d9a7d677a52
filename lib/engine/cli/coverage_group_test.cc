// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/coverage_group.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "report/report_section.h"

namespace ispace {
namespace coverage_group_test {

/// A section of which only the place matters.
class Placed final : public ReportSection {
  public:
    Placed(int rank, std::string name) : rank_(rank), name_(std::move(name)) {}
    [[nodiscard]] std::string_view name() const override { return name_; }
    [[nodiscard]] int rank() const override { return rank_; }
    void writeJson(JsonWriter& /*json*/) const override {}
    [[nodiscard]] std::string text() const override { return name_; }

  private:
    int rank_;
    std::string name_;
};

TEST(ReportParts, AreSortedByRankAndKeepTheirOrder) {
    ReportParts parts = {std::make_shared<Placed>(20, "b"), std::make_shared<Placed>(40, "d")};
    join(parts, {std::make_shared<Placed>(40, "e"), std::make_shared<Placed>(10, "a"),
                 std::make_shared<Placed>(20, "c")});
    std::string names;
    for (const auto& part : parts) names += part->text();
    EXPECT_EQ(names, "abcde");
}

/// A group that judges "noise:" and adds one section.
class Group : public CoverageGroup {
  public:
    explicit Group(bool searches) : searches_(searches) {}
    void declare(CommandLine& line) override {
        line.group(searches_ ? "Searches" : "Noise");
        line.flag(searches_ ? "--search" : "--noise", is_asked_, "", Enters::Nothing);
    }
    void take(const CommandLine& /*line*/) override {}
    [[nodiscard]] bool isAsked() const override { return is_asked_; }
    [[nodiscard]] bool searches() const override { return searches_; }
    [[nodiscard]] std::string_view requirements() const override {
        return searches_ ? "" : "; noise:20";
    }
    [[nodiscard]] bool takesRequirement(const std::string& text) override {
        return !searches_ && text.starts_with("noise:");
    }
    [[nodiscard]] std::vector<std::string> recordedSite() const override {
        return is_asked_ && !searches_ ? std::vector<std::string>{"scene.env"}
                                       : std::vector<std::string>();
    }
    void measure(const MeasuredSite& /*site*/, CoverageFindings& findings) override {
        findings.files.emplace_back(searches_ ? "search" : "noise");
    }

  private:
    bool searches_, is_asked_ = false;
};

const std::vector<CoverageRow>& rows() {
    static const std::vector<CoverageRow> all = {
        {"quests",
         []() -> std::unique_ptr<CoverageGroup> { return std::make_unique<Group>(true); }},
        {"sound",
         []() -> std::unique_ptr<CoverageGroup> { return std::make_unique<Group>(false); }},
        {"light", nullptr, "lux"}};
    return all;
}

TEST(CoverageExtensions, MeasureSearchesApartAndWhatIsAskedAlone) {
    CoverageExtensions groups(rows());
    CommandLine line("coverage", "[ENV]", "Tests groups.");
    groups.declare(line);
    EXPECT_EQ(groups.options(), (std::vector<std::string>{"--search", "--noise"}));
    EXPECT_TRUE(groups.recordedSite().empty());
    const char* const words[] = {"coverage", "--noise", "--search"};
    line.parse(3, words);
    EXPECT_TRUE(groups.isAsked());
    EXPECT_EQ(groups.recordedSite(), std::vector<std::string>{"scene.env"});
    const SiteInput input;
    const SiteCoverage coverage;
    const CoverageOptions how;
    const CommonOptions common;
    const SceneRules rules;
    const MeasuredSite site{input, coverage, how, {}, common, rules};
    CoverageFindings findings;
    groups.measure(site, findings, false);
    EXPECT_EQ(findings.files, std::vector<std::string>{"noise"});
    groups.measure(site, findings, true);
    EXPECT_EQ(findings.files, (std::vector<std::string>{"noise", "search"}));
}

TEST(CoverageExtensions, RequirementsAreThoseOfGroupsOrNameTheExtensionThatIsMissing) {
    const CoverageExtensions groups(rows());
    EXPECT_EQ(groups.requirements(), "; noise:20");
    EXPECT_TRUE(groups.takesRequirement("noise:20"));
    EXPECT_FALSE(groups.takesRequirement("95%"));
    try {
        (void)groups.takesRequirement("lux:300");
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "--require: `lux:300`: it belongs to the extension light, which this build "
                     "lacks");
    }
}

}  // namespace coverage_group_test
}  // namespace ispace
