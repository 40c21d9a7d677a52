// SPDX-License-Identifier: GPL-3.0-or-later
// Verbs of plans of days that extensions bring: what people do with their bodies, `sits on chair1
// 5min`. ActivityDirector asks here, and does not know them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"
#include "sim/world.h"

namespace ispace::days {

/// A person about to begin or end a deed.
struct DeedMoment {
    const World* world = nullptr;
    std::size_t mover = 0;           ///< of the person, in World::movers()
    const Record* person = nullptr;  ///< its record now
    std::string id = {};             ///< of the person
    std::string target = {};         ///< "" for verbs without one
    std::string object = {};         ///< of the second part of a verb: the target of the first
    Pose2 stood = {};                ///< where the person stood when the deed began
};

/// The beginning of a deed.
struct PersonDeed {
    std::string change = {};   ///< a request, "ACT ann posture=sit", or ""
    std::string refusal = {};  ///< the reason why the person does not do it; else ""
};

/// A verb: `VERB [WORD] [TARGET] [THEN-WORD TARGET] [DURATION]`.
struct PersonVerb {
    /// How the person comes to it before the deed begins.
    enum class Approach {
        None,   ///< stays where it is
        Faces,  ///< turns to the target on the spot if that is behind it or aside
        Beside  ///< goes to the target, as `uses` does
    };
    std::string verb = {}, word = {};
    std::string target = {};  ///< an example, "chair1"; "": the verb has no target
    bool lasts = false;       ///< it has a duration
    Approach approach = Approach::None;
    bool is_of_rest = false;  ///< people that sit or lie do it as well
    bool interrupts = false;  ///< a line that begins with it ends what the person is doing
    /// Returns the ids of further targets besides zones, elements and things of extensions. Null:
    /// these.
    std::vector<std::string> (*targets)(const World& world) = nullptr;
    bool is_for_goals = true;  ///< false: targets() returns all
    /// Returns the point of a target to which the person turns: of Way::Faces, and where it is set
    /// also of Way::Beside.
    std::optional<Point2> (*aim)(const World& world, const std::string& target) = nullptr;
    /// Returns the reason why the person does not set out for it, or "". Null: "".
    std::string (*refusal)(const DeedMoment& moment) = nullptr;
    /// Called once the person is there, and changes asked for before are made.
    PersonDeed (*begin)(const DeedMoment& moment) = nullptr;
    /// Likewise after its duration, with the change that ends it. Null: none does.
    PersonDeed (*end)(const DeedMoment& moment) = nullptr;
    /// The second part of the verb, with another target behind a word: `carries cup to
    /// kitchen`, which follows unless the first one is given up. Null: it has no second part.
    const PersonVerb* then = nullptr;
};

/// Adds a verb, for the program: call it before any plan is read.
void addPersonVerb(PersonVerb verb);
/// Returns all verbs, in the order in which they were added. Thread-safe.
const std::vector<PersonVerb>& personVerbs();

}  // namespace ispace::days
