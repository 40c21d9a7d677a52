// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstddef>

#include "env/standing.h"

namespace ispace {

namespace {

// Usual measures, in metres; small furniture has them in proportion.
constexpr double kBoard = 0.03;
constexpr double kDeskLeg = 0.05;
constexpr double kChairLeg = 0.035;
constexpr double kPanel = 0.03;
/// Of the table's diameter.
constexpr double kStemShare = 0.1, kFootShare = 0.5;
/// Height of a chair's seat, of the whole: 0.45 m of 0.85 m.
constexpr double kSeatShare = 0.45 / 0.85;

/// At most a quarter of the extent.
double atMostQuarter(double wanted, double extent) { return std::min(wanted, extent / 4); }

void addLegs(Body& body, const Standing& thing, double leg, double top, Material material) {
    const double x = thing.length / 2, y = thing.width / 2;
    body.prisms.reserve(body.prisms.size() + 4);
    for (const Point2 low :
         {Point2{-x, -y}, Point2{x - leg, -y}, Point2{x - leg, y - leg}, Point2{-x, y - leg}})
        body.prisms.push_back(
            {thing.box(low, {low.x + leg, low.y + leg}), thing.bottom, top, material});
}

}  // namespace

Body tableBody(const Record& record) {
    const Standing table = standingOf(record);
    const double board = atMostQuarter(kBoard, table.height());
    const double foot_top = table.bottom + board, stem_top = table.top - board;
    Body body;
    body.prisms.push_back(roundPrism(table.ellipse(), stem_top, table.top, Material::Wood));
    body.prisms.push_back(
        roundPrism(table.ellipse(kStemShare), foot_top, stem_top, Material::Metal));
    body.prisms.push_back(
        roundPrism(table.ellipse(kFootShare), table.bottom, foot_top, Material::Metal));
    return body;
}

Body deskBody(const Record& record) {
    const Standing desk = standingOf(record);
    const double x = desk.length / 2, y = desk.width / 2;
    const double board_bottom = desk.top - atMostQuarter(kBoard, desk.height());
    Body body;
    body.prisms.push_back({desk.rectangle(), board_bottom, desk.top, Material::Wood});
    if (record.text("kind") == "closed") {
        const double panel = atMostQuarter(kPanel, std::min(desk.length, desk.width));
        const auto add = [&](Point2 low, Point2 high) {
            body.prisms.push_back(
                {desk.box(low, high), desk.bottom, board_bottom, Material::WoodDark});
        };
        add({-x, -y}, {-x + panel, y});
        add({x - panel, -y}, {x, y});
        add({-x, y - panel}, {x, y});
    } else {
        addLegs(body, desk, atMostQuarter(kDeskLeg, std::min(desk.length, desk.width)),
                board_bottom, Material::Metal);
    }
    return body;
}

Body chairBody(const Record& record) {
    const Standing chair = standingOf(record);
    const double x = chair.length / 2, y = chair.width / 2;
    const double seat_top = chair.bottom + kSeatShare * chair.height();
    const double seat_bottom = seat_top - atMostQuarter(kBoard, chair.height());
    const double back = atMostQuarter(kBoard, chair.length);
    Body body;
    body.prisms.push_back({chair.rectangle(), seat_bottom, seat_top, Material::Fabric});
    body.prisms.push_back(
        {chair.box({-x, -y}, {-x + back, y}), seat_top, chair.top, Material::Fabric});
    addLegs(body, chair, atMostQuarter(kChairLeg, std::min(chair.length, chair.width)), seat_bottom,
            Material::Metal);
    return body;
}

namespace {

/// Edge of the square section of the bars.
constexpr double kBar = 0.05;

/// How a stack of boxes looks: heights, and extents as shares of the widest, in turn from below.
constexpr std::array<double, 3> kBoxHeight{1.2, 1, 0.8};
struct Share {
    double length, width;
    double ahead, left;  ///< which way the box is moved within the extent: -1, 0 or 1
};
constexpr std::array<Share, 3> kBoxShare{{{1, 1, 0, 0}, {0.88, 0.94, -1, 1}, {0.92, 0.84, 1, -1}}};

// Of a screen, in metres; small ones have them in proportion.
constexpr double kScreenBoard = 0.02, kPost = 0.04, kFootHeight = 0.03, kFootLength = 0.06;
/// Height of its lower edge, and how far its feet stand from its ends, of the whole.
constexpr double kLowerEdge = 0.25, kFootPlace = 0.125;

/// Places of the middles of `count` bars side by side, from edge to edge of the extent.
double barPlace(int i, int count, double bar, double extent) {
    if (count == 1) return 0;
    return (extent - bar) * (static_cast<double>(i) / (count - 1) - 0.5);
}

}  // namespace

Body infraBody(const Record& record) {
    Standing frame = standingOf(record);
    frame.bottom = record.number("height");
    const double x = frame.length / 2, y = frame.width / 2;
    const int rows = static_cast<int>(record.number("rows"));
    const int cols = static_cast<int>(record.number("cols"));
    // Bars that would overlap are thinner.
    const double row = std::min(kBar, frame.width / rows),
                 col = std::min(kBar, frame.length / cols);
    frame.top = frame.bottom + kBar;
    Body body;
    const auto add = [&](Point2 low, Point2 high) {
        body.prisms.push_back({frame.box(low, high), frame.bottom, frame.top, Material::Metal});
    };
    for (int i = 0; i < rows; ++i) {
        const double middle = barPlace(i, rows, row, frame.width);
        add({-x, middle - row / 2}, {x, middle + row / 2});
    }
    for (int i = 0; i < cols; ++i) {
        const double middle = barPlace(i, cols, col, frame.length);
        add({middle - col / 2, -y}, {middle + col / 2, y});
    }
    return body;
}

Body boxesBody(const Record& record) {
    const Standing stack = standingOf(record);
    const auto count = static_cast<std::size_t>(record.number("count"));
    double whole = 0;
    for (std::size_t i = 0; i < count; ++i) whole += kBoxHeight[i % kBoxHeight.size()];
    Body body;
    double below = 0, bottom = stack.bottom;
    for (std::size_t i = 0; i < count; ++i) {
        below += kBoxHeight[i % kBoxHeight.size()];
        // Each stands on the very top of the one below, and the last ends at the very top.
        const double top =
            i + 1 == count ? stack.top : stack.bottom + stack.height() * below / whole;
        const Share& share = kBoxShare[i % kBoxShare.size()];
        const double x = stack.length / 2, y = stack.width / 2;
        const double ahead = share.ahead * (1 - share.length) * x;
        const double left = share.left * (1 - share.width) * y;
        body.prisms.push_back({stack.box({ahead - share.length * x, left - share.width * y},
                                         {ahead + share.length * x, left + share.width * y}),
                               bottom, top, Material::Box});
        bottom = top;
    }
    return body;
}

Body screenBody(const Record& record) {
    const Standing screen = standingOf(record);
    const double x = screen.length / 2, y = screen.width / 2;
    const double board = std::min(kScreenBoard, screen.width / 2);
    const double post = std::min({kPost, screen.width / 2, screen.length / 16});
    const double foot = std::max(post, std::min(kFootLength, screen.length / 8));
    const double foot_top = screen.bottom + std::min(kFootHeight, screen.height() / 16);
    const double edge = screen.bottom + kLowerEdge * screen.height();
    Body body;
    body.prisms.push_back(
        {screen.box({-x, -board / 2}, {x, board / 2}), edge, screen.top, Material::Screen});
    for (const double side : {-1.0, 1.0}) {
        const double middle = side * (0.5 - kFootPlace) * screen.length;
        body.prisms.push_back(
            {screen.box({middle - post / 2, -post / 2}, {middle + post / 2, post / 2}), foot_top,
             edge, Material::Metal});
        body.prisms.push_back({screen.box({middle - foot / 2, -y}, {middle + foot / 2, y}),
                               screen.bottom, foot_top, Material::Metal});
    }
    return body;
}

}  // namespace ispace
