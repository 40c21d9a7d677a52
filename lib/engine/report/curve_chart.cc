// SPDX-License-Identifier: GPL-3.0-or-later
// Values and proven bounds by the number of sensors; the area between them is what a search may
// still gain. Axes have steps of 1, 2 or 5 times a power of ten.
#include "report/curve_chart.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number.h"
#include "drawing/color.h"
#include "drawing/drawing.h"
#include "report/coverage_report.h"

namespace ispace {

namespace {

constexpr int kMinWidth = 200, kMaxWidth = 12000;

using palette::kFaintInk, palette::kInk;
constexpr Color kGridLine = Color::rgb(0xE1E4E8);
/// Transparent, so that the grid shows through.
constexpr Color kGap = Color::rgb(0x0072B2).faded(0.14);
Color valueColor() { return seriesColor(3); }
Color boundColor() { return seriesColor(0); }

/// An interval of an axis with ticks at all whole multiples of `step`.
struct Axis {
    double first = 0, last = 1, step = 1;

    [[nodiscard]] double shareOf(double value) const { return (value - first) / (last - first); }
    /// Calls visit(value) for each tick.
    template <typename Visit>
    void forEachTick(Visit visit) const {
        const double end = std::floor(last / step + 1e-9);
        for (double k = std::ceil(first / step - 1e-9); k <= end; ++k) visit(k * step);
    }
};

/// Axis of whole sensors, from 0 unless that would leave half of the chart empty.
Axis sensorAxis(const std::vector<CurvePoint>& points, double max_ticks) {
    Axis axis;
    if (points.empty()) return axis;
    const double first = points.front().sensors, last = points.back().sensors;
    axis.first = 2 * first > last && points.size() > 1 ? first : std::min(0.0, first);
    axis.last = points.size() == 1 ? last + 1 : std::max(last, axis.first + 1);
    axis.step = roundStep(std::max(1.0, (axis.last - axis.first) / max_ticks));
    return axis;
}

/// Axis in per cent, from 0 to the first tick above all values.
Axis shareAxis(const std::vector<CurvePoint>& points) {
    constexpr double kMaxTicks = 6;
    double most = 0;
    for (const CurvePoint& point : points) most = std::max({most, point.value, point.bound});
    most = most > 0 ? std::clamp(100 * most, 0.1, 100.0) : 100;
    Axis axis;
    axis.step = roundStep(most / kMaxTicks);
    axis.last = std::min(100.0, std::ceil(most / axis.step - 1e-9) * axis.step);
    return axis;
}

/// The picture and the bounds of its axes on the page.
struct Chart {
    Picture& picture;
    const std::vector<CurvePoint>& points;
    double em;
    Box2 plot;  ///< page units: low is the upper left corner
    Axis sensors, shares;

    [[nodiscard]] Point2 at(double count, double share) const {
        return {plot.low.x + sensors.shareOf(count) * plot.width(),
                plot.high.y - shares.shareOf(100 * share) * plot.depth()};
    }
    [[nodiscard]] std::vector<Point2> line(double CurvePoint::*member) const {
        std::vector<Point2> places;
        places.reserve(points.size());
        for (const CurvePoint& point : points) places.push_back(at(point.sensors, point.*member));
        return places;
    }
    [[nodiscard]] TextStyle text(Align align, Color color = kFaintInk) const {
        return {em, false, align, color, {}};
    }
};

void drawAxes(const Chart& chart) {
    const double em = chart.em;
    const Box2& plot = chart.plot;
    const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(chart.shares.step))));
    chart.shares.forEachTick([&](double value) {
        const double y = chart.at(chart.sensors.first, value / 100).y;
        chart.picture.line({plot.low.x, y}, {plot.high.x, y}, {kGridLine, em / 16});
        chart.picture.text({plot.low.x - 0.5 * em, y + 0.36 * em},
                           percentText(value / 100, decimals), chart.text(Align::Right));
    });
    chart.sensors.forEachTick([&](double count) {
        const double x = chart.at(count, 0).x;
        chart.picture.line({x, plot.high.y}, {x, plot.high.y + 0.35 * em}, {kInk, em / 14});
        chart.picture.text({x, plot.high.y + 1.5 * em}, formatFixed(count, 0),
                           chart.text(Align::Center));
    });
    chart.picture.line({plot.low.x, plot.high.y}, plot.high, {kInk, em / 14});
    chart.picture.line({plot.low.x, plot.low.y}, {plot.low.x, plot.high.y}, {kInk, em / 14});
    chart.picture.text({(plot.low.x + plot.high.x) / 2, plot.high.y + 3.1 * em}, "sensors",
                       chart.text(Align::Center));
}

/// Writes values beside their dots if there is room.
void drawFigures(const Chart& chart) {
    const double em = chart.em;
    const double apart = chart.plot.width() / (chart.sensors.last - chart.sensors.first);
    if (apart < 4.2 * em) return;
    TextStyle style = chart.text(Align::Left, kInk);
    style.halo = Color::rgb(0xFFFFFF).faded(0.85);
    for (const CurvePoint& point : chart.points) {
        const Point2 dot = chart.at(point.sensors, point.value);
        if (dot.y + 1.6 * em > chart.plot.high.y) continue;
        chart.picture.text({dot.x + 0.35 * em, dot.y + 1.35 * em}, percentText(point.value, 1),
                           style);
    }
}

void drawLines(const Chart& chart) {
    const double em = chart.em;
    const std::vector<Point2> values = chart.line(&CurvePoint::value);
    const std::vector<Point2> bounds = chart.line(&CurvePoint::bound);
    Polygon gap = values;
    gap.insert(gap.end(), bounds.rbegin(), bounds.rend());
    const bool alone = values.size() == 1;
    if (alone)
        chart.picture.line(values[0], bounds[0], {kGap, 0.8 * em});
    else if (!gap.empty())
        chart.picture.area(gap, {kGap});
    const double dot = std::clamp(
        0.2 * chart.plot.width() / std::max(1.0, chart.sensors.last - chart.sensors.first), em / 8,
        0.28 * em);
    if (!alone) {
        chart.picture.lines(bounds, {Stroke{boundColor(), em / 9, {em / 2, em / 4}}});
        chart.picture.lines(values, {Stroke{valueColor(), em / 7}});
    }
    for (const Point2 place : bounds)
        chart.picture.line({place.x - dot, place.y}, {place.x + dot, place.y},
                           {boundColor(), em / 7});
    for (const Point2 place : values) chart.picture.circle(place, dot, {valueColor()});
}

/// Draws the key on one line from `left` on.
void drawKey(const Chart& chart, double left, double base) {
    const double em = chart.em, y = base - 0.36 * em;
    chart.picture.line({left, y}, {left + 1.6 * em, y}, {valueColor(), em / 7});
    chart.picture.circle({left + 0.8 * em, y}, 0.28 * em, {valueColor()});
    const TextStyle style = chart.text(Align::Left, kInk);
    const std::string found = "coverage found", most = "at most, of these candidates";
    chart.picture.text({left + 2.1 * em, base}, found, style);
    const double next = left + 3.6 * em + textWidth(found, style);
    chart.picture.line({next, y}, {next + 1.6 * em, y}, {boundColor(), em / 9, {em / 2, em / 4}});
    const double room = chart.plot.high.x - next - 2.1 * em;
    chart.picture.text({next + 2.1 * em, base}, fitText(most, room, style), style);
}

}  // namespace

std::string curveCsv(const std::vector<CurvePoint>& points) {
    std::string text = "sensors,value,bound\n";
    for (const CurvePoint& point : points) {
        text += std::to_string(point.sensors);
        text += ',';
        appendDouble(text, roundSignificant(point.value));
        text += ',';
        appendDouble(text, roundSignificant(point.bound));
        text += '\n';
    }
    return text;
}

std::string curveText(const std::vector<CurvePoint>& points) {
    std::vector<TextRow> rows = {{"sensors", "coverage", "at most"}};
    rows.reserve(points.size() + 1);
    for (const CurvePoint& point : points)
        rows.push_back(
            {std::to_string(point.sensors), percentText(point.value), percentText(point.bound)});
    return aligned(rows, "r");
}

std::string drawCurve(const std::vector<CurvePoint>& points, const std::string& title,
                      PictureFormat format, int width) {
    if (width < kMinWidth || width > kMaxWidth)
        throw UsageError("a curve " + std::to_string(width) +
                         " pixels wide cannot be drawn, wanted " + std::to_string(kMinWidth) +
                         " to " + std::to_string(kMaxWidth));
    std::vector<CurvePoint> sorted = points;
    std::stable_sort(sorted.begin(), sorted.end(), [](const CurvePoint& a, const CurvePoint& b) {
        return a.sensors < b.sensors;
    });
    const double em = std::max(10.0, width / 1200.0 * 17),
                 margin = std::max(1.4 * em, width / 40.0);
    const double key_base = margin + (title.empty() ? 1.0 : 3.2) * em;
    const double top = key_base + 1.8 * em;
    const double left = margin + 3.4 * em, right = width - margin - 2.6 * em;
    const double bottom = std::max(top + 8 * em, 0.6 * width);
    Picture picture(width, std::ceil(bottom + 3.4 * em + margin));
    const Chart chart{picture,
                      sorted,
                      em,
                      {{left, top}, {right, bottom}},
                      sensorAxis(sorted, std::clamp((right - left) / (3 * em), 2.0, 20.0)),
                      shareAxis(sorted)};
    if (!title.empty()) {
        const TextStyle style{1.35 * em, true, Align::Left, kInk, {}};
        picture.text({margin, margin + 1.1 * em}, fitText(title, width - 2 * margin, style), style);
    }
    drawKey(chart, margin, key_base);
    drawAxes(chart);
    drawLines(chart);
    drawFigures(chart);
    return picture.write(format);
}

namespace {

constexpr const char* kCsv = "csv";
constexpr PictureFormat kPictures[] = {PictureFormat::Png, PictureFormat::Svg, PictureFormat::Pdf};

}  // namespace

std::vector<std::string> curveFormats() {
    std::vector<std::string> names = {kCsv};
    for (const PictureFormat picture : kPictures) names.emplace_back(nameOf(picture));
    return names;
}

std::string curveFile(const std::vector<CurvePoint>& points, const std::string& format) {
    constexpr int kWidth = 900;
    if (format == kCsv) return curveCsv(points);
    const auto* const picture =
        std::find_if(std::begin(kPictures), std::end(kPictures),
                     [&format](PictureFormat one) { return nameOf(one) == format; });
    return drawCurve(points, "Coverage by number of sensors", *picture, kWidth);
}

}  // namespace ispace
