// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/bumper_file.h"

#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

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

}  // namespace ispace
