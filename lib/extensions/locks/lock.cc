// SPDX-License-Identifier: GPL-3.0-or-later
// Rules in one table: a tag of `access` opens, locks and unlocks; force breaks a locked door, which
// then is open and locks no more. Answers are changes of records, with the reason if there is none.
//
// checkExit() opens all doors that the person may pass, builds the floor anew, and looks whether a
// doorway of its part leads out.
#include "extensions/locks/lock.h"

#include <algorithm>
#include <functional>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "env/zone.h"
#include "geom/point.h"
#include "record/schema.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"

namespace ispace::locks {

namespace {

constexpr std::string_view kOpens = "opens", kLocks = "locks", kUnlocks = "unlocks",
                           kForces = "forces";

constexpr double kMostStrength = 1e6;

/// A door that says whether it is locked has a lock.
bool isLocked(const Record& door) { return door.has("locked") && door.flag("locked"); }

bool hasLock(const Record& door) {
    return door.has("locked") || door.has("access") || door.flag("forced");
}

bool hasTag(const Record& record) {
    return record.schema().find("tag") != nullptr && record.has("tag");
}

}  // namespace

bool Lock::opensTo(const Record& mover) const {
    return hasTag(mover) &&
           std::find(access.begin(), access.end(), mover.text("tag")) != access.end();
}

std::vector<std::string> parseAccess(std::string_view text) {
    std::vector<std::string> tags;
    while (true) {
        const std::size_t end = std::min(text.find(','), text.size());
        const std::string_view tag = text.substr(0, end);
        if (!isWord(tag))
            throw FormatError(
                Diagnostic{"", 0, 0,
                           "`access`: wanted tags between commas, as 42,43; " +
                               (tag.empty() ? "one is empty" : excerpt(tag) + " is none")});
        if (std::find(tags.begin(), tags.end(), tag) != tags.end())
            throw FormatError(
                Diagnostic{"", 0, 0, "`access`: the tag " + excerpt(tag) + " is given twice"});
        tags.emplace_back(tag);
        if (end == text.size()) return tags;
        text.remove_prefix(end + 1);
    }
}

Lock lockOf(const Record& door) {
    Lock lock;
    lock.is_locked = isLocked(door);
    lock.is_forced = door.flag("forced");
    if (door.has("access")) {
        try {
            lock.access = parseAccess(door.text("access"));
        } catch (const FormatError& error) {
            throw FormatError(door.finding("access", error.diagnostics().front().message));
        }
    }
    if (lock.is_locked && door.flag("open"))
        throw FormatError(door.finding(
            "locked", "an open door cannot be locked: set open=no, or locked=no before it opens"));
    if (lock.is_locked && lock.is_forced)
        throw FormatError(door.finding(
            "locked", "the lock of a door that was forced is broken: set forced=no to repair it"));
    return lock;
}

ActResult actOnLock(const Record& door, std::string_view verb, const Record& person,
                    std::string changes) {
    const Lock lock = lockOf(door);
    const auto refused = [](std::string reason) { return ActResult{"", std::move(reason)}; };
    const std::string no_right =
        hasTag(person) ? "its lock does not know the person's tag" : "the person has no tag";
    const bool is_of_lock = verb == kLocks || verb == kUnlocks || verb == kForces;
    if (is_of_lock && !hasLock(door)) return refused("it has no lock");
    if (verb == kOpens) {
        if (!lock.is_locked) return {std::move(changes), ""};
        if (!lock.opensTo(person)) return refused("it is locked, and " + no_right);
        return {"locked=no open=yes", ""};
    }
    if (verb == kLocks) {
        if (lock.is_locked) return {};
        if (lock.is_forced) return refused("its lock is broken");
        if (door.flag("open")) return refused("it is open");
        if (!lock.opensTo(person)) return refused(no_right);
        return {"locked=yes", ""};
    }
    if (verb == kUnlocks) {
        if (!lock.is_locked) return {};
        if (!lock.opensTo(person)) return refused(no_right);
        return {"locked=no", ""};
    }
    if (verb == kForces) {
        if (!lock.is_locked) return refused("it is not locked");
        return {"forced=yes locked=no open=yes", ""};
    }
    return {std::move(changes), ""};
}

UseChanges passOfLock(const Record& door, const Record& person) {
    const Lock lock = lockOf(door);
    if (lock.access.empty()) return {};
    if (!lock.is_locked) return {.begin = "open=yes", .end = "open=no"};
    if (!lock.opensTo(person)) return {};
    return {.begin = "locked=no open=yes", .end = "open=no locked=yes"};
}

std::string shutOfLock(const Record& door, std::string changes) {
    return door.flag("forced") || !hasLock(door) ? "open=no" : std::move(changes);
}

namespace {

/// Checks the tags of doors, with those of all records of the scene listed once.
class AccessCheck {
  public:
    explicit AccessCheck(const Scene& scene) : scene_(&scene) {
        for (const Record& each : scene.records)
            if (hasTag(each)) known_.push_back(each.text("tag"));
        tags_.insert(known_.begin(), known_.end());
    }
    [[nodiscard]] std::optional<Finding> operator()(std::size_t record) const {
        const Record& door = scene_->records[record];
        if (!door.has("access")) return std::nullopt;
        const std::string& id = scene_->ids[record];
        for (const std::string& tag : lockOf(door).access) {
            if (tags_.contains(tag)) continue;
            const std::string nearest = nearestWord(tag, known_);
            return Finding{
                .element = id,
                .message =
                    "door " + id + " opens to the tag " + excerpt(tag) + ", which no record has",
                .hint = nearest.empty() ? "give it to a person by tag=" : "write `" + nearest + '`',
                .source = door.keyPlace("access")};
        }
        return std::nullopt;
    }

  private:
    const Scene* scene_;
    std::vector<std::string> known_;
    std::unordered_set<std::string> tags_;
};

}  // namespace

std::optional<Finding> checkAccess(const Scene& scene, std::size_t record) {
    return AccessCheck(scene)(record);
}

std::optional<Finding> checkDrive(const Scene& scene, std::size_t record) {
    const Record& door = scene.records[record];
    if (!door.has("drive")) return std::nullopt;
    const std::string& drive = door.text("drive");
    std::vector<std::string> known;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const std::vector<std::string> keys = stateKeysOf(scene.records[i].keyword());
        if (std::find(keys.begin(), keys.end(), "on") == keys.end()) continue;
        if (scene.ids[i] == drive) return std::nullopt;
        known.push_back(scene.ids[i]);
    }
    const std::string nearest = nearestWord(drive, known);
    return Finding{.severity = Severity::Error,
                   .element = scene.ids[record],
                   .message = "the drive of door " + scene.ids[record] + " is " + excerpt(drive) +
                              ", which is no appliance",
                   .hint = nearest.empty() ? "name one of kind=gate" : "name `" + nearest + '`',
                   .source = door.keyPlace("drive")};
}

namespace {

/// Returns a point a little off a doorway, on one of its sides.
Point2 besideDoorway(const Doorway& doorway, double side) {
    constexpr double kOff = 0.01;
    const Vec2 along = doorway.line.b - doorway.line.a;
    const Point2 middle = doorway.line.a + 0.5 * along;
    const double off = side * (doorway.thickness / 2 + kOff) / length(along);
    return middle + off * Vec2{-along.y, along.x};
}

/// Returns true for a door that stays shut to a person.
bool isBarred(const Record& door, const Record& person) {
    return isLocked(door) && !lockOf(door).opensTo(person);
}

}  // namespace

std::optional<Finding> checkExit(const Scene& scene, std::size_t record) {
    const Record& person = scene.records[record];
    const auto is_barred = [&](const Record& door) {
        return door.keyword() == "door" && isBarred(door, person);
    };
    if (std::none_of(scene.records.begin(), scene.records.end(), is_barred)) return std::nullopt;
    std::vector<Record> records = scene.records;
    for (Record& each : records)
        if (each.keyword() == "door" && !is_barred(each) && !each.flag("open")) {
            if (isLocked(each)) each.set("locked", Value(false));
            each.set("open", Value(true));
        }
    const Environment open(records, scene.ids, scene.environment);
    const Tuple& at = person.tuple("at");
    const Point2 place{at[0], at[1]};
    const std::vector<Region>& parts = open.indoor().parts;
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const Region& each) {
        return each.locate(place) != Side::Outside;
    });
    if (part == parts.end()) return std::nullopt;
    std::vector<std::string> barred;
    for (const Doorway& doorway : doorwaysOf(open)) {
        const bool is_left = part->locate(besideDoorway(doorway, 1)) != Side::Outside;
        const bool is_right = part->locate(besideDoorway(doorway, -1)) != Side::Outside;
        if (is_left == is_right) continue;
        const auto found = std::find(scene.ids.begin(), scene.ids.end(), doorway.id);
        if (!is_barred(scene.records[static_cast<std::size_t>(found - scene.ids.begin())]))
            return std::nullopt;
        barred.push_back(doorway.id);
    }
    if (barred.empty()) return std::nullopt;
    std::string doors;
    for (const std::string& id : barred) doors.append(doors.empty() ? "" : ", ").append(id);
    doors += barred.size() == 1 ? " is locked" : " are locked";
    return Finding{
        .element = scene.ids[record],
        .at = place,
        .message = "no door lets human " + scene.ids[record] + " out of the room: " + doors,
        .hint = "name its tag in `access` of a door, or set locked=no",
        .source = person.place()};
}

void addLocks() {
    addSceneKeys(
        "door",
        {{.name = "locked",
          .type = KeyType::Flag,
          .help = "yes: it is shut, and opens to the tags of `access` alone; no: it has a lock"},
         {.name = "access",
          .type = KeyType::Text,
          .help = "tags of people that it lets pass, as 42,43: it opens before them, and shuts "
                  "behind them"},
         {.name = "forced",
          .type = KeyType::Flag,
          .help = "yes: its lock is broken, and does not lock",
          .default_value = false},
         {.name = "strength",
          .type = KeyType::Number,
          .help = "energy in J with which a robot that runs into it forces its lock; left out: no "
                  "robot does",
          .lower = 0,
          .upper = kMostStrength},
         {.name = "drive",
          .type = KeyType::Word,
          .help = "id of the appliance that moves it, as one of kind=gate: it is switched on when "
                  "the door opens or closes",
          .role = Role::Reference}});
    addThingKind("door",
                 {.states = {"locked", "forced"},
                  .has_states = hasLock,
                  .check = [](const Record& door) { lockOf(door); },
                  .verbs = {std::string(kLocks), std::string(kUnlocks), std::string(kForces)},
                  .act = actOnLock,
                  .pass = passOfLock,
                  .shut = shutOfLock,
                  .barrier = [](const Record& door) -> std::string_view {
                      return isLocked(door) ? "locked" : "";
                  },
                  .entities = {{"locked", "lock", ""}, {"forced", "binary_sensor", "tamper"}}});
    addRecordCheck("door", [](const Scene& scene) {
        return std::function<std::optional<Finding>(std::size_t record)>(AccessCheck(scene));
    });
    addRecordCheck("door", checkDrive);
    addRecordCheck("human", checkExit);
}

}  // namespace ispace::locks
