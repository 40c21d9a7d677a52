// SPDX-License-Identifier: GPL-3.0-or-later
// One table names the quantiles for text, page and JSON; a single sample has no quantiles. Shares
// are rounded for people only.
#include "extensions/robustness/robustness_report.h"

#include <algorithm>

#include "base/message.h"
#include "base/number.h"
#include "report/coverage_report.h"

namespace ispace::robustness {

namespace {

/// Quantiles that reports list, ascending.
struct NamedQuantile {
    const char *head, *key;
    double share;
};
constexpr NamedQuantile kQuantiles[] = {{"worst", "worst", 0},
                                        {"5 %", "quantile_05", 0.05},
                                        {"median", "median", 0.5},
                                        {"95 %", "quantile_95", 0.95},
                                        {"best", "best", 1}};

std::string figureName(const std::string& name, bool is_exact) {
    return printable(name) + (is_exact ? "" : " (by cells)");
}

std::string idsText(const std::vector<std::string>& ids) {
    std::string text;
    for (const std::string& id : ids) text += (text.empty() ? "" : ", ") + printable(id);
    return text;
}

/// Returns the loss of a requirement's figure; null if that is unknown.
const FigureLoss* lossOf(const Robustness& robustness, Requirement figure) {
    figure.share = 0;
    for (const FigureLoss& loss : robustness.losses)
        if (loss.figure == figure) return &loss;
    return nullptr;
}

bool isMet(const FigureLoss& loss, double share) {
    return loss.worst >= share - (loss.is_exact ? kExactError : 0);
}

void writeShare(JsonWriter& json, const char* key, double value) {
    json.key(key).value(roundSignificant(value));
}

/// Writes the members `count`, `figures` and `requirements`.
void writeSampled(JsonWriter& json, const SampledFigures& sampled,
                  const std::vector<Requirement>& requirements, bool has_error = false) {
    json.key("count").value(sampled.samples);
    json.key("figures").beginArray();
    for (const FigureSpread& figure : sampled.figures) {
        json.beginObject();
        json.key("figure").value(figure.name);
        json.key("exact").value(figure.is_exact);
        writeShare(json, "planned", figure.planned);
        writeShare(json, "mean", figure.mean());
        if (has_error) writeShare(json, "error", standardErrorOf(figure.values));
        for (const NamedQuantile& one : kQuantiles)
            writeShare(json, one.key, figure.quantile(one.share));
        json.endObject();
    }
    json.endArray();
    json.key("requirements").beginArray();
    for (std::size_t i = 0; i < requirements.size(); ++i) {
        json.beginObject();
        json.key("requirement").value(requirementText(requirements[i]));
        json.key("met").value(sampled.met[i]);
        json.endObject();
    }
    json.endArray();
}

void writeFailures(JsonWriter& json, const Robustness& robustness) {
    json.key("failures").beginObject();
    json.key("count").value(robustness.failures);
    json.key("figures").beginArray();
    for (const FigureLoss& loss : robustness.losses) {
        json.beginObject();
        json.key("figure").value(loss.name);
        json.key("exact").value(loss.is_exact);
        writeShare(json, "planned", loss.planned);
        writeShare(json, "worst", loss.worst);
        json.key("sensors").beginArray();
        for (const std::string& id : loss.sensors) json.value(id);
        json.endArray();
        json.endObject();
    }
    json.endArray();
    json.key("requirements").beginArray();
    for (const Requirement& requirement : robustness.requirements) {
        const FigureLoss* const loss = lossOf(robustness, requirement);
        json.beginObject();
        json.key("requirement").value(requirementText(requirement));
        json.key("met").value(loss != nullptr && isMet(*loss, requirement.share));
        json.endObject();
    }
    json.endArray();
    json.endObject();
}

}  // namespace

void RobustnessSection::writeJson(JsonWriter& json) const {
    if (robustness_.mounting) {
        json.key("mounting").beginObject();
        writeShare(json, "distance", robustness_.tolerance.distance);
        writeShare(json, "angle", robustness_.tolerance.angle.degrees());
        writeSampled(json, *robustness_.mounting, robustness_.requirements);
        json.endObject();
    }
    if (robustness_.failures > 0) writeFailures(json, robustness_);
    if (robustness_.crowd) {
        constexpr const char* kNames[] = {"random", "scene", "run"};
        const bool is_random = robustness_.crowd_of == Robustness::CrowdOf::Random;
        json.key("crowd").beginObject();
        json.key("of").value(kNames[static_cast<std::size_t>(robustness_.crowd_of)]);
        if (is_random) json.key("people").value(robustness_.people);
        writeSampled(json, *robustness_.crowd, robustness_.requirements, is_random);
        json.endObject();
    }
}

std::string mountingText(const Robustness& robustness) {
    const int count = robustness.mounting->samples;
    return "mounted within " + formatDouble(robustness.tolerance.distance) + " m and " +
           formatDouble(roundSignificant(robustness.tolerance.angle.degrees())) + " degrees, " +
           std::to_string(count) + (count == 1 ? " time" : " times");
}

std::string crowdText(const Robustness& robustness) {
    const std::string count = std::to_string(robustness.crowd->samples);
    switch (robustness.crowd_of) {
        case Robustness::CrowdOf::Scene:
            return "with the people of the scene";
        case Robustness::CrowdOf::Run:
            return "with the people of the run at " + count + " moments";
        case Robustness::CrowdOf::Random:
            break;
    }
    return "with " + std::to_string(robustness.people) +
           (robustness.people == 1 ? " person" : " people") + " at random, " + count + " times";
}

std::string failuresText(int count) {
    return "any " + std::to_string(count) + (count == 1 ? " sensor fails" : " sensors fail");
}

std::vector<TextRow> spreadRows(const SampledFigures& sampled, bool has_error) {
    std::vector<TextRow> rows = {{"", "planned"}};
    if (sampled.samples == 1) {
        rows.front().emplace_back("measured");
        for (const FigureSpread& figure : sampled.figures)
            rows.push_back({figureName(figure.name, figure.is_exact), percentText(figure.planned),
                            percentText(figure.mean())});
        return rows;
    }
    for (const NamedQuantile& one : kQuantiles) rows.front().emplace_back(one.head);
    rows.front().emplace_back("mean");
    if (has_error) rows.front().emplace_back("error");
    for (const FigureSpread& figure : sampled.figures) {
        TextRow row = {figureName(figure.name, figure.is_exact), percentText(figure.planned)};
        for (const NamedQuantile& one : kQuantiles)
            row.push_back(percentText(figure.quantile(one.share)));
        row.push_back(percentText(figure.mean()));
        if (has_error) row.push_back(percentText(standardErrorOf(figure.values)));
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<TextRow> failureRows(const Robustness& robustness) {
    std::vector<TextRow> rows = {{"", "planned", "worst", "without"}};
    for (const FigureLoss& loss : robustness.losses)
        rows.push_back({figureName(loss.name, loss.is_exact), percentText(loss.planned),
                        percentText(loss.worst), idsText(loss.sensors)});
    return rows;
}

std::vector<std::string> robustRequirements(const Robustness& robustness) {
    std::vector<std::string> sentences;
    for (std::size_t i = 0; i < robustness.requirements.size(); ++i) {
        const Requirement& requirement = robustness.requirements[i];
        const std::string text = printable(requirementText(requirement));
        if (const auto& spread = robustness.mounting)
            sentences.push_back(text + " is met by " + std::to_string(spread->met[i]) + " of " +
                                std::to_string(spread->samples) + " mountings");
        if (const auto& crowd = robustness.crowd; crowd && crowd->samples == 1)
            sentences.push_back(text + (crowd->met[i] == 1 ? " is met " : " is not met ") +
                                crowdText(robustness));
        else if (crowd)
            sentences.push_back(text + " is met by " + std::to_string(crowd->met[i]) + " of " +
                                std::to_string(crowd->samples) + " crowds");
        if (robustness.failures == 0) continue;
        const FigureLoss* const loss = lossOf(robustness, requirement);
        if (loss == nullptr)
            sentences.push_back(text + " is not known for failures");
        else if (isMet(*loss, requirement.share))
            sentences.push_back(text + " is met if " + failuresText(robustness.failures));
        else
            sentences.push_back(text + " is not met without " + idsText(loss->sensors) + ": " +
                                percentText(loss->worst) + " are left");
    }
    return sentences;
}

std::string RobustnessSection::text() const {
    std::string text;
    if (robustness_.mounting)
        text += '\n' + mountingText(robustness_) + ":\n" +
                aligned(spreadRows(*robustness_.mounting), "lr");
    if (robustness_.failures > 0)
        text += "\nif " + failuresText(robustness_.failures) + ":\n" +
                aligned(failureRows(robustness_), "lrrl");
    if (robustness_.crowd)
        text += '\n' + crowdText(robustness_) + ":\n" +
                aligned(spreadRows(*robustness_.crowd,
                                   robustness_.crowd_of == Robustness::CrowdOf::Random),
                        "lr");
    for (const std::string& sentence : robustRequirements(robustness_)) text += sentence + '\n';
    return text;
}

namespace {

/// Makes a table of rows with their heads.
PageTable tableOf(std::string caption, std::string sides, std::vector<TextRow> rows) {
    PageTable table{std::move(caption), std::move(sides), std::move(rows.front()), {}};
    table.rows.assign(std::make_move_iterator(rows.begin() + 1),
                      std::make_move_iterator(rows.end()));
    return table;
}

}  // namespace

PageAdditions RobustnessSection::page(const PageSubject& subject) const {
    if (subject.of == PageSubject::Of::Storey) return {};
    PageSection section{"robustness", "Robustness", {}};
    if (robustness_.mounting)
        section.blocks.push_back(tableOf("sensors " + mountingText(robustness_) + ", at random",
                                         "lr", spreadRows(*robustness_.mounting)));
    if (robustness_.crowd)
        section.blocks.push_back(tableOf(
            crowdText(robustness_), "lr",
            spreadRows(*robustness_.crowd, robustness_.crowd_of == Robustness::CrowdOf::Random)));
    if (robustness_.failures > 0)
        section.blocks.push_back(
            tableOf("if " + failuresText(robustness_.failures), "lrrl", failureRows(robustness_)));
    for (const std::string& sentence : robustRequirements(robustness_))
        section.blocks.push_back(PageText{"Required " + sentence + "."});
    PageAdditions added;
    added.figures.push_back(std::move(section));
    return added;
}

}  // namespace ispace::robustness
