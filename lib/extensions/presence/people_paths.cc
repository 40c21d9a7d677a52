// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces are straight, from one used moment to the next; in a bend of 0.5 m radius at 1.4 m/s the
// chord is 4 mm shorter than the way. Steps above 12 m/s are jumps of a client, and make no piece.
#include "extensions/presence/people_paths.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace ispace::presence {

std::vector<std::size_t> PeoplePaths::firsts() const {
    std::vector<std::size_t> firsts(people.size() + 1, pieces.size());
    for (std::size_t i = pieces.size(); i-- > 0;) firsts[pieces[i].person] = i;
    // A person without pieces has those from the next one's first to before it.
    for (std::size_t k = people.size(); k-- > 0;)
        if (firsts[k] == pieces.size()) firsts[k] = firsts[k + 1];
    return firsts;
}

void PathCutter::add(const std::string& person, double time, Point2 place) {
    constexpr double kFastest = 12;  // m/s: no person runs faster
    // Callers add the people of one moment after another, in one order.
    for (std::size_t k = 0; k < ways_.size(); ++k) {
        last_ = (last_ + 1) % ways_.size();
        if (ways_[last_].id == person) break;
    }
    if (ways_.empty() || ways_[last_].id != person) {
        last_ = ways_.size();
        ways_.push_back({.id = person, .place = place});
    }
    Path& way = ways_[last_];
    constexpr double kTolerance = 1e-9;  // s
    constexpr std::size_t kMaxPieces = 10'000'000;
    const double passed = time - way.time;
    if (passed < kPathStep - kTolerance) return;
    const Vec2 step = place - way.place;
    const double covered = length(step);
    if (std::isfinite(passed) && covered > 0 && covered <= kFastest * passed) {
        if (++pieces_ > kMaxPieces)
            throw UsageError(
                "the ways have more than 10 000 000 pieces of 0.2 s; take a shorter run");
        way.pieces.push_back({0, way.time, way.place, (1 / passed) * step, covered});
    }
    way.time = time;
    way.place = place;
}

PeoplePaths PathCutter::finish() {
    PeoplePaths ways;
    for (Path& way : ways_) {
        for (PathPiece& piece : way.pieces) {
            piece.person = ways.people.size();
            ways.pieces.push_back(piece);
        }
        ways.people.push_back(std::move(way.id));
    }
    ways_.clear();
    last_ = pieces_ = 0;
    return ways;
}

void visitPeople(RunReader& reader, const PersonVisit& visit) {
    while (reader.next())
        for (const RunState& state : reader.states())
            if (const RunMember& member = reader.members()[state.member]; member.is_person)
                visit(member.id, reader.time(), state.pose.position);
}

}  // namespace ispace::presence
