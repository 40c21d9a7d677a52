// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the coverage of a run: text, JSON, and ways coloured on a map by the number of sensors.
#include "extensions/runs/run_report.h"

#include <algorithm>
#include <array>

#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "report/coverage_report.h"
#include "report/map/map_layer.h"
#include "report/map/map_parts.h"

namespace ispace::runs {

namespace {

constexpr std::size_t kColumns = 4;  // numbers of sensors; the last column includes greater ones
constexpr std::size_t kLossesListed = 5;

std::string seconds(double time) { return formatFixed(time, 2) + " s"; }
std::string pointText(Point2 place) {
    return "(" + formatFixed(place.x, 2) + ", " + formatFixed(place.y, 2) + ")";
}

void writeMember(JsonWriter& json, const char* key, double value) {
    json.key(key).value(roundSignificant(value));
}

void writeMember(JsonWriter& json, const char* key, std::vector<double> values) {
    for (double& value : values) value = roundSignificant(value);
    json.key(key).value(values);
}

void writeMember(JsonWriter& json, const RunCoverageMetrics& metrics) {
    json.beginObject();
    if (!metrics.id.empty()) {
        json.key("id").value(metrics.id);
        json.key("kind").value(metrics.is_person ? "person" : "robot");
    }
    writeMember(json, "duration", metrics.duration);
    writeMember(json, "length", metrics.length);
    writeMember(json, "time_shares", metrics.time_shares);
    writeMember(json, "way_shares", metrics.way_shares);
    json.key("losses").value(metrics.losses);
    json.key("longest_unseen");
    if (const auto& gap = metrics.longest_gap) {
        json.beginObject();
        writeMember(json, "begin", gap->begin);
        writeMember(json, "end", gap->end);
        writeMember(json, "from", {gap->from.x, gap->from.y});
        writeMember(json, "to", {gap->to.x, gap->to.y});
        json.endObject();
    } else {
        json.null();
    }
    json.endObject();
}

/// Returns the share of exactly k sensors; with `and_more`, of k or more.
double shareOf(const std::vector<double>& shares, std::size_t k, bool and_more) {
    double sum = 0;
    for (std::size_t i = k; i < shares.size() && (i == k || and_more); ++i) sum += shares[i];
    return sum;
}

std::size_t columnsOf(const RunCoverage& run) {
    return std::clamp<std::size_t>(run.all.time_shares.size(), 2, kColumns);
}

TextRow rowOf(const RunCoverage& run, const RunCoverageMetrics& metrics, bool is_way) {
    const std::vector<double>& shares = is_way ? metrics.way_shares : metrics.time_shares;
    const std::string who =
        metrics.id.empty() ? "all"
                           : (metrics.is_person ? "person " : "robot ") + printable(metrics.id);
    TextRow row = {who, is_way ? formatFixed(metrics.length, 2) + " m" : seconds(metrics.duration)};
    const std::size_t columns = columnsOf(run);
    for (std::size_t k = 0; k < columns; ++k)
        row.push_back(shares.empty() ? "-" : percentText(shareOf(shares, k, k + 1 == columns)));
    if (is_way) return row;
    row.push_back(std::to_string(metrics.losses));
    const auto& gap = metrics.longest_gap;
    row.push_back(gap ? seconds(gap->end - gap->begin) : "-");
    if (gap) row.push_back("from t=" + formatFixed(gap->begin, 2) + " at " + pointText(gap->from));
    return row;
}

std::string tableOf(const RunCoverage& run, bool is_way) {
    TextRow head = {is_way ? "share of its way" : "share of its time", is_way ? "way" : "there",
                    "unseen"};
    const std::size_t columns = columnsOf(run);
    for (std::size_t k = 1; k < columns; ++k) {
        const bool and_more = k + 1 == columns && run.all.time_shares.size() > columns;
        head.push_back("by " + std::to_string(k) + (and_more ? " and more" : ""));
    }
    if (!is_way) head.insert(head.end(), {"lost", "longest unseen"});
    std::vector<TextRow> rows = {head};
    for (const RunCoverageMetrics& member : run.members) rows.push_back(rowOf(run, member, is_way));
    if (run.members.size() > 1) rows.push_back(rowOf(run, run.all, is_way));
    std::string sides = "l" + std::string(columns + 3, 'r');
    return aligned(rows, sides + "l");
}

constexpr std::size_t kListed = 20;

std::string timesText(std::size_t times) {
    return std::to_string(times) + (times == 1 ? " time" : " times");
}

std::string contactRows(const RunCoverage& run) {
    std::vector<TextRow> rows;
    for (const RunContact& contact : run.contacts) {
        if (rows.size() == kListed) break;
        rows.push_back({" ", printable(contact.id) + " ran into " + printable(contact.other),
                        "at " + pointText(contact.at), "t=" + formatFixed(contact.first, 2),
                        timesText(contact.times)});
    }
    std::string text = aligned(rows, "lllrr");
    if (run.contacts.size() > kListed)
        text += "   and " + std::to_string(run.contacts.size() - kListed) + " more\n";
    return text;
}

std::string unreachedRows(const RunCoverage& run) {
    std::vector<TextRow> rows;
    for (const UnreachedTarget& target : run.unreached) {
        if (rows.size() == kListed) break;
        const std::string to = printable(target.to) + (target.to.empty() ? "" : " ") +
                               (target.at ? pointText(*target.at) : "");
        rows.push_back({" ", printable(target.id), "to " + to, "t=" + formatFixed(target.first, 2),
                        timesText(target.times)});
    }
    std::string text = aligned(rows, "lllrr");
    if (run.unreached.size() > kListed)
        text += "   and " + std::to_string(run.unreached.size() - kListed) + " more\n";
    return text;
}

std::string runText(const RunCoverage& run) {
    std::string text = "run " + printable(run.name) + ", t=" + formatFixed(run.begin, 2) + " to " +
                       formatFixed(run.end, 2) + " s: seen by so many sensors\n" +
                       tableOf(run, false) + "\n" + tableOf(run, true);
    if (!run.contacts.empty()) text += "\ncollisions:\n" + contactRows(run);
    if (!run.unreached.empty()) text += "\ngiven up on the way:\n" + unreachedRows(run);
    if (run.losses.empty()) return text;
    text += "\nwhere sight was lost:\n";
    std::vector<TextRow> rows;
    for (std::size_t i = 0; i < std::min(kLossesListed, run.losses.size()); ++i) {
        const TrackLoss& loss = run.losses[i];
        rows.push_back({" ", printable(run.members[loss.member].id),
                        "at " + (loss.room.empty() ? "" : loss.room + '/') + pointText(loss.place),
                        "t=" + formatFixed(loss.begin, 2), "for " + seconds(loss.duration)});
    }
    text += aligned(rows, "lllrr");
    if (run.losses.size() > kLossesListed)
        text += "   and " + std::to_string(run.losses.size() - kLossesListed) + " shorter\n";
    return text;
}

}  // namespace

void RunSection::writeJson(JsonWriter& json) const {
    json.key("run").beginObject();
    json.key("record").value(run_.name);
    writeMember(json, "begin", run_.begin);
    writeMember(json, "end", run_.end);
    json.key("members").beginArray();
    for (const RunCoverageMetrics& member : run_.members) writeMember(json, member);
    json.endArray();
    json.key("all");
    writeMember(json, run_.all);
    json.key("losses").beginArray();
    for (const TrackLoss& loss : run_.losses) {
        json.beginObject();
        json.key("id").value(run_.members[loss.member].id);
        if (!loss.room.empty()) json.key("room").value(loss.room);
        writeMember(json, "begin", loss.begin);
        writeMember(json, "duration", loss.duration);
        writeMember(json, "place", {loss.place.x, loss.place.y});
        json.endObject();
    }
    json.endArray();
    json.key("unreached").beginArray();
    for (const UnreachedTarget& target : run_.unreached) {
        json.beginObject();
        json.key("id").value(target.id);
        if (!target.to.empty()) json.key("to").value(target.to);
        if (target.at) writeMember(json, "place", {target.at->x, target.at->y});
        writeMember(json, "first", target.first);
        json.key("times").value(target.times);
        json.endObject();
    }
    json.endArray();
    json.key("contacts").beginArray();
    for (const RunContact& contact : run_.contacts) {
        json.beginObject();
        json.key("id").value(contact.id).key("other").value(contact.other);
        writeMember(json, "place", {contact.at.x, contact.at.y});
        writeMember(json, "first", contact.first);
        json.key("times").value(contact.times);
        json.endObject();
    }
    json.endArray().endObject();
}

namespace {

/// Colours of ways seen by 0, 1, 2 and more sensors: Okabe and Ito's vermilion, orange, green, and
/// ink. All have a white rim, as floor is blue; in grey, the dashes of the first identify it.
constexpr std::array<std::uint32_t, 4> kRunColors = {0xD55E00, 0xF0A000, 0x00845F, 0x1F2328};

std::size_t classOf(std::size_t sensors) { return std::min(sensors, kRunColors.size() - 1); }

Stroke strokeOf(std::size_t run_class, double em) {
    Stroke stroke{Color::rgb(kRunColors[run_class]), em / 5};
    if (run_class == 0) stroke.dashes = {em / 2, em / 4};
    return stroke;
}

constexpr std::size_t kMaxMarked = 50;

/// Draws the ways of a run, and rings where sight was lost.
class RunLayer final : public MapLayer {
  public:
    explicit RunLayer(const RunCoverage& run) : run_(run) {}
    [[nodiscard]] std::string_view name() const override { return "ways of the run"; }
    void draw(Picture& picture, const MapPicture& map) const override {
        std::array<std::vector<std::vector<Point2>>, kRunColors.size()> chains;
        const double tolerance = 0.2 / map.view.scale;
        for (const SeenPath& way : run_.ways)
            if (way.points.size() > 1)
                chains[classOf(way.sensors)].push_back(thinned(way.points, tolerance));
        picture.pushView(map.view);
        for (const auto& some : chains)
            picture.lines(some, {Stroke{palette::kWhite.faded(0.8), map.em / 2.6}});
        for (std::size_t i = chains.size(); i-- > 0;)
            picture.lines(chains[i], {strokeOf(i, map.em)});
        picture.pop();
        for (std::size_t i = 0; i < std::min(kMaxMarked, run_.losses.size()); ++i)
            drawChosenRing(picture, map.view * run_.losses[i].place, 0.5 * map.em, map.em);
    }

    [[nodiscard]] std::optional<LegendBlock> legend() const override {
        using Sign = LegendItem::Sign;
        LegendBlock block{"Ways seen by", {}, {"time", "way"}};
        const auto share = [](const std::vector<double>& shares, std::size_t k) {
            double sum = 0;
            for (std::size_t i = k; i < shares.size(); ++i)
                if (classOf(i) == k) sum += shares[i];
            return shares.empty() ? std::string("–") : percentText(sum);
        };
        for (std::size_t k = 0; k < kRunColors.size(); ++k) {
            if (k > 1 && k >= run_.all.time_shares.size()) break;
            std::string text = k == 0 ? "no sensor" : std::to_string(k);
            if (k > 0) text += k == 1 ? " sensor" : " sensors";
            if (k + 1 == kRunColors.size()) text = std::to_string(k) + " and more";
            LegendItem item{
                k == 0 ? Sign::Dashes : Sign::Line, Color::rgb(kRunColors[k]), {}, text, ""};
            item.value = share(run_.all.time_shares, k);
            item.second = share(run_.all.way_shares, k);
            block.items.push_back(std::move(item));
        }
        if (!run_.losses.empty())
            block.items.push_back(
                {Sign::Ring, {}, {}, "sight was lost", std::to_string(run_.losses.size()) + " ×"});
        if (const auto& gap = run_.all.longest_gap)
            block.items.push_back(
                {Sign::None, {}, {}, "longest unseen", seconds(gap->end - gap->begin)});
        return block;
    }

  private:
    const RunCoverage& run_;
};

/// Tells for which share of their time movers were seen, and the longest time without sight.
/// \param movers e.g. "robots and people"
PageText sightInRun(const RunCoverage& run, const std::string& movers) {
    return {"In the run of " + formatFixed(run.end - run.begin, 2) + " s " + movers +
            " were seen for " + percentText(1 - run.all.time_shares.front()) + " of their time; " +
            (run.all.longest_gap
                 ? "the longest time without sight was " +
                       formatFixed(run.all.longest_gap->end - run.all.longest_gap->begin, 2) + " s."
                 : "sight was never lost.")};
}

/// Tells of collisions and of targets that were given up; empty without any.
std::vector<PageText> incidentsOf(const RunCoverage& run) {
    static constexpr std::size_t kNamed = 3;
    const auto told = [](const std::string& head, std::span<const std::string> all) {
        std::string text = head;
        for (std::size_t i = 0; i < std::min(kNamed, all.size()); ++i)
            text += (i > 0 ? ", " : " ") + all[i];
        if (all.size() > kNamed) text += " and " + std::to_string(all.size() - kNamed) + " more";
        return PageText{text + ".", Tone::Bad};
    };
    std::vector<std::string> contacts, targets;
    for (const RunContact& one : run.contacts) contacts.push_back(one.id + " into " + one.other);
    for (const UnreachedTarget& one : run.unreached)
        targets.push_back(one.id + " to " +
                          (one.to.empty() && one.at ? pointText(*one.at) : one.to));
    std::vector<PageText> texts;
    if (!contacts.empty()) texts.push_back(told("Movers collided:", contacts));
    if (!targets.empty()) texts.push_back(told("Ways were given up:", targets));
    return texts;
}

}  // namespace

RunSection::RunSection(const RunCoverage& run, bool is_of_storey)
    : run_(run),
      is_silent_(is_of_storey && run.members.empty()),
      layer_(std::make_unique<RunLayer>(run)) {}

RunSection::~RunSection() = default;

std::string RunSection::text() const { return is_silent_ ? "" : '\n' + runText(run_); }

const MapLayer* RunSection::mapLayer() const { return is_silent_ ? nullptr : layer_.get(); }

PageAdditions RunSection::page(const PageSubject& subject) const {
    using Of = PageSubject::Of;
    static constexpr const char* kCaption =
        "Ways of robots and people by the number of sensors that saw them.";
    PageAdditions added;
    if (is_silent_) return added;
    if (subject.of == Of::Storey) {
        added.caption = kCaption;
        added.tables.emplace_back(PageCode{runText(run_)});
        return added;
    }
    added.title = "run";
    if (!run_.all.time_shares.empty())
        added.sight.push_back(sightInRun(
            run_, subject.of == Of::Site ? "robots and people on storeys" : "robots and people"));
    for (PageText& text : incidentsOf(run_)) added.sight.push_back(std::move(text));
    if (subject.of == Of::Site) {
        added.tables.emplace_back(PageCode{runText(run_)});
        return added;
    }
    MapOptions options;
    options.layers = {layer_.get()};
    added.closing.push_back(
        {"run",
         "Recorded run",
         {PageFigure{kCaption, coverageMap(*subject.scene, *subject.coverage, options)},
          PageCode{runText(run_)}}});
    return added;
}

}  // namespace ispace::runs
