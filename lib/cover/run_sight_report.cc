// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/run_sight_report.h"

#include <algorithm>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "cover/text_table.h"

namespace ispace {

namespace {

constexpr std::size_t kColumns = 4;  // numbers of sensors, the last one and more
constexpr std::size_t kLossesListed = 5;

std::string seconds(double time) { return formatFixed(time, 2) + " s"; }
std::string placeText(Point2 place) {
    return "(" + formatFixed(place.x, 2) + ", " + formatFixed(place.y, 2) + ")";
}

void write(JsonWriter& json, const char* key, double value) {
    json.key(key).value(roundSignificant(value));
}

void write(JsonWriter& json, const char* key, std::vector<double> values) {
    for (double& value : values) value = roundSignificant(value);
    json.key(key).value(values);
}

void write(JsonWriter& json, const RunSightMetrics& metrics) {
    json.beginObject();
    if (!metrics.id.empty()) {
        json.key("id").value(metrics.id);
        json.key("kind").value(metrics.is_person ? "person" : "robot");
    }
    write(json, "duration", metrics.duration);
    write(json, "length", metrics.length);
    write(json, "time_shares", metrics.time_shares);
    write(json, "way_shares", metrics.way_shares);
    json.key("losses").value(metrics.losses);
    json.key("longest_unseen");
    if (const auto& gap = metrics.longest_gap) {
        json.beginObject();
        write(json, "begin", gap->begin);
        write(json, "end", gap->end);
        write(json, "from", {gap->from.x, gap->from.y});
        write(json, "to", {gap->to.x, gap->to.y});
        json.endObject();
    } else {
        json.null();
    }
    json.endObject();
}

/// Of exactly k sensors, of the last column of so many and more.
double shareOf(const std::vector<double>& shares, std::size_t k, bool and_more) {
    double sum = 0;
    for (std::size_t i = k; i < shares.size() && (i == k || and_more); ++i) sum += shares[i];
    return sum;
}

std::size_t columnsOf(const RunSight& run) {
    return std::clamp<std::size_t>(run.all.time_shares.size(), 2, kColumns);
}

TextRow rowOf(const RunSight& run, const RunSightMetrics& metrics, bool is_way) {
    const std::vector<double>& shares = is_way ? metrics.way_shares : metrics.time_shares;
    const std::string who =
        metrics.id.empty() ? "all"
                           : (metrics.is_person ? "person " : "robot ") + printable(metrics.id);
    TextRow row = {who, is_way ? formatFixed(metrics.length, 2) + " m" : seconds(metrics.duration)};
    const std::size_t columns = columnsOf(run);
    for (std::size_t k = 0; k < columns; ++k)
        row.push_back(shares.empty() ? "-" : percentText(shareOf(shares, k, k + 1 == columns), 1));
    if (is_way) return row;
    row.push_back(std::to_string(metrics.losses));
    const auto& gap = metrics.longest_gap;
    row.push_back(gap ? seconds(gap->end - gap->begin) : "-");
    if (gap) row.push_back("from t=" + formatFixed(gap->begin, 2) + " at " + placeText(gap->from));
    return row;
}

std::string tableOf(const RunSight& run, bool is_way) {
    TextRow head = {is_way ? "share of its way" : "share of its time", is_way ? "way" : "there",
                    "unseen"};
    const std::size_t columns = columnsOf(run);
    for (std::size_t k = 1; k < columns; ++k) {
        const bool and_more = k + 1 == columns && run.all.time_shares.size() > columns;
        head.push_back("by " + std::to_string(k) + (and_more ? " and more" : ""));
    }
    if (!is_way) head.insert(head.end(), {"lost", "longest unseen"});
    std::vector<TextRow> rows = {head};
    for (const RunSightMetrics& member : run.members) rows.push_back(rowOf(run, member, is_way));
    if (run.members.size() > 1) rows.push_back(rowOf(run, run.all, is_way));
    std::string sides = "l" + std::string(columns + 3, 'r');
    return aligned(rows, sides + "l");
}

}  // namespace

void writeRun(JsonWriter& json, const RunSight& run) {
    json.key("run").beginObject();
    json.key("record").value(run.name);
    write(json, "begin", run.begin);
    write(json, "end", run.end);
    json.key("members").beginArray();
    for (const RunSightMetrics& member : run.members) write(json, member);
    json.endArray();
    json.key("all");
    write(json, run.all);
    json.key("losses").beginArray();
    for (const SightLoss& loss : run.losses) {
        json.beginObject();
        json.key("id").value(run.members[loss.who].id);
        write(json, "begin", loss.begin);
        write(json, "duration", loss.duration);
        write(json, "place", {loss.place.x, loss.place.y});
        json.endObject();
    }
    json.endArray().endObject();
}

std::string runText(const RunSight& run) {
    std::string text = "run " + printable(run.name) + ", t=" + formatFixed(run.begin, 2) + " to " +
                       formatFixed(run.end, 2) + " s: seen by so many sensors\n" +
                       tableOf(run, false) + "\n" + tableOf(run, true);
    if (run.losses.empty()) return text;
    text += "\nwhere sight was lost:\n";
    std::vector<TextRow> rows;
    for (std::size_t i = 0; i < std::min(kLossesListed, run.losses.size()); ++i) {
        const SightLoss& loss = run.losses[i];
        rows.push_back({" ", printable(run.members[loss.who].id), "at " + placeText(loss.place),
                        "t=" + formatFixed(loss.begin, 2), "for " + seconds(loss.duration)});
    }
    text += aligned(rows, "lllrr");
    if (run.losses.size() > kLossesListed)
        text += "   and " + std::to_string(run.losses.size() - kLossesListed) + " shorter\n";
    return text;
}

}  // namespace ispace
