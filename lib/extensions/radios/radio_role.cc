// SPDX-License-Identifier: GPL-3.0-or-later
// Messages arrive in the same step, as light does. The loss of a message is drawn from seed,
// sender, receiver and the sender's count, so that a message has the same fate however many others
// receive it. Meshes of a room are built at the first message after a change.
#include "extensions/radios/radio_role.h"

#include <array>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "base/random.h"
#include "extensions/radios/radio.h"
#include "scene/sensor/sensor.h"
#include "server/role_answer.h"
#include "trace/ray_world.h"

namespace ispace::radios {

namespace {

/// Of the draws here, apart from those of the core; a byte.
constexpr auto kRadioDraws = static_cast<Purpose>(201);
constexpr std::size_t kLongestText = 1000;  // bytes

constexpr auto kMany = static_cast<std::size_t>(-1);
constexpr auto kRequests = std::to_array<RoleRequest>({
    {"SEND", "id text", 2, kMany},
    {"READ", "id", 1, 1},
});

/// Returns words as they stood in the line, with the blanks between them.
std::string lineOf(std::span<const std::string_view> words) {
    const std::string_view last = words.back();
    return {words[0].data(), static_cast<std::size_t>(last.data() + last.size() - words[0].data())};
}

struct RadioOfRun {
    std::string id;  // of its record
    std::size_t room = 0;
    Radio radio;
    RadioCarrier carrier;
    std::int64_t sent = 0, heard = 0;
};

struct Room {
    std::string id;
    Simulation* simulation = nullptr;
    std::int64_t changes = -1;
    std::shared_ptr<const RayWorld> light = {}, sound = {};  // made when a message is sent

    [[nodiscard]] const World& world() const { return simulation->world(); }
};

/// What the clients of a run share.
struct Run {
    std::vector<Room> rooms;
    std::uint64_t seed = 0;
    std::map<std::string, RadioOfRun, std::less<>> radios;  // by name across the run

    [[nodiscard]] SimTime now() const { return rooms.front().world().time(); }
    [[nodiscard]] std::vector<std::string> radiosThatMatch(const Glob& glob) const {
        std::vector<std::string> names;
        for (const auto& each : radios)
            if (glob.matches(each.first)) names.push_back(each.first);
        return names;
    }
    void readChanged();
    [[nodiscard]] const RayWorld& meshOf(Room& room, bool is_infrared) const;
    [[nodiscard]] Pose3 poseOf(const RadioOfRun& radio) const;
    [[nodiscard]] bool isDropped(std::string_view from, std::int64_t number, std::string_view to,
                                 double drop) const;
};

/// Reads the radios of the worlds that have changed; counts go on.
void Run::readChanged() {
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        const World& world = rooms[room].world();
        if (std::exchange(rooms[room].changes, world.changes()) == world.changes()) continue;
        rooms[room].light = rooms[room].sound = nullptr;
        std::map<std::string, RadioOfRun, std::less<>> known;
        for (auto each = radios.begin(); each != radios.end();)
            if (each->second.room == room)
                known.insert(radios.extract(each++));
            else
                ++each;
        const Scene& scene = world.scene();
        for (std::size_t i = 0; i < scene.records.size(); ++i) {
            if (scene.records[i].keyword() != "radio") continue;
            const std::string name =
                rooms[room].id.empty() ? scene.ids[i] : rooms[room].id + '/' + scene.ids[i];
            RadioOfRun radio{scene.ids[i], room, radioOf(scene.records[i]),
                             radioCarrier(scene, scene.records[i])};
            if (const auto before = known.find(name); before != known.end()) {
                radio.sent = before->second.sent;
                radio.heard = before->second.heard;
            }
            radios.emplace(name, std::move(radio));
        }
    }
}

/// Returns the surfaces that stop infrared light, or those that radio passes with a loss: glass,
/// too.
const RayWorld& Run::meshOf(Room& room, bool is_infrared) const {
    std::shared_ptr<const RayWorld>& mesh = is_infrared ? room.light : room.sound;
    if (!mesh)
        mesh = std::make_shared<const RayWorld>(RayWorld::ofEnvironment(
            room.world().scene().environment, is_infrared ? Surfaces::Opaque : Surfaces::Solid));
    return *mesh;
}

Pose3 Run::poseOf(const RadioOfRun& radio) const {
    const World& world = rooms[radio.room].world();
    if (radio.carrier.id.empty()) return radio.carrier.pose;
    const auto mover = world.moverNamed(radio.carrier.id);
    return mover ? mountedPose(world.status(*mover).pose, radio.carrier.pose) : radio.carrier.pose;
}

bool Run::isDropped(std::string_view from, std::int64_t number, std::string_view to,
                    double drop) const {
    if (drop <= 0) return false;
    std::array<float, 1> uniform{};
    draw({seed, kRadioDraws, hashOf(from) ^ mixedBits(hashOf(to)),
          static_cast<std::uint64_t>(number)},
         0, {.uniform = uniform});
    return static_cast<double>(uniform[0]) < drop;
}

class RadioClient : public ClientRole {
  public:
    RadioClient(Run& run, std::list<RadioClient*>& clients, std::string_view glob)
        : run_(run), clients_(clients), glob_(glob) {
        clients_.push_back(this);
    }
    ~RadioClient() override { clients_.remove(this); }
    RadioClient(const RadioClient&) = delete;
    RadioClient& operator=(const RadioClient&) = delete;

    [[nodiscard]] std::span<const RoleRequest> requests() const override { return kRequests; }
    RoleAnswer request(std::span<const std::string_view> words) override {
        run_.readChanged();
        const auto found = run_.radios.find(words[1]);
        if (found == run_.radios.end() || !glob_.matches(words[1]))
            return {errorText(404, "no radio is " + excerpt(words[1]) +
                                       didYouMean(words[1], run_.radiosThatMatch(glob_)))};
        RadioOfRun& radio = found->second;
        std::string line = "OK ";
        line.append(words[0]).append(" id=").append(words[1]);
        line.append(" t=").append(formatMilliseconds(run_.now()));
        if (words[0] == "READ") {
            line.append(" channel=").append(std::to_string(radio.radio.channel));
            line.append(" sent=").append(std::to_string(radio.sent));
            line.append(" heard=").append(std::to_string(radio.heard));
            return {line += '\n'};
        }
        const std::string text = lineOf(words.subspan(2));
        if (text.size() > kLongestText) return {errorText(413, "a message has at most 1000 bytes")};
        send(found->first, radio, text);
        return {line += '\n'};
    }
    [[nodiscard]] bool waits() const override { return false; }
    std::string stepped(bool has_room) override {
        return has_room ? takeLines(unread_, formatMilliseconds(run_.now())) : "";
    }
    /// Radios are no sensors.
    [[nodiscard]] std::span<const std::string> sensors() const override { return {}; }
    [[nodiscard]] double clock(SimTime time) const override { return seconds(time); }

    void hear(std::string_view name, const std::string& line) {
        if (glob_.matches(name)) unread_.add(line);
    }

  private:
    void send(std::string_view from, RadioOfRun& sender, const std::string& text) {
        const std::int64_t number = sender.sent++;
        const Pose3 origin = run_.poseOf(sender);
        Room& room = run_.rooms[sender.room];
        for (auto& [name, receiver] : run_.radios) {
            if (&receiver == &sender || receiver.room != sender.room ||
                receiver.radio.is_infrared != sender.radio.is_infrared ||
                receiver.radio.channel != sender.radio.channel)
                continue;
            const Pose3 place = run_.poseOf(receiver);
            if (length(place.position - origin.position) > sender.radio.range) continue;
            const auto margin = signalMargin(sender.radio, origin, receiver.radio, place,
                                             run_.meshOf(room, sender.radio.is_infrared));
            if (!margin) continue;
            const double kept = (1 - sender.radio.drop) * (1 - receiver.radio.drop);
            if (run_.isDropped(from, number, name, 1 - kept)) continue;
            ++receiver.heard;
            std::string line = "EVENT message t=" + formatMilliseconds(run_.now()) + " id=";
            line.append(name).append(" from=").append(from).append(" margin=");
            line.append(formatFixed(*margin, 1)).append(" text=").append(text).append("\n");
            for (RadioClient* const client : clients_) client->hear(name, line);
            room.simulation->events().notify({.kind = EventKind::State,
                                              .time = run_.now(),
                                              .id = receiver.id,
                                              .other = "heard",
                                              .text = std::to_string(receiver.heard)});
        }
    }

    Run& run_;
    std::list<RadioClient*>& clients_;
    Glob glob_;
    UnreadItems<std::string> unread_;
};

class Radios : public RoleService {
  public:
    explicit Radios(Run run) : run_(std::move(run)) {}
    [[nodiscard]] std::string_view verb() const override { return "RADIO"; }

    std::unique_ptr<ClientRole> take(std::string_view glob, std::string& answer) override {
        run_.readChanged();
        answer.append("OK RADIO ").append(glob).append(" t=");
        answer.append(formatMilliseconds(run_.now())).append(" radios=");
        answer.append(joined(run_.radiosThatMatch(Glob(glob)), ",")).append("\n");
        return std::make_unique<RadioClient>(run_, clients_, glob);
    }

    void stepped() override {}
    [[nodiscard]] bool holdsWorld() const override { return false; }
    [[nodiscard]] std::string waitsFor() const override { return ""; }
    [[nodiscard]] std::vector<RoomState> states() const override {
        std::vector<RoomState> states;
        states.reserve(run_.radios.size());
        for (const auto& [name, radio] : run_.radios)
            states.push_back({name, "heard", std::to_string(radio.heard)});
        return states;
    }

  private:
    Run run_;
    std::list<RadioClient*> clients_;
};

}  // namespace

std::unique_ptr<RoleService> makeRadios(std::span<const RunRoom> rooms, std::uint64_t seed) {
    Run run;
    run.seed = seed;
    run.rooms.reserve(rooms.size());
    for (const RunRoom& room : rooms) run.rooms.push_back({room.id, room.simulation});
    run.readChanged();
    if (run.radios.empty()) return nullptr;
    return std::make_unique<Radios>(std::move(run));
}

}  // namespace ispace::radios
