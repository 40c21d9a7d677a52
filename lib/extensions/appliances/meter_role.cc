// SPDX-License-Identifier: GPL-3.0-or-later
// Energy is power times the time of a step, in which no power changes: a phase that ends between
// two steps is off by a step at most. A counter shows whole units of the plug's `count`. Phases end
// by changes of records (ACT), which the run records and a replay repeats; a change that is refused
// is asked for again.
#include "extensions/appliances/meter_role.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "extensions/appliances/appliance.h"
#include "server/role_answer.h"

namespace ispace::appliances {

namespace {

constexpr auto kRequests = std::to_array<RoleRequest>({
    {"READ", "id", 1, 1},
    {"WATCH", "", 0, 0},
    {"UNWATCH", "", 0, 0},
    {"TIME", "", 0, 0},
});

constexpr double kJoules = 3.6e6;  // in a kilowatt-hour

/// A plug of the run and its counter.
struct Meter {
    std::size_t room = 0;
    Plug plug;
    double watts = 0, joules = 0;
    std::int64_t counted = 0;  // as last told

    [[nodiscard]] double count() const {
        return roundSignificant(static_cast<double>(counted) * plug.count, 12);
    }
};

/// An appliance of the run.
struct Follower {
    ApplianceFigures figures;
    AppliancePhase phase;  ///< that its record has, or for which it was asked
    double watts = 0;
    bool was_on = false;  ///< as its record was last read
    ApplianceState state = ApplianceState::Off;
};

/// A world of the run with its appliances, by ids of records.
struct Room {
    std::string id;
    Simulation* simulation = nullptr;
    std::int64_t changes = -1;
    std::shared_ptr<const Scene> start = {};  // a restart begins anew
    std::map<std::string, Follower> appliances = {};
    SimTime due = kMaxTime;  // no phase ends before

    [[nodiscard]] const World& world() const { return simulation->world(); }
    [[nodiscard]] std::string nameOf(const std::string& record) const {
        return id.empty() ? record : id + '/' + record;
    }
    void read();
    void goOn();
    void findDue();
};

/// Returns the change that gives an appliance a phase, as a part of ACT; "" if its record has it.
std::string changeTo(const std::string& id, const AppliancePhase& phase, const Appliance& now) {
    std::string change;
    if (phase.is_on != now.is_on) change.append(phase.is_on ? " on=yes" : " on=no");
    if (phase.state != now.state) change.append(" state=").append(nameOf(phase.state));
    return change.empty() ? "" : id + change;
}

void ask(Simulation& simulation, const std::string& changes) {
    if (!changes.empty() && !simulation.isReplay()) simulation.askChange("ACT " + changes);
}

void add(std::string& changes, const std::string& change) {
    if (change.empty()) return;
    changes.append(changes.empty() ? "" : " ; ").append(change);
}

/// Reads the records after a change, and asks for those that follow from it.
void Room::read() {
    const Scene& scene = world().scene();
    const bool is_start = std::exchange(start, world().sharedStart()) != world().sharedStart();
    std::map<std::string, bool> mains;
    for (const Plug& plug : plugsOf(scene)) mains.emplace(plug.of, plug.is_on);
    auto known = std::exchange(appliances, {});
    std::string wanted;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        if (scene.records[i].keyword() != "appliance") continue;
        const std::string& name = scene.ids[i];
        const Appliance now = applianceOf(scene.records[i]);
        const auto before = known.find(name);
        const auto plug = mains.find(name);
        const bool has_mains = plug == mains.end() || plug->second;
        Follower& follower = appliances[name];
        const bool is_new = is_start || before == known.end();
        if (!is_new) follower = before->second;
        // Unless the change that was asked for failed, which is asked for again.
        if (is_new || now.is_on != follower.was_on || now.state != follower.state ||
            has_mains != follower.phase.has_mains)
            follower.phase = phaseAfterChange(now, is_new ? nullptr : &before->second.phase,
                                              has_mains, world().time());
        follower.figures = now.figures;
        follower.watts = now.watts();
        follower.was_on = now.is_on;
        follower.state = now.state;
        add(wanted, changeTo(name, follower.phase, now));
    }
    ask(*simulation, wanted);
    findDue();
}

void Room::findDue() {
    due = kMaxTime;
    for (const auto& [name, follower] : appliances)
        if (const auto end = endOf(follower.figures, follower.phase)) due = std::min(due, *end);
}

/// Ends the phases that are over.
void Room::goOn() {
    const SimTime now = world().time();
    if (now < due) return;
    const Scene& scene = world().scene();
    std::string wanted;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const auto found = appliances.find(scene.ids[i]);
        if (found == appliances.end()) continue;
        auto& [name, follower] = *found;
        follower.phase = phaseAt(follower.figures, follower.phase, now);
        add(wanted, changeTo(name, follower.phase, applianceOf(scene.records[i])));
    }
    ask(*simulation, wanted);
    findDue();
}

/// What the clients of a run share.
struct Run {
    std::vector<Room> rooms;
    std::map<std::string, Meter, std::less<>> meters;  // by name

    [[nodiscard]] SimTime now() const { return rooms.front().world().time(); }
    [[nodiscard]] std::vector<std::string> metersThatMatch(const Glob& glob) const {
        std::vector<std::string> names;
        for (const auto& each : meters)
            if (glob.matches(each.first)) names.push_back(each.first);
        return names;
    }
    void list(std::size_t room);
};

/// Lists the plugs of a room, again after a change; those of the same id count on.
void Run::list(std::size_t room) {
    std::map<std::string, Meter, std::less<>> listed;
    for (Plug& plug : plugsOf(rooms[room].world().scene())) {
        const std::string name = rooms[room].nameOf(plug.id);
        const auto known = meters.find(name);
        Meter& meter = listed[name];
        if (known != meters.end()) meter = known->second;
        meter.room = room;
        meter.watts = rooms[room].appliances.at(plug.of).watts;
        meter.plug = std::move(plug);
    }
    std::erase_if(meters, [room](const auto& each) { return each.second.room == room; });
    meters.merge(listed);
}

std::string readingText(const std::string& id, const Meter& meter, SimTime time) {
    std::string text = "id=" + id + " t=" + formatMilliseconds(time);
    text.append(" on=").append(meter.plug.is_on ? "1" : "0");
    text.append(" power=").append(formatDouble(meter.watts));
    text.append(" energy=").append(formatFixed(meter.joules / kJoules, 6));
    return text;
}

class MeterClient : public ClientRole {
  public:
    MeterClient(Run& run, std::list<MeterClient*>& clients, std::string_view glob)
        : run_(run), clients_(clients), glob_(glob) {
        clients_.push_back(this);
    }
    ~MeterClient() override { clients_.remove(this); }
    MeterClient(const MeterClient&) = delete;
    MeterClient& operator=(const MeterClient&) = delete;

    [[nodiscard]] std::span<const RoleRequest> requests() const override { return kRequests; }
    RoleAnswer request(std::span<const std::string_view> words) override {
        if (words[0] == "READ") return {read(words[1])};
        if (words[0] == "WATCH") watches_ = true;
        if (words[0] == "UNWATCH") watches_ = false;
        std::string line = "OK ";
        line.append(words[0]).append(" t=").append(formatMilliseconds(run_.now()));
        return {line += '\n'};
    }
    [[nodiscard]] bool waits() const override { return false; }
    std::string stepped(bool has_room) override {
        return has_room ? takeLines(unread_, formatMilliseconds(run_.now())) : "";
    }
    /// Meters are no sensors.
    [[nodiscard]] std::span<const std::string> sensors() const override { return {}; }
    [[nodiscard]] double clock(SimTime time) const override { return seconds(time); }

    void hear(const std::string& id, const Meter& meter) {
        if (!watches_ || !glob_.matches(id)) return;
        unread_.add("EVENT meter " + readingText(id, meter, run_.now()) + "\n");
    }

  private:
    std::string read(std::string_view id) {
        const auto found = run_.meters.find(id);
        if (found == run_.meters.end() || !glob_.matches(id))
            return errorText(
                404, "no plug " + excerpt(id) + didYouMean(id, run_.metersThatMatch(glob_)));
        return "OK READ " + readingText(found->first, found->second, run_.now()) + "\n";
    }

    Run& run_;
    std::list<MeterClient*>& clients_;
    Glob glob_;
    bool watches_ = false;
    UnreadItems<std::string> unread_;
};

class Meters : public RoleService {
  public:
    explicit Meters(Run run) : run_(std::move(run)), time_(run_.now()) {
        for (std::size_t room = 0; room < run_.rooms.size(); ++room) readRoom(room);
    }
    [[nodiscard]] std::string_view verb() const override { return "METER"; }

    std::unique_ptr<ClientRole> take(std::string_view glob, std::string& answer) override {
        answer.append("OK METER ").append(glob).append(" t=");
        answer.append(formatMilliseconds(run_.now())).append(" plugs=");
        answer.append(joined(run_.metersThatMatch(Glob(glob)), ",")).append("\n");
        return std::make_unique<MeterClient>(run_, clients_, glob);
    }

    /// Changes between steps are read in the next one, before which all are made.
    void stepped() override {
        if (run_.now() == time_) return;
        for (std::size_t room = 0; room < run_.rooms.size(); ++room)
            if (run_.rooms[room].changes != run_.rooms[room].world().changes()) readRoom(room);
        count();
        for (Room& room : run_.rooms) room.goOn();
    }

    [[nodiscard]] bool holdsWorld() const override { return false; }
    [[nodiscard]] std::string waitsFor() const override { return ""; }
    [[nodiscard]] std::vector<RoomState> states() const override {
        std::vector<RoomState> states;
        states.reserve(2 * run_.meters.size());
        for (const auto& [id, meter] : run_.meters) {
            states.push_back({id, "power", formatDouble(meter.watts)});
            states.push_back({id, "energy", formatDouble(meter.count())});
        }
        return states;
    }

  private:
    void readRoom(std::size_t room) {
        std::map<std::string, double> before;
        for (const auto& [id, meter] : run_.meters) before.emplace(id, meter.watts);
        run_.rooms[room].changes = run_.rooms[room].world().changes();
        run_.rooms[room].read();
        run_.list(room);
        for (auto& [id, meter] : run_.meters) {
            if (meter.room != room) continue;
            const auto known = before.find(id);
            if (known == before.end() || known->second == meter.watts) continue;
            notify(id, meter, "power", formatDouble(meter.watts));
        }
    }

    /// Counts the energy of the step: a change took effect before it. A seek is no step.
    void count() {
        const SimTime now = run_.now();
        const SimTime passed = now - std::exchange(time_, now);
        if (passed != run_.rooms.front().world().stepLength()) return;
        for (auto& [id, meter] : run_.meters) {
            if (meter.watts == 0) continue;
            meter.joules += meter.watts * seconds(passed);
            constexpr double kRounding = 1e-9;
            const auto counted = static_cast<std::int64_t>(
                std::floor(meter.joules / kJoules / meter.plug.count + kRounding));
            if (counted == meter.counted) continue;
            meter.counted = counted;
            notify(id, meter, "energy", formatDouble(meter.count()));
        }
    }

    /// Raises an event of the run.
    void notify(const std::string& id, const Meter& meter, const char* key, std::string value) {
        for (MeterClient* const client : clients_) client->hear(id, meter);
        run_.rooms[meter.room].simulation->events().notify({.kind = EventKind::State,
                                                            .time = run_.now(),
                                                            .id = meter.plug.id,
                                                            .other = key,
                                                            .text = std::move(value)});
    }

    Run run_;
    std::list<MeterClient*> clients_;
    SimTime time_;
};

}  // namespace

std::unique_ptr<RoleService> makeMeters(std::span<const RunRoom> rooms, std::uint64_t /*seed*/) {
    Run run;
    bool has_any = false;
    run.rooms.reserve(rooms.size());
    for (const RunRoom& room : rooms) {
        for (const Record& record : room.simulation->world().scene().records)
            has_any = has_any || record.keyword() == "appliance" || record.keyword() == "plug";
        run.rooms.push_back({room.id, room.simulation});
    }
    if (!has_any) return nullptr;
    return std::make_unique<Meters>(std::move(run));
}

}  // namespace ispace::appliances
