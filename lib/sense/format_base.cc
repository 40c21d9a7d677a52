// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/format_base.h"

#include "base/error.h"
#include "sensor/kind.h"

namespace ispace {

void FormatBase::accept(std::string_view format, std::string_view what,
                        bool (*is_held)(const Sensor&)) const {
    for (const Sensor& one : sensors_.read)
        if (!is_held(one)) refuse(format, what, one);
}

void FormatBase::refuse(std::string_view format, std::string_view what, const Sensor& one) {
    throw UsageError(std::string(format) + " holds " + std::string(what) + ", and " + one.id +
                     " is a " + std::string(kindOf(one.model).keyword) +
                     "; choose sensors with --select, or another format with --to");
}

std::string FormatBase::whole(std::size_t index, const Reading& reading) const {
    std::string bytes, appended;
    append(appended, index, reading);
    const auto file = stream([&bytes](std::string_view piece) { bytes += piece; });
    file->write(appended);
    file->finish();
    return bytes;
}

}  // namespace ispace
