// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/cables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <utility>

#include "geom/arrangement.h"

namespace ispace::pages {

namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// A point on a wall, or away from it.
struct WallFoot {
    std::size_t piece = 0;
    Point2 place;
    double away = 0;  ///< of the point from the wall
};

/// Walls as a graph: pieces meet at common ends.
class WallNet {
  public:
    explicit WallNet(const std::vector<Segment2>& lines) {
        for (const LinePiece& piece : noded(linePieces(lines))) {
            const auto index = pieces_.size();
            pieces_.push_back({piece.segment, nodeAt(piece.segment.a), nodeAt(piece.segment.b)});
            for (const std::size_t node : {pieces_[index].a, pieces_[index].b})
                at_node_[node].push_back(index);
        }
    }

    /// Returns the length along walls from a foot to each node.
    [[nodiscard]] std::vector<double> lengthsFrom(const WallFoot& foot) const {
        std::vector<double> lengths(at_node_.size(), kUnreached);
        using Reached = std::pair<double, std::size_t>;
        std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
        const auto reach = [&](std::size_t node, double length) {
            if (length >= lengths[node]) return;
            lengths[node] = length;
            queue.emplace(length, node);
        };
        const Piece& first = pieces_[foot.piece];
        reach(first.a, distance(foot.place, first.line.a));
        reach(first.b, distance(foot.place, first.line.b));
        while (!queue.empty()) {
            const auto [length, node] = queue.top();
            queue.pop();
            if (length > lengths[node]) continue;
            for (const std::size_t index : at_node_[node]) {
                const Piece& piece = pieces_[index];
                reach(piece.a == node ? piece.b : piece.a,
                      length + distance(piece.line.a, piece.line.b));
            }
        }
        return lengths;
    }

    /// Finds the nearest wall, with all that are as near, if `lengths` are not null among those
    /// that they reach.
    [[nodiscard]] std::vector<WallFoot> nearest(Point2 from,
                                                const std::vector<double>* lengths) const {
        constexpr double kAsNear = 1e-9;  // metres
        std::vector<WallFoot> feet;
        double least = kUnreached;
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            const Piece& piece = pieces_[i];
            if (lengths != nullptr && (*lengths)[piece.a] == kUnreached) continue;
            const Vec2 along = piece.line.b - piece.line.a;
            const double share =
                std::clamp(dot(from - piece.line.a, along) / dot(along, along), 0.0, 1.0);
            const Point2 foot = piece.line.a + share * along;
            const double away = distance(from, foot);
            least = std::min(least, away);
            if (away <= least + kAsNear) feet.push_back({i, foot, away});
        }
        std::erase_if(feet, [least](const WallFoot& foot) { return foot.away > least + kAsNear; });
        return feet;
    }

    /// Returns the length along walls between two feet. \param lengths from the first
    [[nodiscard]] double between(const WallFoot& from, const WallFoot& to,
                                 const std::vector<double>& lengths) const {
        const Piece& piece = pieces_[to.piece];
        const double way = std::min(lengths[piece.a] + distance(to.place, piece.line.a),
                                    lengths[piece.b] + distance(to.place, piece.line.b));
        return from.piece == to.piece ? std::min(way, distance(from.place, to.place)) : way;
    }

  private:
    struct Piece {
        Segment2 line;
        std::size_t a, b;  ///< nodes
    };

    std::size_t nodeAt(Point2 place) {
        const auto [known, is_new] = nodes_.try_emplace({place.x, place.y}, at_node_.size());
        if (is_new) at_node_.emplace_back();
        return known->second;
    }

    std::vector<Piece> pieces_;
    std::vector<std::vector<std::size_t>> at_node_;  ///< pieces
    std::map<std::pair<double, double>, std::size_t> nodes_;
};

/// Shortens the cables to those that end at a panel, given by its record.
void layTo(const Record& record, const std::string& id, const Scene& scene, const WallNet& net,
           std::vector<Cable>& cables) {
    const Point2 at{record.tuple("at")[0], record.tuple("at")[1]};
    for (const WallFoot& foot : net.nearest(at, nullptr)) {
        const std::vector<double> lengths = net.lengthsFrom(foot);
        for (Cable& cable : cables) {
            const Point3 place = scene.sensors[cable.sensor].pose.position;
            for (const WallFoot& own : net.nearest(place.onFloor(), &lengths)) {
                const double length = foot.away + net.between(foot, own, lengths) + own.away +
                                      std::abs(place.z - record.number("height"));
                if (!cable.panel.empty() && length >= cable.length) continue;
                cable = {cable.sensor, id, length, length * record.number("cost")};
            }
        }
    }
}

}  // namespace

std::vector<Cable> cablesOf(const Scene& scene) {
    std::vector<const Element*> panels;
    for (const Element& element : scene.environment.elements())
        if (element.record.keyword() == "panel") panels.push_back(&element);
    std::vector<Cable> cables;
    if (panels.empty()) return cables;
    for (std::size_t i = 0; i < scene.sensors.size(); ++i)
        if (!scene.sensors[i].mount && !scene.sensors[i].person) cables.push_back({i, "", 0, 0});
    const WallNet net(scene.environment.wallLines());
    for (const Element* panel : panels) layTo(panel->record, panel->id, scene, net, cables);
    return cables;
}

}  // namespace ispace::pages
