// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/coverage_rules.h"

#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "extensions/camerarules/site_rules.h"

namespace ispace::camerarules {

namespace {

class CoverageRules final : public CoverageGroup {
  public:
    void declare(CommandLine& line) override {
        line.group("Faces and privacy");
        line.texts(
            "--facing", "ZONE[,DEG[,HEADING]][=SHARE]", facing_words_,
            "report the share of a zone where cameras see faces: within this angle (45deg) of "
            "the heading in which people walk there, by default through the doors on its border; "
            "door:GLOB[,M][,DEG] is the floor within M of doors (1.5m, 45deg); exit with 3 if "
            "less than SHARE",
            Enters::History);
        line.texts("--privacy", "ZONE[,D]", privacy_words_,
                   "exit with 3 if a camera sees some of these zones (globs allowed), or sees it "
                   "with at least D pixels a metre, a number or a density class",
                   Enters::History);
    }

    void take(const CommandLine& /*line*/) override {
        for (const std::string& text : facing_words_)
            facing_.push_back(ofOption("--facing", [&] { return parseFacing(text); }));
        for (const std::string& text : privacy_words_)
            privacy_.push_back(ofOption("--privacy", [&] { return parsePrivacy(text); }));
    }

    [[nodiscard]] bool isAsked() const override {
        return !facing_words_.empty() || !privacy_words_.empty();
    }
    [[nodiscard]] bool wantsWholeDensities() const override { return isAsked(); }
    [[nodiscard]] bool judgesAlone() const override { return !privacy_words_.empty(); }

    void measure(const MeasuredSite& site, CoverageFindings& findings) override {
        for (FacingRule& rule : facing_) rule.zone = inOwnStorey(site.input, rule.zone);
        for (PrivacyRule& rule : privacy_) rule.zones = inOwnStorey(site.input, rule.zones);
        const SiteScene& building = site.input.building;
        const std::vector<CameraRules> rules =
            measureSiteRules(building, site.coverage, site.how, facing_, privacy_);
        if (!facing_.empty() && site.how.plane == 0)
            report(site.common, "coverage", std::string(kFacesOnFloor));
        addRules(findings.parts, building, site.coverage, rules);
        for (JudgedRule& rule : judgedInSite(building, rules)) {
            if (!rule.is_required) continue;
            std::string text = rule.rule + ": " + rule.finding;
            findings.judged.push_back({std::move(rule.rule), "", {rule.is_met, std::move(text)}});
        }
    }

  private:
    std::vector<std::string> facing_words_, privacy_words_;
    std::vector<FacingRule> facing_;
    std::vector<PrivacyRule> privacy_;
};

}  // namespace

std::unique_ptr<CoverageGroup> makeCoverageRules() { return std::make_unique<CoverageRules>(); }

}  // namespace ispace::camerarules
