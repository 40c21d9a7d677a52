// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/scan_text.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "base/number.h"

namespace ispace {

namespace {

void appendHead(std::string& out, const SensorReading& reading, bool stream) {
    const Laser& laser = reading.sensor.as<Laser>();
    out.append("SCAN ").append(reading.sensor.id);
    out.append(" t=").append(formatMilliseconds(reading.time));
    out.append(" seq=").append(std::to_string(reading.seq));
    out.append(" angle_min=").append(formatDouble(laser.first.degrees()));
    out.append(" angle_max=").append(formatDouble(laser.last().degrees()));
    out.append(" step=").append(formatDouble(laser.step.degrees()));
    out.append(" n=").append(std::to_string(reading.scan.ranges.size()));
    if (stream) out += " stream=1";
}

void appendLittleEndian(std::string& out, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((bits >> shift) & 0xffu);
}

}  // namespace

void appendRange(std::string& out, float range) {
    if (std::isinf(range)) {
        out += '-';
        return;
    }
    // A float times 1000 is exact in a double, so rounding it half to even is what a correctly
    // rounded conversion to three decimals does.
    constexpr double kMax = 1e9;
    const double value = range;
    if (!(value >= 0 && value < kMax)) {
        out += formatFixed(value, 3);
        return;
    }
    const auto millimetres = std::llrint(value * 1000);
    std::array<char, 24> digits;
    char* const end =
        std::to_chars(digits.data(), digits.data() + digits.size(), millimetres / 1000).ptr;
    const auto rest = static_cast<int>(millimetres % 1000);
    end[0] = '.';
    end[1] = static_cast<char>('0' + rest / 100);
    end[2] = static_cast<char>('0' + rest / 10 % 10);
    end[3] = static_cast<char>('0' + rest % 10);
    out.append(digits.data(), end + 4);
}

std::string scanText(const SensorReading& reading, bool stream, bool binary) {
    const auto& ranges = reading.scan.ranges;
    constexpr std::size_t kHead = 192, kTextRange = sizeof "12.345,", kBinaryRange = 4;
    std::string out;
    out.reserve(kHead + ranges.size() * (binary ? kBinaryRange : kTextRange));
    appendHead(out, reading, stream);
    if (binary) {
        out.append(" bytes=").append(std::to_string(ranges.size() * kBinaryRange)).append("\n");
        for (const float range : ranges) appendLittleEndian(out, range);
        return out;
    }
    out += " r=";
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        if (i > 0) out += ',';
        appendRange(out, ranges[i]);
    }
    out += '\n';
    return out;
}

}  // namespace ispace
