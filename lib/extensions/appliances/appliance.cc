// SPDX-License-Identifier: GPL-3.0-or-later
// A machine of four states: Start leads to Hold, Hold to Standby, and Standby back to Start with a
// rest time. Times follow from the begin of the phase, not from steps: a run with other steps ends
// phases at the same times. phaseAt() skips phases that ended between two steps.
//
// The catalogue holds typical figures, not those of one product; the source of each stands in its
// row.
#include "extensions/appliances/appliance.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "scene/findings/findings.h"
#include "scene/sensor/sensor_keys.h"
#include "scene/thing_kind.h"

namespace ispace::appliances {

namespace {

constexpr double kMostWatts = 1e6, kLongest = 1e6, kLoudest = 200, kBrightest = 1e6;

constexpr auto kStates = std::to_array<std::string_view>({"off", "standby", "start", "hold"});

ApplianceState stateNamed(std::string_view name) {
    const auto* const found = std::find(kStates.begin(), kStates.end(), name);
    return static_cast<ApplianceState>(found - kStates.begin());
}

/// The catalogue. Limits of standby are those of the European Union's Regulation 2023/826 (0.5 W,
/// 0.8 W with a display), shares of heat those of the Building America House Simulation Protocols
/// (NREL/TP-550-49246, sensible parts), sound of labels (sound power) less 8 dB at a metre.
constexpr auto kKinds = std::to_array<ApplianceKind>(
    {{"dispenser",
      {.start = 1450,
       .hold = 60,
       .standby = 0.5,
       .start_time = 45,
       .hold_time = 30,
       .start_sound = 55,
       .hold_sound = 62},
      true,
      "datasheets of coffee machines of 1450 W: 45 s to heat, 30 s of the pump"},
     {"display",
      {.hold = 22, .standby = 0.3, .lumens = 90},
      false,
      "EU label 2019/2013, 27 inches, class E: 22 kWh in 1000 h; 250 cd/m2"},
     {"fridge",
      {.start = 400,
       .hold = 69,
       .standby = 1,
       .start_time = 1,
       .hold_time = 900,
       .rest_time = 1800,
       .start_sound = 36,
       .hold_sound = 30},
      true,
      "EU label 2019/2016, class E: 207 kWh a year, 38 dB; a third of the time at work; starts at "
      "six times the power"},
     {"gate",
      {.start = 600,
       .hold = 250,
       .standby = 4,
       .start_time = 1,
       .hold_time = 14,
       .start_sound = 65,
       .hold_sound = 60},
      true,
      "datasheets of drives of garage gates: 15 s a way, 250 W under load, 4 W of the receiver"},
     {"kettle",
      {.start = 2200,
       .hold = 2200,
       .standby = 0,
       .start_time = 165,
       .hold_time = 10,
       .start_sound = 62,
       .hold_sound = 68},
      true,
      "1 litre from 15 to 100 degrees is 356 kJ, at 2200 W of which the water gets 98 %: 165 s; "
      "boils 10 s until its switch trips"},
     {"oven",
      {.start = 2500,
       .hold = 800,
       .standby = 0.8,
       .start_time = 480,
       .start_sound = 45,
       .hold_sound = 45,
       .heat = 0.4},
      false,
      "EU label 65/2014, class A, 0.8 kWh a cycle of 47 min with 8 min to heat; the thermostat's "
      "mean"},
     {"plug_lamp",
      {.hold = 8.5, .standby = 0, .lumens = 806},
      false,
      "EU label 2019/2015, LED of 806 lm for a lamp of 60 W"},
     {"tv",
      {.start = 90, .hold = 68, .standby = 0.4, .start_time = 8, .hold_sound = 60, .lumens = 260},
      false,
      "EU label 2019/2013, 50 inches, class F: 68 kWh in 1000 h; 300 cd/m2; speech at 60 dB"},
     {"washer",
      {.start = 1900,
       .hold = 58,
       .standby = 0.5,
       .start_time = 520,
       .hold_time = 12'080,
       .start_sound = 42,
       .hold_sound = 64,
       .heat = 0.8},
      true,
      "EU label 2019/2014, 8 kg, class A: 0.47 kWh and 3.5 h a cycle eco 40-60, spins at 72 dB"}});

const ApplianceKind& kindNamed(std::string_view name) {
    return *std::find_if(kKinds.begin(), kKinds.end(),
                         [&](const ApplianceKind& kind) { return kind.name == name; });
}

std::vector<std::string> kindNames() {
    std::vector<std::string> names;
    names.reserve(kKinds.size());
    for (const ApplianceKind& kind : kKinds) names.emplace_back(kind.name);
    return names;
}

KeySpec tupleKey(std::string name, Unit unit, std::string help, std::size_t count, double upper) {
    return {.name = std::move(name),
            .type = KeyType::Tuple,
            .unit = unit,
            .help = std::move(help),
            .min_count = count,
            .max_count = count,
            .lower = 0,
            .upper = upper};
}

KeySpec numberKey(std::string name, Unit unit, std::string help, double upper) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = unit,
            .help = std::move(help),
            .lower = 0,
            .upper = upper};
}

Emission emissionOfAppliance(const Record& record) {
    const Appliance appliance = applianceOf(record);
    const ApplianceFigures& figures = appliance.figures;
    Emission emission;
    emission.pose = appliance.pose;
    emission.watts = appliance.watts();
    emission.heat = figures.heat * emission.watts;
    if (appliance.state == ApplianceState::Start) emission.volume = figures.start_sound;
    if (appliance.state != ApplianceState::Hold) return emission;
    emission.volume = figures.hold_sound;
    emission.lumens = figures.lumens;
    return emission;
}

UseChanges useOfAppliance(const Record& record) {
    const bool works_alone = kindNamed(record.text("kind")).works_alone;
    return {.begin = "on=yes", .end = works_alone ? "" : "on=no"};
}

/// Maps the ids of appliances to records.
std::map<std::string, std::size_t> appliancesIn(const Scene& scene) {
    std::map<std::string, std::size_t> found;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (scene.records[i].keyword() == "appliance") found.emplace(scene.ids[i], i);
    return found;
}

/// Checks the plugs of a scene, with lists of its appliances and plugs.
class PlugCheck {
  public:
    explicit PlugCheck(const Scene& scene) : scene_(&scene), appliances_(appliancesIn(scene)) {
        for (std::size_t i = 0; i < scene.records.size(); ++i)
            if (scene.records[i].keyword() == "plug")
                first_plugs_.emplace(scene.records[i].text("of"), i);
    }
    [[nodiscard]] std::optional<Finding> operator()(std::size_t record) const;

  private:
    const Scene* scene_;
    std::map<std::string, std::size_t> appliances_;
    std::map<std::string, std::size_t> first_plugs_;  // by their appliances
};

std::optional<Finding> PlugCheck::operator()(std::size_t record) const {
    const Record& plug = scene_->records[record];
    const std::string& of = plug.text("of");
    Finding finding{
        .severity = Severity::Error, .element = scene_->ids[record], .source = plug.keyPlace("of")};
    if (!appliances_.contains(of)) {
        std::vector<std::string> known;
        for (const auto& each : appliances_) known.push_back(each.first);
        const std::string nearest = nearestWord(of, known);
        finding.message =
            "plug " + scene_->ids[record] + " is of " + excerpt(of) + ", which is no appliance";
        finding.hint = nearest.empty() ? "name one in `of`" : "name `" + nearest + '`';
        return finding;
    }
    const std::size_t first = first_plugs_.at(of);
    if (first == record) return std::nullopt;
    finding.message = "plug " + scene_->ids[record] + " is of " + excerpt(of) +
                      ", which has the plug " + scene_->ids[first];
    finding.hint = "leave one of them out";
    return finding;
}

}  // namespace

std::string_view nameOf(ApplianceState state) { return kStates[static_cast<std::size_t>(state)]; }

std::span<const ApplianceKind> applianceKinds() { return kKinds; }

double Appliance::watts() const {
    switch (state) {
        case ApplianceState::Off:
            return 0;
        case ApplianceState::Standby:
            return figures.standby;
        case ApplianceState::Start:
            return figures.start;
        case ApplianceState::Hold:
            return figures.hold;
    }
    return 0;
}

Appliance applianceOf(const Record& record) {
    Appliance appliance;
    appliance.kind = record.text("kind");
    const Tuple& at = record.tuple("at");
    appliance.pose = {
        {at[0], at[1], record.number("height")}, record.angle("heading"), record.angle("tilt"), {}};
    ApplianceFigures& figures = appliance.figures;
    figures = kindNamed(appliance.kind).figures;
    if (record.has("draws")) {
        const Tuple& draws = record.tuple("draws");
        figures.start = draws[0];
        figures.hold = draws[1];
        figures.standby = draws[2];
    }
    if (record.has("lasts")) {
        const Tuple& lasts = record.tuple("lasts");
        figures.start_time = lasts[0];
        figures.hold_time = lasts[1];
        figures.rest_time = lasts[2];
    }
    if (record.has("sound")) {
        const Tuple& sound = record.tuple("sound");
        figures.start_sound = sound[0];
        figures.hold_sound = sound[1];
    }
    if (record.has("heat")) figures.heat = record.number("heat");
    if (record.has("light")) figures.lumens = record.number("light");
    appliance.is_on = record.flag("on");
    appliance.state = stateNamed(record.text("state"));
    return appliance;
}

namespace {

ApplianceState firstOf(const ApplianceFigures& figures) {
    return figures.start_time > 0 ? ApplianceState::Start : ApplianceState::Hold;
}

/// Returns true if it starts again by itself.
bool repeats(const ApplianceFigures& figures) {
    return figures.hold_time > 0 && figures.rest_time > 0;
}

}  // namespace

AppliancePhase phaseAfterChange(const Appliance& now, const AppliancePhase* before, bool has_mains,
                                SimTime time) {
    AppliancePhase phase{now.is_on, now.state, has_mains, time};
    if (!has_mains) {
        phase.state = ApplianceState::Off;
    } else if (before == nullptr) {
        if (now.works()) phase.is_on = true;
        if (phase.is_on && !now.works()) phase.state = firstOf(now.figures);
    } else if (!before->has_mains) {
        if (phase.state == ApplianceState::Off)
            phase.state = phase.is_on ? firstOf(now.figures) : ApplianceState::Standby;
    } else if (now.is_on != before->is_on) {
        if (now.is_on && !now.works()) phase.state = firstOf(now.figures);
        if (!now.is_on && now.works()) phase.state = ApplianceState::Standby;
    } else if (now.state != before->state) {
        phase.is_on = now.works() ||
                      (now.is_on && now.state == ApplianceState::Standby && repeats(now.figures));
    }
    if (before != nullptr && before->state == phase.state && before->is_on == phase.is_on)
        phase.since = before->since;
    return phase;
}

std::optional<SimTime> endOf(const ApplianceFigures& figures, const AppliancePhase& phase) {
    double lasts = 0;
    if (phase.state == ApplianceState::Start) return phase.since + simSeconds(figures.start_time);
    if (phase.state == ApplianceState::Hold) lasts = figures.hold_time;
    if (phase.state == ApplianceState::Standby && phase.is_on) lasts = figures.rest_time;
    if (!(lasts > 0)) return std::nullopt;
    return phase.since + simSeconds(lasts);
}

AppliancePhase nextPhase(const ApplianceFigures& figures, const AppliancePhase& phase) {
    AppliancePhase next = phase;
    next.since = *endOf(figures, phase);
    switch (phase.state) {
        case ApplianceState::Start:
            next.state = ApplianceState::Hold;
            break;
        case ApplianceState::Hold:
            next.state = ApplianceState::Standby;
            next.is_on = repeats(figures);
            break;
        case ApplianceState::Standby:
        case ApplianceState::Off:
            next.state = firstOf(figures);
            break;
    }
    return next;
}

AppliancePhase phaseAt(const ApplianceFigures& figures, AppliancePhase phase, SimTime time) {
    for (int i = 0; i < kMostPhases; ++i) {
        const auto end = endOf(figures, phase);
        if (!end || *end > time) return phase;
        phase = nextPhase(figures, phase);
    }
    phase.since = time;
    return phase;
}

std::vector<Plug> plugsOf(const Scene& scene) {
    const auto appliances = appliancesIn(scene);
    std::map<std::string, std::string> owners;
    std::vector<Plug> plugs;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        if (record.keyword() != "plug" || !appliances.contains(record.text("of"))) continue;
        if (!owners.emplace(record.text("of"), scene.ids[i]).second) continue;
        plugs.push_back(
            {scene.ids[i], record.text("of"), record.flag("on"), record.number("count")});
    }
    return plugs;
}

std::vector<Schema> applianceSchemas() {
    KeySpec on{
        .name = "on", .type = KeyType::Flag, .help = "it is switched on", .default_value = false};
    KeySpec plug_on = on;
    plug_on.help = "it lets power through";
    plug_on.default_value = true;
    KeySpec heading = headingKey("direction of its light, from +x");
    heading.default_value = 0.0;
    KeySpec height =
        numberKey("height", Unit::Length, "of its sound and light above the floor", 100);
    height.default_value = 1.0;
    KeySpec count = numberKey("count", Unit::None, "kWh by which its counter counts", 1e6);
    count.default_value = 0.01;
    count.lower = 1e-6;
    std::vector<std::string> states(kStates.begin(), kStates.end());
    return {
        {.keyword = "appliance",
         .type = RecordType::Placement,
         .help =
             "a thing that takes power, sounds, warms and shines while it works, for simrun and "
             "scan; it has no body",
         .keys = {idKey(),
                  {.name = "kind",
                   .type = KeyType::Choice,
                   .help = "row of the catalogue",
                   .choices = kindNames(),
                   .required = true},
                  {.name = "at",
                   .type = KeyType::Tuple,
                   .unit = Unit::Length,
                   .help = "its place x,y",
                   .min_count = 2,
                   .max_count = 2,
                   .lower = -kMaxDistance,
                   .upper = kMaxDistance,
                   .required = true,
                   .role = Role::Place},
                  std::move(heading),
                  angleKey("tilt", "of its light upwards; a lamp: -90", -90, 90, Role::Tilt),
                  std::move(height),
                  std::move(on),
                  {.name = "state",
                   .type = KeyType::Choice,
                   .help = "its phase",
                   .default_value = "standby",
                   .choices = std::move(states)},
                  tupleKey("draws", Unit::None, "power in start, hold and standby, W", 3,
                           kMostWatts),
                  tupleKey("lasts", Unit::Time,
                           "time of start, of hold (0: until it is switched off) and of rest (0: "
                           "it is done)",
                           3, kLongest),
                  tupleKey("sound", Unit::None,
                           "sound pressure levels at a metre in start and hold, dB (0: silent)", 2,
                           kLoudest),
                  numberKey("heat", Unit::Share, "share of its power that warms its zone", 1),
                  numberKey("light", Unit::None, "its light in hold, lumens", kBrightest)}},
        {.keyword = "plug",
         .type = RecordType::Placement,
         .help = "a plug between an appliance and the mains, which meters and switches it",
         .keys = {idKey(),
                  {.name = "of",
                   .type = KeyType::Word,
                   .help = "id of the appliance",
                   .required = true,
                   .role = Role::Reference},
                  std::move(plug_on),
                  std::move(count)}}};
}

void addAppliances() {
    addThingKind(
        "appliance",
        {.states = {"on", "state"}, .emission = emissionOfAppliance, .use = useOfAppliance});
    addThingKind("plug", {.states = {"on"}, .told = {"power", "energy"}});
    addRecordCheck("plug", [](const Scene& scene) {
        return std::function<std::optional<Finding>(std::size_t record)>(PlugCheck(scene));
    });
}

}  // namespace ispace::appliances
