// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/point.h"
#include "sim/joined_worlds.h"
#include "sim/sim_time.h"
#include "sim/world.h"

namespace ispace {

/// A requirement on a run, as one sentence:
///
///     no collision|stall [of SUBJECT] [WINDOW]
///     SUBJECT [not] STATE [WHEN] [WINDOW]
///
/// SUBJECT is the id of a robot or a person, or a glob (`r*`) for all its matches. WINDOW is
/// `after T`, `before T` or both, ends included. STATE and WHEN are:
///
///     within D of X,Y | within D of ID | in zone ZONE | seen [by N] | unseen
///     stalled | still | faster than V | slower than V
///
///     once (the default) | always | never | for at least D | at most D
///
/// `always` and `never` may also stand before the state. A state that holds at a step lasts until
/// the next one. `for at least` wants it to last so long without a break; `at most` wants no time
/// without a break to be longer. `seen by N` is by N sensors or more, see Watch.
///
/// In joined worlds ids are those across them, points and zones have their room before them:
/// `within 1 of upper/2,3`, `in zone upper/kitchen`. Distances are within a room.
struct Expectation {
    enum class State { Collision, Stalled, Still, Near, InZone, Seen, Faster, Slower };
    enum class When { Once, Always, Never, AtLeast, AtMost };

    std::string text;  ///< as given
    std::string subject = "*";
    State state = State::Collision;
    bool is_negated = false;      ///< requires that the state does not hold
    double amount = 0;            ///< metres, m/s, or a number of sensors
    std::string room = {};        ///< Near: of the point, "" for the only world
    std::optional<Point2> place;  ///< Near: of this point,
    std::string name;             ///< or of the mover with this id; InZone: the zone
    When when = When::Once;
    SimTime span{};
    SimTime after{};
    SimTime before = SimTime::max();
};

/// Parses a sentence. \throws UsageError that names the expected word and its position
Expectation parseExpectation(std::string_view text);

/// Result of an expectation.
struct RunVerdict {
    std::string expectation;
    bool is_met = false;
    SimTime time{};           ///< when it was decided
    std::string reason = {};  ///< why it is not met: "r1 was 1.2 m away at t=4.500, never nearer"
};

/// Judges a run by its expectations. The same run gets the same verdicts, at any speed and with any
/// number of clients.
class ExpectationJudge {
  public:
    /// The world must outlive the judge. \throws UsageError for subjects and zones that the world
    /// lacks
    ExpectationJudge(const World& world, std::vector<Expectation> expectations);
    /// Likewise for joined worlds.
    ExpectationJudge(std::span<const JoinedRoom> rooms, std::vector<Expectation> expectations);
    ~ExpectationJudge();
    ExpectationJudge(ExpectationJudge&&) noexcept;
    ExpectationJudge& operator=(ExpectationJudge&&) noexcept;

    /// Reads the worlds: call it before the first step and after every step.
    void observe();
    /// Returns verdicts in the order of the expectations, as if the run ended now.
    [[nodiscard]] std::vector<RunVerdict> verdicts() const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Returns one line for each unmet expectation; "" if all are met.
std::string unmetText(const std::vector<RunVerdict>& verdicts);

}  // namespace ispace
