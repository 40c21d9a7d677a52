// SPDX-License-Identifier: GPL-3.0-or-later
// SCIP as bytes, see scip.h for the source. Numbers are six bits a character from '0' on, most
// significant first; the check character is the low six bits of a line's sum, plus '0'.
#include "extensions/wire/scip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace ispace::wire {

namespace {

/// Steps have four digits, distances 18 bits.
constexpr int kMaxSteps = 9999, kMaxScipDistance = (1 << 18) - 1;

struct Row {
    std::string_view model;  // of share/devices
    std::string_view name, product;
    int min_mm, max_mm, front, none, near, unused;
    bool has_intensity, has_echoes;
};

constexpr std::array kRows{
    Row{"urg-04lx", "URG-04LX(Hokuyo Automatic Co.,Ltd.)", "SOKUIKI Sensor URG-04LX", 20, 5600, 384,
        0, 19, 19, false, false},
    Row{"urg-04lx-ug01", "URG-04LX-UG01(Simple-URG)", "SOKUIKI Sensor URG-04LX-UG01(Simple-URG)",
        20, 5600, 384, 0, 19, 19, false, false},
    Row{"utm-30lx", "UTM-30LX(Hokuyo Automatic Co.,Ltd.)", "SOKUIKI Sensor TOP-URG UTM-30LX", 23,
        60000, 540, 1, 2, 0, true, false},
    Row{"utm-30lx-ew", "UTM-30LX-EW", "SOKUIKI Sensor UTM-30LX-EW", 23, 60000, 540, 1, 2, 0, true,
        true},
    Row{"ust-10lx", "UST-10LX", "SOKUIKI Sensor UST-10LX", 20, 30000, 540, 65533, 2, 0, true,
        false},
    Row{"ust-20lx", "UST-20LX", "SOKUIKI Sensor UST-20LX", 20, 60000, 540, 65533, 2, 0, true,
        false},
};

const Row* rowOf(const Laser& laser) {
    const auto* const row = std::find_if(kRows.begin(), kRows.end(), [&laser](const Row& known) {
        return known.model == laser.model;
    });
    return row == kRows.end() ? nullptr : row;
}

bool isWhole(double value) {
    constexpr double kRounding = 1e-6;
    return std::fabs(value - std::round(value)) < kRounding;
}

int roundedToInt(double value) { return static_cast<int>(std::lround(value)); }

/// Step of the first beam, counted from the front.
int offsetOf(const Laser& laser) {
    return roundedToInt(laser.first.degrees() / laser.step.degrees());
}

int frontOf(const Laser& laser) {
    const Row* const row = rowOf(laser);
    if (row != nullptr && row->front + offsetOf(laser) >= 0) return row->front;
    // Not from 0: some programs take a first step of 0 for a missing one.
    return std::max(1, 1 - offsetOf(laser));
}

}  // namespace

std::string ScipModel::refusal(const Laser& laser) {
    if (laser.sweep != SweepAxis::None) return "it sweeps, which SCIP cannot tell";
    constexpr const char* kTooMany = "it has more steps than SCIP can number";
    const double turn = 360 / laser.step.degrees();
    const double first = laser.first.degrees() / laser.step.degrees();
    if (turn > kMaxSteps) return kTooMany;
    if (!isWhole(turn)) return "a turn is no whole number of its steps, as SCIP wants it";
    if (!isWhole(first)) return "no step of it looks straight ahead, as SCIP wants it";
    if (frontOf(laser) + offsetOf(laser) + laser.beams - 1 > kMaxSteps) return kTooMany;
    return "";
}

ScipModel ScipModel::of(const Laser& laser) {
    constexpr double kSecondsAMinute = 60;
    ScipModel out;
    out.turn = roundedToInt(360 / laser.step.degrees());
    out.front = frontOf(laser);
    out.first = out.front + offsetOf(laser);
    out.last = out.first + laser.beams - 1;
    out.rpm = std::max(1, roundedToInt(laser.rate * kSecondsAMinute));
    if (const Row* const row = rowOf(laser)) {
        out.name = row->name;
        out.product = row->product;
        out.min_mm = row->min_mm;
        out.max_mm = row->max_mm;
        out.none = row->none;
        out.near = row->near;
        out.unused = row->unused;
        out.has_intensity = row->has_intensity;
        out.has_echoes = row->has_echoes;
        return out;
    }
    out.name = laser.model.empty() ? "ispace laser" : "ispace " + laser.model;
    out.product = "simulated laser";
    const double most = std::min(laser.max_range * kMmPerMetre, double{kMaxScipDistance});
    out.max_mm = std::max(1, static_cast<int>(std::ceil(most)));
    const double least = std::min(laser.min_range * kMmPerMetre, double{kMaxScipDistance});
    out.min_mm = std::clamp(roundedToInt(least), 1, out.max_mm);
    out.has_intensity = true;
    return out;
}

int ScipModel::number(float range) const {
    if (!std::isfinite(range)) return none;
    const double mm = std::round(static_cast<double>(range) * kMmPerMetre);
    if (mm < min_mm) return near;
    return mm > max_mm ? none : static_cast<int>(mm);
}

std::vector<int> ScipModel::numbers(const std::vector<float>& ranges, int start, int end,
                                    int cluster) const {
    std::vector<int> out;
    out.reserve(static_cast<std::size_t>((end - start) / cluster) + 1);
    for (int from = start; from <= end; from += cluster) {
        const int to = std::min(end, from + cluster - 1);
        std::optional<int> best;
        for (int step = from; step <= to; ++step) {
            const auto beam = static_cast<std::size_t>(step - first);
            const bool is_used = step >= first && beam < ranges.size();
            const int value = is_used ? number(ranges[beam]) : unused;
            if (!best || (isDistance(value) && (!isDistance(*best) || value < *best))) best = value;
        }
        out.push_back(*best);
    }
    return out;
}

namespace {

constexpr unsigned kSix = 0x3F, kZero = 0x30;
constexpr std::size_t kColumns = 64;
constexpr std::size_t kMaxText = 16;

bool isDigit(char c) { return c >= '0' && c <= '9'; }

bool isOfText(char c) {
    return isDigit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == ' ' || c == '.' ||
           c == '_' || c == '+' || c == '@';
}

}  // namespace

char scipCheck(std::string_view content) {
    unsigned sum = 0;
    for (const char c : content) sum += static_cast<unsigned char>(c);
    return static_cast<char>((sum & kSix) + kZero);
}

void appendScipNumber(std::string& out, std::uint32_t value, int characters) {
    for (int i = characters - 1; i >= 0; --i)
        out += static_cast<char>(((value >> (6U * static_cast<unsigned>(i))) & kSix) + kZero);
}

void appendScipLine(std::string& out, std::string_view content) {
    out += content;
    out += scipCheck(content);
    out += '\n';
}

void appendScipField(std::string& out, std::string_view key, std::string_view value) {
    const std::size_t begin = out.size();
    out.append(key).append(":").append(value);
    const char check = scipCheck(std::string_view(out).substr(begin));
    out += ';';
    out += check;
    out += '\n';
}

void appendScipData(std::string& out, std::string_view values) {
    for (std::size_t i = 0; i < values.size(); i += kColumns)
        appendScipLine(out, values.substr(i, kColumns));
}

std::optional<std::string> ScipLines::next() {
    for (std::size_t i = 0; i < bytes_.size(); ++i) {
        const char c = bytes_[i];
        if (c != '\n' && c != '\r') {
            if (line_.size() <= kMaxLength) line_ += c;
        } else if (!line_.empty()) {
            bytes_.erase(0, i + 1);
            return std::exchange(line_, {});
        }
    }
    bytes_.clear();
    return std::nullopt;
}

ScipRequest ScipRequest::of(std::string_view line) {
    ScipRequest request;
    const std::size_t semicolon = std::min(line.find(';'), line.size());
    request.text = line.substr(semicolon);
    const std::string_view body = line.substr(0, semicolon);
    const std::size_t letters = body.starts_with("SCIP2.0") ? 7 : body.starts_with("%") ? 3 : 2;
    request.command = body.substr(0, letters);
    request.parameters = body.substr(request.command.size());
    if (line.size() > ScipLines::kMaxLength) {
        request.fault = "0F";
    } else if (request.text.size() > kMaxText + 1) {
        request.fault = "0G";
    } else if (!request.text.empty() &&
               !std::all_of(request.text.begin() + 1, request.text.end(), isOfText)) {
        request.fault = "0H";
    }
    return request;
}

ScipSweep parseScipSweep(std::string_view parameters, bool streams, int last, std::string& status) {
    constexpr std::size_t kOfOne = 10, kOfStream = 13;
    ScipSweep sweep;
    const std::size_t length = streams ? kOfStream : kOfOne;
    if (parameters.size() != length) {
        status = parameters.size() < length ? "0C" : "0D";
        return sweep;
    }
    status = "00";
    const auto number = [&](std::size_t from, std::size_t size, std::string_view fault) {
        int value = 0;
        for (const char c : parameters.substr(from, size)) {
            if (!isDigit(c)) {
                if (status == "00") status = fault;
                return 0;
            }
            value = value * 10 + (c - '0');
        }
        return value;
    };
    sweep.start = number(0, 4, "01");
    sweep.end = number(4, 4, "02");
    sweep.cluster = std::max(1, number(8, 2, "03"));
    if (streams) {
        sweep.interval = number(10, 1, "06");
        sweep.count = number(11, 2, "07");
    }
    if (status != "00") return sweep;
    if (sweep.end > last)
        status = "04";
    else if (sweep.end < sweep.start)
        status = "05";
    return sweep;
}

}  // namespace ispace::wire
