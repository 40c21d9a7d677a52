// SPDX-License-Identifier: GPL-3.0-or-later
// Records of extensions that act on a room: they take power, sound, warm and shine, people use
// them, they let people pass or not, and turn the sensors on them. Sensors, states and activities
// ask here, and know no keyword. A record of the core has a kind, too, once an extension adds keys
// to it.
//
// Kinds are added by one thread before any scene is read; another kind for a keyword replaces the
// first. From then on the table is constant, and its functions may be called by several threads:
// they depend on their arguments alone.
//
//     addThingKind("kettle", {.states = {"on"}, .emission = kettleEmission});
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "env/mesh.h"
#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

struct PersonFigure;
struct Scene;

/// What a thing takes and gives off in the state of its record.
struct Emission {
    Pose3 pose = {};    ///< in the room: where it sounds and shines, and the axis of its light
    double watts = 0;   ///< electric power
    double heat = 0;    ///< W that warm the zone in which it stands
    double volume = 0;  ///< sound pressure level at a metre, dB; 0: silent
    double lumens = 0;  ///< of its light, even over a pyramid about its axis
    Angle spread = Angle::degrees(120);  ///< full angle of the pyramid, across and upright
};

/// The changes of states that follow when a person uses a thing: `key=value`, or "" for none.
struct UseChanges {
    std::string begin, end;
};

/// What comes of an act of a person on a thing.
struct ActResult {
    std::string changes;  ///< of its states, `key=value key=value`
    std::string refusal;  ///< the reason for no change: "it is locked"; else ""
};

/// Tells home automation more about a state than its name.
struct StateEntity {
    std::string key;
    std::string component, device_class;  ///< of Home Assistant, the class may be ""
};

/// What pictures show of a thing.
struct ThingBody {
    std::vector<Mesh> meshes = {};  ///< closed, seen from outside; no ray of a sensor meets them
    /// The light that it gives off, linear red, green and blue, 1 as bright as a white wall in
    /// light; empty: it reflects light as its materials do.
    std::optional<std::array<float, 3>> glow = {};
};

/// Records with a keyword.
struct ThingKind {
    std::vector<std::string> states = {};     ///< keys whose values may change while the world runs
    std::vector<std::string> body_keys = {};  ///< further keys that change the body of a person
    std::vector<std::string> told = {};       ///< further states, numbers that events of a run tell
    /// Returns true for records whose states are told: a door with a lock. Null: all.
    bool (*has_states)(const Record& record) = nullptr;
    Emission (*emission)(const Record& record) = nullptr;  ///< null: none
    UseChanges (*use)(const Record& record) = nullptr;     ///< null: it stays as it is
    /// Throws FormatError if values of a record contradict each other: such a scene is rejected,
    /// and so is a change that leads to it. Null: all go together.
    void (*check)(const Record& record) = nullptr;
    /// Returns the reason why the record of a person does not change like this while the world
    /// runs, or "". \param at where the person is after the change \param scene likewise
    /// Null: "".
    std::string (*refusal)(const Record& before, const Record& after, const Pose2& at,
                           const Scene& scene) = nullptr;
    /// Verbs for what people do to it, as `locks` in a plan of days.
    std::vector<std::string> verbs = {};
    /// Returns what comes of one of these verbs, or of `opens`, `closes` and `switches`, for which
    /// `changes` are those without the kind. Null: these.
    ActResult (*act)(const Record& record, std::string_view verb, const Record& person,
                     std::string changes) = nullptr;
    /// Returns the changes that let a person pass a shut door, and those behind the person; `begin`
    /// is "" if it does not. Null: it does not.
    UseChanges (*pass)(const Record& record, const Record& person) = nullptr;
    /// Returns the changes that shut an open door behind people: `changes` are those of pass(), and
    /// the door may have become another one since. Null: these.
    std::string (*shut)(const Record& record, std::string changes) = nullptr;
    /// Returns the word for a door that lets no person pass: "locked". Null, or "": "shut".
    std::string_view (*barrier)(const Record& record) = nullptr;
    std::vector<StateEntity> entities = {};
    /// Returns the frame in which a record carries sensors, relative to its carrier (`on`, a robot
    /// or an object; then z counts from the floor or from the top) or the room: a joint that turns
    /// them. Null: it carries them as an object does, on its top.
    Pose3 (*mount)(const Record& record) = nullptr;
    /// Returns its body for pictures and models, in its frame. Such records, which have `at` with
    /// three numbers, `heading` and perhaps `on`, go with the robot or object that carries them.
    /// Null: none.
    ThingBody (*body)(const Record& record) = nullptr;
    /// Returns the body of a person, for the keyword `human`, with the thing that it carries, if
    /// any; null for the usual one. Null: that.
    std::shared_ptr<const PersonFigure> (*figure)(const Record& person,
                                                  const Record* load) = nullptr;
};

/// Adds the kind of a keyword, for the program: call it before any scene is read.
void addThingKind(std::string_view keyword, ThingKind kind);

/// Returns the kind of a keyword; null for keywords of the core and others without one.
/// Thread-safe.
const ThingKind* thingKind(std::string_view keyword);
/// Returns all kinds, by keyword.
const std::map<std::string, ThingKind, std::less<>>& thingKinds();
/// Returns the emission of a record; empty if its keyword has none. Thread-safe.
std::optional<Emission> emissionOf(const Record& record);
/// Returns the body that a kind gives a person with a load, which may be null; null for the usual
/// one. Thread-safe.
std::shared_ptr<const PersonFigure> figureOf(const Record& person, const Record* load = nullptr);
/// Returns the word for a door that lets no person pass, "" for others. Thread-safe.
std::string_view barrierOf(const Record& record);

}  // namespace ispace
