// SPDX-License-Identifier: GPL-3.0-or-later
// Advances the state of a world by a step.
//
// First, each mover proposes a move from the state at the beginning, in parallel: no proposal reads
// another. A mover that stands is done, and so is one with more room about it than it and any other
// can use up in the step. Second, the rest look at their neighbours, in parallel, and most are
// done. Third, those that may collide are settled one by one, robots before people, by id: a move
// is tested against the settled moves and against the starts of all others, and cancelled if it
// collides. So the result is that of settling all of them in this order.
//
// Invariant: `room` of a mover is a lower bound of the distance to every other circle, less what
// both can have moved since it was measured; `clearance` is that to bodies.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/tolerance.h"
#include "sim/world_state.h"

namespace ispace {

namespace {

/// Metres around a robot within which obstacles are cached: they are looked up again once it has
/// gone as far.
constexpr double kLookout = 1;
/// Movers that one thread proposes for: fewer are done before other threads have begun.
constexpr std::size_t kTogether = 64;

}  // namespace

/// Chunks have a constant size and separate lists, so results are the same for any number of
/// threads.
void World::Data::proposeAll() {
    if (std::exchange(moved, false)) traffic.rebuild(motions);
    if (!longest_step) longest_step = longestStep();
    chunks.resize((movers.size() + kTogether - 1) / kTogether);
    const Surroundings around{movers, motions, &traffic};
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t k) {
        Chunk& chunk = chunks[k];
        chunk.doubtful.clear();
        chunk.ends.clear();
        chunk.unreached.clear();
        chunk.moved = false;
        const std::size_t end = std::min((k + 1) * kTogether, movers.size());
        for (std::size_t i = k * kTogether; i < end; ++i) {
            propose(i, around);
            if (isAlone(i))
                finish(i, chunk);
            else
                chunk.doubtful.push_back(i);
        }
    });
}

/// Independent of all other proposals: reads only position and speed of other movers, which stay.
void World::Data::propose(std::size_t mover, const Surroundings& around) {
    Move& move = moves[mover];
    Motion& motion = motions[mover];
    move.from = &motion;
    states[mover].blocked.reset();
    if (!movers[mover].rest().empty()) {
        move.to = {.motion = motion};
        move.drift = {};
        putBody(mover);
        return;
    }
    if (const SimTime now = time - step_length; pilots[mover].isDue(now, motion))
        pilots[mover].steer({&around, states[mover].obstacles, &states[mover].vicinity, mover,
                             states[mover].clearance, now, step_length},
                            motion);
    if (motion.arrived()) {
        move.to = {.motion = motion};
        move.drift = {};
        return;
    }
    setLimits(mover);
    move.to = advance(motion, states[mover].limits, move.duration);
    if (options.noise && mover < odometers.size() && odometers[mover].isNoisy()) {
        move.drift = odometers[mover].stray(move.to.motion, motion.pose, steps);
        move.to.path += length(move.drift);
    }
    // For the next step, and for navigators.
    if (move.to.motion.drive.speed != 0 || move.to.motion.side.speed != 0)
        move.to.motion.keepForward();
    states[mover].blocked = elementAhead(mover);
}

/// Puts the body of a person that rests where it is.
void World::Data::putBody(std::size_t mover) {
    MoverState& state = states[mover];
    const Pose2& pose = motions[mover].pose;
    if (!state.body.empty() && state.body_at == pose) return;
    state.body = discsOf(*movers[mover].figure, pose);
    state.body_at = pose;
    moves[mover].body = &state.body;
    moves[mover].span = movers[mover].figure->reach;
}

void World::Data::setLimits(std::size_t mover) {
    MotionLimits& limits = states[mover].limits;
    const FrictionMap& friction = setting->friction;
    const double rough = friction.at(motions[mover].pose.position);
    if (!friction.empty()) limits = limitsOf(movers[mover].model, rough);
    if (const auto& own = states[mover].own_limits) {
        limits = narrowed(limitsOf(movers[mover].model, rough), *own, rough);
        return;
    }
    const double speed = pilots[mover].isOn() ? pilots[mover].speed() : movers[mover].model.speed;
    limits.drive.top = (1 - rough) * speed;
}

/// Most steps need no search: only once ways have used up the clearance is it measured anew.
std::optional<std::size_t> World::Data::elementAhead(std::size_t mover) {
    const Move& move = moves[mover];
    MoverState& state = states[mover];
    if (move.to.path == 0) return std::nullopt;
    if (state.clearance < move.to.path) {
        const double around = move.radius + kLookout;
        state.clearance =
            state.obstacles->nearest(move.start(), around) - move.radius - kContactTolerance;
        if (state.clearance < move.to.path) {
            if (const auto element = collides(move, *state.obstacles)) return element;
        }
    }
    state.clearance -= move.to.path;
    return std::nullopt;
}

/// Returns true if the move cannot meet another mover, whatever its move. The room is not measured
/// again before it may be used up. The way due to noise is not known beforehand.
bool World::Data::isAlone(std::size_t mover) {
    const Advance& to = moves[mover].to;
    double& room = states[mover].room;
    const double both = to.path + *longest_step;
    if (to.path > 0 && (options.noise || states[mover].blocked || room < 2 * both)) return false;
    room -= both;
    return true;
}

/// Returns false if the move cannot meet another mover, whatever its move. Measures the room.
bool World::Data::mayMeet(std::size_t mover) {
    // Longer than a search takes to pay, but no farther than movers see each other: fast ones, or
    // long steps, would have half of a crowd in reach.
    constexpr double kSteps = 32;
    const Move& move = moves[mover];
    if (states[mover].blocked) return true;
    const double both = move.to.path + std::max(*longest_step, farthest);
    double room = options.noise ? 0 : std::min(kSteps * both, 2 * both + kMoverSight);
    bool may_meet = false;
    traffic.forEachNear(
        move.start(), move.radius + std::max(room, 2 * both), [&](std::size_t other) {
            if (other == mover || may_meet) return;
            const Move& its = moves[other];
            room = std::min(room, distance(move.start(), traffic.place(other)) - move.radius -
                                      move.reachOf(its) - kContactTolerance);
            if (room < 2 * both) may_meet = collides(move, its, true) || collides(move, its, false);
        });
    states[mover].room = may_meet ? 0 : room - both;
    return may_meet;
}

/// The parallel part changes only the mover itself and its chunk, and reads of others no more than
/// places and proposals.
void World::Data::settle() {
    const auto look = [this](Chunk& chunk) {
        std::erase_if(chunk.doubtful, [&](std::size_t mover) {
            if (mayMeet(mover)) return false;
            finish(mover, chunk);
            return true;
        });
    };
    farthest = 0;
    if (options.noise)
        for (const Move& move : moves) farthest = std::max(farthest, move.to.path);
    std::size_t doubtful = 0;
    for (const Chunk& chunk : chunks) doubtful += chunk.doubtful.size();
    if (doubtful > 2 * kTogether)
        tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t k) { look(chunks[k]); });
    else if (doubtful > 0)
        std::for_each(chunks.begin(), chunks.end(), look);
    // One after another: each move depends on those settled before it.
    unsettled.clear();
    for (const Chunk& chunk : chunks)
        unsettled.insert(unsettled.end(), chunk.doubtful.begin(), chunk.doubtful.end());
    std::sort(unsettled.begin(), unsettled.end(),
              [&](std::size_t a, std::size_t b) { return traffic.rank(a) < traffic.rank(b); });
    for (const std::size_t mover : unsettled) {
        if (states[mover].blocked) {
            collide({mover, std::nullopt, elements()[*states[mover].blocked].id, time});
        } else if (const auto other = traffic.hit(moves, mover, farthest)) {
            collide({mover, other, movers[*other].id, time});
        }
        finish(mover, chunks[mover / kTogether]);
    }
}

/// A bump stops a navigated mover for this step only; any other stalls, which ends its command.
void World::Data::collide(const Collision& collision) {
    Move& move = moves[collision.robot];
    states[collision.robot].bump = move.end() - move.start();
    move.cancel();
    if (collision.robot < odometers.size()) odometers[collision.robot].stay();
    if (pilots[collision.robot].isOn()) return pilots[collision.robot].bumped();
    states[collision.robot].stall = true;
    collisions.push_back(collision);
}

/// The move is final.
void World::Data::finish(std::size_t mover, Chunk& chunk) {
    Motion& motion = next_motions[mover];
    motion = moves[mover].to.motion;
    const bool has_moved = motion.pose != motions[mover].pose;
    chunk.moved = chunk.moved || has_moved;
    if (mover >= odometers.size()) {
        // A person that is stopped lowers its limbs where it stands.
        chunk.moved = walk(mover) || chunk.moved;
    } else {
        if (has_moved)
            odometers[mover].roll(travelOf(motions[mover], motion, moves[mover].duration));
        if (options.noise) odometers[mover].count(steps);
    }
    if (const auto point = pilots[mover].takeUnreached())
        chunk.unreached.push_back({mover, *point});
    if (states[mover].running == 0) return;
    const auto end = [&](Outcome outcome) { chunk.ends.push_back({mover, 0, outcome, time}); };
    if (Navigator& pilot = pilots[mover]; pilot.isOn()) {
        return;
    } else if (pilot.state() != Navigator::State::Off) {
        end(pilot.state() == Navigator::State::Arrived ? Outcome::Done : Outcome::Unreached);
        pilot.turnOff();
    } else if (states[mover].stall) {
        end(Outcome::Stall);
    } else if (motion.arrived()) {
        end(Outcome::Done);
        motion.halt();
    }
}

/// Lists are in order of rank, that of robots before people: clients see the same order for any
/// number of threads.
void World::Data::apply() {
    std::swap(motions, next_motions);
    const std::size_t before = ends.size();
    for (const Chunk& chunk : chunks) {
        moved = moved || chunk.moved;
        ends.insert(ends.end(), chunk.ends.begin(), chunk.ends.end());
        unreached.insert(unreached.end(), chunk.unreached.begin(), chunk.unreached.end());
    }
    if (moved) sensors.moved();
    const auto is_under_way = [this](const CommandEnd& end) {
        return states[end.robot].trip && continueTrip(end.robot, end.outcome);
    };
    ends.erase(std::remove_if(ends.begin() + static_cast<std::ptrdiff_t>(before), ends.end(),
                              is_under_way),
               ends.end());
    std::sort(unreached.begin(), unreached.end(),
              [&](const UnreachedPoint& a, const UnreachedPoint& b) {
                  return traffic.rank(a.mover) < traffic.rank(b.mover);
              });
    const auto added = ends.begin() + static_cast<std::ptrdiff_t>(before);
    std::sort(added, ends.end(), [&](const CommandEnd& a, const CommandEnd& b) {
        return traffic.rank(a.robot) < traffic.rank(b.robot);
    });
    for (auto end = added; end != ends.end(); ++end)
        end->id = std::exchange(states[end->robot].running, 0);
}

/// Swings the limbs by the way that the body has really gone, 0 after a collision.
/// \returns true if they have moved
bool World::Data::walk(std::size_t mover) {
    const std::size_t person = mover - scene->robots.size();
    const Motion& motion = next_motions[mover];
    const double speed = std::hypot(motion.drive.speed, motion.side.speed);
    const double path = moves[mover].to.path;
    gaits[person].walk(movers[mover].model.height, motion.drive.speed < 0 ? -path : path, speed);
    const Angle swing = gaits[person].swing(speed);
    return std::exchange(swings[person], swing) != swing;
}

}  // namespace ispace
