// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/mqtt/mqtt_options.h"

namespace ispace::extension {

Extension mqtt() { return {.name = "mqtt", .bridge = mqtt::makeMqttOptions}; }

}  // namespace ispace::extension
