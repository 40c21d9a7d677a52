// SPDX-License-Identifier: GPL-3.0-or-later
// Touches come from the readings of tags, not from true places: noise of the sensor moves a touch,
// which kHold smooths. Readings are taken once, by their number; a tag that is not located keeps
// its stays for kHold. Contents are lines of at most 1000 bytes, and live as long as the run.
#include "extensions/memory/memory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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
#include "extensions/memory/touches.h"
#include "sense/ultrasound_burst.h"
#include "server/role_answer.h"

namespace ispace::memory {

namespace {

constexpr std::size_t kLongestContent = 1000;  // bytes

constexpr auto kMany = static_cast<std::size_t>(-1);
constexpr auto kRequests = std::to_array<RoleRequest>({
    {"STORE", "id [storey/]x,y[,z] [radius=m] [text]", 2, kMany},
    {"FORGET", "id", 1, 1},
    {"FIND", "[storey/]x,y,z | text", 1, kMany},
    {"RECALL", "id", 1, 1},
    {"TIME", "", 0, 0},
});

/// Returns words as they stood in the line, with the blanks between them.
std::string lineOf(std::span<const std::string_view> words) {
    if (words.empty()) return "";
    const std::string_view last = words.back();
    return {words[0].data(), static_cast<std::size_t>(last.data() + last.size() - words[0].data())};
}

std::string pointText(Point3 point) {
    return formatFixed(point.x, 3) + "," + formatFixed(point.y, 3) + "," + formatFixed(point.z, 3);
}

std::string lowered(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

std::string_view nameOf(Touch::Kind kind) {
    constexpr auto kNames = std::to_array<std::string_view>({"touch", "dwell", "leave"});
    return kNames[static_cast<std::size_t>(kind)];
}

/// An ultrasonic tag of the run.
struct TagOfRun {
    std::string name;  ///< with its room
    std::size_t room = 0, sensor = 0;
    std::int64_t seq = -1;  ///< of the last reading that was taken
};

/// What the clients of a run share.
struct Run {
    struct Room {
        std::string id;
        Simulation* simulation = nullptr;
        std::int64_t changes = -1;
    };
    std::vector<Room> rooms;
    std::vector<TagOfRun> tags;
    VolumeIndex volumes;
    Touches touches;

    [[nodiscard]] SimTime now() const { return rooms.front().simulation->world().time(); }
    [[nodiscard]] std::vector<std::string> tagsThatMatch(const Glob& glob) const {
        std::vector<std::string> names;
        for (const TagOfRun& tag : tags)
            if (glob.matches(tag.name)) names.push_back(tag.name);
        return names;
    }
    void lookForTags();
};

/// Lists the tags again in rooms that were changed.
void Run::lookForTags() {
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        const World& world = rooms[room].simulation->world();
        if (std::exchange(rooms[room].changes, world.changes()) == world.changes()) continue;
        std::erase_if(tags, [room](const TagOfRun& tag) { return tag.room == room; });
        const std::string prefix = rooms[room].id.empty() ? "" : rooms[room].id + "/";
        for (std::size_t i = 0; i < world.sensors().size(); ++i)
            if (world.sensors()[i].tryAs<Tag>() != nullptr)
                tags.push_back({prefix + world.sensors()[i].id, room, i});
    }
}

/// Returns the position that a reading of a tag has: by times of flight, or of the simple model at
/// the height of the tag; empty if it is not located.
std::optional<Point3> positionIn(const Burst& burst) {
    if (burst.fix) return burst.fix->position;
    if (burst.simple) return Point3{burst.simple->x, burst.simple->y, burst.pose.position.z};
    return std::nullopt;
}

class MemoryClient : public ClientRole {
  public:
    MemoryClient(Run& run, std::list<MemoryClient*>& clients, std::string_view tags)
        : run_(run), clients_(clients), glob_(tags), sensors_(run.tagsThatMatch(glob_)) {
        clients_.push_back(this);
    }
    ~MemoryClient() override { clients_.remove(this); }
    MemoryClient(const MemoryClient&) = delete;
    MemoryClient& operator=(const MemoryClient&) = delete;

    [[nodiscard]] std::span<const RoleRequest> requests() const override { return kRequests; }
    RoleAnswer request(std::span<const std::string_view> words) override {
        if (words[0] == "STORE") return {store(words.subspan(1))};
        if (words[0] == "FORGET") return {forget(words[1])};
        if (words[0] == "FIND") return {find(words.subspan(1))};
        if (words[0] == "RECALL") return {recall(words[1])};
        return {"OK TIME t=" + formatMilliseconds(run_.now()) + "\n"};
    }
    [[nodiscard]] bool waits() const override { return false; }
    std::string stepped(bool has_room) override {
        return has_room ? takeLines(unread_, formatMilliseconds(run_.now())) : "";
    }
    [[nodiscard]] std::span<const std::string> sensors() const override { return sensors_; }
    [[nodiscard]] double clock(SimTime time) const override { return seconds(time); }

    void hear(const Touch& touch, const std::string& line) {
        if (!glob_.matches(touch.tag)) return;
        unread_.add(line);
    }

  private:
    /// A point of a room; `wrong` holds the error.
    struct Place {
        std::size_t room = 0;
        Point3 at;
        std::string wrong = {};
    };
    [[nodiscard]] Place placeOf(std::string_view text) const;
    std::string store(std::span<const std::string_view> words);
    std::string forget(std::string_view id);
    [[nodiscard]] std::string find(std::span<const std::string_view> words) const;
    [[nodiscard]] std::string recall(std::string_view id) const;
    [[nodiscard]] std::string unknown(std::string_view id) const;

    Run& run_;
    std::list<MemoryClient*>& clients_;
    Glob glob_;
    std::vector<std::string> sensors_;
    UnreadItems<std::string> unread_;
};

MemoryClient::Place MemoryClient::placeOf(std::string_view text) const {
    Place place;
    std::string_view rest = text;
    if (!run_.rooms.front().id.empty()) {
        const std::size_t slash = rest.find('/');
        const auto room =
            std::find_if(run_.rooms.begin(), run_.rooms.end(), [&](const Run::Room& each) {
                return slash != std::string_view::npos && each.id == rest.substr(0, slash);
            });
        if (room == run_.rooms.end()) {
            place.wrong =
                "a place in a building has a storey, as in ground/1,2,1.2; found " + excerpt(text);
            return place;
        }
        place.room = static_cast<std::size_t>(room - run_.rooms.begin());
        rest.remove_prefix(slash + 1);
    }
    std::vector<double> numbers;
    bool is_right = true, is_last = false;
    while (is_right && !is_last) {
        constexpr double kFarthest = 1e6;
        const std::size_t comma = rest.find(',');
        is_last = comma == std::string_view::npos;
        const auto number = parseDouble(rest.substr(0, comma));
        is_right = number && std::abs(*number) <= kFarthest && numbers.size() < 3;
        if (is_right) numbers.push_back(*number);
        if (!is_last) rest.remove_prefix(comma + 1);
    }
    if (!is_right || numbers.size() < 2) {
        place.wrong = excerpt(text) + " is no place x,y[,z]";
        return place;
    }
    place.at = {numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : kVolumeHeight};
    return place;
}

std::string MemoryClient::store(std::span<const std::string_view> words) {
    if (!isWord(words[0]))
        return errorText(
            400, excerpt(words[0]) + " is no name of a volume: letters, digits and _-./+:@");
    const Place place = placeOf(words[1]);
    if (!place.wrong.empty()) return errorText(400, place.wrong);
    Volume volume;
    if (const Volume* const known = run_.volumes.find(words[0])) volume = *known;
    volume.id = words[0];
    volume.room = place.room;
    volume.at = place.at;
    std::span<const std::string_view> text = words.subspan(2);
    constexpr std::string_view kRadius = "radius=";
    if (!text.empty() && text[0].starts_with(kRadius)) {
        const auto radius = parseDouble(text[0].substr(kRadius.size()));
        if (!radius || *radius < kLeastVolume || *radius > kMostVolume)
            return errorText(416, excerpt(text[0]) + ": wanted metres from 0.001 to 100");
        volume.radius = *radius;
        volume.size = std::nullopt;
        text = text.subspan(1);
    }
    if (!text.empty()) volume.content = lineOf(text);
    if (volume.content.size() > kLongestContent)
        return errorText(413, "a content has at most 1000 bytes");
    if (!run_.volumes.store(std::move(volume)))
        return errorText(409, "there are " + std::to_string(VolumeIndex::kMost) + " volumes");
    std::string line = "OK STORE ";
    return line.append(words[0]).append("\n");
}

std::string MemoryClient::unknown(std::string_view id) const {
    std::vector<std::string> known;
    for (const auto& each : run_.volumes.all()) known.push_back(each.first);
    return errorText(404, "no volume " + excerpt(id) + didYouMean(id, known));
}

std::string MemoryClient::forget(std::string_view id) {
    if (!run_.volumes.forget(id)) return unknown(id);
    std::string line = "OK FORGET ";
    return line.append(id).append("\n");
}

std::string MemoryClient::find(std::span<const std::string_view> words) const {
    std::vector<std::string> ids;
    const Place place = placeOf(words[0]);
    if (words.size() == 1 && place.wrong.empty()) {
        for (const Volume* const volume : run_.volumes.about(place.room, place.at))
            ids.push_back(volume->id);
    } else {
        const std::string text = lowered(lineOf(words));
        for (const auto& [id, volume] : run_.volumes.all())
            if (lowered(volume.content).find(text) != std::string::npos) ids.push_back(id);
    }
    return "OK FIND n=" + std::to_string(ids.size()) + " ids=" + joined(ids, ",") + "\n";
}

std::string MemoryClient::recall(std::string_view id) const {
    const Volume* const volume = run_.volumes.find(id);
    if (volume == nullptr) return unknown(id);
    const std::string& room = run_.rooms[volume->room].id;
    std::string line = "OK RECALL id=" + volume->id + " at=" + (room.empty() ? "" : room + "/") +
                       pointText(volume->at);
    if (volume->size)
        line.append(" size=").append(
            pointText({volume->size->x, volume->size->y, volume->size->z}));
    else
        line.append(" radius=").append(formatFixed(volume->radius, 3));
    line.append(" by=").append(joined(run_.touches.tagsIn(volume->id), ","));
    return line.append(" text=").append(volume->content).append("\n");
}

class Memory : public RoleService {
  public:
    explicit Memory(Run run) : run_(std::move(run)) {}
    [[nodiscard]] std::string_view verb() const override { return "MEMORY"; }

    std::unique_ptr<ClientRole> take(std::string_view tags, std::string& answer) override {
        auto client = std::make_unique<MemoryClient>(run_, clients_, tags);
        const std::span<const std::string> names = client->sensors();
        answer.append("OK MEMORY ")
            .append(tags)
            .append(" t=")
            .append(formatMilliseconds(run_.now()));
        answer.append(" volumes=").append(std::to_string(run_.volumes.all().size()));
        answer.append(" tags=").append(joined({names.begin(), names.end()}, ",")).append("\n");
        return client;
    }

    void stepped() override {
        run_.lookForTags();
        const SimTime now = run_.now();
        for (TagOfRun& tag : run_.tags) {
            const World& world = run_.rooms[tag.room].simulation->world();
            const SensorReading& reading = world.reading(tag.sensor);
            if (std::exchange(tag.seq, reading.seq) == reading.seq) continue;
            const Burst* const burst = std::get_if<Burst>(&reading.value);
            const auto position = burst == nullptr ? std::nullopt : positionIn(*burst);
            if (position)
                notify(run_.touches.moved(tag.name, run_.volumes.about(tag.room, *position), now));
        }
        notify(run_.touches.passed(now));
    }

    [[nodiscard]] bool holdsWorld() const override { return false; }
    [[nodiscard]] std::string waitsFor() const override { return ""; }
    [[nodiscard]] std::vector<RoomState> states() const override {
        std::vector<RoomState> states;
        states.reserve(run_.volumes.all().size());
        for (const auto& each : run_.volumes.all())
            states.push_back({each.first, "touched", touched_.contains(each.first) ? "1" : "0"});
        return states;
    }

  private:
    void notify(const std::vector<Touch>& touches) {
        for (const Touch& touch : touches) {
            std::string line = "EVENT ";
            line.append(nameOf(touch.kind)).append(" t=").append(formatMilliseconds(touch.time));
            line.append(" id=").append(touch.volume).append(" by=").append(touch.tag);
            line.append(" for=").append(formatMilliseconds(touch.lasted));
            const Volume* const volume = run_.volumes.find(touch.volume);
            line.append(" text=").append(volume == nullptr ? "" : volume->content).append("\n");
            for (MemoryClient* const client : clients_) client->hear(touch, line);
            notifyState(touch.volume, volume);
        }
    }

    /// Raises the event of the run when the first tag comes into a volume, and when the last has
    /// left.
    void notifyState(const std::string& id, const Volume* volume) {
        const bool is_touched = !run_.touches.tagsIn(id).empty();
        const auto known = touched_.find(id);
        if (is_touched == (known != touched_.end())) return;
        // Meanwhile it may have been forgotten, or stored in another room.
        const std::size_t number = is_touched ? volume->room : known->second;
        if (is_touched)
            touched_.emplace(id, number);
        else
            touched_.erase(known);
        const Run::Room& room = run_.rooms[number];
        const std::string prefix = room.id + "/";
        room.simulation->events().notify(
            {.kind = EventKind::State,
             .time = run_.now(),
             .id = id.starts_with(prefix) ? id.substr(prefix.size()) : id,
             .other = "touched",
             .text = is_touched ? "1" : "0"});
    }

    Run run_;
    std::list<MemoryClient*> clients_;
    std::map<std::string, std::size_t> touched_;  // rooms of volumes, by id
};

}  // namespace

std::unique_ptr<RoleService> makeMemory(std::span<const RunRoom> rooms, std::uint64_t /*seed*/) {
    Run run;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        run.rooms.push_back({rooms[i].id, rooms[i].simulation});
        const std::string prefix = rooms[i].id.empty() ? "" : rooms[i].id + "/";
        for (Volume& volume : volumesOf(rooms[i].simulation->world().scene(), prefix, i))
            run.volumes.store(std::move(volume));
    }
    run.lookForTags();
    if (run.volumes.all().empty() && run.tags.empty()) return nullptr;
    return std::make_unique<Memory>(std::move(run));
}

}  // namespace ispace::memory
