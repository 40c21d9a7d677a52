// SPDX-License-Identifier: GPL-3.0-or-later
// JSON lines, schema ispace-trace/1: a head, then a pose that was tried on each line. Errors name
// line and column; a key that is there twice is one, as json::parse would take the last in silence.
#include "report/trace_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "record/text.h"
#include "sense/formats/reading_text.h"

namespace ispace {

namespace {

using nlohmann::json;

constexpr std::string_view kSchema = "ispace-trace/1";
const char* const kWanted = "no trace, wanted what arrange --trace writes";

[[noreturn]] void failInLine(const std::string& message, std::size_t column = 0) {
    throw FormatError({"", 0, static_cast<int>(column), message});
}

/// Finds a key of the outermost object that is there twice; json::parse keeps the last. A callback
/// of json::parse would see it as well, and look through each list after each of its items.
class KeysOnce : public nlohmann::json_sax<json> {
  public:
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return ++depth_, true; }
    bool end_object() override { return --depth_, true; }
    bool start_array(std::size_t) override { return ++depth_, true; }
    bool end_array() override { return --depth_, true; }
    bool key(string_t& name) override {
        if (depth_ == 1 && !keys_.insert(name).second) failInLine("a second " + excerpt(name));
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;  // json::parse reports it
    }

  private:
    std::size_t depth_ = 0;
    std::set<std::string> keys_;
};

/// Parses the object of one line. \throws FormatError without file and line
json parseTraceLine(std::string_view text) {
    KeysOnce keys;
    json::sax_parse(text, &keys);
    try {
        json line = json::parse(text);
        if (!line.is_object()) failInLine("the line is no JSON object");
        return line;
    } catch (const json::parse_error& error) {
        const std::size_t at = std::max<std::size_t>(error.byte, 1);
        failInLine(at > text.size() ? "the line ends here, within its JSON object"
                                    : "found " + excerpt(text.substr(at - 1, 20)) +
                                          ", which JSON does not have there",
                   at);
    } catch (const json::out_of_range&) {
        failInLine("a number is too large");
    }
}

/// Returns a member of the type T. \throws FormatError as parseTraceLine
template <typename T>
T memberOf(const json& line, const char* key, const char* type) {
    const auto member = line.find(key);
    if (member == line.end()) failInLine("no " + excerpt(key));
    try {
        return member->get<T>();
    } catch (const json::type_error&) {
        failInLine(excerpt(key) + " is not " + type);
    }
}

History readHeader(const json& line) {
    const auto schema = memberOf<std::string>(line, "schema", "a string");
    if (schema != kSchema)
        failInLine("found schema " + excerpt(schema) + ", wanted " + excerpt(kSchema));
    return line.contains("history") ? memberOf<History>(line, "history", "a list of strings")
                                    : History();
}

TriedPose readTried(const json& line) {
    TriedPose tried;
    tried.sensor = memberOf<std::string>(line, "sensor", "a string");
    const auto pose = memberOf<std::vector<double>>(line, "pose", "a list of numbers");
    if (pose.size() != 6)
        failInLine("a pose has six numbers, x,y,z,heading,tilt,roll, found " +
                   std::to_string(pose.size()));
    tried.pose = {{pose[0], pose[1], pose[2]},
                  Angle::radians(pose[3]),
                  Angle::radians(pose[4]),
                  Angle::radians(pose[5])};
    tried.value = memberOf<double>(line, "value", "a number");
    if (!(tried.value >= 0 && tried.value <= 1)) failInLine("a value is a share from 0 to 1");
    if (line.contains("slice_area"))
        tried.slice_area = memberOf<double>(line, "slice_area", "a number");
    if (line.contains("storey")) tried.room = memberOf<std::string>(line, "storey", "a string");
    if (line.contains("chosen")) tried.is_chosen = memberOf<bool>(line, "chosen", "true or false");
    return tried;
}

}  // namespace

std::string writeTrace(const TraceFile& trace) {
    JsonWriter header;
    header.beginObject().key("schema").value(kSchema).key("history").value(trace.history);
    header.endObject();
    std::string text = header.take() + '\n';
    for (const TriedPose& tried : trace.poses) {
        JsonWriter json;
        json.beginObject().key("sensor").value(tried.sensor);
        if (!tried.room.empty()) json.key("storey").value(tried.room);
        addPose(json, tried.pose);
        json.key("value").value(roundSignificant(tried.value));
        if (tried.slice_area) json.key("slice_area").value(roundSignificant(*tried.slice_area));
        if (tried.is_chosen) json.key("chosen").value(true);
        json.endObject();
        text.append(json.text()).push_back('\n');
    }
    return text;
}

TraceFile readTrace(const std::string& text, const std::string& name) {
    constexpr std::string_view kBlanks = " \t\r";
    TraceFile trace;
    bool has_header = false;
    LineReader lines(text);
    while (const auto content = lines.next()) {
        const std::size_t first = content->find_first_not_of(kBlanks);
        if (first == std::string_view::npos) continue;
        if (!has_header && (*content)[first] != '{')
            throw FormatError({name, lines.number(), 0, kWanted});
        try {
            const json line = parseTraceLine(*content);
            if (has_header)
                trace.poses.push_back(readTried(line));
            else
                trace.history = readHeader(line);
        } catch (const FormatError& error) {
            const Diagnostic& found = error.diagnostics().front();
            throw FormatError({name, lines.number(), found.column, found.message});
        }
        has_header = true;
    }
    if (!has_header) throw FormatError({name, 0, 0, kWanted});
    return trace;
}

}  // namespace ispace
