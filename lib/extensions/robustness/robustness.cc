// SPDX-License-Identifier: GPL-3.0-or-later
// 100 mountings and 100 crowds, drawn from the seed: the standard error of a mean share of 100
// samples is at most 5 percentage points, and usually far less. Failures are searched, not drawn.
// All three add their section to the report of coverage; none of them changes its verdict.
#include "extensions/robustness/robustness.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "cli/progress_bar.h"
#include "cli/storey_operands.h"
#include "extensions/robustness/crowd.h"
#include "extensions/robustness/robustness_report.h"
#include "extensions/robustness/site_robustness.h"
#include "site/storey_people.h"

namespace ispace::robustness {

namespace {

/// Random mountings and crowds of --perturb and --crowd.
constexpr int kSamples = 100;
constexpr int kMaxFailures = 8;

/// People among whom coverage is reported, too.
struct CrowdChoice {
    Robustness::CrowdOf of = Robustness::CrowdOf::Random;
    int people = 0;  ///< of Random
};

/// Parses `N`, `scene` or `run`.
CrowdChoice parseCrowd(const std::string& text) {
    constexpr int kMaxPeople = 10'000;
    if (text == "scene") return {Robustness::CrowdOf::Scene};
    if (text == "run") return {Robustness::CrowdOf::Run};
    const auto people = parseInteger(text);
    if (!people || *people < 0 || *people > kMaxPeople)
        throw UsageError('`' + text + "` is not a number of people up to " +
                         std::to_string(kMaxPeople) + ", scene or run");
    return {Robustness::CrowdOf::Random, static_cast<int>(*people)};
}

/// Returns the crowds of --crowd: by sample, then by room.
std::vector<SiteCrowd> crowdsOf(const MeasuredSite& site, const CrowdChoice& crowd,
                                const std::string& record) {
    const SiteInput& input = site.input;
    const std::size_t rooms = input.rooms().size();
    std::vector<SiteCrowd> crowds;
    switch (crowd.of) {
        case Robustness::CrowdOf::Random: {
            const std::vector<std::size_t> people =
                spreadOverStoreys(site.coverage, static_cast<std::size_t>(crowd.people));
            crowds.assign(kSamples, SiteCrowd(rooms));
            for (std::size_t i = 0; i < rooms; ++i) {
                if (people[i] == 0) continue;
                const CrowdFloor floor(*input.rooms()[i]);
                for (std::size_t k = 0; k < kSamples; ++k)
                    crowds[k][i] = floor.draw(
                        people[i], {.seed = seedOfStorey(site.common.seed, i), .frame = k});
            }
            break;
        }
        case Robustness::CrowdOf::Scene:
            crowds.emplace_back();
            for (const auto& scene : input.rooms()) crowds[0].push_back(crowdOf(*scene));
            break;
        case Robustness::CrowdOf::Run:
            // The storeys of a record have the same moments.
            for (std::size_t i = 0; i < rooms; ++i) {
                const std::vector<Crowd> own = crowdsOfRun(
                    recordOfStorey(recordFor(input, record), input.building.document.storeys[i]),
                    *input.rooms()[i], kSamples);
                crowds.resize(i == 0 ? own.size() : std::min(crowds.size(), own.size()),
                              SiteCrowd(rooms));
                for (std::size_t k = 0; k < crowds.size(); ++k) crowds[k][i] = own[k];
            }
            break;
    }
    return crowds;
}

class RobustnessGroup final : public CoverageGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Mounting, failures and people");
        line.parsed(
            "--perturb", "M,DEG",
            [this](const std::string& text) { tolerance_ = parseTolerance(text); },
            "report how coverage and requirements fall if sensors are mounted up to M and DEG off "
            "their poses, as in 5cm,3deg: 100 random mountings",
            Enters::Nothing);
        line.count("--failures", "K", failures_, 1, kMaxFailures,
                   "report coverage and requirements without the K sensors that cost most",
                   Enters::Nothing);
        line.parsed(
            "--crowd", "N|scene|run",
            [this](const std::string& text) { crowd_ = parseCrowd(text); },
            "report coverage and requirements with people in the way of sight: N at random "
            "positions, "
            "100 times; those of the scene; those of --run DIR at 100 moments",
            Enters::Nothing);
    }

    void take(const CommandLine& line) override {
        if (!crowd_ || crowd_->of != Robustness::CrowdOf::Run) return;
        const std::vector<std::string> records = line.valuesOf("--run");
        if (records.empty())
            throw UsageError("--crowd run takes people of a record: give --run DIR");
        record_ = records.back();
    }

    [[nodiscard]] bool isAsked() const override { return tolerance_ || failures_ || crowd_; }

    /// \throws UsageError as worstFailures(), UnmetError as CrowdFloor
    void measure(const MeasuredSite& site, CoverageFindings& findings) override {
        const SiteScene& building = site.input.building;
        const SiteCoverage& planned = site.coverage;
        robustness_.requirements.assign(site.requirements.begin(), site.requirements.end());
        robustness_.failures = failures_.value_or(0);
        if (failures_)
            robustness_.losses = worstFailuresOfSite(planned, *failures_, site.requirements);
        const auto progress = makeProgress("coverage", site.common.progress, site.common.quiet);
        if (crowd_) {
            robustness_.crowd_of = crowd_->of;
            robustness_.people = crowd_->people;
            robustness_.crowd =
                crowdSite(building, planned, site.how, crowdsOf(site, *crowd_, record_),
                          site.requirements, *progress);
        }
        if (tolerance_) {
            robustness_.tolerance = *tolerance_;
            robustness_.mounting = perturbSite(building, planned, site.how, *tolerance_, kSamples,
                                               site.common.seed, site.requirements, *progress);
        }
        findings.parts.sum.push_back(std::make_shared<RobustnessSection>(robustness_));
    }

  private:
    std::optional<MountingTolerance> tolerance_;
    std::optional<int> failures_;
    std::optional<CrowdChoice> crowd_;
    std::string record_;
    Robustness robustness_;
};

}  // namespace

std::unique_ptr<CoverageGroup> makeRobustness() { return std::make_unique<RobustnessGroup>(); }

}  // namespace ispace::robustness
