// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/device_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/number.h"
#include "layout/laser.h"
#include "layout/ranger.h"
#include "layout/ultrasound.h"

namespace ispace {

namespace {

using Row = std::array<std::string, 8>;

/// Degrees of people: no more decimals than tell devices apart.
std::string degreesText(Angle angle) {
    return formatDouble(std::round(angle.degrees() * 100) / 100);
}

std::string limitsText(double least, double greatest) {
    return formatDouble(least) + ".." + formatDouble(greatest);
}

void describe(const Record& device, Row& row) {
    auto& [model, kind, name, range, fov, size, rate, confidence] = row;
    if (kind == "laser") {
        const Laser laser = withFigures(Laser(), device);
        range = limitsText(laser.min_range, laser.max_range);
        fov = degreesText(laser.span());
        size = std::to_string(laser.beams);
        rate = formatDouble(laser.rate);
    } else if (kind == "ranger") {
        const Ranger ranger = withFigures(Ranger(), device);
        range = limitsText(ranger.min_range, ranger.max_range);
        fov = degreesText(ranger.fov_x) + "x" + degreesText(ranger.fov_y);
        size = std::to_string(ranger.columns) + "x" + std::to_string(ranger.rows);
        rate = formatDouble(ranger.rate);
    } else if (kind == "ultrasound") {
        const Receiver receiver = withFigures(Receiver(), device);
        range = limitsText(receiver.min_range, receiver.max_range);
        fov = degreesText(receiver.fov);
        size = "-";
        rate = formatDouble(receiver.rate);
    } else {
        const Tag tag = withFigures(Tag(), device);
        range = "-";
        fov = degreesText(tag.fov);
        size = "-";
        rate = formatDouble(tag.rate);
    }
}

}  // namespace

std::string deviceTable(const DeviceCatalogue& devices, std::span<const std::string_view> kinds) {
    std::vector<Row> rows = {
        {"MODEL", "KIND", "NAME", "RANGE/m", "FOV/deg", "SIZE", "RATE/Hz", "CONFIDENCE"}};
    for (const std::string_view kind : kinds)
        for (const Record& device : devices.devices()) {
            if (device.keyword() != kind) continue;
            Row row = {device.text("model"),
                       device.keyword(),
                       device.has("name") ? device.text("name") : "-",
                       "",
                       "",
                       "",
                       "",
                       device.text("confidence")};
            describe(device, row);
            rows.push_back(std::move(row));
        }
    std::array<std::size_t, std::tuple_size_v<Row>> widths{};
    for (const Row& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string out;
    for (const Row& row : rows) {
        for (std::size_t i = 0; i + 1 < row.size(); ++i) {
            out += row[i];
            out.append(widths[i] - row[i].size() + 2, ' ');
        }
        out += row.back();
        out += '\n';
    }
    return out;
}

}  // namespace ispace
