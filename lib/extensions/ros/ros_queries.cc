// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_queries.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "extensions/ros/ros_parameters.h"

namespace ispace::ros {

namespace {

// Of rcl_interfaces/msg/ParameterType.
constexpr std::uint8_t kNotSet = 0, kBool = 1, kInteger = 2, kDouble = 3, kText = 4, kBytes = 5,
                       kBools = 6, kIntegers = 7, kDoubles = 8;

using Value = decltype(RosParameter::value);

std::uint8_t typeOf(const Value& value) {
    if (std::holds_alternative<bool>(value)) return kBool;
    return std::holds_alternative<double>(value) ? kDouble : kDoubles;
}

std::string_view descriptionOf(std::string_view name) {
    if (name == "clock.paused") return "whether simulated time stands still";
    if (name == "clock.rate") return "simulated seconds in a second of wall time";
    return name.ends_with(".heading") ? "direction that it faces, degrees counter-clockwise from x"
                                      : "position in metres";
}

std::vector<std::string> readTexts(CdrReader& in) {
    std::vector<std::string> texts;
    for (std::size_t left = in.count(); left > 0; --left) texts.emplace_back(in.text());
    return texts;
}

/// Calls visit(name, parameter), null for an unknown one, for each name of a request.
template <typename Visit>
void forEachNamed(CdrReader& in, ServerState& state, CdrWriter& out, Visit visit) {
    const std::vector<RosParameter> all = rosParameters(state);
    const std::vector<std::string> names = readTexts(in);
    out.count(names.size());
    for (const std::string& name : names) {
        const auto found = std::find_if(all.begin(), all.end(),
                                        [&](const RosParameter& one) { return one.name == name; });
        visit(name, found == all.end() ? nullptr : &*found);
    }
}

/// Levels of names end in dots; a depth of 0 is any.
void list(CdrReader& in, ServerState& state, CdrWriter& out) {
    const std::vector<std::string> prefixes = readTexts(in);
    const auto depth = in.number<std::uint64_t>();
    std::vector<std::string> names, found_prefixes;
    for (const RosParameter& one : rosParameters(state)) {
        const auto is_below = [&](const std::string& prefix) {
            if (one.name == prefix) return true;
            if (!one.name.starts_with(prefix + '.')) return false;
            const auto levels = std::count(
                one.name.begin() + static_cast<std::ptrdiff_t>(prefix.size()), one.name.end(), '.');
            return depth == 0 || static_cast<std::uint64_t>(levels) <= depth;
        };
        const auto levels =
            static_cast<std::uint64_t>(std::count(one.name.begin(), one.name.end(), '.'));
        const bool is_wanted = prefixes.empty()
                                   ? depth == 0 || levels < depth
                                   : std::any_of(prefixes.begin(), prefixes.end(), is_below);
        if (!is_wanted) continue;
        names.push_back(one.name);
        const std::string prefix = one.name.substr(0, one.name.rfind('.'));
        if (std::find(found_prefixes.begin(), found_prefixes.end(), prefix) == found_prefixes.end())
            found_prefixes.push_back(prefix);
    }
    for (const auto& texts : {names, found_prefixes}) {
        out.count(texts.size());
        for (const std::string& text : texts) out.put(text);
    }
}

void describe(CdrReader& in, ServerState& state, CdrWriter& out) {
    forEachNamed(in, state, out, [&](const std::string& name, const RosParameter* parameter) {
        out.put(name).put(parameter == nullptr ? kNotSet : typeOf(parameter->value));
        out.put(parameter == nullptr ? "" : descriptionOf(name));
        // Constraints; whether it is only read; whether its type may change; ranges.
        out.put("").put(parameter == nullptr).put(false).count(0).count(0);
    });
}

void types(CdrReader& in, ServerState& state, CdrWriter& out) {
    forEachNamed(in, state, out, [&](const std::string& /*name*/, const RosParameter* parameter) {
        out.put(parameter == nullptr ? kNotSet : typeOf(parameter->value));
    });
}

void values(CdrReader& in, ServerState& state, CdrWriter& out) {
    forEachNamed(in, state, out, [&](const std::string& /*name*/, const RosParameter* parameter) {
        const Value value = parameter == nullptr ? Value(false) : parameter->value;
        const auto* const flag = std::get_if<bool>(&value);
        const auto* const number = std::get_if<double>(&value);
        const auto* const numbers = std::get_if<std::vector<double>>(&value);
        out.put(parameter == nullptr ? kNotSet : typeOf(value));
        out.put(flag != nullptr && *flag).put(std::int64_t{0});
        out.put(number == nullptr ? 0.0 : *number).put("");
        out.count(0).count(0).count(0);
        out.sequence<double>(numbers == nullptr ? std::vector<double>() : *numbers);
        out.count(0);
    });
}

template <typename Number>
nlohmann::json readNumbers(CdrReader& in) {
    nlohmann::json numbers = nlohmann::json::array();
    for (std::size_t left = in.count(); left > 0; --left) numbers.push_back(in.number<Number>());
    return numbers;
}

/// Reads a rcl_interfaces/msg/ParameterValue: its type, and a field of each type.
nlohmann::json readValue(CdrReader& in) {
    const auto type = in.number<std::uint8_t>();
    std::array<nlohmann::json, kDoubles + 1> fields;
    fields[kBool] = in.number<std::uint8_t>() != 0;
    fields[kInteger] = in.number<std::int64_t>();
    fields[kDouble] = in.number<double>();
    fields[kText] = in.text();
    fields[kBytes] = readNumbers<std::uint8_t>(in);
    fields[kBools] = readNumbers<std::uint8_t>(in);
    fields[kIntegers] = readNumbers<std::int64_t>(in);
    fields[kDoubles] = readNumbers<double>(in);
    readTexts(in);
    return type < fields.size() ? fields[type] : nlohmann::json();
}

constexpr RosQuery kQueries[] = {
    {"/simrun/list_parameters", "rcl_interfaces/srv/ListParameters", list},
    {"/simrun/describe_parameters", "rcl_interfaces/srv/DescribeParameters", describe},
    {"/simrun/get_parameter_types", "rcl_interfaces/srv/GetParameterTypes", types},
    {"/simrun/get_parameters", "rcl_interfaces/srv/GetParameters", values}};

}  // namespace

std::span<const RosQuery> rosQueries() { return kQueries; }

std::vector<std::pair<std::string, nlohmann::json>> readParameters(CdrReader& request) {
    std::vector<std::pair<std::string, nlohmann::json>> parameters;
    for (std::size_t left = request.count(); left > 0; --left) {
        std::string name(request.text());
        parameters.emplace_back(std::move(name), readValue(request));
    }
    return parameters;
}

void writeSetResult(const std::string& refusal, CdrWriter& out) {
    out.put(refusal.empty()).put(refusal);
}

}  // namespace ispace::ros
