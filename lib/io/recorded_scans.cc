// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/recorded_scans.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace ispace {

namespace {

using nlohmann::json;

constexpr std::string_view kSchema = "ispace-scan/1";

/// \throws FormatError
int countOf(const json& value, const char* name) {
    constexpr int kMost = std::numeric_limits<int>::max();
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMost)
        throw FormatError({"", 0, 0, '`' + std::string(name) + "` is no whole number from 0 on"});
    return value.get<int>();
}

/// \throws json::exception, FormatError
RecordedScan scanOf(const json& line) {
    constexpr std::size_t kPose = 6;
    RecordedScan scan;
    scan.sensor = line.at("sensor").get<std::string>();
    scan.time = line.at("t").get<double>();
    scan.frame = countOf(line.at("frame"), "frame");
    if (line.contains("scan")) scan.number = countOf(line["scan"], "scan");
    const auto pose = line.at("pose").get<std::vector<double>>();
    if (pose.size() != kPose) throw FormatError({"", 0, 0, "`pose` has not six numbers"});
    scan.pose = {{pose[0], pose[1], pose[2]},
                 Angle::radians(pose[3]),
                 Angle::radians(pose[4]),
                 Angle::radians(pose[5])};
    for (const json& range : line.at("ranges"))
        scan.ranges.push_back(range.is_null() ? std::numeric_limits<float>::infinity()
                                              : range.get<float>());
    return scan;
}

}  // namespace

/// The next line that is whole.
std::optional<std::string_view> RecordedScans::nextLine() {
    std::size_t seen = begin_;
    while (true) {
        const std::size_t end = buffer_.find('\n', seen);
        if (end != std::string::npos) {
            const auto line = std::string_view(buffer_).substr(begin_, end - begin_);
            begin_ = end + 1;
            ++line_;
            return line;
        }
        buffer_.erase(0, begin_);
        begin_ = 0;
        seen = buffer_.size();
        if (!read_(buffer_)) return std::nullopt;
    }
}

std::optional<RecordedScan> RecordedScans::next() {
    while (const auto text = nextLine()) {
        try {
            const json line = json::parse(*text);
            if (!line.is_object()) throw FormatError({"", 0, 0, "no line of ispace-scan/1"});
            if (line_ == 1) {
                if (line.value("schema", "") != kSchema)
                    throw FormatError({"", 0, 0, "its first line does not say ispace-scan/1"});
            } else if (line.contains("ranges")) {
                return scanOf(line);
            }
        } catch (const json::exception&) {
            throw FormatError({name_, line_, 0, "no line of ispace-scan/1"});
        } catch (const FormatError& error) {
            throw FormatError({name_, line_, 0, error.diagnostics().front().message});
        }
    }
    return std::nullopt;
}

}  // namespace ispace
