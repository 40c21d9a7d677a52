// SPDX-License-Identifier: GPL-3.0-or-later
// Poses and ranges are whole numbers, millimetres and hundredths of a degree, which are shorter in
// JSON and enough for a screen. Clients that have the frame before get differences; others the
// whole state. Both texts are made on request alone.
#include "extensions/web/web_frames.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <exception>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/json_writer.h"
#include "base/number.h"
#include "drawing/color.h"
#include "drawing/plan/plan.h"
#include "drawing/plan/plan_json.h"
#include "scene/bodies.h"
#include "scene/placement_schemas.h"
#include "scene/room_state.h"
#include "sense/formats/reading_fields.h"
#include "sim/mover.h"
#include "sim/sim_time.h"

namespace ispace::web {

namespace {

double rounded(double value) { return std::round(value * 1000) / 1000; }

void addPlanPose(JsonWriter& json, const Pose3& pose) {
    json.key("pose").beginArray();
    json.value(rounded(pose.position.x)).value(rounded(pose.position.y));
    json.value(rounded(pose.heading.degrees())).endArray();
}

/// The parts of a person that sits, lies or points, as seen from above.
void addBody(JsonWriter& json, const Mover& mover) {
    std::vector<BodyPart> parts = personParts(mover.model.height, mover.figure.get());
    std::stable_sort(parts.begin(), parts.end(),
                     [](const BodyPart& a, const BodyPart& b) { return a.top < b.top; });
    json.key("body").beginArray();
    for (const BodyPart& part : parts) {
        json.beginArray().value(rounded(part.center.x)).value(rounded(part.center.y));
        json.value(rounded(part.radius > 0 ? part.radius : part.half_length));
        json.value(rounded(part.radius > 0 ? 0 : part.half_width)).endArray();
    }
    json.endArray();
}

/// In the order of World::movers().
void addMovers(JsonWriter& json, const Scene& scene) {
    json.key("movers").beginArray();
    for (const Mover& mover : moversOf(scene)) {
        const RobotModel& model = mover.model;
        json.beginObject().key("id").value(mover.id);
        json.key("kind").value(mover.is_person ? "person" : "robot");
        json.key("model").value(model.model).key("radius").value(model.radius);
        json.key("length").value(model.length).key("width").value(model.width);
        json.key("center").value(model.center).key("height").value(model.height);
        json.key("side").value(model.max_sidespeed);
        if (mover.figure != nullptr) addBody(json, mover);
        json.endObject();
    }
    json.endArray();
}

/// Also mats, gates and tags, in the order of the scene.
void addSensors(JsonWriter& json, const Scene& scene) {
    json.key("sensors").beginArray();
    for (const PlacedRecord& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        const std::string& keyword = record.keyword();
        if (keyword == "human" || keyword == "robot" || isActuator(keyword)) continue;
        json.beginObject().key("id").value(scene.ids[placed.record]).key("kind").value(keyword);
        if (placed.mount) json.key("on").value(placed.mount->robot);
        if (sensorKind(keyword) != nullptr)
            if (const auto& person = scene.sensors[placed.index].person)
                json.key("on").value(scene.robots.size() + *person);
        addPlanPose(json, placed.mount ? placed.mount->robot_from_sensor : placed.pose);
        if (keyword == "mat") {
            json.key("size").value(std::vector<double>(record.tuple("size")));
        } else if (keyword == "gate") {
            json.key("size").value(std::vector<double>{0, record.number("width")});
        } else if (keyword != "tag" && headingOf(placed.pose)) {
            const BearingSpan span = bearingsOf(scene, placed);
            json.key("view").beginArray();
            json.value(rounded(span.from.degrees())).value(rounded(span.to.degrees()));
            json.value(rounded(span.range)).endArray();
        }
        json.endObject();
    }
    json.endArray();
}

void addColors(JsonWriter& json) {
    using namespace palette;
    json.key("colors").beginObject();
    for (const auto& [name, color] : {std::pair{"ink", kInk},
                                      {"faint", kFaintInk},
                                      {"grid", kGrid},
                                      {"robot", kRobot},
                                      {"person", kPerson},
                                      {"sensor", kSensor},
                                      {"mat", kMat}})
        json.key(name).value(cssColor(color));
    json.key("series").beginArray();
    for (std::size_t i = 0; i < kSeriesColors; ++i) json.value(cssColor(seriesColor(i)));
    json.endArray().endObject();
}

/// Lamps, heaters and others that people switch and that have a position: doors, windows and blinds
/// are parts of the plan. `on` is the robot that carries one, in whose frame it is.
void addActuators(JsonWriter& json, const Scene& scene) {
    json.key("actuators").beginArray();
    const auto add = [&](std::size_t record, double x, double y, std::optional<std::size_t> on) {
        json.beginObject().key("id").value(scene.ids[record]);
        json.key("kind").value(scene.records[record].keyword());
        json.key("at").beginArray().value(rounded(x)).value(rounded(y)).endArray();
        if (on) json.key("on").value(*on);
        json.endObject();
    };
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        if (!isActuator(record.keyword()) || !record.has("at")) continue;
        if (!carrierOf(record).empty()) continue;
        if (record.keyword() == "door" || record.keyword() == "window" ||
            record.keyword() == "human")
            continue;
        const Tuple& at = record.tuple("at");
        add(i, at[0], at[1], std::nullopt);
    }
    for (const PlacedRecord& placed : scene.placed) {
        const Record& record = scene.records[placed.record];
        if (!isActuator(record.keyword()) || carrierOf(record).empty()) continue;
        const Point3 at =
            placed.mount ? placed.mount->robot_from_sensor.position : placed.pose.position;
        std::optional<std::size_t> robot;
        if (placed.mount) robot = placed.mount->robot;
        add(placed.record, at.x, at.y, robot);
    }
    json.endArray();
}

/// The states of actuators that are on or off, by their keys.
void addSwitched(JsonWriter& json, const Scene& scene) {
    std::set<std::string> keys;
    for (const Record& record : scene.records)
        for (const std::string& key : stateKeysOf(record.keyword()))
            if (record.schema().find(key)->type == KeyType::Flag) keys.insert(key);
    json.key("switched").beginArray();
    for (const std::string& key : keys) json.value(key);
    json.endArray();
}

void addPassages(JsonWriter& json, const std::vector<PassageOutline>& passages) {
    json.key("passages").beginArray();
    for (const PassageOutline& passage : passages) {
        json.beginObject().key("id").value(passage.id).key("kind").value(passage.kind);
        json.key("outline").beginArray();
        for (const Point2 corner : passage.outline)
            json.value(rounded(corner.x)).value(rounded(corner.y));
        json.endArray().endObject();
    }
    json.endArray();
}

void addMarks(JsonWriter& json, const std::vector<RunMark>& marks) {
    if (marks.empty()) return;
    json.key("marks").beginArray();
    for (const RunMark& mark : marks) {
        json.beginObject().key("t").value(mark.time).key("kind").value(mark.kind);
        json.key("id").value(mark.id).key("other").value(mark.other);
        json.key("text").value(mark.text).endObject();
    }
    json.endArray();
}

void addAdditions(JsonWriter& json, const std::vector<std::string>& additions) {
    if (additions.empty()) return;
    json.key("additions").beginArray();
    for (const std::string& addition : additions) json.value(addition);
    json.endArray();
}

}  // namespace

std::string webScene(const Scene& scene, std::int64_t version, const WebSceneFacts& facts) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-web-scene/1").key("scene").value(version);
    json.key("title").value(facts.title).key("plan");
    writePlan(json, scene);
    addMovers(json, scene);
    addSensors(json, scene);
    addActuators(json, scene);
    addSwitched(json, scene);
    addPassages(json, facts.passages);
    addMarks(json, facts.marks);
    addAdditions(json, facts.additions);
    addColors(json);
    json.endObject();
    return json.take();
}

namespace {

using std::chrono::steady_clock;

constexpr auto kMinInterval = std::chrono::milliseconds(33);
/// While the world is paused, requests may still change it.
constexpr auto kIdleInterval = std::chrono::milliseconds(100);
/// Frames take at most one part in kShare of the time.
constexpr int kShare = 20;
/// Numbers of readings in one frame; the reading that exceeds them is still in it.
constexpr std::size_t kMaxNumbers = 60'000;

void append(std::string& out, std::int64_t number) {
    std::array<char, 24> digits;
    char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    out.append(digits.data(), end);
}

/// Converts to thousandths, degrees to hundredths.
std::int64_t fixed(double value) { return std::llround(value * 1000); }
std::int64_t fixed(Angle angle) { return std::llround(angle.degrees() * 100); }

void append(std::string& out, std::initializer_list<std::int64_t> numbers) {
    char separator = '[';
    for (const std::int64_t number : numbers) {
        out += std::exchange(separator, ',');
        append(out, number);
    }
    out += ']';
}

void appendText(std::string& out, std::string_view text) { out += JsonWriter().value(text).text(); }

/// Appends the values of fields that the page shows.
struct PageValue {
    std::string& out;
    std::size_t numbers = 0;  ///< of lists with a number an element

    void operator()(std::int64_t value) { append(out, value); }
    void operator()(double value) { out += formatDouble(value); }
    void operator()(Angle angle) { out += formatDouble(angle.degrees()); }
    void operator()(const std::vector<std::int64_t>& values) {
        char separator = '[';
        for (const std::int64_t value : values) {
            out += std::exchange(separator, ',');
            append(out, value);
        }
        out += values.empty() ? "[]" : "]";
    }
    void operator()(std::span<const float> ranges) {
        out += '[';
        bool comma = false;
        for (const float range : ranges) {
            if (std::exchange(comma, true)) out += ',';
            append(out, std::isinf(range) ? -1 : std::llround(static_cast<double>(range) * 1000));
        }
        out += ']';
        numbers = ranges.size();
    }
    template <typename Value>
    void operator()(const Value& /*value*/) {}
};

/// Appends the part of a reading that the page shows. \returns its size in numbers, 0 if the page
/// does not show this sensor
std::size_t appendReading(std::string& out, const Sensor& sensor, const SensorReading& reading) {
    const std::span<const ReadingField> fields = readingKind(sensor.model).fields;
    const auto is_shown = [](const ReadingField& field) { return (field.uses & kInPage) != 0; };
    if (std::none_of(fields.begin(), fields.end(), is_shown)) return 0;
    out += out.ends_with('[') ? "{\"id\":" : ",{\"id\":";
    appendText(out, sensor.id);
    const ReadingView view = viewOf(sensor, reading);
    PageValue values{out};
    for (const ReadingField& field : fields) {
        if (!is_shown(field)) continue;
        out.append(",\"").append(field.name).append("\":");
        std::visit(values, field.value(view));
    }
    out += '}';
    return std::max<std::size_t>(values.numbers, 1);
}

}  // namespace

namespace {

/// Maximum points of a way in a frame: the next ones.
constexpr std::size_t kMaxPath = 100;

void appendPath(std::string& out, std::span<const Point2> way) {
    char separator = '[';
    for (const Point2 point : way.first(std::min(way.size(), kMaxPath))) {
        out += std::exchange(separator, ',');
        append(out, fixed(point.x));
        out += ',';
        append(out, fixed(point.y));
    }
    out += separator == '[' ? "[]" : "]";
}

/// The ways of a mover.
struct MoverPaths {
    std::span<const Point2> now;                 ///< from where it is; empty if it is elsewhere
    std::vector<std::span<const Point2>> later;  ///< after passages
};

std::string wayText(const std::string& mover, const MoverPaths& ways) {
    std::string out = "{\"id\":";
    appendText(out, mover);
    out += ",\"way\":";
    appendPath(out, ways.now);
    if (!ways.later.empty()) {
        char separator = '[';
        out += ",\"later\":";
        for (const std::span<const Point2> way : ways.later) {
            out += std::exchange(separator, ',');
            appendPath(out, way);
        }
        out += ']';
    }
    return out += '}';
}

/// Appends what programs tell of people and robots, if they do.
void appendTracks(std::string& out, const std::vector<const ToldTrack*>& tracks) {
    if (tracks.empty()) return;
    char separator = '[';
    out += ",\"tracks\":";
    for (const ToldTrack* const track : tracks) {
        out += std::exchange(separator, ',');
        out += '[';
        appendText(out, track->source.empty() ? track->track : track->source + '/' + track->track);
        out += ',';
        append(out, fixed(track->place.x));
        out += ',';
        append(out, fixed(track->place.y));
        out += ']';
    }
    out += ']';
}

/// Appends elements of a list.
void appendElement(std::string& list, const std::string& element) {
    if (!list.empty()) list += ',';
    list += element;
}

}  // namespace

std::string WebFrames::newPaths() {
    const World& world = simulation_->world();
    std::map<std::string, MoverPaths> ways;
    for (std::size_t i = 0; i < world.movers().size(); ++i)
        if (const auto ahead = world.wayAhead(i); !ahead.empty())
            ways[world.movers()[i].id].now = ahead;
    const std::vector<PlannedPath> planned =
        facts_.planned ? facts_.planned() : std::vector<PlannedPath>();
    for (const PlannedPath& way : planned) ways[way.mover].later.emplace_back(way.points);
    std::map<std::string, std::string> texts;
    std::string changed;
    for (const auto& [mover, its] : ways) {
        std::string text = wayText(mover, its);
        const auto before = ways_.find(mover);
        if (before == ways_.end() || before->second != text) appendElement(changed, text);
        texts.emplace(mover, std::move(text));
    }
    for (const auto& [mover, text] : ways_)
        if (!texts.contains(mover)) appendElement(changed, wayText(mover, {}));
    ways_ = std::move(texts);
    return changed;
}

void WebFrames::look(WallTime now) {
    if (now < next_look_) return;
    const auto start = steady_clock::now();
    const World& world = simulation_->world();
    const bool stepped = world.steps() != steps_ || world.changes() != version_;
    std::string state = stateText();
    std::string ways = newPaths();
    if (stepped || state != state_ || !ways.empty()) {
        steps_ = world.steps();
        if (std::exchange(version_, world.changes()) != world.changes())
            sent_.assign(world.sensors().size(), -1);
        state_ = std::move(state);
        changed_ways_ = std::move(ways);
        ++number_;
        changes_.reset();
        whole_.reset();
    }
    next_look_ = now + std::max<std::chrono::nanoseconds>(stepped ? kMinInterval : kIdleInterval,
                                                          kShare * (steady_clock::now() - start));
}

WebFrames::Text WebFrames::frame(std::int64_t known) {
    // Combines both texts, so that each reading is sent once.
    const bool has_last = known == number_ - 1 && known > 0;
    Text& text = has_last ? changes_ : whole_;
    if (!text) {
        const auto start = steady_clock::now();
        text = std::make_shared<const std::string>(withReadings(!has_last));
        next_look_ += kShare * (steady_clock::now() - start);
    }
    return text;
}

WebFrames::Text WebFrames::scene() {
    if (std::exchange(scene_version_, sceneVersion()) != sceneVersion() || !scene_)
        scene_ = std::make_shared<const std::string>(
            webScene(simulation_->world().scene(), scene_version_, facts_));
    return scene_;
}

void WebFrames::askMesh(ServerState& state) {
    if (std::exchange(mesh_->is_underway, true)) return;
    const auto text = std::make_shared<std::string>("ROOM scene=");
    append(*text, sceneVersion());
    *text += '\n';
    state.runInBackground({[text, write = facts_.mesh, scene = simulation_->world().sharedScene()] {
                               if (write) *text += write(*scene);
                           },
                           [text, mesh = std::weak_ptr(mesh_),
                            version = sceneVersion()](const std::exception_ptr& /*failure*/) {
                               // Without a mesh, as of a room that is too large, the line is alone.
                               const auto into = mesh.lock();
                               if (!into) return;
                               into->text = text;
                               into->version = version;
                               into->is_underway = false;
                           }});
}

std::string WebFrames::stateText() const {
    const World& world = simulation_->world();
    const Clock& clock = leader_->clock();
    std::string out = ",\"scene\":";
    append(out, world.changes());
    out.append(",\"t\":").append(formatMilliseconds(world.time())).append(",\"steps\":");
    append(out, world.steps());
    out.append(",\"clock\":\"");
    out.append(clock.kind == Clock::Kind::Real   ? "real"
               : clock.kind == Clock::Kind::Fast ? "fast"
                                                 : "step");
    out.append("\",\"rate\":").append(formatDouble(clock.rate));
    out.append(",\"days\":").append(leader_->followsDays() ? "true" : "false");
    out.append(",\"paused\":").append(leader_->paused() ? "true" : "false");
    out.append(",\"replay\":").append(leader_->isReplay() ? "true" : "false");
    out.append(",\"over\":").append(leader_->isHeld() ? "true" : "false");
    out.append(",\"movers\":[");
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        const RobotStatus status = world.status(i);
        if (i > 0) out += ',';
        append(out, {fixed(status.pose.position.x), fixed(status.pose.position.y),
                     fixed(status.pose.heading), fixed(status.speed), fixed(status.rotspeed),
                     status.stall ? 1 : 0, fixed(status.phase)});
    }
    out += ']';
    appendTracks(out, simulation_->tracks().present(world.time()));
    return out;
}

bool WebFrames::isNew(std::size_t sensor) const {
    return sent_[sensor] != simulation_->world().reading(sensor).seq;
}

std::string WebFrames::withReadings(bool all) {
    const World& world = simulation_->world();
    std::string out = "{\"schema\":\"ispace-web-frame/1\",\"frame\":";
    append(out, number_);
    out.append(state_).append(",\"ways\":[");
    if (all)
        for (std::string_view separator; const auto& [mover, text] : ways_)
            out.append(std::exchange(separator, ",")).append(text);
    else
        out += changed_ways_;
    out.append("],\"all\":").append(all ? "true" : "false").append(",\"readings\":[");
    std::size_t numbers = 0;
    // If the scene has changed since, the next frame describes it.
    const std::size_t count = version_ == world.changes() ? sent_.size() : 0, first = turn_;
    for (std::size_t i = 0; i < count && numbers < kMaxNumbers; ++i) {
        const std::size_t sensor = (first + i) % count;
        if (!all && !isNew(sensor)) continue;
        const SensorReading& reading = world.reading(sensor);
        numbers += appendReading(out, world.sensors()[sensor], reading);
        if (all) continue;
        sent_[sensor] = reading.seq;
        turn_ = (sensor + 1) % count;
    }
    return out += "]}";
}

}  // namespace ispace::web
