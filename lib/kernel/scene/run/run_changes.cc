// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/run/run_changes.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/run/run_reader.h"

namespace ispace {

BumperFile::BumperFile(std::string name, LineSource lines)
    : name_(std::move(name)), lines_(std::move(lines)) {
    const auto head = lines_.next();
    if (head && *head != "t,id,hit") fail("no bumpers of a run: wanted the columns t,id,hit");
    readLine();
}

void BumperFile::fail(const std::string& what) const {
    throw FormatError({name_, lines_.number(), 0, what});
}

void BumperFile::readLine() {
    row_.reset();
    const auto line = lines_.next();
    if (!line) return;
    splitFields(*line, fields_);
    const auto time = fields_.size() == 3 ? parseDouble(fields_[0]) : std::nullopt;
    if (!time || *time < time_) fail("wanted t,id,hit in order of time: " + excerpt(*line));
    time_ = *time;
    RunBumpers row{std::string(fields_[1]), {}};
    const std::string_view hit = fields_[2];
    for (std::size_t i = 0; i < hit.size() || i % 2 == 0; ++i) {
        const char c = i < hit.size() ? hit[i] : ' ';
        const bool is_between = i % 2 == 1;
        if (is_between ? c != ';' : c != '0' && c != '1')
            fail("hit is " + excerpt(hit) + ", wanted 0 or 1 of each bumper, like 0;1");
        if (!is_between) row.hit.push_back(c == '1');
    }
    row_ = std::move(row);
}

void BumperFile::read(double time, std::vector<RunBumpers>& bumpers) {
    for (; row_ && time_ <= time; readLine()) bumpers.push_back(std::move(*row_));
}

std::string takeField(std::string_view& rest) {
    std::string field;
    if (!rest.starts_with('"')) {
        field = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(field.size() + 1, rest.size()));
        return field;
    }
    std::size_t at = 1;
    for (; at < rest.size(); ++at) {
        if (rest[at] == '"' && (at + 1 == rest.size() || rest[++at] != '"')) break;
        field += rest[at];
    }
    rest.remove_prefix(std::min(at + 1, rest.size()));
    return field;
}

std::vector<RunChange> recordedChanges(const std::string& folder) {
    const std::string name = RecordedFiles(folder).events;
    if (!std::filesystem::exists(name)) return {};
    LineSource lines = tableOf(name);
    const auto head = lines.next();
    if (head && !head->starts_with("t,kind,id,other"))
        throw FormatError({name, 1, 0, "no events of a run: wanted t,kind,id,other,…"});
    std::vector<RunChange> changes;
    while (const auto line = lines.next()) {
        std::string_view rest = *line;
        const std::string time = takeField(rest);
        if (takeField(rest) != "change") continue;
        RunChange change;
        const auto seconds = parseRunTime(time);
        if (!seconds)
            throw FormatError(
                {name, lines.number(), 0, "t is " + excerpt(time) + ", wanted seconds from 0 on"});
        change.time = *seconds;
        takeField(rest);  // id
        change.scene = takeField(rest);
        for (int unused = 0; unused < 3; ++unused) takeField(rest);  // x, y, value
        change.text = takeField(rest);
        change.line = lines.number();
        changes.push_back(std::move(change));
    }
    return changes;
}

namespace {

/// A genuine record has rows for each step between its changes.
Budget budgetOf(const std::string& folder, std::optional<std::uint64_t> max_work) {
    const RecordedFiles files(folder);
    std::uint64_t bytes = 0;
    for (const std::string* file : {&files.robots, &files.people, &files.events}) {
        std::error_code missing;
        const std::uintmax_t size = std::filesystem::file_size(*file, missing);
        if (!missing) bytes += size;
    }
    return Budget(0, {max_work.value_or(Budget::kMaxWork + Budget::kPerByte * bytes)});
}

}  // namespace

RunChanges::RunChanges(const std::string& folder, Scene start, DeviceCatalogue devices,
                       ReadScene read, std::optional<std::uint64_t> max_work)
    : folder_(folder),
      first_(std::make_shared<const Scene>(std::move(start))),
      start_(first_),
      devices_(std::move(devices)),
      read_(std::move(read)),
      changes_(recordedChanges(folder)),
      whole_(budgetOf(folder, max_work)),
      budget_(whole_) {}

RunChanges::Step RunChanges::stepOf(const RunChange& change, const Scene& now,
                                    const MoverPlaces& places) {
    const bool loads = change.text.starts_with("LOAD");
    if (change.text == "RESET") return {*start_, true, {}};
    if (loads && change.scene.empty())
        throw UsageError("the record does not hold the scene that was loaded");
    if (!change.scene.empty()) {
        Scene scene = read_(fileOfRecord(folder_, change.scene));
        if (loads) start_ = std::make_shared<const Scene>(scene);
        return {std::move(scene), loads,
                loads ? std::vector<std::string>() : placedBy(parseEdits(change.text), now)};
    }
    const std::vector<Edit> edits = parseEdits(change.text);
    return {makeScene(editedRecords(now, edits, places), now, devices_), false,
            placedBy(edits, now)};
}

bool RunChanges::isDue(double before) const {
    constexpr double kRounding = 5e-10;  // s
    return next_ < changes_.size() && changes_[next_].time < before - kRounding;
}

std::optional<RunChanges::Step> RunChanges::next(double before, const Scene& now,
                                                 const MoverPlaces& places) {
    while (isDue(before)) {
        const RunChange& change = changes_[next_++];
        if (!budget_.take(now.records.size())) {
            refuse("it and those before make " + budget_.excess());
            continue;
        }
        try {
            Step step = stepOf(change, now, places);
            step.change = change;
            return step;
        } catch (const FormatError& error) {
            refuse(error.what());
        } catch (const UsageError& error) {
            refuse(error.what());
        } catch (const std::system_error& error) {
            refuse(error.what());
        }
    }
    return std::nullopt;
}

void RunChanges::rewind() {
    next_ = 0;
    budget_ = whole_;
    start_ = first_;
}

void RunChanges::refuse(const std::string& why) {
    if (!failure_.empty()) return;
    const RunChange& change = changes_[next_ - 1];
    failure_ = RecordedFiles(folder_).events + ":" + std::to_string(change.line) + ": " +
               excerpt(change.text) + " at t=" + formatDouble(change.time) +
               " cannot be made again: " + why;
}

}  // namespace ispace
