// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/goal_options.h"

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrange/arrange.h"
#include "base/error.h"
#include "env/zone.h"
#include "extensions/goals/least_seen_trip.h"
#include "extensions/goals/localisation.h"
#include "extensions/goals/localise_search.h"
#include "extensions/goals/path_objective.h"
#include "record/schema.h"

namespace ispace::goals {

namespace {

/// `coverage --path` and `--localise`.
class GoalFigures final : public CoverageGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Ways and positions");
        line.texts("--path", "FROM,TO", way_words_,
                   "report the way between these two zones, over free floor, that sensors see for "
                   "the shortest length, and draw it",
                   Enters::History);
        line.meters("--localise", localise_to_, kMinErrorLimit, kMaxErrorLimit,
                    "report the error with which the sensors localise a tag or a person, over the "
                    "floor; in the mean, errors above this and floor without a position count as "
                    "this",
                    Enters::History);
    }

    void take(const CommandLine& /*line*/) override {
        for (const std::string& text : way_words_)
            ways_.push_back(ofOption("--path", [&] { return parseWay(text); }));
    }

    [[nodiscard]] bool isAsked() const override {
        return !way_words_.empty() || localise_to_.has_value();
    }

    /// Measures ways through the site, and positions in each room and over all.
    void measure(const MeasuredSite& site, CoverageFindings& findings) override {
        for (PathChoice& way : ways_)
            way = {inOwnStorey(site.input, way.from), inOwnStorey(site.input, way.to)};
        const SiteObjectives figures =
            measureObjectives(site.input.building, site.coverage, ways_, 1, localise_to_);
        addSections<ObjectivesSection>(findings.parts, figures.storeys, figures.all);
    }

  private:
    std::vector<std::string> way_words_;
    std::vector<PathChoice> ways_;
    std::optional<double> localise_to_;  // metres; larger errors count as this
};

/// \throws UsageError if one of these options is given
void refuse(const CommandLine& line, std::span<const std::string_view> options) {
    for (const std::string_view option : options)
        if (line.given(std::string(option)))
            throw UsageError("--objective path and localise are goals of their own: leave out " +
                             std::string(option));
}

/// Options of searches for covered floor.
void refuseOfCoverage(const CommandLine& line, std::span<const std::string_view> others) {
    constexpr std::string_view kOther[] = {
        "--target", "--budget", "--refine",     "--connected",   "--reso",
        "--judge",  "--proof",  "--shard",      "--resume",      "--curve",
        "--heat",   "--trace",  "--export-mps", "--alternatives"};
    refuse(line, kOther);
    refuse(line, others);
}

/// Measures ways and positions of a layout, and adds them to the findings.
/// \param is_exact if its coverage is not measured yet
void judgeGoal(const ArrangedSite& site, std::span<const PathChoice> ways,
               std::optional<double> localise_to, bool is_exact, ArrangeFindings& findings) {
    const SiteCoverage own = site.coverage != nullptr
                                 ? SiteCoverage()
                                 : measureSite(site.placed, {.plane = site.how.plane,
                                                             .density = site.how.pixel_density,
                                                             .exact = is_exact});
    const SiteCoverage& coverage = site.coverage != nullptr ? *site.coverage : own;
    const SiteObjectives figures =
        measureObjectives(site.placed, coverage, ways, site.how.redundancy, localise_to);
    for (const NamedFigure& figure : namedFigures(figures.all))
        findings.lines.push_back({figure.name + ": " + figure.finding});
    if (site.coverage != nullptr)
        addSections<ObjectivesSection>(findings.parts, figures.storeys, figures.all);
}

/// `arrange --objective path:FROM,TO`.
class PathGoal final : public ObjectiveGroup {
  public:
    [[nodiscard]] std::string_view word() const override { return "path:FROM,TO"; }
    [[nodiscard]] bool takes(std::string_view text) override {
        constexpr std::string_view kWord = "path:";
        if (!text.starts_with(kWord) || text == kWord) return false;
        way_ = parseWay(text.substr(kWord.size()));
        return true;
    }
    [[nodiscard]] std::string_view help() const override {
        return "the length seen of the way between two zones that is seen least";
    }
    void declare(CommandLine& /*line*/) override {}

    void settle(const CommandLine& line, std::span<const std::string_view> others,
                ArrangeOptions& how) const override {
        refuseOfCoverage(line, others);
        constexpr std::string_view kOfFloor[] = {"--zone", "--weight"};
        refuse(line, kOfFloor);
        how.objective = std::make_shared<const PathObjective>(way_, StoreyZone(), StoreyZone());
    }

    void aim(const SiteInput& input, ArrangeOptions& how) const override {
        const std::string option = "--objective";
        const PathChoice way = wayIn(input);
        if (!input.isOneRoom()) {
            how.objective = std::make_shared<const PathObjective>(
                way, zoneOfStorey(input.building, option, way.from),
                zoneOfStorey(input.building, option, way.to),
                passages::sitePassages(input.building));
            return;
        }
        for (const std::string& zone : {way.from, way.to})
            static_cast<void>(
                ofOption(option, [&] { return readZone(zone, input.only().environment); }));
        how.objective = std::make_shared<const PathObjective>(way, StoreyZone{0, way.from},
                                                              StoreyZone{0, way.to});
    }

    /// Regions for ways may take longer than a limit of time allows.
    void judge(const ArrangedSite& site, ArrangeFindings& findings) const override {
        const PathChoice way = wayIn(site.input);
        judgeGoal(site, {&way, 1}, std::nullopt, site.found.is_complete, findings);
    }

  private:
    /// Returns the zones as they are called in a site.
    [[nodiscard]] PathChoice wayIn(const SiteInput& input) const {
        return {inOwnStorey(input, way_.from), inOwnStorey(input, way_.to)};
    }

    PathChoice way_;
};

/// `arrange --objective localise[:M]`.
class LocaliseGoal final : public ObjectiveGroup {
  public:
    [[nodiscard]] std::string_view word() const override { return "localise[:M]"; }
    [[nodiscard]] bool takes(std::string_view text) override {
        constexpr std::string_view kWord = "localise";
        if (text == kWord) return true;
        if (!text.starts_with(kWord) || text.size() < kWord.size() + 2 || text[kWord.size()] != ':')
            return false;
        within_ = limitOf(std::string(text.substr(kWord.size() + 1)));
        return true;
    }
    [[nodiscard]] std::string_view help() const override {
        return "small errors of positions of tags and people, M at most (default 1)";
    }
    void declare(CommandLine& /*line*/) override {}

    void settle(const CommandLine& line, std::span<const std::string_view> others,
                ArrangeOptions& how) const override {
        refuseOfCoverage(line, others);
        constexpr std::string_view kOfTimes[] = {"--redundancy"};
        refuse(line, kOfTimes);
        how.objective = std::make_shared<const LocaliseObjective>(within_);
    }

    /// Positions are judged by cells.
    void judge(const ArrangedSite& site, ArrangeFindings& findings) const override {
        judgeGoal(site, {}, within_, false, findings);
    }

  private:
    static double limitOf(const std::string& text) {
        const KeySpec key{.name = "",  // the option's name is added anyway
                          .type = KeyType::Tuple,
                          .unit = Unit::Length,
                          .help = "",
                          .min_count = 1,
                          .max_count = 1,
                          .lower = kMinErrorLimit,
                          .upper = kMaxErrorLimit};
        return std::get<Tuple>(parseValue(key, text))[0];
    }

    double within_ = 1;
};

}  // namespace

std::unique_ptr<CoverageGroup> makeGoalFigures() { return std::make_unique<GoalFigures>(); }
std::unique_ptr<ObjectiveGroup> makePathGoal() { return std::make_unique<PathGoal>(); }
std::unique_ptr<ObjectiveGroup> makeLocaliseGoal() { return std::make_unique<LocaliseGoal>(); }

}  // namespace ispace::goals
