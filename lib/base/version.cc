// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/version.h"

#include "base/json_writer.h"

namespace ispace {

std::string_view version() { return ISPACE_VERSION; }

JsonWriter& beginReport(JsonWriter& json, std::string_view schema, std::string_view tool) {
    json.beginObject().key("schema").value(schema);
    return json.key("tool").value(tool).key("version").value(version());
}

}  // namespace ispace
