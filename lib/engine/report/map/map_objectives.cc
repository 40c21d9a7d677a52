// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "base/number.h"
#include "report/map/map_parts.h"
#include "report/objective_report.h"

namespace ispace {

namespace {

/// Colours of unseen and seen pieces of a way, those of ways in runs (Okabe and Ito's vermilion and
/// green).
constexpr std::array<std::uint32_t, 2> kPieceColors = {0xD55E00, 0x00845F};

Stroke pieceStroke(bool is_seen, double em) {
    Stroke stroke{Color::rgb(kPieceColors[is_seen ? 1 : 0]), em / 5};
    if (!is_seen) stroke.dashes = {em / 2, em / 4};
    return stroke;
}

}  // namespace

void drawLeastSeenPaths(Picture& picture, const MapPicture& map) {
    if (map.options.objectives == nullptr) return;
    std::array<std::vector<std::vector<Point2>>, kPieceColors.size()> chains;
    for (const LeastSeenPath& way : map.options.objectives->ways)
        for (const LeastSeenPath::Piece& piece : way.pieces) {
            auto& some = chains[piece.is_seen ? 1 : 0];
            if (some.empty() || !(some.back().back() == piece.from)) some.push_back({piece.from});
            some.back().push_back(piece.to);
        }
    picture.pushView(map.view);
    for (const auto& some : chains)
        picture.lines(some, {Stroke{palette::kWhite.faded(0.8), map.em / 2.6}});
    for (std::size_t i = 0; i < chains.size(); ++i)
        picture.lines(chains[i], {pieceStroke(i == 1, map.em)});
    picture.pop();
}

LegendBlock leastSeenPathsBlock(const ObjectiveFigures& figures) {
    using Sign = LegendItem::Sign;
    LegendBlock block{"Ways that are seen least", {}};
    block.items.push_back({Sign::Line, Color::rgb(kPieceColors[1]), {}, "seen", ""});
    block.items.push_back(
        {Sign::Dashes, Color::rgb(kPieceColors[0]), {}, "unseen, or in a zone", ""});
    for (const LeastSeenPath& way : figures.ways)
        block.items.push_back({Sign::None,
                               {},
                               {},
                               way.of.from + " to " + way.of.to,
                               way.seen ? formatFixed(*way.seen, 2) + " m seen" : "unknown"});
    return block;
}

}  // namespace ispace
