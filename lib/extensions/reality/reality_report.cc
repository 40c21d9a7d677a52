// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of a comparison: tables of residuals by range, incidence, bearing, surface and time.
// Spreads are robust (1.4826 times the median deviation), so that a person in the way is no spread.
#include "extensions/reality/reality_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "env/level.h"
#include "report/coverage_report.h"

namespace ispace::reality {

namespace {

constexpr std::size_t kWorst = 10;      // rows of long tables in text
constexpr double kHistogramHalf = 0.5;  // metres
constexpr std::size_t kHistogramBins = 100;

std::string centimetres(double metres) { return formatFixed(100 * metres, 1) + " cm"; }

/// Residuals of one group.
struct ResidualGroup {
    std::vector<double> residuals;
    std::size_t returns = 0, inliers = 0;

    void add(const MeasuredBeam& beam) {
        if (!(beam.measured < kNoReturn)) return;
        ++returns;
        if (!(beam.expected < kNoReturn)) return;
        const double residual = beam.residual();
        residuals.push_back(residual);
        if (std::abs(residual) <= kInlierDistance) ++inliers;
    }
    [[nodiscard]] ResidualRow row(std::string name) {
        const RobustSpread spread = robustSpread(residuals);
        return {std::move(name), returns,
                returns == 0 ? 0 : static_cast<double>(inliers) / static_cast<double>(returns),
                spread.median, spread.sigma};
    }
};

/// Groups beams by a number; names(number) names a group.
class GroupedResiduals {
  public:
    explicit GroupedResiduals(std::string by) { table_.by = std::move(by); }
    void add(std::int64_t group, const MeasuredBeam& beam) { groups_[group].add(beam); }
    template <typename Name>
    ResidualTable table(Name name) {
        for (auto& [number, group] : groups_)
            if (group.returns > 0) table_.rows.push_back(group.row(name(number)));
        return std::move(table_);
    }

  private:
    ResidualTable table_;
    std::map<std::int64_t, ResidualGroup> groups_;
};

std::int64_t rangeGroup(double range) {
    constexpr double kFirst = 1;  // metres; each group is twice as wide as the one before
    return range < kFirst ? 0 : 1 + static_cast<std::int64_t>(std::floor(std::log2(range)));
}

std::string rangeName(std::int64_t group) {
    const double far = std::exp2(static_cast<double>(group));
    return (group == 0 ? "0" : formatDouble(far / 2)) + ".." + formatDouble(far) + " m";
}

constexpr std::int64_t kDegreesOfIncidence = 15, kDegreesOfBearing = 15;

std::string degreesName(std::int64_t group, std::int64_t step) {
    return std::to_string(group * step) + ".." + std::to_string((group + 1) * step) + " deg";
}

std::vector<ResidualTable> tablesOf(const LoggedRun& run, const Environment& environment) {
    GroupedResiduals ranges("range"), incidences("incidence"), bearings("beam"),
        surfaces("surface"), times("time"), sensors("sensor");
    constexpr std::size_t kSpans = 10;
    for (std::size_t i = 0; i < run.scans.size(); ++i) {
        const MeasuredScan& scan = run.scans[i];
        const std::span<const MeasuredBeam> beams = run.beamsOf(scan);
        const auto span = static_cast<std::int64_t>(i * kSpans / run.scans.size());
        for (std::size_t k = 0; k < beams.size(); ++k) {
            const MeasuredBeam& beam = beams[k];
            times.add(span, beam);
            sensors.add(static_cast<std::int64_t>(scan.sensor), beam);
            if (scan.scan != nullptr) {
                const Angle bearing = scan.scan->first + static_cast<double>(k) * scan.scan->step;
                bearings.add(static_cast<std::int64_t>(
                                 std::floor(bearing.degrees() / double{kDegreesOfBearing})),
                             beam);
            }
            if (!(beam.expected < kNoReturn)) continue;
            ranges.add(rangeGroup(double{beam.expected}), beam);
            const double degrees =
                Angle::radians(std::acos(std::min(1.0, double{beam.cosine}))).degrees();
            incidences.add(std::min<std::int64_t>(
                               5, static_cast<std::int64_t>(degrees / double{kDegreesOfIncidence})),
                           beam);
            surfaces.add(beam.surface, beam);
        }
    }
    std::vector<ResidualTable> tables;
    tables.push_back(ranges.table(rangeName));
    tables.push_back(incidences.table(
        [](std::int64_t group) { return degreesName(group, kDegreesOfIncidence); }));
    tables.push_back(
        bearings.table([](std::int64_t group) { return degreesName(group, kDegreesOfBearing); }));
    tables.push_back(surfaces.table([&](std::int64_t element) {
        return element < 0 ? std::string("other")
                           : environment.elements()[static_cast<std::size_t>(element)].id;
    }));
    // The surface with the most outliers first.
    std::stable_sort(tables.back().rows.begin(), tables.back().rows.end(),
                     [](const ResidualRow& a, const ResidualRow& b) {
                         return (1 - a.inliers) * static_cast<double>(a.beams) >
                                (1 - b.inliers) * static_cast<double>(b.beams);
                     });
    tables.push_back(times.table([&](std::int64_t span) {
        const auto first =
            (static_cast<std::size_t>(span) * run.scans.size() + kSpans - 1) / kSpans;
        return "scan " + std::to_string(first + 1) + " on";
    }));
    if (run.sensors.size() > 1)
        tables.push_back(sensors.table(
            [&](std::int64_t sensor) { return run.sensors[static_cast<std::size_t>(sensor)].id; }));
    return tables;
}

std::string kindName(PlanError::Kind kind) { return kind == PlanError::Kind::New ? "new" : "gone"; }

std::string elementName(std::int32_t element, const Environment& environment) {
    return element < 0 ? "" : environment.elements()[static_cast<std::size_t>(element)].id;
}

/// Returns a field of CSV, quoted if it has to be (RFC 4180).
std::string tableField(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string field = "\"";
    for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
    return field + '"';
}

TextRow textRow(const ResidualRow& row) {
    return {row.name, std::to_string(row.beams), percentText(row.inliers, 1),
            centimetres(row.median), centimetres(row.sigma)};
}

std::string tableText(const ResidualTable& table) {
    std::vector<TextRow> rows{{"by " + table.by, "beams", "inliers", "bias", "sigma"}};
    const bool is_long = table.by == "surface";
    for (const ResidualRow& row : table.rows) {
        if (is_long && rows.size() > kWorst) break;
        rows.push_back(textRow(row));
    }
    std::string text = "\n" + aligned(rows, "lr");
    if (is_long && table.rows.size() > kWorst)
        text += "and " + std::to_string(table.rows.size() - kWorst) + " more\n";
    return text;
}

std::string alignmentText(const Alignment& alignment) {
    const Pose2& whole = alignment.whole;
    return "aligned: the log by " + centimetres(whole.position.x) + ", " +
           centimetres(whole.position.y) + " and " + formatFixed(whole.heading.degrees(), 2) +
           " degrees; single poses by " + centimetres(alignment.median_metres) + " and " +
           formatFixed(alignment.median_turn.degrees(), 2) + " degrees (medians), " +
           centimetres(alignment.most_metres) + " and " +
           formatFixed(alignment.most_turn.degrees(), 2) + " degrees (greatest); " +
           std::to_string(alignment.kept) + " kept\n";
}

std::string errorsText(const RealityReport& report, const Environment& environment) {
    std::string text;
    if (!report.errors.errors.empty()) {
        std::vector<TextRow> rows{
            {"plan", "at", "size", "scans", "beams", "element", "beams that pass"}};
        for (const PlanError& error : report.errors.errors) {
            if (rows.size() > kWorst) break;
            rows.push_back(
                {kindName(error.kind),
                 formatFixed(error.center.x, 2) + "," + formatFixed(error.center.y, 2),
                 formatFixed(error.length, 1) + " x " + formatFixed(error.width, 1) + " m",
                 std::to_string(error.scans), std::to_string(error.beams),
                 elementName(error.element, environment),
                 error.kind == PlanError::Kind::Gone ? percentText(error.share, 0) : ""});
        }
        text += "\n" + aligned(rows, "lllrrlr");
        if (report.errors.errors.size() > kWorst)
            text += "and " + std::to_string(report.errors.errors.size() - kWorst) + " more\n";
    }
    if (!report.errors.moves.empty()) {
        std::vector<TextRow> rows{{"moved", "by", "along x", "along y", "", "beams"}};
        for (const PlanMove& move : report.errors.moves) {
            if (rows.size() > kWorst) break;
            rows.push_back({elementName(move.element, environment),
                            formatFixed(length(move.shift), 2) + " m", formatFixed(move.shift.x, 2),
                            formatFixed(move.shift.y, 2),
                            move.is_across ? "or more, along itself" : "",
                            std::to_string(report.errors.errors[move.found].beams)});
        }
        text += "\n" + aligned(rows, "lrrrlr");
    }
    constexpr double kLeast = 0.02;
    std::vector<TextRow> rows{{"surface", "offset", "sigma", "beams", "scans"}};
    for (const SurfaceOffset& offset : report.errors.offsets) {
        if (rows.size() > kWorst) break;
        if (std::abs(offset.offset) < kLeast) continue;
        rows.push_back({elementName(offset.element, environment), centimetres(offset.offset),
                        centimetres(offset.sigma), std::to_string(offset.beams),
                        std::to_string(offset.scans)});
    }
    if (rows.size() > 1) text += "\n" + aligned(rows, "lrrrr");
    if (!report.records.empty()) {
        text += "\nrecords to paste:\n";
        for (const std::string& record : report.records) text += record + "\n";
    }
    return text;
}

void writePose(JsonWriter& json, const Pose2& pose) {
    json.beginArray().value(pose.position.x).value(pose.position.y).value(pose.heading.radians());
    json.endArray();
}

void writeErrors(JsonWriter& json, const RealityReport& report, const Environment& environment) {
    json.key("errors").beginArray();
    for (const PlanError& error : report.errors.errors) {
        json.beginObject().key("kind").value(kindName(error.kind));
        json.key("at").beginArray().value(error.center.x).value(error.center.y).endArray();
        json.key("heading").value(error.heading.radians());
        json.key("size").beginArray().value(error.length).value(error.width).endArray();
        json.key("scans").value(error.scans).key("beams").value(error.beams);
        json.key("element");
        if (error.element < 0)
            json.null();
        else
            json.value(elementName(error.element, environment));
        json.key("share");
        if (error.kind == PlanError::Kind::Gone)
            json.value(error.share);
        else
            json.null();
        json.endObject();
    }
    json.endArray().key("moves").beginArray();
    for (const PlanMove& move : report.errors.moves) {
        json.beginObject().key("element").value(elementName(move.element, environment));
        json.key("shift").beginArray().value(move.shift.x).value(move.shift.y).endArray();
        json.key("across").value(move.is_across);
        json.key("gone").value(move.gone).key("new").value(move.found).endObject();
    }
    json.endArray().key("offsets").beginArray();
    for (const SurfaceOffset& offset : report.errors.offsets) {
        json.beginObject().key("element").value(elementName(offset.element, environment));
        json.key("offset").value(offset.offset).key("sigma").value(offset.sigma);
        json.key("beams").value(offset.beams).key("scans").value(offset.scans).endObject();
    }
    json.endArray().key("records").value(report.records);
}

/// Parses a length in metres, or with a suffix. nullopt for other text.
std::optional<double> lengthOf(std::string_view text) {
    for (const UnitSuffix& unit : suffixesOf(Unit::Length))
        if (text.ends_with(unit.name))
            if (const auto value =
                    parseScaled(text.substr(0, text.size() - unit.name.size()), unit.exponent))
                return *value * unit.factor;
    return parseDouble(text);
}

}  // namespace

RealityReport measureReality(const Log& log, const LoggedRun& run, const Environment& environment,
                             std::optional<Alignment> alignment) {
    RealityReport report{.log = displayName(log.name),
                         .format = log.format,
                         .room = {},
                         .scans = run.scans.size(),
                         .left_out = run.left_out,
                         .beams = run.beams.size(),
                         .fit = {},
                         .tables = {},
                         .alignment = {},
                         .errors = {},
                         .records = {},
                         .histogram = {}};
    report.alignment = std::move(alignment);
    ResidualGroup all;
    constexpr auto kBins = static_cast<double>(kHistogramBins);
    report.histogram.resize(kHistogramBins);
    for (const MeasuredBeam& beam : run.beams) {
        all.add(beam);
        if (!beam.hasBoth()) continue;
        ++report.residuals;
        const double place = (beam.residual() / kHistogramHalf + 1) * (kBins / 2);
        if (place >= 0 && place < kBins) ++report.histogram[static_cast<std::size_t>(place)];
    }
    const ResidualRow row = all.row("");
    report.returns = row.beams;
    report.inliers = row.inliers;
    report.sigma = row.sigma;
    report.bias = row.median;
    std::vector<std::size_t> scans(run.scans.size());
    std::iota(scans.begin(), scans.end(), std::size_t{0});
    const std::vector<BeamSample> samples = evenShare(samplesOf(run, scans));
    if (!samples.empty()) report.fit = fitBeams(samples, SpreadTerms::Constant);
    report.tables = tablesOf(run, environment);
    report.errors = findPlanErrors(run, report.sigma);
    report.records = recordsOf(report.errors, environment);
    return report;
}

std::string realityText(const RealityReport& report, const Environment& environment) {
    const BeamModel& model = report.fit.model;
    std::string text = report.log + " (" + report.format + ") against " + report.room + ": " +
                       std::to_string(report.scans) + " scans, " + std::to_string(report.beams) +
                       " beams, " + std::to_string(report.returns) + " returns\n";
    if (report.alignment) text += alignmentText(*report.alignment);
    text += "\n" +
            aligned({{"inliers", percentText(report.inliers, 1),
                      "of the returns are within 20 cm of the simulation"},
                     {"sigma", centimetres(report.sigma), "robust, of the residuals"},
                     {"bias", centimetres(report.bias), "median residual: measured less simulated"},
                     {"hit", percentText(model.hit, 1),
                      "of the beams, with a sigma of " + centimetres(model.sigma[0]) +
                          " and a bias of " + centimetres(model.bias)},
                     {"short", percentText(model.nearer, 1),
                      "something nearer than the plan, lambda " + formatFixed(model.lambda, 2) +
                          " per metre"},
                     {"max", percentText(model.max, 1), "no return"},
                     {"random", percentText(model.random, 1), "anywhere"}},
                    "lrl");
    for (const ResidualTable& table : report.tables) text += tableText(table);
    return text + errorsText(report, environment);
}

std::string realityJson(const RealityReport& report, const Environment& environment) {
    const BeamModel& model = report.fit.model;
    JsonWriter json;
    beginReport(json, "ispace-reality/1", "scan");
    json.key("log").value(report.log).key("format").value(report.format);
    json.key("digest").value(environment.digest());
    json.key("scans").value(report.scans).key("left_out").value(report.left_out);
    json.key("beams").value(report.beams).key("returns").value(report.returns);
    json.key("inliers").value(report.inliers).key("sigma").value(report.sigma);
    json.key("bias").value(report.bias).key("hit").value(model.hit);
    json.key("short").value(model.nearer).key("max").value(model.max);
    json.key("random").value(model.random).key("lambda").value(model.lambda);
    json.key("hit_sigma").value(model.sigma[0]).key("hit_bias").value(model.bias);
    json.key("mixed").value(model.mixed).key("log_likelihood").value(report.fit.log_likelihood);
    json.key("alignment");
    if (report.alignment) {
        const Alignment& alignment = *report.alignment;
        json.beginObject().key("whole");
        writePose(json, alignment.whole);
        json.key("median").value(alignment.median_metres).key("most").value(alignment.most_metres);
        json.key("median_turn").value(alignment.median_turn.radians());
        json.key("most_turn").value(alignment.most_turn.radians());
        json.key("kept").value(alignment.kept).endObject();
    } else {
        json.null();
    }
    json.key("tables").beginObject();
    for (const ResidualTable& table : report.tables) {
        json.key(table.by).beginArray();
        for (const ResidualRow& row : table.rows)
            json.beginObject()
                .key("name")
                .value(row.name)
                .key("beams")
                .value(row.beams)
                .key("inliers")
                .value(row.inliers)
                .key("bias")
                .value(row.median)
                .key("sigma")
                .value(row.sigma)
                .endObject();
        json.endArray();
    }
    json.endObject();
    writeErrors(json, report, environment);
    return json.endObject().take() + '\n';
}

std::string realityTable(const LoggedRun& run, const Environment& environment) {
    std::string text = "sensor,t,scan,beam,measured,expected,cosine,surface,range_max\n";
    const auto add = [&text](float range) {
        constexpr double kDigits = 1e5;
        text += ',';
        if (range < kNoReturn) text += formatDouble(std::round(double{range} * kDigits) / kDigits);
    };
    for (std::size_t i = 0; i < run.scans.size(); ++i) {
        const MeasuredScan& scan = run.scans[i];
        const MeasuredSensor& sensor = run.sensors[scan.sensor];
        const std::string begin =
            tableField(sensor.id) + ',' + formatDouble(scan.time()) + ',' + std::to_string(i) + ',';
        const std::span<const MeasuredBeam> beams = run.beamsOf(scan);
        for (std::size_t k = 0; k < beams.size(); ++k) {
            text += begin + std::to_string(k);
            add(beams[k].measured);
            add(beams[k].expected);
            text += ',' + formatDouble(roundSignificant(double{beams[k].cosine}, 4)) + ',' +
                    tableField(elementName(beams[k].surface, environment)) + ',';
            if (sensor.max_range < 1e5) text += formatDouble(sensor.max_range);
            text += '\n';
        }
    }
    return text;
}

RealityRequirement parseRealityRequirement(const std::string& text) {
    const std::size_t sign = text.find('=');
    const std::string name = text.substr(0, sign);
    const std::string value = sign == std::string::npos ? "" : text.substr(sign + 1);
    RealityRequirement requirement;
    requirement.text = text;
    if (name == "inliers") {
        const auto share = parseShare(value);
        if (!share) throw UsageError("`" + text + "` has no share, such as inliers=90%");
        requirement.value = *share;
        return requirement;
    }
    if (name != "sigma" && name != "bias")
        throw UsageError("`" + text + "` is none of inliers=SHARE, sigma=LENGTH, bias=LENGTH");
    requirement.of = name == "sigma" ? RealityRequirement::Of::Sigma : RealityRequirement::Of::Bias;
    const auto length = lengthOf(value);
    if (!length || *length < 0)
        throw UsageError("`" + text + "` has no length, such as " + name + "=3cm");
    requirement.value = *length;
    return requirement;
}

std::vector<std::string> unmetRequirements(const RealityReport& report,
                                           const std::vector<RealityRequirement>& requirements) {
    std::vector<std::string> unmet;
    for (const RealityRequirement& each : requirements) {
        if (report.residuals == 0) {
            unmet.push_back("no beam returns in both log and simulation: " + each.text +
                            " is not met");
            continue;
        }
        switch (each.of) {
            case RealityRequirement::Of::Inliers:
                if (report.inliers < each.value)
                    unmet.push_back("inliers are " + percentText(report.inliers, 2) +
                                    ", below the required " + formatPercent(each.value));
                break;
            case RealityRequirement::Of::Sigma:
                if (report.sigma > each.value)
                    unmet.push_back("sigma is " + formatFixed(100 * report.sigma, 2) +
                                    " cm, above the required " +
                                    formatDouble(roundSignificant(100 * each.value)) + " cm");
                break;
            case RealityRequirement::Of::Bias:
                if (std::abs(report.bias) > each.value)
                    unmet.push_back("the bias is " + formatFixed(100 * report.bias, 2) +
                                    " cm, beyond the required " +
                                    formatDouble(roundSignificant(100 * each.value)) + " cm");
                break;
        }
    }
    return unmet;
}

}  // namespace ispace::reality
