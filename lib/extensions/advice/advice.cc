// SPDX-License-Identifier: GPL-3.0-or-later
// --suggest of coverage runs after coverage is measured, and never changes its verdict; at --time-
// limit or a signal it reports the best so far, and says so.
#include "extensions/advice/advice.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "cli/progress_bar.h"
#include "extensions/advice/site_suggestions.h"
#include "extensions/advice/suggestion_report.h"
#include "extensions/camerarules/camera_rules.h"

namespace ispace::advice {

namespace {

constexpr int kSuggestions = 5, kMaxSuggestions = 7;  // one of each kind

/// `coverage --suggest`.
class AdviceGroup final : public CoverageGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Suggestions");
        line.countOr(
            "--suggest", most_, kSuggestions, 1, kMaxSuggestions,
            "report up to N changes that would help: a sensor to add, turn, move, replace or "
            "remove, furniture to move, and with --require, --facing or --privacy the changes that "
            "meet all; each with its gain and its command",
            Enters::Nothing);
        constexpr double kMaxWait = 1e9;
        line.duration("--time-limit", time_limit_, 0, kMaxWait,
                      "end the search of --suggest with the best so far after this time (500ms, "
                      "2s, 1min); the report then says so",
                      Enters::Nothing);
        line.example("coverage room.env layout.3dm --require 90% --suggest 3",
                     "exit with 3 unless the sensors cover 90 % of the room, and name three "
                     "changes that help");
        line.essential({"--suggest", "--time-limit"});
    }

    void take(const CommandLine& line) override {
        if (time_limit_ && !most_)
            throw UsageError("--time-limit is about --suggest: give that, too");
        facing_ = line.valuesOf("--facing");
        privacy_ = line.valuesOf("--privacy");
    }

    [[nodiscard]] bool isAsked() const override { return most_.has_value(); }

    [[nodiscard]] bool searches() const override { return true; }

    void measure(const MeasuredSite& site, CoverageFindings& findings) override {
        SuggestOptions wanted{.most = static_cast<std::size_t>(*most_),
                              .measure = site.how,
                              .requirements = {site.requirements.begin(), site.requirements.end()}};
        for (const std::string& text : facing_) {
            camerarules::FacingRule rule = camerarules::parseFacing(text);
            rule.zone = inOwnStorey(site.input, rule.zone);
            if (rule.required) wanted.facing.push_back(std::move(rule));
        }
        for (const std::string& text : privacy_) {
            camerarules::PrivacyRule rule = camerarules::parsePrivacy(text);
            rule.zones = inOwnStorey(site.input, rule.zones);
            wanted.privacy.push_back(std::move(rule));
        }
        SearchWatch watch(makeProgress("coverage", site.common.progress, site.common.quiet),
                          time_limit_);
        advice_ = adviceFor(site.input.building, site.coverage, wanted, shippedDevices(), watch);
        advice_.command = editCommand(operandsToEdit(site.input), site.rules);
        advice_.has_fixed =
            std::any_of(site.input.rooms().begin(), site.input.rooms().end(), [](const auto& room) {
                return std::any_of(
                    room->sensors.begin(), room->sensors.end(), [](const Sensor& sensor) {
                        return !sensor.mount && !sensor.person && kindOf(sensor.model).is_arranged;
                    });
            });
        advice_.is_cut = watch.stopped();
        findings.signal = watch.signal();
        findings.parts.sum.push_back(std::make_shared<AdviceSection>(advice_));
    }

  private:
    std::optional<int> most_;
    std::optional<double> time_limit_;  // seconds
    std::vector<std::string> facing_, privacy_;
    Advice advice_;
};

}  // namespace

std::unique_ptr<CoverageGroup> makeAdvice() { return std::make_unique<AdviceGroup>(); }

}  // namespace ispace::advice
