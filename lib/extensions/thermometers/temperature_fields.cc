// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of thermometers.
#include <cmath>

#include "extensions/thermometers/temperature.h"
#include "sense/formats/field_values.h"

namespace ispace::thermometers {

namespace {

using namespace fields;

/// Tenths of a kelvin: smaller changes of a state are no events.
FieldValue tenthsOfKelvin(const View& reading) {
    constexpr double kTenths = 10;
    return fieldOf(std::round(kTenths * reading.as<Temperature>().celsius) / kTenths + 0.0);
}

constexpr ReadingField kTemperatureFields[] = {
    {"zone", kInInfo,
     [](const View& r) { return FieldValue(FieldText(r.sensor.as<Thermometer>().zone)); }},
    {"resolution", kInInfo, figure<Thermometer, &Thermometer::resolution>},
    {"error", kInInfo, figure<Thermometer, &Thermometer::error>},
    {"rate", kInInfo, figure<Thermometer, &Thermometer::rate>},
    {"celsius", kInJson | kInColumn,
     [](const View& r) { return FieldValue(Measured{r.as<Temperature>().celsius}); }},
    {"celsius", kInLine | kIsState, tenthsOfKelvin},
    {"celsius", kInArray, measured<Temperature, &Temperature::celsius>, kFloat64,
     [](const View&) { return std::vector<std::uint64_t>(); }}};

constexpr RosTopic kTemperatureTopics[] = {{RosType::Temperature, "temperature", RosFrame::Sensor,
                                            [](const RosHeader& header, const View& r) {
                                                return measureMessage(header,
                                                                      r.as<Temperature>().celsius);
                                            }}};

}  // namespace

const ReadingKind Temperature::kKind = {.fields = kTemperatureFields, .topics = kTemperatureTopics};

}  // namespace ispace::thermometers
