// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/runs/run_options.h"

#include <string>
#include <vector>

#include "base/run_files.h"
#include "cli/common_options.h"
#include "cli/storey_operands.h"
#include "extensions/runs/site_run_coverage.h"
#include "scene/run/run_reader.h"

namespace ispace::runs {

namespace {

/// `coverage --run`.
class RunGroup final : public CoverageGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Recorded runs");
        line.file("--run", "DIR", record_,
                  "report by how many sensors robots and people were seen in the run that simrun "
                  "--record wrote there, and where sight was lost, in numbers and on the map",
                  Enters::BaseName);
        line.essential({"--run"});
    }
    void take(const CommandLine& /*line*/) override {}
    [[nodiscard]] bool isAsked() const override { return !record_.empty(); }

    [[nodiscard]] std::vector<std::string> recordedSite() const override {
        if (record_.empty()) return {};
        if (const std::string building = recordedBuilding(record_); !building.empty())
            return {building};
        static_cast<void>(RunReader(record_));  // fails before a missing layout does
        const std::string scene = sceneOfRecord(record_);
        return scene.empty() ? std::vector<std::string>() : std::vector{scene};
    }

    void fit(const SiteInput& input) const override { mustBeRecordOf(input, "--run", record_); }

    void measure(const MeasuredSite& site, CoverageFindings& findings) override {
        const std::string folder = recordFor(site.input, record_);
        for (const Storey& storey : site.input.building.document.storeys)
            findings.files.push_back(RecordedFiles(recordOfStorey(folder, storey)).robots);
        std::vector<std::string> warnings;
        run_ = measureSiteRun(sceneForRecord(site.input, folder), folder,
                              {.plane = site.how.plane, .density = site.how.density},
                              site.rules.max_work, warnings);
        for (const std::string& warning : warnings) warn(site.common, "coverage", warning);
        addRun(findings.parts, site.input.building, run_);
    }

  private:
    std::string record_;
    SiteRunCoverage run_;
};

/// The run in `simrun --report`. It has no option.
class RunReport final : public RecordGroup {
  public:
    void report(const RecordedRun& run, SiteParts& parts) override {
        const SiteScene& building = run.input.building;
        if (building.isRoomAlone() && !RunReader(run.record).next()) return;
        std::vector<std::string> repeated;  // warnings that the run itself gave
        run_ = measureSiteRun(building, run.record, {}, run.rules.max_work, repeated);
        addRun(parts, building, run_);
    }

  private:
    SiteRunCoverage run_;
};

}  // namespace

std::unique_ptr<CoverageGroup> makeRunGroup() { return std::make_unique<RunGroup>(); }

std::unique_ptr<RecordGroup> makeRunReport() { return std::make_unique<RunReport>(); }

}  // namespace ispace::runs
