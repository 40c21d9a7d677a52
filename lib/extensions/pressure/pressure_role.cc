// SPDX-License-Identifier: GPL-3.0-or-later
// Readings are numbered periods of the sensor's rate since the start; noise is keyed by seed, id
// and number, so that a reading does not depend on how often it is asked for. States `weight` are
// told once they differ by a kilogram, which keeps noise out of the events.
#include "extensions/pressure/pressure_role.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "server/role_answer.h"

namespace ispace::pressure {

namespace {

constexpr auto kRequests = std::to_array<RoleRequest>({
    {"READ", "id", 1, 1},
    {"WATCH", "[every=k]", 0, 1},
    {"UNWATCH", "", 0, 0},
    {"TIME", "", 0, 0},
});

/// A sensor with its newest reading.
struct SensorOfRun {
    std::size_t room = 0;
    const PressureFloor* floor = nullptr;  // or
    const PressureSeat* seat = nullptr;
    std::int64_t number = -1;  // of the newest period
    PressureReading reading = {};
    bool was_occupied = false;
    double told = 0;  // kg
};

/// A reading as keys of a line.
std::string readingText(const std::string& id, const SensorOfRun& sensor) {
    const PressureReading& reading = sensor.reading;
    std::string text = "id=" + id + " t=" + formatMilliseconds(reading.time);
    text.append(" seq=").append(std::to_string(reading.number));
    text.append(" weight=").append(formatFixed(reading.kilograms(), 2));
    text.append(" occupied=").append(reading.is_occupied ? "1" : "0");
    if (sensor.floor == nullptr) return text;
    text.append(" columns=").append(std::to_string(sensor.floor->columns()));
    text.append(" rows=").append(std::to_string(sensor.floor->rows()));
    text.append(" cells=");
    bool is_first = true;
    for (const auto& [index, newtons] : reading.cells) {
        text.append(std::exchange(is_first, false) ? "" : ",").append(std::to_string(index));
        text.append(":").append(formatFixed(newtons, 1));
    }
    return text;
}

/// What the clients of a run share.
struct Run {
    struct Room {
        std::string id;
        Simulation* simulation = nullptr;
        PressureField field;
        std::int64_t changes = 0;
    };
    std::vector<Room> rooms;
    std::map<std::string, SensorOfRun, std::less<>> sensors;  // by id

    [[nodiscard]] SimTime now() const { return rooms.front().simulation->world().time(); }
    [[nodiscard]] std::vector<std::string> sensorsThatMatch(const Glob& glob) const {
        std::vector<std::string> names;
        for (const auto& each : sensors)
            if (glob.matches(each.first)) names.push_back(each.first);
        return names;
    }
    void list(std::size_t room);
    void notifyLoads();
    bool readIfDue(SensorOfRun& sensor) const;
};

/// Lists the sensors of a room, again after a change; those of the same id keep their states.
void Run::list(std::size_t room) {
    std::map<std::string, SensorOfRun, std::less<>> listed;
    const auto keep = [&](const std::string& id, const PressureFloor* floor,
                          const PressureSeat* seat) {
        const auto known = sensors.find(id);
        SensorOfRun& sensor = listed[id];
        if (known != sensors.end()) sensor = known->second;
        sensor.room = room;
        sensor.floor = floor;
        sensor.seat = seat;
    };
    for (const PressureFloor& floor : rooms[room].field.floors()) keep(floor.id, &floor, nullptr);
    for (const PressureSeat& seat : rooms[room].field.seats()) keep(seat.id, nullptr, &seat);
    std::erase_if(sensors, [room](const auto& each) { return each.second.room == room; });
    sensors.merge(listed);
}

/// Lets each room know the weights of all, as people and robots go from one to another.
void Run::notifyLoads() {
    if (rooms.size() < 2) return;
    std::map<std::string, double> all;
    for (const Room& room : rooms) all.insert(room.field.loads().begin(), room.field.loads().end());
    for (Room& room : rooms) room.field.expectVisitors(all);
}

/// Reads a sensor at the begin of its next period. \returns true if it did
bool Run::readIfDue(SensorOfRun& sensor) const {
    constexpr double kRounding = 1e-9;
    const PressureField& field = rooms[sensor.room].field;
    const double rate = sensor.floor != nullptr ? sensor.floor->rate : sensor.seat->rate;
    const auto number = static_cast<std::int64_t>(seconds(now()) * rate + kRounding);
    if (number == sensor.number) return false;
    sensor.number = number;
    sensor.reading = sensor.floor != nullptr ? field.read(*sensor.floor, number)
                                             : field.read(*sensor.seat, number);
    return true;
}

class FloorClient : public ClientRole {
  public:
    FloorClient(Run& run, std::list<FloorClient*>& clients, std::string_view glob)
        : run_(run), clients_(clients), glob_(glob) {
        clients_.push_back(this);
    }
    ~FloorClient() override { clients_.remove(this); }
    FloorClient(const FloorClient&) = delete;
    FloorClient& operator=(const FloorClient&) = delete;

    [[nodiscard]] std::span<const RoleRequest> requests() const override { return kRequests; }
    RoleAnswer request(std::span<const std::string_view> words) override {
        if (words[0] == "READ") return {read(words[1])};
        if (words[0] == "WATCH") return {watch(words.subspan(1))};
        if (words[0] == "UNWATCH") {
            every_ = 0;
            return {"OK UNWATCH t=" + formatMilliseconds(run_.now()) + "\n"};
        }
        return {"OK TIME t=" + formatMilliseconds(run_.now()) + "\n"};
    }
    [[nodiscard]] bool waits() const override { return false; }
    std::string stepped(bool has_room) override {
        return has_room ? takeLines(unread_, formatMilliseconds(run_.now())) : "";
    }
    /// SCAN does not know its sensors.
    [[nodiscard]] std::span<const std::string> sensors() const override { return {}; }
    [[nodiscard]] double clock(SimTime time) const override { return seconds(time); }

    void hear(const std::string& id, const SensorOfRun& sensor) {
        if (every_ == 0 || sensor.number % every_ != 0 || !glob_.matches(id)) return;
        unread_.add("EVENT floor " + readingText(id, sensor) + "\n");
    }

  private:
    std::string read(std::string_view id) {
        const auto found = run_.sensors.find(id);
        if (found == run_.sensors.end() || !glob_.matches(id))
            return errorText(404, "no floor or seat " + excerpt(id) +
                                      didYouMean(id, run_.sensorsThatMatch(glob_)));
        return "OK READ " + readingText(found->first, found->second) + "\n";
    }
    std::string watch(std::span<const std::string_view> words) {
        constexpr std::string_view kEvery = "every=";
        constexpr std::int64_t kMost = 1'000'000;
        std::optional<std::int64_t> every = 1;
        if (!words.empty())
            every = words[0].starts_with(kEvery) ? parseInteger(words[0].substr(kEvery.size()))
                                                 : std::nullopt;
        if (!every || *every < 1 || *every > kMost)
            return errorText(400, excerpt(words[0]) + ": wanted every=k, from 1 to 1000000");
        every_ = *every;
        return "OK WATCH every=" + std::to_string(every_) + "\n";
    }

    Run& run_;
    std::list<FloorClient*>& clients_;
    Glob glob_;
    std::int64_t every_ = 0;  // 0: does not watch
    UnreadItems<std::string> unread_;
};

class Floors : public RoleService {
  public:
    explicit Floors(Run run) : run_(std::move(run)) {
        for (std::size_t room = 0; room < run_.rooms.size(); ++room) run_.list(room);
        run_.notifyLoads();
        for (auto& each : run_.sensors) run_.readIfDue(each.second);
    }
    [[nodiscard]] std::string_view verb() const override { return "FLOOR"; }

    std::unique_ptr<ClientRole> take(std::string_view glob, std::string& answer) override {
        answer.append("OK FLOOR ").append(glob).append(" t=");
        answer.append(formatMilliseconds(run_.now())).append(" sensors=");
        answer.append(joined(run_.sensorsThatMatch(Glob(glob)), ",")).append("\n");
        return std::make_unique<FloorClient>(run_, clients_, glob);
    }

    void stepped() override {
        for (std::size_t room = 0; room < run_.rooms.size(); ++room) {
            Run::Room& each = run_.rooms[room];
            each.field.observe();
            const std::int64_t changes = each.simulation->world().changes();
            if (std::exchange(each.changes, changes) == changes) continue;
            run_.list(room);
            run_.notifyLoads();
        }
        for (auto& [id, sensor] : run_.sensors) {
            if (run_.readIfDue(sensor))
                for (FloorClient* const client : clients_) client->hear(id, sensor);
            notifyStates(id, sensor);
        }
    }

    [[nodiscard]] bool holdsWorld() const override { return false; }
    [[nodiscard]] std::string waitsFor() const override { return ""; }
    [[nodiscard]] std::vector<RoomState> states() const override {
        std::vector<RoomState> states;
        states.reserve(2 * run_.sensors.size());
        for (const auto& [id, sensor] : run_.sensors) {
            states.push_back({id, "occupied", sensor.was_occupied ? "1" : "0"});
            states.push_back({id, "weight", formatDouble(sensor.told)});
        }
        return states;
    }

  private:
    /// Raises the events of the run. A weight is told once it differs by a kilogram.
    void notifyStates(const std::string& id, SensorOfRun& sensor) {
        const double weight = std::round(sensor.reading.kilograms());
        if (sensor.reading.is_occupied != sensor.was_occupied) {
            sensor.was_occupied = sensor.reading.is_occupied;
            notify(id, sensor.room, "occupied", sensor.was_occupied ? "1" : "0");
        }
        if (weight != sensor.told) {
            sensor.told = weight;
            notify(id, sensor.room, "weight", formatDouble(weight));
        }
    }
    void notify(const std::string& id, std::size_t room, const char* key, std::string value) {
        const std::string prefix = run_.rooms[room].id + "/";
        run_.rooms[room].simulation->events().notify(
            {.kind = EventKind::State,
             .time = run_.now(),
             .id = id.starts_with(prefix) ? id.substr(prefix.size()) : id,
             .other = key,
             .text = std::move(value)});
    }

    Run run_;
    std::list<FloorClient*> clients_;
};

}  // namespace

std::unique_ptr<RoleService> makePressure(std::span<const RunRoom> rooms, std::uint64_t /*seed*/) {
    Run run;
    bool has_any = false;
    run.rooms.reserve(rooms.size());
    for (const RunRoom& room : rooms) {
        const World& world = room.simulation->world();
        PressureField field(world, room.id.empty() ? "" : room.id + "/");
        has_any = has_any || !field.floors().empty() || !field.seats().empty();
        run.rooms.push_back({room.id, room.simulation, std::move(field), world.changes()});
    }
    if (!has_any) return nullptr;
    return std::make_unique<Floors>(std::move(run));
}

}  // namespace ispace::pressure
