// SPDX-License-Identifier: GPL-3.0-or-later
// The world tells of a collision only after it has stopped the robot: velocities are therefore kept
// from the step before. The force is that of a spring without damping (half m v^2 = half k x^2),
// rounded to 0.1 N; for a person it may be compared with the limits of ISO/TS 15066, Annex A, with
// the stiffness of a part of the body from there.
//
// Two that meet are stopped one after the other, which the world reports twice: the first and
// harder contact counts.
#include "extensions/bumpers/bumper.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/placement_schemas.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"
#include "server/role_answer.h"

namespace ispace::bumpers {

namespace {

constexpr double kStiffness = 20'000;  // N/m: 5 mm at 100 N

constexpr auto kRequests = std::to_array<RoleRequest>({
    {"READ", "id", 1, 1},
});

const Record* robotOfBumper(const Scene& scene, const Record& bumper) {
    const auto found = std::find(scene.ids.begin(), scene.ids.end(), bumper.text("of"));
    if (found == scene.ids.end()) return nullptr;
    const Record& record = scene.records[static_cast<std::size_t>(found - scene.ids.begin())];
    return record.keyword() == "robot" ? &record : nullptr;
}

Point2 nearestOn(Point2 a, Point2 b, Point2 place) {
    const Vec2 along = b - a;
    const double square = dot(along, along);
    const double share = square > 0 ? std::clamp(dot(place - a, along) / square, 0.0, 1.0) : 0;
    return a + share * along;
}

struct BumperOfRun {
    std::string id;        // of its record
    std::string robot;     // its name across the run
    std::size_t room = 0;  // of its record
    std::string of = {};   // as the record says it
    double stiffness = kStiffness;
    double force = 0;  // N
    std::string into = {};
    SimTime until{};     // it is told as long at least,
    bool stays = false;  // and while the robot that ran into it stands there,
    Point2 at = {};      // where it met it
};

struct Room {
    std::string id;
    Simulation* simulation = nullptr;
    std::int64_t changes = -1;
    std::vector<Vec2> velocities = {};  // of its movers before the step

    [[nodiscard]] const World& world() const { return simulation->world(); }
};

/// What the clients of a run share.
struct Run {
    std::vector<Room> rooms;
    std::map<std::string, BumperOfRun, std::less<>> bumpers;  // by name across the run

    [[nodiscard]] SimTime now() const { return rooms.front().world().time(); }
    [[nodiscard]] std::vector<std::string> bumpersThatMatch(const Glob& glob) const {
        std::vector<std::string> names;
        for (const auto& each : bumpers)
            if (glob.matches(each.first)) names.push_back(each.first);
        return names;
    }
    /// Returns the room in which a robot is now, and its number there.
    struct Place {
        std::size_t room, mover;
    };
    [[nodiscard]] std::optional<Place> placeOf(const std::string& robot) const {
        for (std::size_t room = 0; room < rooms.size(); ++room)
            if (const auto mover = rooms[room].world().robotNamed(robot))
                return Place{room, *mover};
        return std::nullopt;
    }
    void readChanged();
};

/// Reads the bumpers of the worlds that have changed; forces stay.
void Run::readChanged() {
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        const World& world = rooms[room].world();
        if (std::exchange(rooms[room].changes, world.changes()) == world.changes()) continue;
        std::map<std::string, BumperOfRun, std::less<>> known;
        for (auto each = bumpers.begin(); each != bumpers.end();)
            if (each->second.room == room)
                known.insert(bumpers.extract(each++));
            else
                ++each;
        const Scene& scene = world.scene();
        for (std::size_t i = 0; i < scene.records.size(); ++i) {
            const Record& record = scene.records[i];
            if (record.keyword() != "bumper") continue;
            const std::string name =
                rooms[room].id.empty() ? scene.ids[i] : rooms[room].id + '/' + scene.ids[i];
            const std::string& of = record.text("of");
            const std::string prefix = rooms[room].id.empty() ? "" : rooms[room].id + '/';
            BumperOfRun bumper{scene.ids[i], of.starts_with(prefix) ? of : prefix + of, room, of,
                               record.number("stiffness")};
            if (const auto before = known.find(name); before != known.end()) {
                bumper.force = before->second.force;
                bumper.into = before->second.into;
                bumper.until = before->second.until;
                bumper.stays = before->second.stays;
                bumper.at = before->second.at;
            }
            bumpers.emplace(name, std::move(bumper));
        }
    }
}

/// The velocity of a mover in the room.
Vec2 velocityOf(const RobotStatus& status) {
    const Vec2 ahead = unitVector(status.pose.heading);
    return status.speed * ahead + status.sidespeed * perpendicular(ahead);
}

bool standsAt(const RobotStatus& status, Point2 place) {
    return status.pose.position == place && status.speed == 0 && status.sidespeed == 0 &&
           status.rotspeed == Angle();
}

double massOf(const Scene& scene, std::string_view id) {
    const auto found = std::find(scene.ids.begin(), scene.ids.end(), id);
    if (found == scene.ids.end()) return kPersonMass;
    const Record& record = scene.records[static_cast<std::size_t>(found - scene.ids.begin())];
    return record.keyword() == "robot" ? record.number("mass") : kPersonMass;
}

class BumperClient : public ClientRole {
  public:
    BumperClient(Run& run, std::list<BumperClient*>& clients, std::string_view glob)
        : run_(run), clients_(clients), glob_(glob) {
        clients_.push_back(this);
    }
    ~BumperClient() override { clients_.remove(this); }
    BumperClient(const BumperClient&) = delete;
    BumperClient& operator=(const BumperClient&) = delete;

    [[nodiscard]] std::span<const RoleRequest> requests() const override { return kRequests; }
    RoleAnswer request(std::span<const std::string_view> words) override {
        run_.readChanged();
        const auto found = run_.bumpers.find(words[1]);
        if (found == run_.bumpers.end() || !glob_.matches(words[1]))
            return {errorText(404, "no bumper is " + excerpt(words[1]) +
                                       didYouMean(words[1], run_.bumpersThatMatch(glob_)))};
        std::string line = "OK READ id=";
        line.append(words[1]).append(" t=").append(formatMilliseconds(run_.now()));
        line.append(" force=").append(formatDouble(found->second.force));
        return {line.append(" into=").append(found->second.into).append("\n")};
    }
    [[nodiscard]] bool waits() const override { return false; }
    std::string stepped(bool has_room) override {
        return has_room ? takeLines(unread_, formatMilliseconds(run_.now())) : "";
    }
    /// Bumpers tell contacts, not readings at a rate.
    [[nodiscard]] std::span<const std::string> sensors() const override { return {}; }
    [[nodiscard]] double clock(SimTime time) const override { return seconds(time); }

    void hear(std::string_view name, const std::string& line) {
        if (glob_.matches(name)) unread_.add(line);
    }

  private:
    Run& run_;
    std::list<BumperClient*>& clients_;
    Glob glob_;
    UnreadItems<std::string> unread_;
};

class Bumpers : public RoleService {
  public:
    explicit Bumpers(Run run) : run_(std::move(run)), time_(run_.now()) { keepVelocities(); }
    [[nodiscard]] std::string_view verb() const override { return "BUMPER"; }

    std::unique_ptr<ClientRole> take(std::string_view glob, std::string& answer) override {
        run_.readChanged();
        answer.append("OK BUMPER ").append(glob).append(" t=");
        answer.append(formatMilliseconds(run_.now())).append(" bumpers=");
        answer.append(joined(run_.bumpersThatMatch(Glob(glob)), ",")).append("\n");
        return std::make_unique<BumperClient>(run_, clients_, glob);
    }

    void stepped() override {
        if (std::exchange(time_, run_.now()) == run_.now()) return;
        run_.readChanged();
        for (auto& [name, bumper] : run_.bumpers) {
            const auto place = run_.placeOf(bumper.robot);
            if (!place) continue;
            const auto& [at, mover] = *place;
            const Room& room = run_.rooms[at];
            for (const Collision& collision : room.world().collisions()) {
                if (collision.robot == mover)
                    meet(name, bumper, room, {mover, collision.other, collision.into, true});
                else if (collision.other == mover)
                    meet(
                        name, bumper, room,
                        {mover, collision.robot, room.world().movers()[collision.robot].id, false});
            }
            // Speeds, not the flag of the stall: a command clears that, which a replay does not
            // have.
            if (bumper.force > 0 && time_ >= bumper.until &&
                !(bumper.stays && standsAt(room.world().status(mover), bumper.at))) {
                bumper.force = 0;
                bumper.into.clear();
                notifyState(bumper);
            }
        }
        keepVelocities();
    }

    [[nodiscard]] bool holdsWorld() const override { return false; }
    [[nodiscard]] std::string waitsFor() const override { return ""; }
    [[nodiscard]] std::vector<RoomState> states() const override {
        std::vector<RoomState> states;
        states.reserve(run_.bumpers.size());
        for (const auto& [name, bumper] : run_.bumpers)
            states.push_back({name, "force", formatDouble(bumper.force)});
        return states;
    }

  private:
    void keepVelocities() {
        for (Room& room : run_.rooms) {
            room.velocities.clear();
            for (std::size_t i = 0; i < room.world().movers().size(); ++i)
                room.velocities.push_back(velocityOf(room.world().status(i)));
        }
    }

    /// A robot that meets another mover or an element.
    struct Meeting {
        std::size_t robot = 0;
        std::optional<std::size_t> other;
        std::string_view into;
        bool runs = false;  ///< it ran into the other, and stands since
    };

    /// Returns the unit vector from a robot to the place where it meets a body.
    static Vec2 towards(const World& world, const Meeting& meeting, Vec2 velocity) {
        const Point2 here = world.status(meeting.robot).pose.position;
        const RobotModel& robot = world.movers()[meeting.robot].model;
        std::optional<Point2> there;
        if (meeting.other) {
            there = world.status(*meeting.other).pose.position;
        } else {
            for (const Element& element : world.scene().environment.elements())
                if (element.id == meeting.into)
                    there = contactOf(element.body, {here, velocity, robot.radius, robot.height});
        }
        const Vec2 way = there ? *there - here : velocity;
        const double size = length(way);
        if (size > 0) return (1 / size) * way;
        return unitVector(world.status(meeting.robot).pose.heading);
    }

    void meet(std::string_view name, BumperOfRun& bumper, const Room& room,
              const Meeting& meeting) {
        const World& world = room.world();
        if (meeting.robot >= room.velocities.size()) return;
        Vec2 velocity = room.velocities[meeting.robot];
        double mass = massOf(world.scene(), bumper.robot);
        if (meeting.other && *meeting.other < room.velocities.size()) {
            velocity = velocity - room.velocities[*meeting.other];
            mass = reducedMass(mass, massOf(world.scene(), meeting.into));
        }
        const double speed = std::max(0.0, dot(velocity, towards(world, meeting, velocity)));
        constexpr double kTenths = 10;
        const double force =
            std::round(contactForce(speed, bumper.stiffness, mass) * kTenths) / kTenths;
        // The world stops one after the other of two that meet: the first contact is the hard one.
        bumper.stays = bumper.stays || meeting.runs;
        bumper.at = world.status(meeting.robot).pose.position;
        if (force <= 0 || (time_ < bumper.until && force <= bumper.force)) return;
        bumper.force = force;
        bumper.into = meeting.into;
        bumper.stays = meeting.runs;
        bumper.until = time_ + simSeconds(kForceHold);
        std::string line = "EVENT impact t=" + formatMilliseconds(time_) + " id=";
        line.append(name).append(" robot=").append(bumper.robot);
        line.append(" into=").append(bumper.into).append(" force=");
        line.append(formatDouble(bumper.force)).append(" speed=");
        line.append(formatFixed(speed, 3)).append("\n");
        for (BumperClient* const client : clients_) client->hear(name, line);
        notifyState(bumper);
    }

    void notifyState(const BumperOfRun& bumper) const {
        run_.rooms[bumper.room].simulation->events().notify({.kind = EventKind::State,
                                                             .time = run_.now(),
                                                             .id = bumper.id,
                                                             .other = "force",
                                                             .text = formatDouble(bumper.force)});
    }

    Run run_;
    SimTime time_;
    std::list<BumperClient*> clients_;
};

}  // namespace

double contactForce(double speed, double stiffness, double mass) {
    return std::max(0.0, speed) * std::sqrt(stiffness * mass);
}

double reducedMass(double a, double b) { return a * b / (a + b); }

std::optional<Point2> contactOf(const Body& body, const RobotOnItsWay& robot) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    std::optional<Point2> met;
    double first = kNever, least = kNever;
    const auto take = [&](Point2 a, Point2 b, double bottom, double top) {
        if (bottom >= robot.height || top <= 0) return;
        const Point2 point = nearestOn(a, b, robot.place);
        const Vec2 way = point - robot.place;
        const double apart = length(way);
        const double closing = apart > 0 ? dot(robot.velocity, way) / apart : 0;
        constexpr double kAlong = 1e-9;  // m/s: past it, not towards it
        const double time =
            closing > kAlong ? std::max(0.0, apart - robot.radius) / closing : kNever;
        if (met && !(time < first || (time == first && apart < least))) return;
        first = time;
        least = apart;
        met = point;
    };
    for (const Sheet& sheet : body.sheets)
        take(sheet.line.a, sheet.line.b, sheet.bottom, sheet.top);
    for (const Prism& prism : body.prisms)
        for (std::size_t i = 0; i < prism.footprint.size(); ++i)
            take(prism.footprint[i], prism.footprint[(i + 1) % prism.footprint.size()],
                 prism.bottom, prism.top);
    return met;
}

std::optional<Finding> checkBumper(const Scene& scene, std::size_t record) {
    const Record& bumper = scene.records[record];
    if (robotOfBumper(scene, bumper) != nullptr) return std::nullopt;
    std::vector<std::string> robots;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (scene.records[i].keyword() == "robot") robots.push_back(scene.ids[i]);
    return Finding{.severity = Severity::Error,
                   .element = scene.ids[record],
                   .message = "bumper " + scene.ids[record] + " is of " +
                              excerpt(bumper.text("of")) + ", which is no robot",
                   .hint = "name a robot by of=ID" + didYouMean(bumper.text("of"), robots),
                   .source = bumper.keyPlace("of")};
}

std::vector<Schema> bumperSchemas() {
    constexpr double kSoftest = 1, kHardest = 1e9;
    return {{.keyword = "bumper",
             .type = RecordType::Placement,
             .help = "measures the force with which a robot runs into things, robots and people, "
                     "for simrun",
             .keys = {idKey(),
                      {.name = "of",
                       .type = KeyType::Word,
                       .help = "id of the robot",
                       .required = true,
                       .role = Role::Reference},
                      {.name = "stiffness",
                       .type = KeyType::Number,
                       .help = "of the bumper, N/m: with the robot's mass it gives the force",
                       .default_value = kStiffness,
                       .lower = kSoftest,
                       .upper = kHardest}}}};
}

void addBumpers() {
    addThingKind("bumper", {.told = {"force"}});
    addRecordCheck("bumper", checkBumper);
}

std::unique_ptr<RoleService> makeBumpers(std::span<const RunRoom> rooms, std::uint64_t /*seed*/) {
    Run run;
    run.rooms.reserve(rooms.size());
    for (const RunRoom& room : rooms) run.rooms.push_back({room.id, room.simulation});
    run.readChanged();
    if (run.bumpers.empty()) return nullptr;
    for (const auto& [name, bumper] : run.bumpers) {
        if (run.placeOf(bumper.robot)) continue;
        const Scene& scene = run.rooms[bumper.room].world().scene();
        for (std::size_t i = 0; i < scene.ids.size(); ++i)
            if (scene.ids[i] == bumper.id)
                throw FormatError(scene.records[i].finding("of", "bumper " + bumper.id + " is of " +
                                                                     excerpt(bumper.of) +
                                                                     ", which is no robot"));
    }
    return std::make_unique<Bumpers>(std::move(run));
}

}  // namespace ispace::bumpers
