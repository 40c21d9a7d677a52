// SPDX-License-Identifier: GPL-3.0-or-later
// join_schema SCHEMA PART... JOINED: a JSON schema with the parts that extensions add to it.
// Members of objects of a part join those of the schema, and elements of its arrays (`oneOf`,
// `required`) follow those of the schema; no part replaces a value. Run while the schemas are
// built.
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "cli/run_tool.h"

namespace {

using Json = nlohmann::ordered_json;  // keys in the order of the files

/// Adds the members and elements of `part`. `where` is the path of both in the schema, for errors.
void join(Json& schema, const Json& part, const std::string& where) {
    if (schema.is_array() && part.is_array()) {
        schema.insert(schema.end(), part.begin(), part.end());
        return;
    }
    if (!schema.is_object() || !part.is_object())
        throw ispace::FormatError({.message = where + " stands in the schema, too"});
    for (const auto& [key, value] : part.items()) {
        std::string path = where;
        path.append("/").append(key);
        if (const auto known = schema.find(key); known != schema.end())
            join(*known, value, path);
        else
            schema[key] = value;
    }
}

/// Appends JSON in which objects and arrays of up to 120 bytes take a line, as in the files here.
void write(std::string& out, const Json& json, const std::string& indent) {
    constexpr std::size_t kShort = 120;
    const std::string line = json.dump();
    if (!json.is_structured() || line.size() <= kShort) {
        out += line;
        return;
    }
    const std::string inner = indent + "  ";
    std::string_view before = "\n";
    out += json.is_object() ? '{' : '[';
    for (const auto& [key, value] : json.items()) {
        out.append(before).append(inner);
        if (json.is_object()) out.append(Json(key).dump()).append(": ");
        write(out, value, inner);
        before = ",\n";
    }
    out.append("\n").append(indent) += json.is_object() ? '}' : ']';
}

Json read(const std::string& file) {
    Json json = Json::parse(ispace::readAll(file), nullptr, false);
    if (!json.is_object())
        throw ispace::FormatError({.file = file, .message = "is no object of JSON"});
    return json;
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("join_schema", [&] {
        if (argc < 3) throw ispace::UsageError("wanted a schema, its parts and the joined schema");
        Json schema = read(argv[1]);
        for (int i = 2; i + 1 < argc; ++i) join(schema, read(argv[i]), argv[i]);
        std::string joined;
        write(joined, schema, "");
        ispace::writeAll(argv[argc - 1], joined + "\n");
    });
}
