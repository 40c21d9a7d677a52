// SPDX-License-Identifier: GPL-3.0-or-later
// States of lifts as rows, written when a phase begins or the calls change, and flushed at once:
// there are few.
#include "extensions/passages/lift_record.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/message.h"

namespace ispace::passages {

namespace {

constexpr std::string_view kLiftHead = "t,id,phase,storey,to,calls";
/// In the order of Lift::Phase.
constexpr std::array<std::string_view, 5> kPhases = {"waiting", "opening", "open", "closing",
                                                     "riding"};

}  // namespace

LiftRecorder::LiftRecorder(std::string file, std::vector<LiftNames> names)
    : file_(std::move(file)), names_(std::move(names)), written_(names_.size()) {
    file_.pending.append(kLiftHead).append("\n");
    file_.flush();
}

void LiftRecorder::record(SimTime time, const std::vector<Lift>& lifts) {
    for (std::size_t i = 0; i < lifts.size(); ++i) {
        Lift::State state = lifts[i].state();
        const Lift::State& before = written_[i];
        if (state.phase == before.phase && state.phase == Lift::Phase::Waiting)
            state.since = before.since;
        if (names_[i].id.empty() || state == before) continue;
        // After a restart the phase begins anew.
        if (state.phase == before.phase && state.since != before.since) write(time, i, {});
        write(time, i, state);
        written_[i] = std::move(state);
    }
    if (!file_.pending.empty()) file_.flush();
}

void LiftRecorder::write(SimTime time, std::size_t lift, const Lift::State& state) {
    const std::vector<std::string>& storeys = names_[lift].storeys;
    std::string& out = file_.pending;
    out.append(formatSimTime(time)).append(",").append(names_[lift].id).append(",");
    out.append(kPhases[static_cast<std::size_t>(state.phase)]).append(",");
    out.append(storeys[state.stop]).append(",");
    if (state.phase == Lift::Phase::Riding) out.append(storeys[state.next]);
    std::string_view separator = ",";
    if (state.calls.empty()) out.append(separator);
    for (const std::size_t stop : state.calls)
        out.append(std::exchange(separator, ";")).append(storeys[stop]);
    out += '\n';
}

LiftReader::LiftReader(std::string file, std::vector<LiftNames> names)
    : file_(std::move(file)), names_(std::move(names)), lines_(tableOf(file_)) {
    open();
}

void LiftReader::fail(const std::string& text) const {
    throw FormatError({file_, lines_.number(), 0, text});
}

void LiftReader::open() {
    const auto head = lines_.next();
    if (!head || *head != kLiftHead)
        fail("no lifts of a run: wanted the columns " + std::string(kLiftHead));
    states_.assign(names_.size(), {});
    time_ = row_time_ = SimTime(0);
    readRow();
}

std::size_t LiftReader::stopOf(std::size_t lift, std::string_view storey) const {
    const std::vector<std::string>& storeys = names_[lift].storeys;
    const auto found = std::find(storeys.begin(), storeys.end(), storey);
    if (found == storeys.end()) fail(names_[lift].id + " does not stop at " + excerpt(storey));
    return static_cast<std::size_t>(found - storeys.begin());
}

/// Reads ahead to the next row of a lift that the building has, as others may have been removed
/// since; leaves row_ empty at the end.
void LiftReader::readRow() {
    std::vector<std::string_view> fields;
    for (row_.reset(); !row_;) {
        const auto line = lines_.next();
        if (!line) return;
        splitFields(*line, fields);
        const auto time = fields.size() == 6 ? parseSimTime(fields[0]) : std::nullopt;
        if (!time || *time < row_time_)
            fail("wanted " + std::string(kLiftHead) + " in order of time: " + excerpt(*line));
        row_time_ = *time;
        const auto name = std::find_if(names_.begin(), names_.end(), [&](const LiftNames& one) {
            return !one.id.empty() && one.id == fields[1];
        });
        if (name == names_.end()) continue;
        const auto lift = static_cast<std::size_t>(name - names_.begin());
        const auto phase = std::find(kPhases.begin(), kPhases.end(), fields[2]);
        if (phase == kPhases.end()) fail("unknown phase " + excerpt(fields[2]));
        Lift::State state;
        state.phase = static_cast<Lift::Phase>(phase - kPhases.begin());
        state.stop = stopOf(lift, fields[3]);
        const bool rides = state.phase == Lift::Phase::Riding;
        state.next = rides ? stopOf(lift, fields[4]) : state.stop;
        for (std::string_view rest = fields[5]; !rest.empty();) {
            const std::size_t end = std::min(rest.find(';'), rest.size());
            state.calls.push_back(stopOf(lift, rest.substr(0, end)));
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        row_.emplace(lift, std::move(state));
    }
}

const std::vector<Lift::State>& LiftReader::at(SimTime time) {
    if (time < time_) {
        lines_ = tableOf(file_);
        open();
    }
    time_ = time;
    // The state of a row is seen after the step that it precedes.
    for (; row_ && row_time_ < time; readRow()) {
        auto& [lift, state] = *row_;
        const Lift::State& before = states_[lift];
        const bool goes_on = state.phase == before.phase && state.stop == before.stop &&
                             (state.phase != Lift::Phase::Riding || state.next == before.next);
        state.since = goes_on ? before.since : row_time_;
        states_[lift] = std::move(state);
    }
    return states_;
}

}  // namespace ispace::passages
