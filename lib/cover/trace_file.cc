// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/trace_file.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "cover/json_line.h"
#include "sense/pose_json.h"

namespace ispace {

namespace {

constexpr std::string_view kSchema = "ispace-trace/1";
const char* const kWanted = "no trace, wanted what arrange --trace writes";

/// Reads the members of an object, each at most once: read(key) is false for what is unknown,
/// which is passed over. \throws FormatError if one of `wanted` is missing
template <typename Read>
void readObject(JsonLine& line, std::initializer_list<const char*> wanted, Read read) {
    std::set<std::string> keys;
    line.object([&](const std::string& key) {
        if (!keys.insert(key).second) line.fail("a second " + excerpt(key));
        if (!read(key)) line.skip();
    });
    line.end();
    for (const char* const key : wanted)
        if (!keys.contains(key)) line.fail("no " + excerpt(key));
}

History readHeader(JsonLine& line) {
    History history;
    readObject(line, {"schema"}, [&](const std::string& key) {
        if (key == "schema") {
            if (const std::string schema = line.string(); schema != kSchema)
                line.fail("found schema " + excerpt(schema) + ", wanted " + excerpt(kSchema));
        } else if (key == "history") {
            line.array([&] { history.push_back(line.string()); });
        } else {
            return false;
        }
        return true;
    });
    return history;
}

Pose3 readPose(JsonLine& line) {
    std::array<double, 6> numbers = {};
    std::size_t count = 0;
    line.array([&] {
        const double number = line.number();
        if (count < numbers.size()) numbers[count] = number;
        ++count;
    });
    if (count != numbers.size())
        line.fail("a pose has six numbers, x,y,z,heading,tilt,roll, found " +
                  std::to_string(count));
    return {{numbers[0], numbers[1], numbers[2]},
            Angle::radians(numbers[3]),
            Angle::radians(numbers[4]),
            Angle::radians(numbers[5])};
}

double readShare(JsonLine& line) {
    const double value = line.number();
    if (!(value >= 0 && value <= 1)) line.fail("a value is a share from 0 to 1");
    return value;
}

TriedPose readTried(JsonLine& line) {
    TriedPose tried;
    readObject(line, {"sensor", "pose", "value"}, [&](const std::string& key) {
        if (key == "sensor")
            tried.sensor = line.string();
        else if (key == "pose")
            tried.pose = readPose(line);
        else if (key == "value")
            tried.value = readShare(line);
        else if (key == "slice_area")
            tried.slice_area = line.number();
        else if (key == "chosen")
            tried.is_chosen = line.boolean();
        else
            return false;
        return true;
    });
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
        addPose(json, tried.pose);
        json.key("value").value(tidy(tried.value));
        if (tried.slice_area) json.key("slice_area").value(tidy(*tried.slice_area));
        if (tried.is_chosen) json.key("chosen").value(true);
        json.endObject();
        text.append(json.text()).push_back('\n');
    }
    return text;
}

TraceFile readTrace(const std::string& text, const std::string& name) {
    constexpr std::string_view kBlanks = " \t\r";
    TraceFile trace;
    const std::string_view all = text;
    bool has_header = false;
    int number = 0;
    for (std::size_t begin = 0; begin < all.size();) {
        const std::size_t end = std::min(all.find('\n', begin), all.size());
        const std::string_view content = all.substr(begin, end - begin);
        begin = end + 1;
        ++number;
        const std::size_t first = content.find_first_not_of(kBlanks);
        if (first == std::string_view::npos) continue;
        if (!has_header && content[first] != '{') throw FormatError({name, number, 0, kWanted});
        JsonLine line(content, name, number);
        if (has_header)
            trace.poses.push_back(readTried(line));
        else
            trace.history = readHeader(line);
        has_header = true;
    }
    if (!has_header) throw FormatError({name, 0, 0, kWanted});
    return trace;
}

}  // namespace ispace
