// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

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

}  // namespace ispace
