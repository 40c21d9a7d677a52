// SPDX-License-Identifier: GPL-3.0-or-later
// A turn is linear from begin to end, and reaches the record as changes, one for all heads of a
// room that are due, since a change builds the scene anew. A change takes effect later than it is
// asked for: the role remembers the angles, and waits up to twenty periods for them before it gives
// the turn up. So sensors on a head move in small jumps, and lag behind a little.
#include "extensions/heads/head_role.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "extensions/heads/head.h"
#include "server/role_answer.h"

namespace ispace::heads {

namespace {

constexpr auto kRequests = std::to_array<RoleRequest>({
    {"READ", "id", 1, 1},
    {"TURN", "id pan tilt", 3, 3},
    {"HALT", "id", 1, 1},
});

/// Angles in whole thousandths of a degree, as changes write them.
double rounded(double degrees) {
    constexpr double kSteps = 1000;
    return std::round(degrees * kSteps) / kSteps + 0.0;
}

/// A turn that is under way.
struct Turn {
    SimTime begin{};
    double seconds = 0;  // that it takes
    double from_pan = 0, from_tilt = 0, pan = 0, tilt = 0;
    SimTime next{};  // of the next change
};

/// The last change that was asked for.
struct Asked {
    double before_pan = 0, before_tilt = 0, pan = 0, tilt = 0;
    int periods = 0;  // for which it is not made

    /// One that has been made.
    static Asked of(const Head& head) { return {head.pan, head.tilt, head.pan, head.tilt}; }
    [[nodiscard]] bool isMade(const Head& head) const {
        return head.pan == pan && head.tilt == tilt;
    }
    /// Returns true if it is not made, and neither is another.
    [[nodiscard]] bool isPending(const Head& head) const {
        return !isMade(head) && head.pan == before_pan && head.tilt == before_tilt;
    }
};

struct HeadOfRun {
    std::string id;  // of its record
    std::size_t room = 0;
    Head head;
    std::optional<Turn> turn = {};
    std::optional<Asked> asked = {};  // once it has turned
};

struct Room {
    std::string id;
    Simulation* simulation = nullptr;
    std::int64_t changes = -1;
    std::string asked = {};  // angles for the next change
};

/// What the clients of a run share.
struct Run {
    std::vector<Room> rooms;
    std::map<std::string, HeadOfRun, std::less<>> heads;  // by name across the run

    [[nodiscard]] SimTime now() const { return rooms.front().simulation->world().time(); }
    [[nodiscard]] std::vector<std::string> headsThatMatch(const Glob& glob) const {
        std::vector<std::string> names;
        for (const auto& each : heads)
            if (glob.matches(each.first)) names.push_back(each.first);
        return names;
    }
    void readChanged();
};

/// Reads the heads of the worlds that have changed; turns go on.
void Run::readChanged() {
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        const World& world = rooms[room].simulation->world();
        if (std::exchange(rooms[room].changes, world.changes()) == world.changes()) continue;
        std::map<std::string, HeadOfRun, std::less<>> known;
        for (auto each = heads.begin(); each != heads.end();)
            if (each->second.room == room)
                known.insert(heads.extract(each++));
            else
                ++each;
        const Scene& scene = world.scene();
        for (std::size_t i = 0; i < scene.records.size(); ++i) {
            if (scene.records[i].keyword() != "head") continue;
            const std::string name =
                rooms[room].id.empty() ? scene.ids[i] : rooms[room].id + '/' + scene.ids[i];
            HeadOfRun head{scene.ids[i], room, headOf(scene.records[i])};
            if (const auto before = known.find(name); before != known.end())
                std::tie(head.turn, head.asked) =
                    std::tie(before->second.turn, before->second.asked);
            heads.emplace(name, std::move(head));
        }
    }
}

std::string anglesText(double pan, double tilt) {
    return " pan=" + formatDouble(pan) + " tilt=" + formatDouble(tilt);
}

std::string anglesText(const HeadOfRun& head) { return anglesText(head.head.pan, head.head.tilt); }

class HeadClient : public ClientRole {
  public:
    HeadClient(Run& run, std::list<HeadClient*>& clients, std::string_view glob)
        : run_(run), clients_(clients), glob_(glob) {
        clients_.push_back(this);
    }
    ~HeadClient() override { clients_.remove(this); }
    HeadClient(const HeadClient&) = delete;
    HeadClient& operator=(const HeadClient&) = delete;

    [[nodiscard]] std::span<const RoleRequest> requests() const override { return kRequests; }
    RoleAnswer request(std::span<const std::string_view> words) override {
        run_.readChanged();
        const auto found = run_.heads.find(words[1]);
        if (found == run_.heads.end() || !glob_.matches(words[1]))
            return {errorText(404, "no head is " + excerpt(words[1]) +
                                       didYouMean(words[1], run_.headsThatMatch(glob_)))};
        HeadOfRun& head = found->second;
        std::string line = "OK ";
        line.append(words[0]).append(" id=").append(words[1]);
        line.append(" t=").append(formatMilliseconds(run_.now()));
        if (words[0] == "HALT") {
            // A change that the turn has asked for is still made: it stops there.
            const bool is_due = head.turn && head.asked && head.asked->isPending(head.head);
            head.turn.reset();
            return {line +
                    (is_due ? anglesText(head.asked->pan, head.asked->tilt) : anglesText(head)) +
                    " moving=0\n"};
        }
        if (words[0] != "TURN")
            return {line + anglesText(head) + " moving=" + (head.turn ? "1" : "0") + '\n'};
        const auto pan = parseDouble(words[2]), tilt = parseDouble(words[3]);
        if (!pan || !tilt) return {errorText(400, "TURN takes two angles in degrees")};
        if (std::string wrong = refusal(head.head, *pan, *tilt); !wrong.empty())
            return {errorText(416, wrong)};
        if (run_.rooms[head.room].simulation->isReplay())
            return {errorText(409, "a replay turns as the run did")};
        Turn turn{run_.now(),     0,         head.head.pan, head.head.tilt, rounded(*pan),
                  rounded(*tilt), run_.now()};
        if (!head.asked || !head.asked->isPending(head.head)) head.asked = Asked::of(head.head);
        if (head.head.speed)
            turn.seconds =
                std::max(std::abs(turn.pan - turn.from_pan), std::abs(turn.tilt - turn.from_tilt)) /
                *head.head.speed;
        head.turn = turn;
        return {line + " for=" + formatFixed(turn.seconds, 3) + '\n'};
    }
    [[nodiscard]] bool waits() const override { return false; }
    std::string stepped(bool has_room) override {
        return has_room ? takeLines(unread_, formatMilliseconds(run_.now())) : "";
    }
    /// Heads are no sensors.
    [[nodiscard]] std::span<const std::string> sensors() const override { return {}; }
    [[nodiscard]] double clock(SimTime time) const override { return seconds(time); }

    void hear(std::string_view name, const std::string& line) {
        if (glob_.matches(name)) unread_.add(line);
    }

  private:
    static std::string refusal(const Head& head, double pan, double tilt) {
        const auto beyond = [](std::string_view axis, double angle, Head::Range range) {
            std::string text;
            if (range.contains(angle)) return text;
            text.append(axis).append(" goes from ").append(formatDouble(range.least));
            text.append(" to ").append(formatDouble(range.most)).append(", not to ");
            return text.append(formatDouble(angle));
        };
        std::string wrong = beyond("pan", pan, head.pan_range);
        return wrong.empty() ? beyond("tilt", tilt, head.tilt_range) : wrong;
    }

    Run& run_;
    std::list<HeadClient*>& clients_;
    Glob glob_;
    UnreadItems<std::string> unread_;
};

class Heads : public RoleService {
  public:
    explicit Heads(Run run) : run_(std::move(run)) { run_.readChanged(); }
    [[nodiscard]] std::string_view verb() const override { return "HEAD"; }

    std::unique_ptr<ClientRole> take(std::string_view glob, std::string& answer) override {
        run_.readChanged();
        answer.append("OK HEAD ").append(glob).append(" t=");
        answer.append(formatMilliseconds(run_.now())).append(" heads=");
        answer.append(joined(run_.headsThatMatch(Glob(glob)), ",")).append("\n");
        return std::make_unique<HeadClient>(run_, clients_, glob);
    }

    void stepped() override {
        run_.readChanged();
        const SimTime now = run_.now();
        for (auto& [name, head] : run_.heads) {
            if (!head.turn) continue;
            if (head.head.pan == head.turn->pan && head.head.tilt == head.turn->tilt &&
                now >= head.turn->begin + simSeconds(head.turn->seconds)) {
                head.turn.reset();
                notify(name, head);
                continue;
            }
            if (now < head.turn->next) continue;
            head.turn->next = now + simSeconds(kTurnStep);
            if (goesOn(head, now)) {
                if (head.asked->isMade(head.head)) ask(head, now);
            } else {
                head.turn.reset();
                notify(name, head);
            }
        }
        // One change for all heads of a room: it builds the scene anew.
        for (Room& room : run_.rooms)
            if (!room.asked.empty())
                room.simulation->askChange("ACT " + std::exchange(room.asked, ""));
    }

    [[nodiscard]] bool holdsWorld() const override { return false; }
    [[nodiscard]] std::string waitsFor() const override { return ""; }

  private:
    /// Returns false for a turn that ends where the head is: another request turned it, its range
    /// became smaller, the run was reset, or its changes are refused.
    static bool goesOn(HeadOfRun& head, SimTime now) {
        constexpr int kMostPeriods = 20;
        const Turn& turn = *head.turn;
        if (now < turn.begin || !head.head.pan_range.contains(turn.pan) ||
            !head.head.tilt_range.contains(turn.tilt))
            return false;
        if (head.asked->isMade(head.head)) return true;
        const bool waits = head.asked->isPending(head.head) && ++head.asked->periods < kMostPeriods;
        if (!waits) head.asked.reset();
        return waits;
    }
    /// Asks for the angles of this time.
    void ask(HeadOfRun& head, SimTime now) {
        const Turn& turn = *head.turn;
        const double passed = seconds(now - turn.begin);
        const double share = turn.seconds > 0 ? std::min(1.0, passed / turn.seconds) : 1;
        const double pan = rounded(std::lerp(turn.from_pan, turn.pan, share));
        const double tilt = rounded(std::lerp(turn.from_tilt, turn.tilt, share));
        head.asked = {head.head.pan, head.head.tilt, pan, tilt};
        std::string& asked = run_.rooms[head.room].asked;
        asked.append(asked.empty() ? "" : " ; ").append(head.id);
        asked.append(" pan=").append(formatDouble(pan)).append(" tilt=").append(formatDouble(tilt));
    }
    void notify(std::string_view name, const HeadOfRun& head) {
        std::string line = "EVENT turned t=" + formatMilliseconds(run_.now()) + " id=";
        line.append(name).append(anglesText(head)).append("\n");
        for (HeadClient* const client : clients_) client->hear(name, line);
    }

    Run run_;
    std::list<HeadClient*> clients_;
};

}  // namespace

std::unique_ptr<RoleService> makeHeads(std::span<const RunRoom> rooms, std::uint64_t /*seed*/) {
    Run run;
    run.rooms.reserve(rooms.size());
    for (const RunRoom& room : rooms) run.rooms.push_back({room.id, room.simulation});
    run.readChanged();
    if (run.heads.empty()) return nullptr;
    for (Room& room : run.rooms) room.changes = -1;
    return std::make_unique<Heads>(std::move(run));
}

}  // namespace ispace::heads
