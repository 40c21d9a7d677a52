// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/record_form.h"

#include <algorithm>

#include "base/error.h"

namespace ispace {

std::int64_t RecordForm::stride(SimTime step) const {
    if (every == SimTime(0)) return 1;
    if (every < step || every % step != SimTime(0))
        throw UsageError("--record-every " + formatSimTime(every) +
                         ": wanted a whole number of steps of " + formatSimTime(step) + " s");
    return every / step;
}

const std::vector<std::string>& optionalColumns() {
    static const std::vector<std::string> names = {
        "speed", "rotspeed_deg", "accel", "rotaccel_deg", "stall", "phase", "sidespeed"};
    return names;
}

TableColumns::TableColumns(std::string_view whole, const RecordForm& form) : head(whole) {
    if (!form.columns) return;
    constexpr int kBefore = 2;  // t and id are no numbers of a mover
    const auto has = [](const std::vector<std::string>& names, std::string_view name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    head.clear();
    std::string_view rest = whole.substr(0, whole.find('\n'));
    for (int column = 0; !rest.empty(); ++column) {
        const std::string_view name = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(name.size() + 1, rest.size()));
        if (!has(optionalColumns(), name) || has(*form.columns, name))
            head.append(head.empty() ? "" : ",").append(name);
        else
            kept &= ~(std::uint32_t{1} << static_cast<unsigned>(column - kBefore));
    }
    head += '\n';
}

}  // namespace ispace
