// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/layout_rules.h"

#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "cli/common_options.h"
#include "extensions/camerarules/facing_cells.h"
#include "extensions/camerarules/layout_privacy.h"
#include "extensions/camerarules/site_rules.h"

namespace ispace::camerarules {

namespace {

/// Rules of a site, by room.
template <typename Rule>
using ByRoom = std::vector<std::vector<Rule>>;

class LayoutRules final : public ArrangeGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Faces and privacy");
        line.texts(
            "--facing", "ZONE[,DEG[,HEADING]]", facing_words_,
            "floor of this zone counts only where a camera sees faces: within this angle (45deg) "
            "of the heading in which people walk there, by default through the doors on its "
            "border; door:GLOB[,M][,DEG] is the floor within M of doors (1.5m, 45deg)",
            Enters::History);
        line.texts("--privacy", "ZONE[,D]", privacy_words_,
                   "no camera may see these zones (globs allowed), or see them with at least D "
                   "pixels a metre, a number or a density class",
                   Enters::History);
    }

    void take(const CommandLine& line, const ArrangeOptions& /*how*/) override {
        for (const std::string& text : facing_words_)
            facing_.push_back(ofOption("--facing", [&] { return parseFacing(text); }));
        for (const std::string& text : privacy_words_)
            privacy_.push_back(ofOption("--privacy", [&] { return parsePrivacy(text); }));
        for (const FacingRule& rule : facing_)
            if (rule.required)
                throw UsageError("--facing: a share is asked for by --target; leave out =SHARE");
        const auto refuse = [&line](const std::string& rule, std::span<const char* const> others) {
            for (const char* other : others)
                if (line.given(other))
                    throw UsageError(rule + " and " + other + " do not go together: leave out one");
        };
        constexpr const char* kNotFacing[] = {"--refine", "--robust", "--crowd", "--proof",
                                              "--judge"};
        constexpr const char* kNotPrivate[] = {"--refine", "--proof", "--shard", "--resume",
                                               "--export-mps"};
        if (!facing_.empty()) refuse("--facing", kNotFacing);
        if (!privacy_.empty()) refuse("--privacy", kNotPrivate);
        has_zones_ = line.given("--zone");
    }

    [[nodiscard]] bool isAsked() const override {
        return !facing_words_.empty() || !privacy_words_.empty();
    }
    [[nodiscard]] std::vector<std::string_view> ofFloor() const override { return {"--facing"}; }

    [[nodiscard]] std::vector<std::string> notes(const ArrangeOptions& how) const override {
        std::vector<std::string> notes;
        if (facing_.empty()) return notes;
        if (how.target && !has_zones_)
            notes.push_back(
                "--target is of all floor: faces count in the zones of --facing, plain sight "
                "elsewhere; to count those zones alone, add --zone '" +
                printable(facing_.front().zone) + '\'');
        if (how.plane == 0) notes.emplace_back(kFacesOnFloor);
        return notes;
    }

    void aim(const ArrangeInput& of, ArrangeOptions& how,
             std::span<RoomGoals> goals) const override {
        const SiteInput& input = of.site;
        const ByRoom<FacingRule> facing = facingByRoom(input);
        for (std::size_t i = 0; i < facing.size(); ++i) {
            if (facing[i].empty()) continue;
            goals[i].cover_rule = coverRuleOf(facing[i]);
            how.cover_rule = goals[i].cover_rule;
        }
        std::vector<const Environment*> rooms;
        rooms.reserve(goals.size());
        for (const auto& scene : input.rooms()) rooms.push_back(&scene->environment);
        askPrivacy(privacyByRoom(input), rooms, how, goals);
    }

    void judge(const ArrangedSite& site, ArrangeFindings& findings) const override {
        const std::vector<PrivacyResult> privacy =
            measurePrivacy(site.site, site.groups, site.found, site.how.plane,
                           privacyByRoom(site.input))
                .results;
        CameraRules all{{}, privacy};
        const bool needs_coverage = !facing_.empty() && site.coverage == nullptr;
        const SiteCoverage own = needs_coverage
                                     ? measureSite(site.placed, {.plane = site.how.plane,
                                                                 .density = site.how.pixel_density})
                                     : SiteCoverage();
        const SiteCoverage& coverage = site.coverage != nullptr ? *site.coverage : own;
        const ByRoom<FacingRule> facing = facingByRoom(site.input);
        std::vector<CameraRules> rooms(facing.size());
        for (std::size_t i = 0; i < rooms.size(); ++i) {
            if (!facing_.empty())
                rooms[i].facing =
                    measureFacing(*coverage.floors[i], coverage.storeys[i], facing[i]);
            for (FacingResult result : rooms[i].facing) {
                result.rule.zone = site.input.idOf(i, result.rule.zone);
                all.facing.push_back(std::move(result));
            }
            const std::string before = wholeId(site.input.building.document.storeys[i], "");
            for (PrivacyResult result : privacy) {
                if (!result.zone.starts_with(before)) continue;
                result.zone.erase(0, before.size());
                rooms[i].privacy.push_back(std::move(result));
            }
        }
        for (const JudgedRule& rule : judgedRules(all))
            findings.lines.push_back(
                {rule.rule + ": " + rule.finding, rule.is_required && !rule.is_met});
        if (site.coverage != nullptr) addRules(findings.parts, site.placed, coverage, rooms);
    }

  private:
    [[nodiscard]] ByRoom<FacingRule> facingByRoom(const SiteInput& input) const {
        ByRoom<FacingRule> by_room(input.rooms().size());
        for (const FacingRule& rule : facing_)
            forEachRoomOf(
                input, "--facing", rule.zone, [&](std::size_t room, const std::string& own) {
                    FacingRule here = rule;
                    here.zone = own;
                    for (FacingRule& found : facingIn(input.rooms()[room]->environment, {&here, 1}))
                        by_room[room].push_back(std::move(found));
                });
        return by_room;
    }
    [[nodiscard]] ByRoom<PrivacyRule> privacyByRoom(const SiteInput& input) const {
        ByRoom<PrivacyRule> by_room(input.rooms().size());
        for (const PrivacyRule& rule : privacy_)
            forEachRoomOf(
                input, "--privacy", rule.zones, [&](std::size_t room, const std::string& own) {
                    PrivacyRule here = rule;
                    here.zones = own;
                    static_cast<void>(privateZones(here, input.rooms()[room]->environment));
                    by_room[room].push_back(std::move(here));
                });
        return by_room;
    }

    std::vector<std::string> facing_words_, privacy_words_;
    std::vector<FacingRule> facing_;
    std::vector<PrivacyRule> privacy_;
    bool has_zones_ = false;  // --zone is given
};

}  // namespace

std::unique_ptr<ArrangeGroup> makeLayoutRules() { return std::make_unique<LayoutRules>(); }

}  // namespace ispace::camerarules
