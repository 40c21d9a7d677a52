// SPDX-License-Identifier: GPL-3.0-or-later
// The folder of a recorded run: its files, and the facts in its info.csv.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "base/zstd_text.h"
#include "scene/run/run_changes.h"
#include "scene/run/run_reader.h"

namespace ispace {

RecordedFiles::RecordedFiles(const std::string& folder) {
    const auto in_folder = [&folder](const char* file) {
        return (std::filesystem::path(folder) / file).string();
    };
    const auto perhaps_packed = [&in_folder](const char* file) {
        const std::string plain = in_folder(file), packed = plain + std::string(kZstdSuffix);
        return std::filesystem::exists(packed) ? packed : plain;
    };
    robots = perhaps_packed("robots.csv");
    odometry = perhaps_packed("odometry.csv");
    bumpers = in_folder("bumpers.csv");
    people = perhaps_packed("people.csv");
    scans = perhaps_packed("scans.jsonl");
    events = in_folder("events.csv");
    info = in_folder("info.csv");
}

void checkRecordFolder(const std::string& folder) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(folder, error);
    if (!error && !std::filesystem::is_directory(status))
        error = std::make_error_code(std::errc::not_a_directory);
    if (error) throw std::system_error(error, folder);
}

std::string fileOfRecord(const std::string& folder, const std::string& name) {
    std::string file = (std::filesystem::path(folder) / name).string();
    std::error_code error;
    static_cast<void>(std::filesystem::status(file, error));
    if (error) throw std::system_error(error, file);
    if (!liesOpenlyIn(folder, file))
        throw FormatError(
            {displayName(file), 0, 0,
             "it is no regular file in the folder of the record, or is hidden there"});
    return file;
}

std::string sceneOfRecord(const std::string& folder) {
    const char* const name = "scene.env";
    // Reports links to pipes as existing, too.
    return std::filesystem::exists(
               std::filesystem::symlink_status(std::filesystem::path(folder) / name))
               ? fileOfRecord(folder, name)
               : "";
}

std::optional<RunInfo> recordedInfo(const std::string& folder) {
    const std::string name = RecordedFiles(folder).info;
    if (!std::filesystem::exists(name)) return std::nullopt;
    const std::string text = readAll(name, InputKind::Regular);
    if (text.empty()) return std::nullopt;
    std::vector<std::string_view> columns, fields;
    const std::string_view all(text);
    const std::size_t end = std::min(text.find('\n'), text.size());
    splitFields(all.substr(0, end), columns);
    const std::string_view rest = all.substr(std::min(end + 1, text.size()));
    splitFields(rest.substr(0, rest.find('\n')), fields);
    const auto text_of = [&](std::string_view column) -> std::string_view {
        const auto found = std::find(columns.begin(), columns.end(), column);
        const auto at = static_cast<std::size_t>(found - columns.begin());
        return at < fields.size() ? fields[at] : std::string_view();
    };
    const auto field = [&](std::string_view column) { return parseDouble(text_of(column)); };
    const auto step = field("dt");
    if (!step || *step <= 0 || *step > 1)
        throw FormatError({name, 2, 0,
                           "no length of a step: wanted the columns dt,control_interval,steps, as "
                           "`simrun --record` writes"});
    RunInfo info{.step = *step, .every = field("every").value_or(*step)};
    constexpr double kLeast = 1 - 1e-9;
    if (!(info.every >= kLeast * info.step))
        throw FormatError({name, 2, 0,
                           "every is " + excerpt(text_of("every")) +
                               ", wanted the time between moments, from a step on"});
    const double most = std::min(1e15, kLongestRecord / info.step);
    info.steps = std::llround(std::clamp(field("steps").value_or(0), 0.0, most));
    // Too large for a double.
    info.seed = static_cast<std::uint64_t>(parseInteger(text_of("seed")).value_or(0));
    info.noise = field("noise").value_or(0) != 0;
    return info;
}

}  // namespace ispace
