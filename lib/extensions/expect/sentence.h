// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/expect: sentences that say what a run must do, and the judge of them: simrun
// --expect. Uses server and below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "geom/point.h"
#include "sim/sim_time.h"

namespace ispace::expect {

/// A state of movers, of things or of zones that a sentence is about.
struct Condition {
    enum class State {
        Collision,
        Stalled,
        Still,
        Near,
        InZone,
        Seen,
        Faster,
        Slower,  ///< of movers
        On,      ///< of things: the state is neither 0 nor empty
        Is,
        Above,
        Below,
    };
    /// Which of the subjects that match.
    enum class Of {
        Each,   ///< each by itself
        Any,    ///< one or more of them
        Total,  ///< the sum of their values
    };

    std::string subject = "*";
    std::string part = {};  ///< zone in which the subjects stand; "" anywhere
    Of of = Of::Each;
    State state = State::Collision;
    bool is_negated = false;      ///< `not`: requires that the state does not hold
    bool is_opposite = false;     ///< `off`, `closed`, `empty`: of each subject
    double amount = 0;            ///< metres, m/s, a number of sensors, or the value of a state
    std::string room = {};        ///< Near: of the point, "" for the only world
    std::optional<Point2> place;  ///< Near: of this point,
    std::string name;             ///< or of the mover with this id; InZone: the zone; Is: the value
    /// Of a thing: its state; "" if the subject names it (ID.KEY), or for its only state.
    std::string key = {};
    SimTime lasts{};         ///< holds once the state has lasted for more than this
    std::size_t offset = 0;  ///< of the subject in the sentence, bytes
};

/// True if all conditions of one of the lists hold.
using Clause = std::vector<std::vector<Condition>>;

/// A requirement on a run, as one sentence:
///
///     no collision|stall [of SUBJECT] [WINDOW]
///     CLAUSE [WHEN] [within D of EVENT] [while CLAUSE] [WINDOW]
///
/// A CLAUSE is one or more `SUBJECT [not] STATE [for more than D]`, joined by `and` and `or`.
/// SUBJECT is the id of a robot, a person, a thing or a zone, or a glob (`r*`), or a keyword of
/// records (`lamp`), for all its matches, and `of ZONE` for those that stand there; `any` before it
/// means one of the matches, `total` the sum of their values. WINDOW is `after T`, `before T` or
/// both, ends included. STATE of a robot or a person is
///
///     within D of X,Y | within D of ID | in zone ZONE | seen [by N] | unseen
///     stalled | still | faster than V | slower than V
///
/// and of a thing, by the states that events report,
///
///     on | off | open | closed | occupied | empty | broken | motion | touched
///     above V | below V | is V
///
/// with the key after the id if it has several (`l1.level above 0.5`); a zone has `people`,
/// `robots` and `occupied`, a thing with power `watts` and `kwh`. WHEN is
///
///     once (the default) | always | never | at the end | for at least D | for at most D
///     at least N times | at most N times | for at least D in all | for at most D in all
///
/// `always` and `never` may also stand before the state. A state that holds at a step lasts until
/// the next one. `for at least` wants it to last so long without a break; `at most` wants no time
/// without a break to be longer. `seen by N` is by N sensors or more, see Watch.
///
/// An EVENT is a CLAUSE that begins to hold; `ann enters ZONE`, `ann leaves ZONE`, `l1 turns on`,
/// `w1 opens` and their like say so. After each, the state has to hold at a step of the time D
/// (`once`), at all of them (`always`), at none (`never`), or has to begin in it and to last (`for
/// at least`). Without any event the requirement is not met; times that the run cuts off are not
/// judged. `while` judges the steps alone at which its clause holds.
///
/// In joined worlds ids are those across them, points and zones have their room before them:
/// `within 1 of upper/2,3`, `in zone upper/kitchen`. Distances are within a room.
struct Expectation {
    enum class When {
        Once,
        Always,
        Never,
        AtEnd,
        AtLeast,
        AtMost,
        AtLeastTimes,
        AtMostTimes,
        AtLeastInAll,
        AtMostInAll
    };

    std::string text;       ///< as given
    std::string name = {};  ///< of the rule in a file; "" without
    Clause claim;           ///< at least one condition
    When when = When::Once;
    SimTime span{};
    std::int64_t times = 0;
    Clause event = {};            ///< empty without
    std::string event_text = {};  ///< as given
    SimTime deadline{};           ///< after an event
    Clause gate = {};             ///< of `while`; empty without
    std::string gate_text = {};
    SimTime after{};
    SimTime before = SimTime::max();
    Diagnostic source = {};   ///< of the sentence in a file; without a file: of the command line
    bool is_verbatim = true;  ///< columns of the file follow from offsets in the text
};

/// An error in a sentence.
class SentenceError : public UsageError {
  public:
    SentenceError(const std::string& message, std::size_t offset)
        : UsageError(message), offset_(offset) {}
    /// Returns the place of the word at fault, bytes from the beginning.
    [[nodiscard]] std::size_t offset() const { return offset_; }

  private:
    std::size_t offset_;
};

/// Parses a sentence. \throws SentenceError that names the expected word and its position
Expectation parseExpectation(std::string_view text);

}  // namespace ispace::expect
