// SPDX-License-Identifier: GPL-3.0-or-later
// Circles against lines, and circles against circles.
//
// Two moves at once are one relative path past the origin: circles meet if it comes nearer than the
// sum of their radii. Chords are tested first, widened by what the paths may bulge; only where that
// fails are the parts tested. A circle is stopped by a line only if it enters it deeper than at its
// start, so that rounding, or an overlap at the start, traps no mover.
//
// Squared distances choose the lines that are near; decisions are made by distance(), with a margin
// between them that exceeds the rounding of both.
#include "sim/collision.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_set>

#include "base/error.h"
#include "base/number.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "geom/tolerance.h"
#include "scene/findings/findings.h"
#include "trace/moving_bodies.h"

namespace ispace {

namespace {

std::vector<Segment2> linesOf(const Slice& band) {
    std::vector<Segment2> lines;
    band.forEachLine([&](const Segment2& line) { lines.push_back(line); });
    return lines;
}

/// Returns a square that squaredDistance() of a line as near as this does not exceed, rounded in
/// any way: lines beyond it need no distance(), which takes longer.
double squareAbove(double distance) {
    constexpr double kRounding = 1e-9;
    const double more = distance * (1 + kRounding) + kRounding;
    return more * more;
}

/// The relative motion of a point past the origin.
struct RelativePath {
    Vec2 from, to;

    [[nodiscard]] double nearest() const {
        return distance(Point2{}, Segment2{{from.x, from.y}, {to.x, to.y}});
    }
    /// Returns the same as Obstacles::stop.
    [[nodiscard]] bool stops(double reach) const {
        const double least = nearest();
        return least < reach && least < length(from);
    }
};

}  // namespace

double distance(const Segment2& s, const Segment2& t) {
    if (intersects(s, t)) return 0;
    return std::min({distance(s.a, t), distance(s.b, t), distance(t.a, s), distance(t.b, s)});
}

Obstacles::Part::Part(const Slice& band)
    : solids(band.solids),
      boxes(boundsOfEach(band.solids)),
      lines(linesOf(band)),
      solid_owners(band.solid_owners),
      line_owners(band.sheet_owners),
      grid(lines, 0) {
    // In the order of Slice::forEachLine.
    for (std::size_t i = 0; i < solids.size(); ++i)
        line_owners.insert(line_owners.end(), solids[i].size(), solid_owners[i]);
    assert(line_owners.size() == lines.size());
}

Obstacles::Obstacles(const Slice& band) : base_(std::make_shared<const Part>(band)) {}

Obstacles::Obstacles(const Environment& environment, double height, const Obstacles* before) {
    std::optional<ElementChanges> changes;
    if (before != nullptr && before->base_of_)
        changes = environment.changesSince(*before->base_of_);
    if (!changes) {
        base_ = std::make_shared<const Part>(environment.band(0, height));
        base_of_ = environment;
        return;
    }
    base_ = before->base_;
    base_of_ = before->base_of_;
    if (!changes->added.empty())
        added_ = std::make_shared<const Part>(environment.band(0, height, changes->added));
    elements_.assign(base_of_->elements().size(), kGone);
    auto removed = changes->removed.begin();
    auto added = changes->added.begin();
    for (std::size_t i = 0, now = 0; i < elements_.size(); ++i) {
        if (removed != changes->removed.end() && *removed == i) {
            ++removed;
            continue;
        }
        for (; added != changes->added.end() && *added == now; ++added) ++now;
        elements_[i] = now++;
    }
}

template <typename Visit>
void Obstacles::forEachPart(Visit visit) const {
    visit(*base_);
    if (added_) visit(*added_);
}

/// Calls visit(line, its element) for the lines around p, see SegmentGrid::searchFrom.
template <typename Visit, typename Done>
void Obstacles::search(Point2 p, Visit visit, Done done) const {
    forEachPart([&](const Part& part) {
        const auto visit_cell = [&](std::span<const std::uint32_t> cell) {
            for (const std::uint32_t i : cell)
                if (const std::size_t element = elementOf(part, part.line_owners[i]);
                    element != kGone)
                    visit(part.lines[i], element);
        };
        part.grid.searchFrom(p, visit_cell, done);
    });
}

/// Finds the first element with a line that comes nearer than `reach` to p and passes the test.
template <typename Test>
std::optional<std::size_t> Obstacles::find(Point2 p, double reach, Test test) const {
    std::size_t first = kGone;
    const auto visit = [&](const Segment2& line, std::size_t element) {
        if (element < first && test(line)) first = element;
    };
    search(p, visit, [reach](double seen) { return seen >= reach; });
    return first == kGone ? std::nullopt : std::optional(first);
}

std::optional<std::size_t> Obstacles::overlap(Point2 center, double radius) const {
    const double allowed = radius - kContactTolerance;
    if (const auto owner = find(center, allowed, [&](const Segment2& line) {
            return distance(center, line) < allowed;
        }))
        return owner;
    std::size_t first = kGone;
    forEachPart([&](const Part& part) {
        part.boxes.search({center, center}, [&](std::size_t i) {
            const std::size_t element = elementOf(part, part.solid_owners[i]);
            if (element < first && locate(part.solids[i], center) != Side::Outside) first = element;
        });
    });
    return first == kGone ? std::nullopt : std::optional(first);
}

double Obstacles::nearest(Point2 p, double farthest) const {
    double nearest = farthest, square = squareAbove(farthest);
    const auto visit = [&](const Segment2& line, std::size_t) {
        if (squaredDistance(p, line) > square) return;
        nearest = std::min(nearest, distance(p, line));
        square = squareAbove(nearest);
    };
    search(p, visit, [&](double seen) { return seen >= nearest; });
    return nearest;
}

void Obstacles::findAbout(Point2 p, double reach, std::vector<Segment2>& lines) const {
    forEachPart([&](const Part& part) {
        std::vector<std::uint32_t> indices;
        const auto visit = [&](std::span<const std::uint32_t> cell) {
            indices.insert(indices.end(), cell.begin(), cell.end());
        };
        part.grid.searchBox({p - Vec2{reach, reach}, p + Vec2{reach, reach}}, visit);
        std::sort(indices.begin(), indices.end());
        indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
        for (const std::uint32_t i : indices)
            if (squaredDistance(p, part.lines[i]) <= reach * reach &&
                elementOf(part, part.line_owners[i]) != kGone)
                lines.push_back(part.lines[i]);
    });
}

bool Obstacles::near(const Segment2& way, double distance) const {
    const double reach = distance + ispace::distance(way.a, way.b), square = squareAbove(reach);
    bool is_near = false;
    const auto visit = [&](const Segment2& line, std::size_t) {
        if (is_near || squaredDistance(way.a, line) > square) return;
        is_near = (ispace::distance(way.a, line) < reach && ispace::distance(way, line) < distance);
    };
    search(way.a, visit, [&](double seen) { return is_near || seen >= reach; });
    return is_near;
}

std::optional<std::size_t> Obstacles::stop(const Segment2& way, double radius) const {
    const double allowed = radius - kContactTolerance;
    const double reach = allowed + distance(way.a, way.b);
    return find(way.a, reach, [&](const Segment2& line) {
        const double start = distance(way.a, line);
        if (start >= reach) return false;
        const double least = distance(way, line);
        return least < allowed && least < start;
    });
}

void Vicinity::find(const Obstacles& obstacles, Point2 p, double reach) {
    constexpr double kMore = 0.4;  // metres
    middle_ = p;
    reach_ = reach + kMore;
    lines_.clear();
    obstacles.findAbout(p, reach_ + kCornerTolerance, lines_);
}

Point2 Move::place(int part) const {
    if (part == 0 || to.path == 0) return start();
    if (part == kParts) return end();
    const double share = static_cast<double>(part) / kParts;
    return advance(*from, *limits, duration * share).motion.pose.position + share * drift;
}

void Move::cancel() {
    to = {.motion = *from};
    to.motion.halt();
    drift = {};
}

std::optional<std::size_t> collides(const Move& move, const Obstacles& obstacles) {
    if (!obstacles.near(move.chord(), move.radius - kContactTolerance + move.to.bulge))
        return std::nullopt;
    if (move.to.bulge == 0) return obstacles.stop(move.chord(), move.radius);
    Point2 last = move.start();
    for (int part = 1; part <= Move::kParts; ++part) {
        const Point2 next = move.place(part);
        if (const auto owner = obstacles.stop({last, next}, move.radius)) return owner;
        last = next;
    }
    return std::nullopt;
}

std::vector<BodyDisc> discsOf(const PersonFigure& figure, const Pose2& pose) {
    std::vector<BodyDisc> discs;
    for (std::size_t i = 0; i + figure.load_parts < figure.fixed.size(); ++i) {
        const BodyPart& part = figure.fixed[i];
        const bool is_round = part.radius > 0;
        const double radius = is_round ? part.radius : std::min(part.half_length, part.half_width);
        const double along = is_round ? 0 : part.half_length - radius;
        const double across = is_round ? 0 : part.half_width - radius;
        const int count = 1 + static_cast<int>(std::ceil(2 * std::max(along, across) / radius));
        for (int k = 0; k < count; ++k) {
            const double share = count == 1 ? 0 : 2.0 * k / (count - 1) - 1;
            discs.push_back(
                {pose * (part.center + Vec2{share * along, share * across}), radius, part.bottom});
        }
    }
    return discs;
}

namespace {

/// Returns true if the move of a robot runs into the body of a person that rests.
bool meetsBody(const Move& move, const Move& other) {
    if (move.height <= 0 || other.body == nullptr) return false;
    const double farthest = move.radius + other.span + move.to.path;
    const Vec2 apart = move.start() - other.start();
    if (dot(apart, apart) > farthest * farthest) return false;
    const int parts = move.to.bulge == 0 ? 1 : Move::kParts;
    Point2 last = move.start();
    for (int part = 1; part <= parts; ++part) {
        const Point2 next = parts == 1 ? move.end() : move.place(part);
        for (const BodyDisc& disc : *other.body)
            if (disc.bottom < move.height &&
                RelativePath{last - disc.center, next - disc.center}.stops(
                    move.radius + disc.radius - kContactTolerance))
                return true;
        last = next;
    }
    return false;
}

}  // namespace

/// Tests by bounds from cheap to dear: reach of both ways, the relative chord with the lag of both,
/// then the parts.
bool collides(const Move& move, const Move& other, bool other_moves) {
    if (meetsBody(move, other)) return true;
    const double reach = move.radius + other.radius - kContactTolerance;
    const Point2 other_end = other_moves ? other.end() : other.start();
    const RelativePath way{move.start() - other.start(), move.end() - other_end};
    const double lag = move.to.lag + (other_moves ? other.to.lag : 0);
    // Most are too far apart for any way to meet.
    const double farthest = reach + lag + move.to.path + (other_moves ? other.to.path : 0);
    if (dot(way.from, way.from) > farthest * farthest) return false;
    if (way.nearest() >= reach + lag) return false;
    if (lag == 0) return way.stops(reach);
    Vec2 last = way.from;
    for (int part = 1; part <= Move::kParts; ++part) {
        const Vec2 next = move.place(part) - (other_moves ? other.place(part) : other.start());
        if (RelativePath{last, next}.stops(reach)) return true;
        last = next;
    }
    return false;
}

std::vector<std::size_t> settlingOrder(std::span<const Mover> movers) {
    std::vector<std::size_t> order(movers.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        return std::tie(movers[i].is_person, movers[i].id) <
               std::tie(movers[j].is_person, movers[j].id);
    });
    return order;
}

Traffic::Traffic(std::span<const Mover> movers, std::span<const std::size_t> order, double duration)
    : rank_(movers.size()), places_(movers.size()) {
    for (std::size_t k = 0; k < order.size(); ++k) rank_[order[k]] = k;
    for (const auto& [id, model, pose, course, place, is_person, figure] : movers)
        reach_ = std::max(
            {reach_, model.radius + std::hypot(model.max_speed, model.max_sidespeed) * duration,
             figure == nullptr || figure->rest.empty() ? 0 : figure->reach});
}

/// Movers extend as far as any of them gets in a step, so that a query finds all that may meet.
void Traffic::rebuild(std::span<const Motion> motions) {
    for (std::size_t i = 0; i < motions.size(); ++i) places_[i] = motions[i].pose.position;
    grid_.rebuild(places_, reach_);
}

std::optional<std::size_t> Traffic::hit(std::span<const Move> moves, std::size_t mover,
                                        double farthest) const {
    const Move& move = moves[mover];
    const Box2 box =
        bounds(Segment2{move.start(), move.end()}).expanded(move.radius + move.to.bulge + farthest);
    const std::size_t rank = rank_[mover];
    std::optional<std::size_t> first;
    grid_.forEachNear(box, [&](std::size_t other) {
        if (other == mover || (first && rank_[*first] < rank_[other])) return;
        if (collides(move, moves[other], rank_[other] < rank)) first = other;
    });
    return first;
}

namespace {

/// Detects overlapping movers.
class Neighbours {
  public:
    explicit Neighbours(std::span<const Mover> movers) : movers_(movers) {
        double reach = 0;
        std::vector<Point2> places;
        places.reserve(movers.size());
        for (const Mover& mover : movers) {
            places.push_back(mover.pose.position);
            reach = std::max(reach, mover.model.radius);
        }
        grid_.rebuild(places, reach);
    }

    /// Returns the first of movers `begin` to `end` that mover `i` overlaps; two people, by more
    /// than kPress.
    [[nodiscard]] std::optional<std::size_t> firstOver(std::size_t i, std::size_t begin,
                                                       std::size_t end) const {
        const double radius = movers_[i].model.radius;
        const Point2 place = movers_[i].pose.position;
        const Vec2 margin{radius, radius};
        std::size_t first = end;
        grid_.forEachNear({place - margin, place + margin}, [&](std::size_t other) {
            if (other < begin || other >= first) return;
            const bool may_press = movers_[i].is_person && movers_[other].is_person;
            const double reach =
                (may_press ? 1 - kPress : 1) * (radius + movers_[other].model.radius);
            if (apart(i, other) < reach - kContactTolerance) first = other;
        });
        return first < end ? std::optional(first) : std::nullopt;
    }
    [[nodiscard]] double apart(std::size_t i, std::size_t j) const {
        return distance(movers_[i].pose.position, movers_[j].pose.position);
    }

  private:
    /// Share of their widths by which people may overlap: in a crowd, arms give way.
    static constexpr double kPress = 0.1;

    std::span<const Mover> movers_;
    FloorGrid grid_;
};

}  // namespace

/// One set for each height, however many movers have it.
ObstacleSets obstaclesOf(const Environment& environment, std::span<const Mover> movers,
                         const ObstacleSets* before) {
    ObstacleSets sets;
    for (const Mover& mover : movers) {
        const double height = mover.model.height;
        if (sets.contains(height)) continue;
        const Obstacles* known = nullptr;
        if (before != nullptr)
            if (const auto found = before->find(height); found != before->end())
                known = &found->second;
        sets.emplace(height, Obstacles(environment, height, known));
    }
    return sets;
}

void checkStart(const Scene& scene, std::span<const Mover> movers, const ObstacleSets& obstacles) {
    std::unordered_set<std::string_view> met;
    const Neighbours neighbours(movers);
    std::size_t robots = 0;
    while (robots < movers.size() && !movers[robots].is_person) ++robots;
    // Stops at full findings: a heap of movers would be tested in pairs.
    for (std::size_t i = 0; i < movers.size() && met.size() < Diagnostics::kMax; ++i) {
        const Mover& mover = movers[i];
        if (!mover.is_person &&
            obstacles.at(mover.model.height).overlap(mover.pose.position, mover.model.radius))
            met.insert(mover.id);
        // The movers of the same kind before it, and of a robot all people.
        const std::size_t first = mover.is_person ? robots : 0;
        for (const auto other :
             {neighbours.firstOver(i, first, i),
              neighbours.firstOver(i, robots, mover.is_person ? robots : movers.size())})
            if (other) met.insert({mover.id, movers[*other].id});
    }
    if (met.empty()) return;
    Diagnostics findings;
    for (const Finding& finding :
         checkScene(scene, {.checks = {"collisions"},
                           .ids = [&met](const std::string& id) { return met.contains(id); }}))
        findings.add(finding.diagnostic());
    // Overlaps within the tolerance of that check.
    for (std::size_t i = 0; i < movers.size() && findings.empty(); ++i)
        if (met.contains(movers[i].id))
            findings.add(movers[i].place.finding((movers[i].is_person ? "human " : "robot ") +
                                                 movers[i].id +
                                                 " overlaps its surroundings; move it"));
    findings.throwIfAny();
}

void checkCrowding(std::span<const Mover> movers, std::span<const Motion> motions, double reach) {
    std::vector<Point2> places;
    places.reserve(movers.size());
    double radius = 0;
    for (std::size_t i = 0; i < movers.size(); ++i) {
        places.push_back(motions[i].pose.position);
        radius = std::max(radius, movers[i].model.radius);
    }
    const double near = 2 * radius + reach;
    FloorGrid grid;
    grid.rebuild(places, near / 2);
    const Vec2 margin{near / 2, near / 2};
    std::size_t twice = 0;  // each pair is met from both sides
    for (std::size_t i = 0; i < places.size() && twice <= 2 * kMaxMeetingPairs; ++i)
        grid.forEachNear({places[i] - margin, places[i] + margin}, [&](std::size_t other) {
            const Vec2 way = places[other] - places[i];
            if (other != i && dot(way, way) < near * near) ++twice;
        });
    if (twice <= 2 * kMaxMeetingPairs) return;
    throw FormatError(
        Diagnostic{"", 0, 0,
                   "more than " + std::to_string(kMaxMeetingPairs) +
                       " pairs of robots and people would be within " + formatFixed(near, 1) +
                       " m of each other, too many to move; leave some out, spread them over more "
                       "floor, or take shorter steps"});
}

}  // namespace ispace
