// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of light meters.
#include <cmath>

#include "extensions/luxes/illuminance.h"
#include "sense/formats/field_values.h"

namespace ispace::luxes {

namespace {

using namespace fields;

/// Whole lux: smaller changes of a state are no events.
FieldValue wholeLux(const View& reading) {
    return fieldOf(static_cast<std::int64_t>(std::llround(reading.as<Illuminance>().lux)));
}

constexpr ReadingField kLuxFields[] = {
    {"max", kInInfo, figure<Lux, &Lux::max>},
    {"resolution", kInInfo, figure<Lux, &Lux::resolution>},
    {"rate", kInInfo, figure<Lux, &Lux::rate>},
    {"lux", kInJson | kInColumn,
     [](const View& r) { return FieldValue(Measured{r.as<Illuminance>().lux}); }},
    {"lux", kInLine | kIsState, wholeLux},
    {"lux", kInArray, measured<Illuminance, &Illuminance::lux>, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>(); }}};

constexpr RosTopic kLuxTopics[] = {{RosType::Illuminance, "illuminance", RosFrame::Sensor,
                                    [](const RosHeader& header, const View& r) {
                                        return measureMessage(header, r.as<Illuminance>().lux);
                                    }}};

}  // namespace

const ReadingKind Illuminance::kKind = {.fields = kLuxFields, .topics = kLuxTopics};

}  // namespace ispace::luxes
