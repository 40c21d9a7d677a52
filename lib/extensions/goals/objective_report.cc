// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/objective_report.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "report/coverage_report.h"
#include "report/map/map_layer.h"
#include "report/map/map_parts.h"

namespace ispace::goals {

namespace {

std::string errorText(const std::optional<double>& error) {
    constexpr double kMillimetre = 0.001;
    if (!error) return "unknown";
    return *error < 1 ? formatFixed(*error / kMillimetre, 1) + " mm"
                      : formatFixed(*error, 3) + " m";
}

NamedFigure named(const LeastSeenPath& way) {
    NamedFigure figure{"way from " + printable(way.of.from) + " to " + printable(way.of.to), ""};
    if (!way.exists)
        figure.finding = "none over free floor";
    else if (!way.seen)
        figure.finding = "is not known: a view is known by cells only";
    else if (*way.seen == 0)
        figure.finding = "can be unseen all along its " + formatFixed(way.length, 2) + " m";
    else
        figure.finding = "is seen for " + formatFixed(*way.seen, 2) +
                         " m at least; the one so seen is " + formatFixed(way.length, 2) +
                         " m long";
    return figure;
}

NamedFigure named(const Localisation& localisation) {
    NamedFigure figure{"localisation", "no cell of the grid lies indoors"};
    if (!localisation.mean) return figure;
    const std::string within = formatDouble(localisation.within) + " m";
    figure.finding = "mean error " + errorText(localisation.mean) + ", with " + within +
                     " for larger and unknown ones; ";
    if (localisation.median) figure.finding += "median " + errorText(localisation.median) + ", ";
    if (localisation.most) figure.finding += "95% within " + errorText(localisation.most) + ", ";
    figure.finding += percentText(*localisation.share_within) + " of the floor within " + within +
                      ", " + percentText(*localisation.localised) + " with a position";
    return figure;
}

void writeFigure(JsonWriter& json, const char* key, const std::optional<double>& value) {
    json.key(key);
    if (value)
        json.value(roundSignificant(*value));
    else
        json.null();
}

}  // namespace

std::vector<NamedFigure> namedFigures(const ObjectiveFigures& figures) {
    std::vector<NamedFigure> all;
    for (const LeastSeenPath& way : figures.ways) all.push_back(named(way));
    if (figures.localisation) all.push_back(named(*figures.localisation));
    return all;
}

void ObjectivesSection::writeJson(JsonWriter& json) const {
    if (!figures_.ways.empty()) {
        json.key("paths").beginArray();
        for (const LeastSeenPath& way : figures_.ways) {
            json.beginObject();
            json.key("from").value(way.of.from);
            json.key("to").value(way.of.to);
            json.key("exists").value(way.exists);
            writeFigure(json, "seen", way.seen);
            writeFigure(json, "length", way.seen ? std::optional(way.length) : std::nullopt);
            json.key("pieces").beginArray();
            for (const LeastSeenPath::Piece& piece : way.pieces) {
                json.beginObject();
                for (const auto& [key, at] : {std::pair("from", piece.from), {"to", piece.to}})
                    json.key(key).value(
                        std::vector<double>{roundSignificant(at.x), roundSignificant(at.y)});
                json.key("seen").value(piece.is_seen);
                json.endObject();
            }
            json.endArray();
            json.endObject();
        }
        json.endArray();
    }
    if (!figures_.localisation) return;
    const Localisation& localisation = *figures_.localisation;
    json.key("localisation").beginObject();
    writeFigure(json, "within", localisation.within);
    writeFigure(json, "localised", localisation.localised);
    writeFigure(json, "share_within", localisation.share_within);
    writeFigure(json, "mean", localisation.mean);
    writeFigure(json, "median", localisation.median);
    writeFigure(json, "quantile_95", localisation.most);
    json.endObject();
}

std::string ObjectivesSection::text() const {
    std::string text;
    for (const NamedFigure& figure : namedFigures(figures_))
        text += figure.name + ": " + figure.finding + '\n';
    return text.empty() ? "" : '\n' + text;
}

namespace {

/// Colours of unseen and seen pieces of a way, those of ways in runs (Okabe and Ito's vermilion and
/// green).
constexpr std::array<std::uint32_t, 2> kPieceColors = {0xD55E00, 0x00845F};

Stroke pieceStroke(bool is_seen, double em) {
    Stroke stroke{Color::rgb(kPieceColors[is_seen ? 1 : 0]), em / 5};
    if (!is_seen) stroke.dashes = {em / 2, em / 4};
    return stroke;
}

/// Draws the ways.
class LeastSeenPathsLayer final : public MapLayer {
  public:
    explicit LeastSeenPathsLayer(const ObjectiveFigures& figures) : figures_(figures) {}
    [[nodiscard]] std::string_view name() const override { return "ways seen least"; }
    void draw(Picture& picture, const MapPicture& map) const override {
        std::array<std::vector<std::vector<Point2>>, kPieceColors.size()> chains;
        for (const LeastSeenPath& way : figures_.ways)
            for (const LeastSeenPath::Piece& piece : way.pieces) {
                auto& some = chains[piece.is_seen ? 1 : 0];
                if (some.empty() || !(some.back().back() == piece.from))
                    some.push_back({piece.from});
                some.back().push_back(piece.to);
            }
        picture.pushView(map.view);
        for (const auto& some : chains)
            picture.lines(some, {Stroke{palette::kWhite.faded(0.8), map.em / 2.6}});
        for (std::size_t i = 0; i < chains.size(); ++i)
            picture.lines(chains[i], {pieceStroke(i == 1, map.em)});
        picture.pop();
    }

    [[nodiscard]] std::optional<LegendBlock> legend() const override {
        if (figures_.ways.empty()) return std::nullopt;
        using Sign = LegendItem::Sign;
        LegendBlock block{"Ways that are seen least", {}};
        block.items.push_back({Sign::Line, Color::rgb(kPieceColors[1]), {}, "seen", ""});
        block.items.push_back(
            {Sign::Dashes, Color::rgb(kPieceColors[0]), {}, "unseen, or in a zone", ""});
        for (const LeastSeenPath& way : figures_.ways)
            block.items.push_back({Sign::None,
                                   {},
                                   {},
                                   way.of.from + " to " + way.of.to,
                                   way.seen ? formatFixed(*way.seen, 2) + " m seen" : "unknown"});
        return block;
    }

  private:
    const ObjectiveFigures& figures_;
};

}  // namespace

ObjectivesSection::ObjectivesSection(ObjectiveFigures figures)
    : figures_(std::move(figures)), layer_(std::make_unique<LeastSeenPathsLayer>(figures_)) {}

ObjectivesSection::~ObjectivesSection() = default;

const MapLayer* ObjectivesSection::mapLayer() const { return layer_.get(); }

PageAdditions ObjectivesSection::page(const PageSubject& subject) const {
    PageAdditions added;
    if (subject.of == PageSubject::Of::Site)
        added.figures.push_back(
            {"objectives", figures_.localisation ? "Positions" : "Ways", {PageCode{text()}}});
    if (subject.of != PageSubject::Of::Room) return added;
    PageTable table{
        "ways that are seen least, and errors of positions", "ll", {"figure", "measured"}, {}};
    for (const NamedFigure& figure : namedFigures(figures_))
        table.rows.push_back({figure.name, figure.finding});
    PageSection section{"objectives", "Ways and positions", {std::move(table)}};
    if (!figures_.ways.empty()) {
        MapOptions options;
        options.layers = {layer_.get()};
        section.blocks.push_back(
            PageFigure{"Ways between zones that are seen least.",
                       coverageMap(*subject.scene, *subject.coverage, options)});
    }
    added.figures.push_back(std::move(section));
    return added;
}

}  // namespace ispace::goals
