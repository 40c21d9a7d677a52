// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/message.h"
#include "base/number.h"
#include "env/level.h"
#include "extensions/reality/reality_report.h"
#include "report/coverage_report.h"

namespace ispace::reality {

namespace {

constexpr double kMargin = 12;  // page units

/// Colour of a residual: blue is short, red long, grey within 5 cm.
Color residualColor(double residual) {
    constexpr double kNone = 0.05;
    if (std::abs(residual) <= kNone) return Color::rgb(0x57A05A);
    const double share = std::min(1.0, std::abs(residual) / kInlierDistance);
    const Color far = residual < 0 ? Color::rgb(0x1F5FBF) : Color::rgb(0xC2410C);
    return mixed(Color::rgb(0xB9BDC1), far, share);
}

/// Draws the ends of beams, an even share of many, by colour.
void drawEnds(Picture& picture, const LoggedRun& run, double metre) {
    constexpr std::size_t kMost = 20'000;
    const std::size_t step = std::max<std::size_t>(1, run.beams.size() / kMost);
    std::size_t number = 0;
    for (const MeasuredScan& scan : run.scans) {
        const MeasuredRays rays = scan.rays(scan.pose);
        const std::span<const MeasuredBeam> beams = run.beamsOf(scan);
        for (std::size_t k = 0; k < beams.size(); ++k) {
            if (number++ % step != 0 || !beams[k].hasBoth()) continue;
            const Point3 end = rays.end(k, double{beams[k].measured});
            picture.circle(end.onFloor(), 1.2 / metre, {residualColor(beams[k].residual())});
        }
    }
}

void drawErrors(Picture& picture, const PlanErrors& errors) {
    const double half = 0.5 * errors.cell;
    for (const PlanError& error : errors.errors) {
        const bool is_new = error.kind == PlanError::Kind::New;
        const Color color = is_new ? Color::rgb(0x1F5FBF) : Color::rgb(0xC2410C);
        for (const Point2& c : error.cells)
            picture.area(Polygon{{c.x - half, c.y - half},
                                 {c.x + half, c.y - half},
                                 {c.x + half, c.y + half},
                                 {c.x - half, c.y + half}},
                         {color.faded(0.35)});
    }
}

PageTable pageTable(const ResidualTable& table) {
    PageTable page{"by " + table.by, "lrrrr", {table.by, "beams", "inliers", "bias", "sigma"}, {}};
    for (const ResidualRow& row : table.rows)
        page.rows.push_back({row.name, std::to_string(row.beams), percentText(row.inliers, 1),
                             formatFixed(100 * row.median, 1) + " cm",
                             formatFixed(100 * row.sigma, 1) + " cm"});
    return page;
}

}  // namespace

Picture realityMap(const RealityReport& report, const LoggedRun& run,
                   const Environment& environment, int width) {
    const Box2 box = environment.limits().expanded(0.3);
    const double scale = (static_cast<double>(width) - 2 * kMargin) / box.width();
    const double height = std::ceil(scale * box.depth() + 2 * kMargin);
    constexpr double kLegend = 24;
    Picture picture(static_cast<double>(width), std::min(height + kLegend, Picture::kMaxSide));
    picture.describe("Residuals of " + report.log,
                     "The plan, and the ends of beams: green within 5 cm of the simulation, blue "
                     "shorter, red longer. Squares: new things (blue) and missing surfaces (red).");
    picture.pushView({scale, {box.low.x, box.high.y}, {kMargin, kMargin}});
    picture.pushLayer("plan");
    const double level = run.scans.empty() ? kScanHeight : run.scans.front().pose.position.z;
    const Slice slice = environment.slice(level);
    for (const Polygon& solid : slice.solids)
        picture.area(solid, {palette::kOutside, Stroke{palette::kWall, 1}});
    picture.lines(slice.sheets, {Stroke{palette::kWall, 1.5}});
    picture.pop();
    picture.pushLayer("residuals");
    drawEnds(picture, run, scale);
    picture.pop();
    picture.pushLayer("errors");
    drawErrors(picture, report.errors);
    picture.pop();
    picture.pop();
    picture.text({kMargin, picture.height() - 8},
                 "green: within 5 cm; blue: shorter than the plan, new things; red: longer, "
                 "missing surfaces",
                 {.size = 12, .color = palette::kInk});
    return picture;
}

Picture realityHistogram(const RealityReport& report) {
    constexpr double kWidth = 720, kHeight = 260, kLow = 230;
    Picture picture(kWidth, kHeight);
    picture.describe("Histogram of residuals", "From -0.5 to 0.5 m, with the density of hits.");
    const std::size_t most = std::max<std::size_t>(
        1, *std::max_element(report.histogram.begin(), report.histogram.end()));
    const double step = (kWidth - 2 * kMargin) / static_cast<double>(report.histogram.size());
    const double unit = (kLow - kMargin) / static_cast<double>(most);
    for (std::size_t i = 0; i < report.histogram.size(); ++i) {
        const double left = kMargin + static_cast<double>(i) * step;
        const double top = kLow - unit * static_cast<double>(report.histogram[i]);
        picture.area(Polygon{{left, kLow}, {left + step, kLow}, {left + step, top}, {left, top}},
                     {Color::rgb(0x9DB8D9)});
    }
    const BeamModel& model = report.fit.model;
    std::vector<Point2> curve;
    const double bin = 1 / static_cast<double>(report.histogram.size());
    for (std::size_t i = 0; i <= report.histogram.size(); ++i) {
        const double residual = -0.5 + static_cast<double>(i) * bin;
        const double u = (residual - model.bias) / std::max(model.sigma[0], 1e-4);
        const double density = std::exp(-0.5 * u * u) /
                               (std::max(model.sigma[0], 1e-4) * std::sqrt(2 * std::numbers::pi));
        const double count = static_cast<double>(report.fit.samples) * model.hit * density * bin;
        curve.push_back(
            {kMargin + static_cast<double>(i) * step, std::max(kMargin / 2, kLow - unit * count)});
    }
    picture.lines(curve, {Stroke{Color::rgb(0xC2410C), 1.5}});
    picture.line({kMargin, kLow}, {kWidth - kMargin, kLow}, Stroke{palette::kInk, 1});
    for (const double tick : {-0.5, -0.25, 0.0, 0.25, 0.5})
        picture.text({kMargin + (tick + 0.5) * (kWidth - 2 * kMargin), kLow + 18},
                     formatDouble(tick) + " m",
                     {.size = 11,
                      .align = tick < -0.4  ? Align::Left
                               : tick > 0.4 ? Align::Right
                                            : Align::Center,
                      .color = palette::kInk});
    return picture;
}

ReportPage realityPage(const RealityReport& report, const LoggedRun& run,
                       const Environment& environment, const std::string& command) {
    ReportPage page{"A log against the plan", report.log + " against " + report.room, {}, {}};
    PageSection summary{"summary", "Summary", {}};
    const BeamModel& model = report.fit.model;
    PageTable figures{"figures", "lr", {"figure", "value"}, {}};
    const auto cm = [](double metres) { return formatFixed(100 * metres, 1) + " cm"; };
    figures.rows = {{"scans", std::to_string(report.scans)},
                    {"beams", std::to_string(report.beams)},
                    {"inliers within 20 cm", percentText(report.inliers, 1)},
                    {"sigma (robust)", cm(report.sigma)},
                    {"bias (median)", cm(report.bias)},
                    {"hit", percentText(model.hit, 1)},
                    {"short", percentText(model.nearer, 1)},
                    {"max", percentText(model.max, 1)},
                    {"random", percentText(model.random, 1)},
                    {"sigma of hits", cm(model.sigma[0])}};
    if (report.alignment) {
        figures.rows.push_back({"poses aligned by (median)", cm(report.alignment->median_metres)});
        figures.rows.push_back({"and at most", cm(report.alignment->most_metres)});
    }
    summary.blocks.push_back(std::move(figures));
    page.sections.push_back(std::move(summary));
    PageSection plan{"plan", "Plan with residuals", {}};
    plan.blocks.push_back(PageFigure{
        "Ends of beams: green within 5 cm of the simulation, blue shorter, red longer; squares "
        "where several scans agree that the plan is wrong",
        realityMap(report, run, environment, 900)});
    page.sections.push_back(std::move(plan));
    PageSection fit{"fit", "Residuals and fit", {}};
    fit.blocks.push_back(PageFigure{"Residuals from -0.5 to 0.5 m, and the fitted density of hits",
                                    realityHistogram(report)});
    for (const ResidualTable& table : report.tables) fit.blocks.push_back(pageTable(table));
    page.sections.push_back(std::move(fit));
    PageSection errors{"errors", "Where the plan is wrong", {}};
    PageTable regions{"regions", "lllrr", {"kind", "at", "size", "scans", "beams"}, {}};
    for (const PlanError& error : report.errors.errors)
        regions.rows.push_back(
            {error.kind == PlanError::Kind::New ? "new" : "gone",
             formatFixed(error.center.x, 2) + "," + formatFixed(error.center.y, 2),
             formatFixed(error.length, 1) + " x " + formatFixed(error.width, 1) + " m",
             std::to_string(error.scans), std::to_string(error.beams)});
    if (regions.rows.empty())
        errors.blocks.push_back(PageText{"No region of three scans or more differs.", Tone::Good});
    else
        errors.blocks.push_back(std::move(regions));
    if (!report.errors.moves.empty()) {
        PageTable moves{"moved surfaces", "lrrr", {"surface", "by", "along x", "along y"}, {}};
        for (const PlanMove& move : report.errors.moves)
            moves.rows.push_back(
                {move.element < 0
                     ? ""
                     : environment.elements()[static_cast<std::size_t>(move.element)].id,
                 formatFixed(length(move.shift), 2) + " m", formatFixed(move.shift.x, 2) + " m",
                 formatFixed(move.shift.y, 2) + " m"});
        errors.blocks.push_back(std::move(moves));
    }
    if (!report.records.empty()) {
        std::string text;
        for (const std::string& record : report.records) text += record + '\n';
        errors.blocks.push_back(PageCode{std::move(text)});
    }
    page.sections.push_back(std::move(errors));
    page.sections.push_back({"command", "Command", {PageCode{command}}});
    return page;
}

}  // namespace ispace::reality
