// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/preferences.h"

#include <string>
#include <string_view>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

Preferences preferencesOf(const Record& record) {
    constexpr double kBrightest = 1e6, kColdest = -100, kHottest = 100;
    Preferences preferences;
    if (!record.has("prefers")) return preferences;
    const auto refuse = [&record](const std::string& reason) {
        throw FormatError(record.finding("prefers", "`prefers`: " + reason));
    };
    std::string_view rest = record.text("prefers");
    while (true) {
        const std::string_view part = rest.substr(0, rest.find(';'));
        const std::size_t colon = part.find(':');
        const std::string_view name = part.substr(0, colon);
        const bool is_light = name == "light";
        if (colon == std::string_view::npos || (!is_light && name != "temp"))
            refuse(excerpt(part) + " is no preference, wanted light:LUX or temp:CELSIUS" +
                   didYouMean(name, {"light", "temp"}));
        const auto number = parseDouble(part.substr(colon + 1));
        const double lower = is_light ? 0 : kColdest, upper = is_light ? kBrightest : kHottest;
        if (!number || !(*number >= lower && *number <= upper))
            refuse(excerpt(part) + ": wanted a number from " + formatDouble(lower) + " to " +
                   formatDouble(upper));
        auto& value = is_light ? preferences.lux : preferences.celsius;
        if (value) refuse(excerpt(name) + " is given twice");
        value = number;
        if (part.size() == rest.size()) return preferences;
        rest.remove_prefix(part.size() + 1);
    }
}

}  // namespace ispace
