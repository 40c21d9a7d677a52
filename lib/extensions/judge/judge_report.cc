// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/judge/judge_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace::judge {

namespace {

/// A figure that requirements name, and that JSON has as a member.
struct Figure {
    std::string_view key, words;
    bool is_share = false, is_least = false;  ///< in per cent; more is better
    std::optional<double> (*of)(const Judgement&);
};

double countOf(std::size_t number) { return static_cast<double>(number); }

constexpr std::array kFigures = {
    Figure{"mota", "MOTA", true, true,
           [](const Judgement& j) -> std::optional<double> { return j.clear.mota; }},
    Figure{"motp", "MOTP, m", false, false, [](const Judgement& j) { return j.motp(); }},
    Figure{"idf1", "IDF1", true, true,
           [](const Judgement& j) -> std::optional<double> { return j.identity.idf1; }},
    Figure{"hota", "HOTA", true, true,
           [](const Judgement& j) -> std::optional<double> { return j.hota.hota; }},
    Figure{"ospa", "OSPA(2), m", false, false,
           [](const Judgement& j) -> std::optional<double> { return j.ospa; }},
    Figure{"deta", "of HOTA: detection", true, true,
           [](const Judgement& j) -> std::optional<double> { return j.hota.detection; }},
    Figure{"assa", "of HOTA: association", true, true,
           [](const Judgement& j) -> std::optional<double> { return j.hota.association; }},
    Figure{"misses", "misses", false, false,
           [](const Judgement& j) -> std::optional<double> { return countOf(j.clear.misses); }},
    Figure{"false_positives", "false positives", false, false,
           [](const Judgement& j) -> std::optional<double> {
               return countOf(j.clear.false_positives);
           }},
    Figure{"switches", "switches", false, false,
           [](const Judgement& j) -> std::optional<double> { return countOf(j.clear.switches); }},
    Figure{"fragments", "fragments", false, false,
           [](const Judgement& j) -> std::optional<double> { return countOf(j.clear.fragments); }},
    Figure{"latency", "latency, s", false, false, [](const Judgement& j) { return j.latency; }},
};

bool isCount(const Figure& figure) {
    return figure.key == "misses" || figure.key == "false_positives" || figure.key == "switches" ||
           figure.key == "fragments";
}

std::string valueText(const Figure& figure, std::optional<double> value) {
    if (!value) return "-";
    constexpr double kPercent = 100;
    return figure.is_share   ? formatFixed(kPercent * *value, 2) + " %"
           : isCount(figure) ? formatFixed(*value, 0)
                             : formatFixed(*value, 3);
}

std::string trackName(const Judgement& judgement, std::optional<std::size_t> track) {
    return track ? judgement.judged.tracks[*track] : std::string("-");
}

/// The row of a class: name, truths, found, distance, switches.
TextRow rowOf(const ClassFigures& one) {
    constexpr double kPercent = 100;
    const auto truths = static_cast<double>(one.truths), matches = static_cast<double>(one.matches);
    return {printable(one.name), std::to_string(one.truths),
            one.truths == 0 ? "-" : formatFixed(kPercent * matches / truths, 2) + " %",
            one.matches == 0 ? "-" : formatFixed(one.distance / matches, 3),
            std::to_string(one.switches)};
}

TextRow lossRow(const Judgement& judgement, std::size_t index) {
    const Loss& loss = judgement.losses[index];
    return {std::to_string(index + 1),
            formatFixed(loss.begin, 2),
            formatFixed(loss.end - loss.begin, 2),
            printable(judgement.judged.truths[loss.truth].id),
            formatFixed(loss.place.x, 2) + "," + formatFixed(loss.place.y, 2),
            std::string(nameOf(loss.reason)),
            printable(trackName(judgement, loss.before)),
            printable(trackName(judgement, loss.after))};
}

const TextRow kClassHeads = {"", "truths", "found", "mean m", "switches"};
const TextRow kLossHeads = {"loss", "t", "s", "mover", "at", "why", "track", "then"};

/// "38 losses: 20 unseen, 10 crossing, 8 other"
std::string lossesPhrase(const Judgement& judgement) {
    std::array<std::size_t, 4> counts{};
    for (const Loss& loss : judgement.losses) ++counts[static_cast<std::size_t>(loss.reason)];
    std::string text = std::to_string(judgement.losses.size()) +
                       (judgement.losses.size() == 1 ? " loss" : " losses");
    std::string parts;
    for (const LossReason reason :
         {LossReason::Entry, LossReason::Unseen, LossReason::Crossing, LossReason::Other})
        if (const std::size_t count = counts[static_cast<std::size_t>(reason)]; count > 0)
            parts += (parts.empty() ? ": " : ", ") + std::to_string(count) + " " +
                     std::string(nameOf(reason));
    return text + parts;
}

/// "2 movers, 61 frames of 0.1 s, 122 truths; 2 tracks"
std::string sizePhrase(const Judgement& judgement) {
    const JudgedRun& judged = judgement.judged;
    return std::to_string(judged.truths.size()) + " movers, " +
           std::to_string(judged.times.size()) + " frames of " +
           formatDouble(std::round(judged.interval * 1e6) / 1e6) + " s, " +
           std::to_string(judgement.clear.matches + judgement.clear.misses) + " truths; " +
           std::to_string(judged.tracks.size()) + " tracks";
}

}  // namespace

std::optional<double> Judgement::motp() const {
    if (clear.matches == 0) return {};
    return 1 - clear.similarity / static_cast<double>(clear.matches);
}

TrackRequirement parseTrackRequirement(const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals);
    const auto figure = std::find_if(kFigures.begin(), kFigures.end(),
                                     [&](const Figure& one) { return one.key == name; });
    if (figure == kFigures.end()) {
        std::string names;
        for (const Figure& one : kFigures)
            names += (names.empty() ? "" : ", ") + std::string(one.key);
        throw UsageError("--require: `" + text + "` names no figure of tracks: " + names +
                         ", as in mota=90% or motp=0.2");
    }
    std::string value = text.substr(std::min(equals + 1, text.size()));
    const bool is_percent = value.ends_with('%');
    if (is_percent) value.pop_back();
    const std::optional<double> number = parseDouble(value);
    constexpr double kPercent = 100;
    if (!number || (is_percent && !figure->is_share))
        throw UsageError("--require: `" + text + "` needs a number after the =" +
                         (figure->is_share ? ", such as 90%" : ""));
    return {name, is_percent ? *number / kPercent : *number, figure->is_least, text};
}

std::string unmetText(const TrackRequirement& requirement, const Judgement& judgement) {
    const auto figure = std::find_if(kFigures.begin(), kFigures.end(), [&](const Figure& one) {
        return one.key == requirement.figure;
    });
    const std::optional<double> value = figure->of(judgement);
    const bool is_met =
        value && (requirement.is_least ? *value >= requirement.bound : *value <= requirement.bound);
    if (is_met) return "";
    return requirement.figure + " is " + valueText(*figure, value) + ", required is " +
           (requirement.is_least ? "at least " : "at most ") +
           valueText(*figure, requirement.bound) + " (" + requirement.text + ")";
}

std::string judgementJson(const Judgement& judgement) {
    const JudgedRun& judged = judgement.judged;
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-tracks/1");
    json.key("tool").value("coverage").key("version").value(version());
    json.key("run").value(judgement.run).key("file").value(judgement.file);
    json.key("frames").value(judged.times.size()).key("interval").value(judged.interval);
    json.key("movers").value(judged.truths.size()).key("tracks").value(judged.tracks.size());
    json.key("truths").value(judgement.clear.matches + judgement.clear.misses);
    json.key("rows_outside").value(judged.rows_outside);
    for (const Figure& figure : kFigures) {
        json.key(figure.key);
        const std::optional<double> value = figure.of(judgement);
        if (value && isCount(figure))
            json.value(static_cast<std::int64_t>(*value));
        else
            json.value(value);
    }
    json.key("loca").value(judgement.hota.localisation);
    json.key("matches").value(judgement.clear.matches);
    json.key("idtp").value(judgement.identity.true_positives);
    json.key("idfp").value(judgement.identity.false_positives);
    json.key("idfn").value(judgement.identity.misses);
    json.key("mostly_tracked").value(judgement.clear.mostly_tracked);
    json.key("partly_tracked").value(judgement.clear.partly_tracked);
    json.key("mostly_lost").value(judgement.clear.mostly_lost);
    for (const ClassTable& table : judgement.tables) {
        json.key("by_" + table.name).beginArray();
        for (const ClassFigures& one : table.classes) {
            json.beginObject().key(table.name).value(one.name).key("truths").value(one.truths);
            json.key("matches").value(one.matches).key("switches").value(one.switches);
            json.key("motp");
            if (one.matches == 0)
                json.null();
            else
                json.value(one.distance / static_cast<double>(one.matches));
            json.endObject();
        }
        json.endArray();
    }
    json.key("losses").beginArray();
    for (const Loss& loss : judgement.losses) {
        json.beginObject().key("t").value(loss.begin).key("duration").value(loss.end - loss.begin);
        json.key("id").value(judged.truths[loss.truth].id);
        json.key("at").beginArray().value(loss.place.x).value(loss.place.y).endArray();
        json.key("why").value(nameOf(loss.reason));
        for (const auto& [key, track] :
             {std::pair("track", loss.before), std::pair("then", loss.after)}) {
            json.key(key);
            if (track)
                json.value(judged.tracks[*track]);
            else
                json.null();
        }
        json.endObject();
    }
    return json.endArray().endObject().take() + '\n';
}

std::string judgementText(const Judgement& judgement) {
    std::vector<TextRow> rows;
    rows.reserve(kFigures.size());
    for (const Figure& figure : kFigures)
        rows.push_back({std::string(figure.words), valueText(figure, figure.of(judgement))});
    std::string text = "tracks " + printable(judgement.file) + " of run " +
                       printable(judgement.run) + ": " + sizePhrase(judgement) + "\n" +
                       aligned(rows, "lr");
    for (const ClassTable& table : judgement.tables) {
        std::vector<TextRow> lines = {kClassHeads};
        lines.front().front() = table.head;
        for (const ClassFigures& one : table.classes) lines.push_back(rowOf(one));
        text += "\n" + aligned(lines, "lr");
    }
    text += "\n" + lossesPhrase(judgement) + "\n";
    if (judgement.losses.empty()) return text;
    std::vector<TextRow> lines = {kLossHeads};
    for (std::size_t i = 0; i < judgement.losses.size(); ++i)
        lines.push_back(lossRow(judgement, i));
    return text + aligned(lines, "rrrllll");
}

ReportPage judgementPage(const Judgement& judgement, const Scene& scene,
                         const std::string& command) {
    ReportPage page{"Tracks of " + judgement.run, judgement.file + ": " + sizePhrase(judgement)};
    PageTable figures{"", "lr", {"figure", "value"}, {}};
    figures.rows.reserve(kFigures.size());
    for (const Figure& figure : kFigures)
        figures.rows.push_back(
            {std::string(figure.words), valueText(figure, figure.of(judgement))});
    PageSection first{"figures", "Figures", {std::move(figures)}};
    first.blocks.emplace_back(
        PageFigure{"Ways of the movers: found in grey, lost in red, losses by their numbers",
                   judgementMap(judgement, scene, "", 1200)});
    page.sections.push_back(std::move(first));
    PageSection classes{"classes", "Where and when"};
    for (const ClassTable& table : judgement.tables) {
        PageTable one{"", "lr", kClassHeads, {}};
        one.heads.front() = table.head;
        for (const ClassFigures& figures_of : table.classes) one.rows.push_back(rowOf(figures_of));
        classes.blocks.emplace_back(std::move(one));
    }
    if (!classes.blocks.empty()) page.sections.push_back(std::move(classes));
    PageSection losses{"losses", "Losses", {PageText{lossesPhrase(judgement) + "."}}};
    if (!judgement.losses.empty()) {
        PageTable table{"", "rrrllll", kLossHeads, {}};
        constexpr std::size_t kMostRows = 200;
        const std::size_t count = std::min(judgement.losses.size(), kMostRows);
        for (std::size_t i = 0; i < count; ++i) table.rows.push_back(lossRow(judgement, i));
        losses.blocks.emplace_back(std::move(table));
        if (count < judgement.losses.size())
            losses.blocks.emplace_back(PageText{
                "The first " + std::to_string(count) + " of them; --json has all.", Tone::Small});
    }
    page.sections.push_back(std::move(losses));
    page.sections.push_back({"command", "Command", {PageCode{command}}});
    return page;
}

}  // namespace ispace::judge
