// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "env/body.h"
#include "env/body_shapes.h"
#include "record/record.h"
#include "record/text.h"
#include "scene/bodies.h"
#include "scene/element_device.h"
#include "scene/placement_schemas.h"
#include "scene/preferences.h"
#include "scene/robot.h"
#include "scene/sensor/pose_on_carrier.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"

namespace ispace {

namespace {

/// Finds the carrier that `on` of a sensor names, among all ids of a scene.
class Carriers {
  public:
    Carriers(const std::vector<Record>& records, const std::vector<std::string>& ids);

    struct Place {
        Pose3 pose;  ///< in the world; on a robot in its starting pose
        std::optional<Mount> mount;
        std::optional<std::size_t> person = {};
    };
    /// Computes the pose of a sensor with `on`. \throws FormatError if that names no carrier
    [[nodiscard]] Place place(const Record& sensor);
    /// Checks the carrier of a joint. \throws FormatError unless `on` names a robot or an object
    void check(const Record& joint) const { static_cast<void>(carrierOfJoint(joint)); }
    /// Checks the carrier of another thing. \throws FormatError unless a robot, a person or an
    /// object has the id
    void checkThing(const Record& thing) const;
    /// Computes the pose of a thing with a body, as of a sensor; of one that stands in the room,
    /// too.
    [[nodiscard]] Place placeOfThing(const Record& thing);

  private:
    /// Returns the index of the record that `on` names. \throws FormatError for an unknown id
    [[nodiscard]] std::size_t named(const Record& carried) const;
    [[nodiscard]] std::size_t carrierOfJoint(const Record& joint) const;
    /// Places what is fixed on a robot, or on the top of an object.
    [[nodiscard]] Place fixed(std::size_t carrier, Pose3 local);
    struct IdOfRecord {
        const std::vector<std::string>* ids;
        std::string_view operator()(std::size_t i) const { return (*ids)[i]; }
    };

    const std::vector<Record>& records_;
    const std::vector<std::string>& ids_;
    std::optional<IdTable<IdOfRecord>> by_id_;             // if a sensor has a carrier
    std::unordered_map<std::size_t, std::size_t> movers_;  // among robots or people, by record
    std::unordered_map<std::size_t, double> tops_;         // of objects that carry, by record
};

/// Returns true for furniture, pillars and the like, which have a position and a top.
bool isObject(const Record& record) {
    const RecordType type = record.schema().type;
    return type == RecordType::Other || type == RecordType::Infra;
}

/// Returns the kind of a thing with a joint for sensors; null for others.
const ThingKind* jointOf(const Record& record) {
    const ThingKind* const kind = thingKind(record.keyword());
    return kind != nullptr && kind->mount != nullptr ? kind : nullptr;
}

/// Returns the name of the key for the carrier: "on", or another where that is a state.
/// \pre there is one
const std::string& carrierKey(const Record& record) {
    const std::vector<KeySpec>& keys = record.schema().keys;
    return std::find_if(keys.begin(), keys.end(),
                        [](const KeySpec& key) { return key.role == Role::Carrier; })
        ->name;
}

bool isCarrier(const Record& record) {
    return record.keyword() == "robot" || record.keyword() == "human" || isObject(record) ||
           jointOf(record) != nullptr;
}

Carriers::Carriers(const std::vector<Record>& records, const std::vector<std::string>& ids)
    : records_(records), ids_(ids) {
    std::size_t robots = 0, people = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (records[i].schema().type != RecordType::Placement) continue;
        if (records[i].keyword() == "robot") movers_.emplace(i, robots++);
        if (records[i].keyword() == "human") movers_.emplace(i, people++);
        if (!by_id_ && !carrierOf(records[i]).empty()) by_id_.emplace(ids.size(), IdOfRecord{&ids});
    }
}

/// Returns the height at which a thing stands.
double bottomOf(const Body& body) {
    double bottom = std::numeric_limits<double>::infinity();
    for (const Prism& prism : body.prisms) bottom = std::min(bottom, prism.bottom);
    return std::isfinite(bottom) ? bottom : 0;
}

/// Reports a thing that is carried by an id without a person.
Diagnostic noPerson(const Record& thing, const std::string& id) {
    return thing.finding("no person has the id `" + id + "`, which carries it");
}

std::size_t Carriers::named(const Record& carried) const {
    const std::string on = carrierOf(carried);
    const auto found = by_id_->find(on);
    if (found) return *found;
    std::vector<std::string> candidates;
    for (std::size_t i = 0; i < records_.size(); ++i)
        if (isCarrier(records_[i])) candidates.push_back(ids_[i]);
    const std::string& key = carrierKey(carried);
    throw FormatError(carried.finding(
        key, '`' + key + "`: nothing has the id `" + on + '`' + didYouMean(on, candidates)));
}

void Carriers::checkThing(const Record& thing) const {
    const Record& record = records_[named(thing)];
    if (isCarrier(record) && jointOf(record) == nullptr) return;
    const std::string& key = carrierKey(thing);
    throw FormatError(thing.finding(key, '`' + key + "`: `" + carrierOf(thing) + "` is a `" +
                                             record.keyword() +
                                             "`; only robots, people and "
                                             "objects carry a " +
                                             thing.keyword()));
}

std::size_t Carriers::carrierOfJoint(const Record& joint) const {
    const std::size_t found = named(joint);
    const Record& record = records_[found];
    if (record.keyword() == "robot" || (isObject(record) && jointOf(record) == nullptr))
        return found;
    const std::string& key = carrierKey(joint);
    throw FormatError(joint.finding(key, '`' + key + "`: `" + carrierOf(joint) + "` is a `" +
                                             record.keyword() + "`; a " + joint.keyword() +
                                             " stands on a robot or an object"));
}

Carriers::Place Carriers::fixed(std::size_t carrier, Pose3 local) {
    const Record& record = records_[carrier];
    const Pose2 pose = floorPoseOf(record);
    if (record.keyword() == "robot")
        return {mountedPose(pose, local), Mount{movers_.at(carrier), local}};
    const auto [top, is_new] = tops_.try_emplace(carrier, 0);
    if (is_new) top->second = topOf(bodyOf(record));
    local.position.z += top->second;
    return {mountedPose(pose, local), std::nullopt};
}

Carriers::Place Carriers::placeOfThing(const Record& thing) {
    const Tuple& at = thing.tuple("at");
    const Pose3 local{{at[0], at[1], at[2]}, thing.angle("heading"), {}, {}};
    if (carrierOf(thing).empty()) return {local, std::nullopt};
    return fixed(carrierOfJoint(thing), local);
}

Carriers::Place Carriers::place(const Record& sensor) {
    const std::size_t found = named(sensor);
    const Record& record = records_[found];
    if (!isCarrier(record))
        throw FormatError(
            sensor.finding("on", "`on`: `" + sensor.text("on") + "` is a `" + record.keyword() +
                                     "`; only robots, people and objects carry sensors"));
    if (record.keyword() == "human")
        return {mountedPose(floorPoseOf(record), poseOnPerson(sensor, record)), std::nullopt,
                movers_.at(found)};
    if (const std::string person = personWith(record); !person.empty()) {
        const auto by = by_id_->find(person);
        if (!by || records_[*by].keyword() != "human") throw FormatError(noPerson(record, person));
        Pose3 local = poseOf(sensor);
        const auto figure = figureOf(records_[*by], &record);
        const Body body = standingBodyOf(record);
        if (figure != nullptr) {
            local.position.x += figure->load.x;
            local.position.y += figure->load.y;
            local.position.z += figure->load.z + topOf(body) - bottomOf(body);
        }
        return {mountedPose(floorPoseOf(records_[*by]), local), std::nullopt, movers_.at(*by)};
    }
    if (const ThingKind* const joint = jointOf(record)) {
        const Pose3 local = poseOnJoint(joint->mount(record), poseOf(sensor));
        if (carrierOf(record).empty()) return {local, std::nullopt};
        return fixed(carrierOfJoint(record), local);
    }
    return fixed(found, poseOf(sensor));
}

bool isMeta(const Record& record) { return record.schema().type == RecordType::Meta; }

/// The posed records, and the sensors to be placed.
struct Placements {
    std::vector<Sensor> sensors;
    std::vector<PendingSensor> pending;
    std::vector<PlacedRobot> robots;
    std::vector<PlacedPerson> people;
    std::vector<PlacedRecord> placed;
};

Pose3 onFloor(const Pose2& pose) {
    return {{pose.position.x, pose.position.y, 0}, pose.heading, {}, {}};
}

/// Resolves the placement records, one after another.
class Resolver {
  public:
    Resolver(const std::vector<Record>& records, const std::vector<std::string>& ids,
             const DeviceCatalogue& devices)
        : records_(records),
          ids_(ids),
          room_{records, ids, devices},
          devices_(devices),
          carriers_(records, ids) {}

    Placements resolve(Diagnostics& findings) {
        for (std::size_t i = 0; i < records_.size(); ++i) {
            const ThingKind* const kind = thingKind(records_[i].keyword());
            try {
                if (kind != nullptr && kind->check != nullptr) kind->check(records_[i]);
                if (records_[i].schema().type == RecordType::Placement) add(i);
            } catch (const FormatError& error) {
                findings.add(error);
            }
        }
        loadPeople(findings);
        return std::move(out_);
    }

  private:
    /// Gives people the things that they carry, one each.
    void loadPeople(Diagnostics& findings) {
        struct Person {
            const PlacedRecord* placed;
            std::optional<std::size_t> load = {};
        };
        std::optional<std::unordered_map<std::string_view, Person>> people;
        for (std::size_t i = 0; i < records_.size(); ++i) {
            const Record& thing = records_[i];
            const std::string id = personWith(thing);
            if (id.empty()) continue;
            if (!people) {
                people.emplace();
                for (const PlacedRecord& one : out_.placed)
                    if (records_[one.record].keyword() == "human")
                        people->emplace(ids_[one.record], Person{&one});
            }
            const auto person = people->find(id);
            if (person == people->end()) {
                findings.add(noPerson(thing, id));
                continue;
            }
            auto& [placed, load] = person->second;
            if (load) {
                findings.add(thing.finding(carriedKey(), "human " + id + " carries " + ids_[*load] +
                                                             " and " + ids_[i] +
                                                             ": one thing is in the hand"));
                continue;
            }
            load = i;
            try {
                out_.people[placed->index].figure = figureOf(records_[placed->record], &thing);
            } catch (const FormatError&) {
                // The person's record has been reported.
            }
        }
    }

    void add(std::size_t i) {
        const Record& record = records_[i];
        if (const SensorKind* kind = sensorKind(record.keyword())) {
            addSensor(i, *kind);
        } else if (record.keyword() == "robot") {
            RobotModel model = robotOf(record, devices_);
            const Pose2 pose = floorPoseOf(record);
            out_.placed.push_back({i, onFloor(pose), out_.robots.size()});
            out_.robots.push_back(
                {ids_[i], std::move(model), pose, record.place(), courseOf(record)});
        } else if (record.keyword() == "human") {
            preferencesOf(record);  // rejects bad ones
            const Pose2 pose = floorPoseOf(record);
            out_.placed.push_back({i, onFloor(pose), out_.people.size()});
            out_.people.push_back({ids_[i], record.number("height"), record.number("speed"), pose,
                                   record.place(), courseOf(record), figureOf(record)});
        } else if (const ThingKind* const thing = thingKind(record.keyword());
                   thing != nullptr && thing->body != nullptr) {
            const Carriers::Place place = carriers_.placeOfThing(record);
            out_.placed.push_back({i, place.pose, 0, place.mount});
        } else if (!carrierOf(record).empty()) {
            if (jointOf(record) != nullptr)
                carriers_.check(record);
            else if (thingKind(record.keyword()) != nullptr)
                carriers_.checkThing(record);
        } else if (record.schema().find("at") != nullptr) {  // some of extensions have no pose
            out_.placed.push_back({i, onFloor(floorPoseOf(record))});
        }
    }

    /// Adds a sensor, with a pose or pending.
    void addSensor(std::size_t i, const SensorKind& kind) {
        const Record& record = records_[i];
        SensorModel model = kind.read(record, deviceOf(record, devices_));
        if (kind.look_up != nullptr) kind.look_up(model, record, room_);
        const auto place = placeOf(record, kind);
        if (!place) {
            if (kind.is_arranged) out_.pending.push_back({ids_[i], record, std::move(model)});
            return;
        }
        out_.placed.push_back({i, place->pose, out_.sensors.size(), place->mount});
        out_.sensors.push_back(
            {ids_[i], std::move(model), place->pose, place->mount, place->person});
    }

    /// Computes the pose of a sensor; empty if it is pending.
    std::optional<Carriers::Place> placeOf(const Record& sensor, const SensorKind& kind) {
        if (sensor.has("on")) return carriers_.place(sensor);
        if (sensor.has("at")) return Carriers::Place{poseOf(sensor), std::nullopt};
        if (kind.place != nullptr)
            if (const auto pose = kind.place(sensor, room_))
                return Carriers::Place{*pose, std::nullopt};
        return std::nullopt;
    }

    const std::vector<Record>& records_;
    const std::vector<std::string>& ids_;
    RoomRecords room_;
    const DeviceCatalogue& devices_;
    Carriers carriers_;
    Placements out_;
};

/// Builds the environment; reports its errors together with the findings about sensors.
Environment makeEnvironment(const std::vector<Record>& records, const std::vector<std::string>& ids,
                            const Scene* before, Diagnostics& findings) {
    std::optional<Environment> environment;
    try {
        if (before != nullptr)
            environment.emplace(records, ids, before->environment);
        else
            environment.emplace(records, ids);
    } catch (const FormatError& error) {
        findings.add(error);
    }
    findings.throwIfAny();
    return std::move(*environment);
}

/// Lets people name the things that they carry, which follows from these; what a file says of it,
/// as one of a run does, is replaced.
/// \param before the scene before a change, or null
/// \throws FormatError where a change names another thing
void nameLoads(std::vector<Record>& records, const Scene* before) {
    constexpr std::string_view kNone = "none";
    const std::string& key = holdsKey();
    const auto is_holder = [&key](const Record& record) {
        return record.schema().find(key) != nullptr && record.has(key);
    };
    if (std::none_of(records.begin(), records.end(), [&](const Record& record) {
            return is_holder(record) || !personWith(record).empty();
        }))
        return;
    const std::vector<std::string> ids = assignIds(records);
    std::unordered_map<std::string, std::size_t> loads;  // by person
    for (std::size_t i = 0; i < records.size(); ++i)
        if (std::string person = personWith(records[i]); !person.empty())
            loads.emplace(std::move(person), i);
    const auto is_news = [&](std::size_t i) {
        if (before == nullptr) return false;
        const auto old = std::find(before->ids.begin(), before->ids.end(), ids[i]);
        if (old == before->ids.end()) return true;
        const Record& record = before->records[static_cast<std::size_t>(old - before->ids.begin())];
        return !is_holder(record) || record.text(key) != records[i].text(key);
    };
    Diagnostics findings;
    for (std::size_t i = 0; i < records.size(); ++i) {
        Record& person = records[i];
        if (person.schema().find(key) == nullptr) continue;
        const auto load = loads.find(ids[i]);
        const bool holds = is_holder(person);
        if (!holds && load == loads.end()) continue;
        const std::string thing(load == loads.end() ? kNone : ids[load->second]);
        if (holds && person.text(key) == thing) continue;
        if (!holds || !is_news(i)) {
            person.set(key, thing);
            continue;
        }
        std::string message = "human ";
        message.append(ids[i]).append(" ").append(key).append(" ").append(person.text(key));
        message.append(", but carries ").append(load == loads.end() ? "no thing" : thing);
        message.append("; `").append(key).append("` follows from `").append(carriedKey());
        message.append("` of things: leave it out, or set ");
        if (load != loads.end()) message.append(thing).append(".").append(carriedKey()).append("=");
        if (person.text(key) != kNone) {
            if (load != loads.end()) message.append(" and ");
            message.append(person.text(key)).append(".").append(carriedKey());
            message.append("=").append(ids[i]);
        }
        findings.add(person.finding(key, message));
    }
    findings.throwIfAny();
}

/// Builds a scene from records without meta records, except for `records` and `digest`.
Scene sceneOf(const std::vector<Record>& records, const Scene* before,
              const DeviceCatalogue& devices) {
    std::vector<std::string> ids = assignIds(records);
    Diagnostics findings;
    Placements placements = Resolver(records, ids, devices).resolve(findings);
    Environment room = makeEnvironment(records, ids, before, findings);
    return {.records = {},
            .ids = std::move(ids),
            .environment = std::move(room),
            .sensors = std::move(placements.sensors),
            .pending = std::move(placements.pending),
            .robots = std::move(placements.robots),
            .people = std::move(placements.people),
            .placed = std::move(placements.placed)};
}

}  // namespace

std::vector<Record> joinRecords(const std::vector<Record>& environment,
                                const std::vector<Record>& layout) {
    std::vector<Record> joined = environment;
    // Index of the first environment record with an id of the layout, which has few.
    constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
    std::unordered_map<std::string, std::size_t> places;
    for (const Record& record : layout)
        if (std::string id = record.writtenId(); !id.empty())
            places.emplace(std::move(id), kNowhere);
    for (std::size_t i = 0; !places.empty() && i < joined.size(); ++i) {
        if (!joined[i].has("id")) continue;
        const auto place = places.find(joined[i].text("id"));
        if (place != places.end() && place->second == kNowhere) place->second = i;
    }
    for (const Record& record : layout) {
        const std::string id = record.writtenId();
        const auto place = places.find(id);
        if (place == places.end() || place->second == kNowhere) {
            joined.push_back(record);
            continue;
        }
        Record& replaced = joined[place->second];
        if (replaced.keyword() != record.keyword())
            throw FormatError(record.finding(
                "id", "`" + id + "` is the id of the environment's " + replaced.keyword() +
                          ", and a record takes the place of one of its kind; give it another"));
        replaced = record;
    }
    return joined;
}

Scene makeScene(const Document& environment, const Document* layout, const DeviceCatalogue& devices,
                const Scene* before) {
    checkIds(environment.records);
    if (layout != nullptr) checkIds(layout->records);
    std::vector<Record> records =
        layout == nullptr ? environment.records : joinRecords(environment.records, layout->records);
    std::erase_if(records, isMeta);
    nameLoads(records, nullptr);
    const std::optional<std::vector<Record>> filled = withDevices(records, devices);
    Scene scene = sceneOf(filled ? *filled : records, before, devices);
    scene.records = std::move(records);
    if (filled) scene.digest_of_other = environmentDigest(environment.records);
    const auto is_of_room = [](const Record& record) { return record.schema().isEnvironment(); };
    if (layout != nullptr &&
        std::any_of(layout->records.begin(), layout->records.end(), is_of_room))
        scene.digest_of_other = environmentDigest(environment.records);
    return scene;
}

Scene makeScene(std::vector<Record> records, const Scene& before, const DeviceCatalogue& devices) {
    std::erase_if(records, isMeta);
    nameLoads(records, &before);
    const std::optional<std::vector<Record>> filled = withDevices(records, devices);
    Scene scene = sceneOf(filled ? *filled : records, &before, devices);
    scene.records = std::move(records);
    const bool is_same = &scene.environment.elements() == &before.environment.elements();
    scene.digest_of_other = is_same ? before.digest_of_other : before.digest();
    return scene;
}

std::optional<EnvironmentReference> environmentReference(const Document& layout) {
    std::optional<EnvironmentReference> reference;
    for (const Record& record : layout.records) {
        if (record.keyword() != "environment") continue;
        if (reference) {
            if (record == reference->record) continue;
            throw FormatError(record.finding("a second, other `environment`; a layout has one"));
        }
        reference = EnvironmentReference{record.has("file") ? record.text("file") : "",
                                         record.has("digest") ? record.text("digest") : "", record};
    }
    return reference;
}

std::string leftOutText(std::string_view name, std::string_view done,
                        const std::vector<std::string>& ids) {
    constexpr std::size_t kMax = 3;
    std::string text = "`";
    text.append(name).append("` is not ").append(done).append(" yet, left out: ");
    for (std::size_t i = 0; i < std::min(kMax, ids.size()); ++i)
        text.append(i == 0 ? "" : ", ").append(ids[i]);
    if (ids.size() > kMax)
        text.append(" and ").append(std::to_string(ids.size() - kMax)).append(" more");
    return text;
}

std::vector<std::string> leftOut(const Scene& scene, std::span<const std::string_view> keywords,
                                 std::string_view done,
                                 const std::function<bool(std::size_t)>& is_meant) {
    std::vector<std::string> phrases;
    for (const std::string_view keyword : keywords) {
        std::vector<std::string> ids;
        for (std::size_t i = 0; i < scene.records.size(); ++i)
            if (scene.records[i].keyword() == keyword && (!is_meant || is_meant(i)))
                ids.push_back(scene.ids[i]);
        if (!ids.empty()) phrases.push_back(leftOutText(keyword, done, ids));
    }
    return phrases;
}

namespace {

constexpr std::string_view kBlanks = " \t";

/// Removes and returns the first word of a text.
std::string_view takeWord(std::string_view& rest) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(word.size());
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    return word;
}

/// Returns true if the edit sets the position or heading of its record.
bool places(const Edit& edit, const Record& record) {
    if (edit.kind != Edit::Kind::Set) return false;
    const KeySpec* const key = record.schema().find(edit.key);
    return key != nullptr && (key->role == Role::Place || key->role == Role::Heading);
}

bool isMover(const Record& record) {
    return record.keyword() == "robot" || record.keyword() == "human";
}

}  // namespace

std::vector<Edit> parseEdits(std::string_view request) {
    std::string_view rest = request;
    const std::string_view verb = takeWord(rest);
    if (verb == "ADD") return {parseEdit(Edit::Kind::Add, rest)};
    if (verb == "SET") return {parseEdit(Edit::Kind::Set, rest)};
    std::vector<Edit> edits;
    if (verb == "ACT") {
        std::string id(takeWord(rest));
        std::string attribute;
        while (!rest.empty()) {
            const std::string_view word = takeWord(rest);
            if (word == ";") {
                id = takeWord(rest);
                continue;
            }
            attribute.assign(id).append(1, '.').append(word);
            edits.push_back(parseEdit(Edit::Kind::Set, attribute));
        }
        return edits;
    }
    if (verb != "DELETE") throw UsageError(excerpt(verb) + " is no change of a world");
    while (!rest.empty()) edits.push_back(parseEdit(Edit::Kind::Delete, takeWord(rest)));
    return edits;
}

bool isAbout(const Edit& edit, const std::string& id) { return edit.ids.matches(id); }

const char* fileKeyOf(const Record& record) {
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::File && record.has(key.name)) return key.name.c_str();
    return nullptr;
}

bool touchFiles(const std::vector<Edit>& edits, const Scene& scene) {
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const bool is_last = i + 1 == scene.records.size();
        const auto touches = [&](const Edit& edit) {
            return edit.kind == Edit::Kind::Add ? is_last : isAbout(edit, scene.ids[i]);
        };
        if (std::any_of(edits.begin(), edits.end(), touches) &&
            fileKeyOf(scene.records[i]) != nullptr)
            return true;
    }
    return false;
}

std::vector<Record> editedRecords(const Scene& scene, const std::vector<Edit>& edits,
                                  const MoverPlaces& where) {
    std::vector<Record> records = scene.records;
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!isMover(records[i])) continue;
        const auto moves = [&](const Edit& edit) {
            return places(edit, records[i]) && isAbout(edit, scene.ids[i]);
        };
        if (std::none_of(edits.begin(), edits.end(), moves)) continue;
        const auto pose = where(scene.ids[i]);
        if (!pose) continue;
        records[i].set("at", Tuple{pose->position.x, pose->position.y});
        records[i].set("heading", pose->heading.degrees());
    }
    return edited(std::move(records), edits, sceneSchemas(), &scene.ids);
}

void placeAgain(std::vector<Record>& records, std::span<const std::string> ids,
                const std::vector<Edit>& edits, const MoverPlaces& where) {
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (!isMover(records[i])) continue;
        const auto sets = [&](std::string_view key) {
            return std::any_of(edits.begin(), edits.end(), [&](const Edit& edit) {
                return places(edit, records[i]) && (key.empty() || edit.key == key) &&
                       isAbout(edit, ids[i]);
            });
        };
        if (!sets("")) continue;
        const auto pose = where(ids[i]);
        if (!pose) continue;
        if (!sets("at")) records[i].set("at", Tuple{pose->position.x, pose->position.y});
        if (!sets("heading")) records[i].set("heading", pose->heading.degrees());
    }
}

std::vector<std::string> placedBy(const std::vector<Edit>& edits, const Scene& scene) {
    std::vector<std::string> placed;
    for (const Edit& edit : edits) {
        if (edit.kind != Edit::Kind::Set) continue;
        for (std::size_t i = 0; i < scene.ids.size(); ++i)
            if (isAbout(edit, scene.ids[i]) && places(edit, scene.records[i]))
                placed.push_back(scene.ids[i]);
    }
    return placed;
}

}  // namespace ispace
