// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/camera_rules_report.h"

#include <optional>
#include <string_view>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "env/zone.h"
#include "report/report_section.h"

namespace ispace::camerarules {

namespace {

std::string ruleDegrees(Angle angle) { return formatDouble(roundSignificant(angle.degrees())); }

void writeNumber(JsonWriter& json, const char* key, const std::optional<double>& value) {
    json.key(key);
    if (value)
        json.value(roundSignificant(*value));
    else
        json.null();
}

/// Tells a rule without the words of options: "faces at the door Front, up to 1.5 m from it".
std::string plainText(const FacingRule& facing) {
    if (!facing.zone.starts_with(kDoorPrefix)) return "faces in the zone " + printable(facing.zone);
    const std::string_view door = std::string_view(facing.zone).substr(kDoorPrefix.size());
    const std::size_t comma = door.rfind(',');
    std::string text = "faces at the door ";
    text += printable(door.substr(0, comma));
    if (comma != std::string_view::npos)
        text.append(", up to ").append(printable(door.substr(comma + 1))).append(" m from it");
    return text;
}

JudgedRule judged(const FacingResult& result) {
    const FacingRule& facing = result.rule;
    const bool is_of_door = facing.zone.starts_with(kDoorPrefix);
    std::string name = "facing " + printable(facing.zone);
    if (!is_of_door && !facing.door.empty()) name += " through " + printable(facing.door);
    name += " within " + ruleDegrees(facing.within) + " degrees of ";
    std::string_view separator;
    for (const FacingPart& part : facing.parts) {
        name.append(separator).append(ruleDegrees(part.heading));
        separator = " and ";
    }
    JudgedRule rule{std::move(name), isMet(result), facing.required.has_value(), plainText(facing),
                    ""};
    if (!result.share)
        rule.finding = "is not known: a view is known by cells only";
    else
        rule.finding =
            percentText(*result.share) + " of " + formatFixed(result.area, 2) + " m2 is seen";
    if (result.rule.required)
        rule.finding += ", required are " + formatPercent(*result.rule.required);
    return rule;
}

JudgedRule judged(const PrivacyResult& result) {
    JudgedRule rule{"privacy of " + printable(result.zone), isMet(result), true, "", ""};
    if (result.density > 0)
        rule.rule += " from " + formatDouble(result.density) + " pixels a metre";
    if (!result.seen) {
        rule.finding = "is not known: a view is known by cells only";
        return rule;
    }
    if (isMet(result)) {
        rule.finding = "is kept";
        return rule;
    }
    rule.finding = formatFixed(*result.seen, *result.seen < 0.01 ? 4 : 2) + " of " +
                   formatFixed(result.area, 2) + " m2 is seen";
    std::string ids;
    for (const std::string& id : result.cameras) ids += (ids.empty() ? "" : ", ") + printable(id);
    if (!ids.empty()) rule.finding += " by " + ids;
    return rule;
}

}  // namespace

std::vector<JudgedRule> judgedRules(const CameraRules& rules) {
    std::vector<JudgedRule> all;
    for (const FacingResult& result : rules.facing) all.push_back(judged(result));
    for (const PrivacyResult& result : rules.privacy) all.push_back(judged(result));
    return all;
}

void RulesSection::writeJson(JsonWriter& json) const {
    if (!rules_.facing.empty()) {
        json.key("facing").beginArray();
        for (const FacingResult& result : rules_.facing) {
            json.beginObject();
            json.key("zone").value(result.rule.zone);
            if (!result.rule.door.empty()) json.key("door").value(result.rule.door);
            writeNumber(json, "within", result.rule.within.degrees());
            writeNumber(json, "heading", result.rule.heading.degrees());
            if (result.rule.parts.size() > 1) {
                json.key("headings").beginArray();
                for (const FacingPart& part : result.rule.parts)
                    json.value(roundSignificant(part.heading.degrees()));
                json.endArray();
            }
            writeNumber(json, "area", result.area);
            writeNumber(json, "coverage", result.share);
            if (result.rule.required) writeNumber(json, "required", result.rule.required);
            json.key("met").value(isMet(result));
            json.endObject();
        }
        json.endArray();
    }
    if (rules_.privacy.empty()) return;
    json.key("privacy").beginArray();
    for (const PrivacyResult& result : rules_.privacy) {
        json.beginObject();
        json.key("zone").value(result.zone);
        writeNumber(json, "density", result.density);
        writeNumber(json, "area", result.area);
        writeNumber(json, "seen_area", result.seen);
        json.key("cameras").beginArray();
        for (const std::string& id : result.cameras) json.value(id);
        json.endArray();
        json.key("met").value(isMet(result));
        json.endObject();
    }
    json.endArray();
}

std::string RulesSection::text() const {
    std::string text;
    for (const JudgedRule& rule : judgedRules(rules_))
        text += rule.rule + ": " + rule.finding + '\n';
    return text.empty() ? "" : '\n' + text;
}

PageTable rulesTable(std::string caption, std::span<const JudgedRule> rules) {
    PageTable table{std::move(caption), "lll", {"rule", "result", "measured"}, {}};
    for (const JudgedRule& rule : rules) {
        table.rows.push_back({rule.plain.empty() ? rule.rule : rule.plain,
                              !rule.is_required ? "-"
                              : rule.is_met     ? "met"
                                                : "not met",
                              rule.finding});
        table.tones.push_back(!rule.is_required ? Tone::Plain
                              : rule.is_met     ? Tone::Good
                                                : Tone::Bad);
    }
    return table;
}

PageAdditions RulesSection::page(const PageSubject& subject) const {
    PageAdditions added;
    if (subject.of != PageSubject::Of::Room) return added;
    const std::vector<JudgedRule> rules = judgedRules(rules_);
    for (const JudgedRule& one : rules)
        if (one.is_required)
            added.judged.push_back(
                {"Required: " +
                     (one.plain.empty() ? one.rule
                                        : one.plain + facesJudgedAtText(subject.report)) +
                     ": " + outcomeText(one.is_met, one.finding),
                 one.is_met ? Tone::Good : Tone::Bad});
    added.figures.push_back({"rules",
                             "Faces and privacy",
                             {rulesTable("directions of faces" + facesJudgedAtText(subject.report) +
                                             ", and zones that cameras must not see",
                                         rules)}});
    return added;
}

}  // namespace ispace::camerarules
