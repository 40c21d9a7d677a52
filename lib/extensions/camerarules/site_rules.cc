// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/site_rules.h"

#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "env/zone.h"
#include "report/report_section.h"

namespace ispace::camerarules {

namespace {

constexpr const char* kFacing = "--facing";

bool hasZone(const Environment& room, const std::string& zone) {
    if (zone.starts_with(kDoorPrefix)) {
        const Glob doors(zone.substr(kDoorPrefix.size(), zone.rfind(',') - kDoorPrefix.size()));
        for (const Doorway& door : doorwaysOf(room))
            if (doors.matches(door.id)) return true;
        return false;
    }
    const Glob zones(zone);
    for (const Element& element : room.elements())
        if (element.record.keyword() == "zone" && zones.matches(element.id)) return true;
    return false;
}

/// Lists the doors of all storeys, or the zones, for a rule that no storey has.
/// \param own the rule's zone without its storeys
std::string unknownRule(const std::string& option, const std::string& zone, const std::string& own,
                        const SiteScene& building) {
    const bool is_of_doors = own.starts_with(kDoorPrefix);
    std::string list, doors_named;
    std::vector<std::string> zones;
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Storey& storey = building.document.storeys[i];
        const Environment& room = building.scenes[i]->environment;
        if (is_of_doors) {
            if (const std::string doors = doorList(room, storey.id + '/'); !doors.empty())
                list += (list.empty() ? "" : ", ") + doors;
            continue;
        }
        if (option == kFacing && hasZone(room, std::string(kDoorPrefix) + own + ",1"))
            doors_named = "; doors have this name: " + zone.substr(0, zone.size() - own.size()) +
                          std::string(kDoorPrefix) + own;
        for (const Element& element : room.elements())
            if (element.record.keyword() == "zone") {
                list += (list.empty() ? "" : ", ") + wholeId(storey, element.id);
                zones.push_back(element.id);
            }
    }
    const std::string kind = is_of_doors ? "door" : "zone";
    return option + ": " + excerpt(zone) + " meets no " + kind + inLowerCase(own, zones) +
           doors_named +
           (list.empty() ? ": the building has none"
                         : "; the " + kind + "s of the building: " + list);
}

}  // namespace

namespace {

/// Calls measure(storey, zone) for the storeys that have the zone of a rule.
/// \throws UsageError if none has it
void forEachStoreyOf(const SiteScene& building, const SiteCoverage& coverage,
                     const std::string& option, const std::string& text,
                     const std::function<void(std::size_t, const std::string&)>& measure) {
    const auto [storeys, zone] = splitStoreys(building.document, option, text);
    bool is_met = false;
    for (const std::size_t i : storeys) {
        if (!hasZone(coverage.floors[i]->environment, zone)) continue;
        is_met = true;
        measure(i, zone);
    }
    if (!is_met) throw UsageError(unknownRule(option, text, zone, building));
}

template <typename Result>
void append(std::vector<Result> results, std::vector<Result>& all) {
    all.insert(all.end(), std::make_move_iterator(results.begin()),
               std::make_move_iterator(results.end()));
}

}  // namespace

std::vector<CameraRules> measureSiteRules(const SiteScene& building, const SiteCoverage& coverage,
                                          const CoverageOptions& options,
                                          std::span<const FacingRule> facing,
                                          std::span<const PrivacyRule> privacy) {
    if (building.isRoomAlone()) {
        const Scene& room = *building.scenes.front();
        return {CameraRules{measureFacing(room, coverage.storeys.front(), facing),
                            measurePrivacy(room, options.plane, privacy)}};
    }
    std::vector<CameraRules> measured(building.scenes.size());
    for (const FacingRule& rule : facing)
        forEachStoreyOf(
            building, coverage, kFacing, rule.zone, [&](std::size_t i, const std::string& zone) {
                FacingRule own = rule;
                own.zone = zone;
                append(measureFacing(*coverage.floors[i], coverage.storeys[i], {&own, 1}),
                       measured[i].facing);
            });
    std::map<double, SiteCoverage> at_density;
    const auto coverage_at = [&](double density) -> const SiteCoverage& {
        if (density == options.density && options.exact) return coverage;
        const auto [known, is_new] = at_density.try_emplace(density);
        if (is_new) {
            CoverageOptions own = options;
            own.density = density;
            own.exact = true;
            known->second = measureSite(building, own);
        }
        return known->second;
    };
    for (const PrivacyRule& rule : privacy)
        forEachStoreyOf(building, coverage, "--privacy", rule.zones,
                        [&](std::size_t i, const std::string& zones) {
                            PrivacyRule own = rule;
                            own.zones = zones;
                            append(measurePrivacy(*coverage.floors[i],
                                                  coverage_at(rule.density).storeys[i], own),
                                   measured[i].privacy);
                        });
    return measured;
}

StoreyRules rulesOfStorey(const SiteScene& building, const SiteCoverage& coverage,
                          std::size_t storey, std::span<const FacingRule> facing,
                          std::span<const PrivacyRule> privacy) {
    const Storey& own = building.document.storeys[storey];
    StoreyRules rules;
    for (FacingRule rule : facing)
        forEachStoreyOf(
            building, coverage, kFacing, rule.zone, [&](std::size_t i, const std::string& zone) {
                if (i != storey) return;
                rule.zone =
                    zone.starts_with(kDoorPrefix)
                        ? std::string(kDoorPrefix) + wholeId(own, zone.substr(kDoorPrefix.size()))
                        : wholeId(own, zone);
                rules.facing.push_back(rule);
            });
    for (PrivacyRule rule : privacy)
        forEachStoreyOf(building, coverage, "--privacy", rule.zones,
                        [&](std::size_t i, const std::string& zones) {
                            if (i != storey) return;
                            rule.zones = wholeId(own, zones);
                            rules.privacy.push_back(rule);
                        });
    return rules;
}

double missingFloor(std::span<const CameraRules> rules) {
    double sum = 0;
    for (const CameraRules& storey : rules) {
        for (const FacingResult& result : storey.facing)
            if (!isMet(result))
                sum += (*result.rule.required - result.share.value_or(0)) * result.area;
        for (const PrivacyResult& result : storey.privacy)
            if (!isMet(result)) sum += result.seen.value_or(result.area);
    }
    return sum;
}

std::vector<JudgedRule> judgedInSite(const SiteScene& building,
                                     std::span<const CameraRules> rules) {
    std::vector<JudgedRule> all;
    for (std::size_t i = 0; i < rules.size(); ++i)
        for (JudgedRule& rule : judgedRules(rules[i])) {
            const std::string storey = building.document.storeys[i].prefix();
            rule.rule.insert(0, storey);
            if (!rule.plain.empty()) rule.plain.insert(0, storey);
            all.push_back(std::move(rule));
        }
    return all;
}

namespace {

/// The rules of all storeys on one page; each storey's report has those of its own.
class SiteRulesSection final : public ReportSection {
  public:
    explicit SiteRulesSection(std::vector<JudgedRule> rules) : rules_(std::move(rules)) {}
    [[nodiscard]] std::string_view name() const override { return "rules"; }
    [[nodiscard]] int rank() const override { return 10; }
    void writeJson(JsonWriter& /*json*/) const override {}
    [[nodiscard]] std::string text() const override { return ""; }
    [[nodiscard]] PageAdditions page(const PageSubject& subject) const override {
        PageAdditions added;
        added.figures.push_back(
            {"rules",
             "Faces and privacy",
             {rulesTable("directions of faces" + facesJudgedAtText(subject.report) +
                             ", and zones that cameras must not see, by storey",
                         rules_)}});
        return added;
    }

  private:
    std::vector<JudgedRule> rules_;
};

}  // namespace

void addRules(SiteParts& parts, const SiteScene& building, const SiteCoverage& coverage,
              const std::vector<CameraRules>& rules) {
    if (rules.empty()) return;
    parts.storeys.resize(coverage.storeys.size());
    for (std::size_t i = 0; i < rules.size(); ++i)
        parts.storeys[i].push_back(std::make_shared<RulesSection>(rules[i]));
    parts.sum.push_back(std::make_shared<SiteRulesSection>(judgedInSite(building, rules)));
}

}  // namespace ispace::camerarules
