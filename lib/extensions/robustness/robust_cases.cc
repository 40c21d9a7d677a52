// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/robust_cases.h"

#include "base/message.h"
#include "base/number.h"
#include "extensions/robustness/figure_samples.h"
#include "report/coverage_report.h"

namespace ispace::robustness {

namespace {

/// Returns the mean over random cases, with its standard error.
std::string meanOfSamples(const CaseShares& values) {
    std::string text = percentText(values.mean);
    if (values.shares.size() < 2) return text;
    return text + " with a standard error of " + percentText(standardErrorOf(values.shares));
}

std::string samplesText(const std::string& samples, const CaseShares& values) {
    return "in " + std::to_string(values.shares.size()) + ' ' + samples + "; worst " +
           percentText(values.worst) + ", mean " + meanOfSamples(values);
}

std::vector<CaseRow> rowsOfSamples(const std::string& samples, const CaseShares& values) {
    return {{"worst of " + std::to_string(values.shares.size()) + ' ' + samples,
             percentText(values.worst)},
            {"mean", meanOfSamples(values)}};
}

/// Errors of mounting in one room and case.
class MountingErrors final : public PoseErrors {
  public:
    MountingErrors(const Environment& room, const MountingTolerance& tolerance, std::uint64_t seed,
                   std::uint64_t mounting)
        : room_(room), tolerance_(tolerance), seed_(seed), mounting_(mounting) {}

    [[nodiscard]] Pose3 actual(const Sensor& planned) const override {
        Sensor probe = planned;
        probe.id.clear();
        const Point3 at = planned.pose.position;
        for (const double number : {at.x, at.y, at.z}) probe.id += formatDouble(number) + ' ';
        probe.pose.heading = Angle();
        const RandomKey key{.seed = seed_, .frame = mounting_};
        Pose3 pose = mountedPose(room_, probe, tolerance_, key);
        pose.heading = wrapped(planned.pose.heading + pose.heading);
        return pose;
    }

  private:
    const Environment& room_;
    MountingTolerance tolerance_;
    std::uint64_t seed_, mounting_;
};

}  // namespace

SiteCase OtherSites::siteIn(const ArrangeSite& site, std::size_t number) const {
    return caseOf(number == 0 ? site : *others_[number - 1].site);
}

std::string OtherSites::finding(const CaseShares& values) const {
    std::string text;
    for (std::size_t i = 0; i < sites(); ++i)
        text.append(text.empty() ? "in " : ", ")
            .append(printable(nameOf(i)))
            .append(1, ' ')
            .append(percentText(values.shares[i]));
    return text + "; worst " + percentText(values.worst) + ", mean " + percentText(values.mean);
}

std::vector<CaseRow> OtherSites::rows(const CaseShares& values) const {
    std::vector<CaseRow> rows;
    rows.reserve(sites() + 2);
    for (std::size_t i = 0; i < sites(); ++i)
        rows.push_back({nameOf(i), percentText(values.shares[i])});
    rows.push_back({"worst of all", percentText(values.worst)});
    rows.push_back({"mean", percentText(values.mean)});
    return rows;
}

std::string SensorFailures::finding(const CaseShares& values) const {
    std::string text;
    for (const std::string& id : values.failed)
        text.append(text.empty() ? "without " : " and ").append(printable(id));
    if (text.empty()) text = "without failures";
    return text + ", the worst failure, " + percentText(values.worst) +
           "; mean over all failures " + percentText(values.mean);
}

std::vector<CaseRow> SensorFailures::rows(const CaseShares& values) const {
    std::string worst = "worst of all";
    for (const std::string& id : values.failed)
        worst.append(&id == &values.failed.front() ? ": without " : " and ").append(id);
    return {{std::move(worst), percentText(values.worst)}, {"mean", percentText(values.mean)}};
}

std::unique_ptr<const PoseErrors> MountingCases::errorsIn(const Environment& room,
                                                          std::size_t index,
                                                          std::size_t number) const {
    return std::make_unique<const MountingErrors>(room, tolerance_, seeds_[index], number);
}

std::string MountingCases::finding(const CaseShares& values) const {
    return samplesText("mountings", values);
}

std::vector<CaseRow> MountingCases::rows(const CaseShares& values) const {
    return rowsOfSamples("mountings", values);
}

std::vector<Crowd> crowdsIn(const Scene& scene, std::size_t people, std::uint64_t seed) {
    const CrowdFloor floor(scene);
    std::vector<Crowd> crowds(kSearchedSamples);
    for (std::size_t k = 0; people > 0 && k < crowds.size(); ++k)
        crowds[k] = floor.draw(people, {.seed = seed, .frame = k});
    return crowds;
}

SiteCase CrowdCases::siteIn(const ArrangeSite& site, std::size_t number) const {
    return caseOf(site, [&](std::size_t room, std::shared_ptr<const Scene> scene) {
        const Crowd& crowd = crowds_[room][number];
        return crowd.empty() ? std::move(scene)
                             : std::make_shared<const Scene>(withCrowd(*scene, crowd));
    });
}

std::string CrowdCases::finding(const CaseShares& values) const {
    return samplesText(
        "crowds of " + std::to_string(people_) + (people_ == 1 ? " person" : " people"), values);
}

std::vector<CaseRow> CrowdCases::rows(const CaseShares& values) const {
    return rowsOfSamples("crowds", values);
}

}  // namespace ispace::robustness
