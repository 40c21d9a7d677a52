// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/objective_report.h"

#include <cmath>

#include "base/message.h"
#include "base/number.h"
#include "report/coverage_report.h"

namespace ispace {

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

void writeObjectives(JsonWriter& json, const ObjectiveFigures& figures) {
    if (!figures.ways.empty()) {
        json.key("paths").beginArray();
        for (const LeastSeenPath& way : figures.ways) {
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
    if (!figures.localisation) return;
    const Localisation& localisation = *figures.localisation;
    json.key("localisation").beginObject();
    writeFigure(json, "within", localisation.within);
    writeFigure(json, "localised", localisation.localised);
    writeFigure(json, "share_within", localisation.share_within);
    writeFigure(json, "mean", localisation.mean);
    writeFigure(json, "median", localisation.median);
    writeFigure(json, "quantile_95", localisation.most);
    json.endObject();
}

std::string objectivesText(const ObjectiveFigures& figures) {
    std::string text;
    for (const NamedFigure& figure : namedFigures(figures))
        text += figure.name + ": " + figure.finding + '\n';
    return text.empty() ? "" : '\n' + text;
}

}  // namespace ispace
