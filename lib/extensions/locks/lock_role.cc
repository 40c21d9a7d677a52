// SPDX-License-Identifier: GPL-3.0-or-later
// Robots force a door by kinetic energy, half m v^2 with the speed across the door before the step.
// A door that a tag opened shuts once its time is over and no mover is within its doorway, 5 cm to
// spare; a door that people opened meanwhile is theirs to shut. A tag shown twice in one step asks
// once.
#include "extensions/locks/lock_role.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/glob.h"
#include "base/message.h"
#include "env/zone.h"
#include "extensions/locks/lock.h"
#include "geom/predicates.h"
#include "server/role_answer.h"

namespace ispace::locks {

namespace {

constexpr auto kRequests = std::to_array<RoleRequest>({
    {"READ", "id", 1, 1},
    {"TRY", "id tag", 2, 2},
});

/// A door that this service moves or watches.
struct LockedDoor {
    std::string id;  // of its record
    std::size_t room = 0;
    Lock lock;
    bool is_open = false;
    bool was_open = false;           // in the step before
    std::optional<double> strength;  // J
    std::string drive;
    Segment2 line;
    double thickness = 0;
    std::optional<SimTime> until;  // a tag holds it open
    bool locks_again = false;      // then
    std::string asked;             // the change that opens it, which a tag asked for last
    SimTime asked_at{};
};

/// A world of the run.
struct Room {
    std::string id;
    Simulation* simulation = nullptr;
    std::int64_t changes = -1;
    std::vector<Vec2> velocities = {};  // of its robots before the step
    bool has_strength = false;          // of a door

    [[nodiscard]] const World& world() const { return simulation->world(); }
    void ask(const std::string& change) const {
        if (!simulation->isReplay()) simulation->askChange(change);
    }
};

bool isOurs(const Record& record) {
    return record.keyword() == "door" &&
           (record.has("access") || record.has("drive") || record.has("strength"));
}

/// What the clients of a run share.
struct Run {
    std::vector<Room> rooms;
    std::map<std::string, LockedDoor, std::less<>> doors;  // by name across the run

    [[nodiscard]] SimTime now() const { return rooms.front().world().time(); }
    [[nodiscard]] std::vector<std::string> doorsThatMatch(const Glob& glob) const {
        std::vector<std::string> names;
        for (const auto& each : doors)
            if (glob.matches(each.first)) names.push_back(each.first);
        return names;
    }
    void readChanged();
    void read(std::size_t index);
    void switchDrives();
    void forceDoors(std::size_t index);
    void shutDoors();
};

/// Reads the doors of the worlds that have changed.
void Run::readChanged() {
    for (std::size_t room = 0; room < rooms.size(); ++room)
        if (rooms[room].changes != rooms[room].world().changes()) read(room);
}

void Run::read(std::size_t index) {
    Room& room = rooms[index];
    const Scene& scene = room.world().scene();
    room.changes = room.world().changes();
    room.has_strength = false;
    auto known = std::exchange(doors, {});
    std::map<std::string_view, const Record*> records;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (isOurs(scene.records[i])) records.emplace(scene.ids[i], &scene.records[i]);
    for (auto& [name, door] : known)
        if (door.room != index) doors.emplace(name, door);
    if (records.empty()) return;
    for (const Doorway& doorway : doorwaysOf(scene.environment)) {
        const auto found = records.find(doorway.id);
        if (found == records.end()) continue;
        const Record& record = *found->second;
        const std::string name = room.id.empty() ? doorway.id : room.id + '/' + doorway.id;
        const auto before = known.find(name);
        LockedDoor& door = doors[name];
        if (before != known.end())
            door = before->second;
        else
            door.was_open = record.flag("open");
        door.id = doorway.id;
        door.room = index;
        door.lock = lockOf(record);
        door.line = doorway.line;
        door.thickness = doorway.thickness;
        door.strength.reset();
        if (record.has("strength")) door.strength = record.number("strength");
        door.drive = record.has("drive") ? record.text("drive") : "";
        room.has_strength = room.has_strength || door.strength.has_value();
        const bool was_open = std::exchange(door.is_open, record.flag("open"));
        if (was_open && !door.is_open) door.until.reset();
    }
}

/// Switches the drives of the doors on that have moved since the step before.
void Run::switchDrives() {
    for (auto& [name, door] : doors)
        if (std::exchange(door.was_open, door.is_open) != door.is_open && !door.drive.empty())
            rooms[door.room].ask("SET " + door.drive + ".on=yes");
}

/// Forces the locked doors into which robots have run hard enough.
void Run::forceDoors(std::size_t index) {
    Room& room = rooms[index];
    if (!room.has_strength) return;
    const World& world = room.world();
    for (const Collision& collision : world.collisions()) {
        if (collision.other || collision.robot >= room.velocities.size()) continue;
        for (const auto& [name, door] : doors) {
            if (door.room != index || door.id != collision.into || !door.strength ||
                !door.lock.is_locked)
                continue;
            const Scene& scene = world.scene();
            const auto found =
                std::find(scene.ids.begin(), scene.ids.end(), world.movers()[collision.robot].id);
            if (found == scene.ids.end()) continue;
            const Record& robot =
                scene.records[static_cast<std::size_t>(found - scene.ids.begin())];
            const Vec2 along = door.line.b - door.line.a;
            const double speed =
                dot(room.velocities[collision.robot], Vec2{-along.y, along.x}) / length(along);
            if (robot.number("mass") * speed * speed / 2 >= *door.strength)
                room.ask("ACT " + door.id + " forced=yes locked=no open=yes");
        }
    }
    room.velocities.clear();
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const RobotStatus status = world.status(i);
        const Vec2 ahead = unitVector(status.pose.heading);
        room.velocities.push_back(status.speed * ahead +
                                  status.sidespeed * Vec2{-ahead.y, ahead.x});
    }
}

/// Shuts the doors that tags have opened, once their time is over and their doorways are free.
void Run::shutDoors() {
    constexpr double kSpare = 0.05;
    for (auto& [name, door] : doors) {
        if (!door.until || now() < *door.until) continue;
        // A door that people have opened, too, is shut behind them.
        if (!door.is_open || rooms[door.room].simulation->isOpenForPeople(door.id)) {
            door.until.reset();
            continue;
        }
        const World& world = rooms[door.room].world();
        bool is_free = true;
        for (std::size_t i = 0; is_free && i < world.movers().size(); ++i)
            is_free = distance(world.status(i).pose.position, door.line) >
                      world.movers()[i].model.radius + door.thickness / 2 + kSpare;
        // A change that is refused, as the lock was forced meanwhile, is asked for once more.
        if (is_free)
            rooms[door.room].ask("ACT " + door.id + " open=no" +
                                 (door.locks_again && !door.lock.is_forced ? " locked=yes" : ""));
    }
}

class LockClient : public ClientRole {
  public:
    LockClient(Run& run, std::string_view glob) : run_(run), glob_(glob) {}

    [[nodiscard]] std::span<const RoleRequest> requests() const override { return kRequests; }
    RoleAnswer request(std::span<const std::string_view> words) override {
        run_.readChanged();
        const auto found = run_.doors.find(words[1]);
        if (found == run_.doors.end() || !glob_.matches(words[1]))
            return {errorText(404, "no door with `access`, `drive` or `strength` is " +
                                       excerpt(words[1]) +
                                       didYouMean(words[1], run_.doorsThatMatch(glob_)))};
        LockedDoor& door = found->second;
        std::string line = "OK ";
        line.append(words[0]).append(" id=").append(words[1]);
        line.append(" t=").append(formatMilliseconds(run_.now()));
        if (words[0] == "TRY") {
            line.append(" opens=").append(tryTag(door, words[2]) ? "1" : "0");
        } else {
            line.append(" open=").append(door.is_open ? "1" : "0");
            line.append(" locked=").append(door.lock.is_locked ? "1" : "0");
            line.append(" forced=").append(door.lock.is_forced ? "1" : "0");
        }
        return {line += '\n'};
    }
    [[nodiscard]] bool waits() const override { return false; }
    std::string stepped(bool /*has_room*/) override { return ""; }
    /// Doors are no sensors.
    [[nodiscard]] std::span<const std::string> sensors() const override { return {}; }
    [[nodiscard]] double clock(SimTime time) const override { return seconds(time); }

  private:
    /// Opens a door to a tag, or holds one open that a tag has opened. \returns false if its lock
    /// does not know the tag
    bool tryTag(LockedDoor& door, std::string_view tag) {
        const std::vector<std::string>& access = door.lock.access;
        if (std::find(access.begin(), access.end(), tag) == access.end()) return false;
        const Room& room = run_.rooms[door.room];
        if (room.simulation->isReplay()) return true;
        room.simulation->keepOpen(door.id, run_.now() + simSeconds(kHeldOpen));
        if (!door.is_open) {
            door.locks_again = door.lock.is_locked;
            std::string opening =
                "ACT " + door.id + (door.lock.is_locked ? " locked=no" : "") + " open=yes";
            if (door.asked_at != run_.now() || door.asked != opening) {
                room.ask(opening);
                door.asked = std::move(opening);
                door.asked_at = run_.now();
            }
            door.until = run_.now() + simSeconds(kHeldOpen);
        } else if (door.until) {
            door.until = run_.now() + simSeconds(kHeldOpen);
        }
        return true;
    }

    Run& run_;
    Glob glob_;
};

class Locks : public RoleService {
  public:
    explicit Locks(Run run) : run_(std::move(run)), time_(run_.now()) { run_.readChanged(); }
    [[nodiscard]] std::string_view verb() const override { return "LOCK"; }

    std::unique_ptr<ClientRole> take(std::string_view glob, std::string& answer) override {
        run_.readChanged();
        answer.append("OK LOCK ").append(glob).append(" t=");
        answer.append(formatMilliseconds(run_.now())).append(" doors=");
        answer.append(joined(run_.doorsThatMatch(Glob(glob)), ",")).append("\n");
        return std::make_unique<LockClient>(run_, glob);
    }

    void stepped() override {
        if (std::exchange(time_, run_.now()) == run_.now()) return;
        run_.readChanged();
        run_.switchDrives();
        for (std::size_t room = 0; room < run_.rooms.size(); ++room) run_.forceDoors(room);
        run_.shutDoors();
    }

    [[nodiscard]] bool holdsWorld() const override { return false; }
    [[nodiscard]] std::string waitsFor() const override { return ""; }

  private:
    Run run_;
    SimTime time_;
};

}  // namespace

std::unique_ptr<RoleService> makeLocks(std::span<const RunRoom> rooms, std::uint64_t /*seed*/) {
    Run run;
    bool has_any = false;
    run.rooms.reserve(rooms.size());
    for (const RunRoom& room : rooms) {
        const std::vector<Record>& records = room.simulation->world().scene().records;
        has_any = has_any || std::any_of(records.begin(), records.end(), isOurs);
        run.rooms.push_back({room.id, room.simulation});
    }
    if (!has_any) return nullptr;
    return std::make_unique<Locks>(std::move(run));
}

}  // namespace ispace::locks
