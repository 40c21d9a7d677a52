// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/run/run_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "base/run_files.h"
#include "geom/tolerance.h"
#include "scene/run/run_changes.h"

namespace ispace {

namespace {

/// Columns: the required ones first and in this order; others may follow anywhere or be missing.
constexpr std::array<std::string_view, 18> kColumns = {
    "t",      "id",           "x",      "y",     "heading_deg", "speed",  "rotspeed_deg",
    "accel",  "rotaccel_deg", "stall",  "phase", "sidespeed",   "cov_xx", "cov_xy",
    "cov_yy", "cov_xh",       "cov_yh", "cov_hh"};
constexpr std::size_t kNeeded = 5;
enum Column {
    kTime,
    kId,
    kX,
    kY,
    kHeading,
    kSpeed,
    kRotspeed,
    kAccel,
    kRotaccel,
    kStall,
    kPhase,
    kSidespeed,
    kXX,
    kXY,
    kYY,
    kXH,
    kYH,
    kHH
};

/// Reads the moments of one file.
class MomentFile {
  public:
    /// Members are added to `members`, which must outlive the reader.
    MomentFile(std::string name, LineSource lines, bool is_people, std::vector<RunMember>& members)
        : name_(std::move(name)),
          lines_(std::move(lines)),
          is_people_(is_people),
          members_(&members) {
        readHeader();
        readLine();
    }

    /// Returns the time of the next moment; empty at the end.
    [[nodiscard]] std::optional<double> upcoming() const {
        return row_ ? std::optional(row_->time) : std::nullopt;
    }
    /// Appends its states. Returns false for an incomplete last moment. \pre there is one
    bool read(std::vector<RunState>& states);

    [[nodiscard]] bool isCut() const { return is_cut_; }
    /// Permits a last moment with fewer members than before: members may leave.
    void letGo() { may_lack_ = true; }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[noreturn]] void fail(const std::string& what) const {
        throw FormatError({name_, lines_.number(), 0, what});
    }

  private:
    struct Row {
        double time = 0;
        RunState state;
    };

    void readHeader();
    void readLine();
    [[nodiscard]] double number(Column column) const;
    std::size_t indexOf(std::string_view id);

    std::string name_;
    LineSource lines_;
    bool is_people_;
    std::vector<RunMember>* members_;
    std::unordered_map<std::string, std::size_t> index_;
    std::array<std::size_t, kColumns.size()> place_{};  // of each column; npos: it is missing
    std::size_t columns_ = 0;
    std::vector<std::string_view> fields_;
    std::optional<Row> row_;  // read ahead
    std::unordered_map<std::size_t, double> latest_;
    std::size_t count_ = 0;  // of the last moment
    bool is_cut_ = false, may_lack_ = false;
};

void MomentFile::readHeader() {
    constexpr auto kMissing = std::string_view::npos;
    std::optional<std::string_view> line;
    do {
        line = lines_.next();
    } while (line && (line->empty() || line->front() == '#'));
    if (line) splitFields(*line, fields_);
    if (!line || fields_.size() < kNeeded ||
        !std::equal(kColumns.begin(), kColumns.begin() + kNeeded, fields_.begin()))
        fail(
            "no record of a run: wanted the columns t,id,x,y,heading_deg,…, as `simrun --record` "
            "writes");
    columns_ = fields_.size();
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
        const auto found = std::find(fields_.begin(), fields_.end(), kColumns[i]);
        place_[i] =
            found == fields_.end() ? kMissing : static_cast<std::size_t>(found - fields_.begin());
    }
}

double MomentFile::number(Column column) const {
    if (place_[column] == std::string_view::npos) return 0;
    const std::string_view text = fields_[place_[column]];
    const auto value = parseDouble(text);
    if (!value) fail(std::string(kColumns[column]) + " is " + excerpt(text) + ", wanted a number");
    return *value;
}

std::size_t MomentFile::indexOf(std::string_view id) {
    const auto [found, is_new] = index_.try_emplace(std::string(id), members_->size());
    if (is_new) members_->push_back({std::string(id), is_people_});
    return found->second;
}

void MomentFile::readLine() {
    std::optional<std::string_view> line;
    do {
        line = lines_.next();
    } while (line && line->empty());
    const std::optional<Row> before = std::exchange(row_, std::nullopt);
    if (!line) {
        if (lines_.isTooLong())
            fail("a line is longer than " + std::to_string(kMaxLineBytes) + " bytes");
        is_cut_ = is_cut_ || lines_.isCut();
        return;
    }
    splitFields(*line, fields_);
    if (fields_.size() != columns_)
        fail("has " + std::to_string(fields_.size()) + " columns, wanted " +
             std::to_string(columns_) + ": " + excerpt(*line));
    Row row;
    row.time = number(kTime);
    if (!parseRunTime(fields_[0])) fail("t is out of bounds: " + excerpt(fields_[0]));
    if (before && row.time < before->time) fail("time runs backwards");
    row.state.member = indexOf(fields_[place_[kId]]);
    row.state.pose = {{number(kX), number(kY)}, Angle::degrees(number(kHeading))};
    row.state.speed = number(kSpeed);
    row.state.rotspeed = Angle::degrees(number(kRotspeed));
    row.state.accel = number(kAccel);
    row.state.rotaccel = Angle::degrees(number(kRotaccel));
    row.state.is_stalled = number(kStall) != 0;
    row.state.phase = number(kPhase);
    row.state.sidespeed = number(kSidespeed);
    if (place_[kHH] != std::string_view::npos) {
        const PoseCovariance errors{number(kXX), number(kXY), number(kYY),
                                    number(kXH), number(kYH), number(kHH)};
        row.state.odometry = {row.state.pose, errors};
    }
    row_ = row;
}

bool MomentFile::read(std::vector<RunState>& states) {
    const double time = row_->time;
    std::size_t count = 0;
    for (; row_ && row_->time == time; ++count) {
        const auto [latest, is_new] = latest_.try_emplace(row_->state.member, time);
        if (!is_new && latest->second == time)
            fail((*members_)[row_->state.member].id + " is there twice at t=" + formatDouble(time));
        latest->second = time;
        states.push_back(row_->state);
        readLine();
    }
    const bool is_whole = row_ || count >= count_ || may_lack_;
    is_cut_ = is_cut_ || !is_whole;
    count_ = count;
    return is_whole;
}

/// Reads the events of some kinds of a table, t,kind,id,other,x,y,….
class EventFile {
  public:
    struct Row {
        double time = 0;
        std::string kind = {}, id = {}, other = {}, text = {};
        std::optional<Point2> at = {};
    };

    EventFile(std::string name, LineSource lines, std::vector<std::string_view> kinds)
        : name_(std::move(name)), lines_(std::move(lines)), kinds_(std::move(kinds)) {
        const auto head = lines_.next();
        if (head && !head->starts_with("t,kind,id,other"))
            throw FormatError({name_, 1, 0, "no events of a run: wanted t,kind,id,other,…"});
        readLine();
    }

    /// Returns the time of the next event.
    [[nodiscard]] std::optional<double> upcoming() const {
        return row_ ? std::optional(row_->time) : std::nullopt;
    }
    /// Calls visit(row) for the unread events up to a time.
    template <typename Visit>
    void read(double time, Visit visit) {
        for (; row_ && row_->time <= time; readLine()) visit(std::move(*row_));
    }

  private:
    void readLine() {
        row_.reset();
        while (const auto line = lines_.next()) {
            splitFields(*line, fields_);
            if (fields_.size() < 4 ||
                std::find(kinds_.begin(), kinds_.end(), fields_[1]) == kinds_.end())
                continue;
            const auto time = parseRunTime(fields_[0]);
            if (!time)
                throw FormatError({name_, lines_.number(), 0,
                                   "t is " + excerpt(fields_[0]) + ", wanted seconds from 0 on"});
            row_ = Row{.time = *time};
            std::string_view rest = *line;
            std::string t, x, y, value;
            for (std::string* field :
                 {&t, &row_->kind, &row_->id, &row_->other, &x, &y, &value, &row_->text})
                *field = takeField(rest);
            if (const auto px = parseDouble(x), py = parseDouble(y); px && py)
                row_->at = Point2{*px, *py};
            return;
        }
    }

    std::string name_;
    LineSource lines_;
    std::vector<std::string_view> kinds_;
    std::vector<std::string_view> fields_;
    std::optional<Row> row_;  // read ahead
};

const std::vector<std::string_view> kReadEvents = {"collision", "unreached"};

bool exists(const std::string& file) { return std::filesystem::exists(file); }

}  // namespace

struct RunReader::Data {
    void add(const std::string& name, LineSource lines, bool is_people) {
        files.emplace_back(name, std::move(lines), is_people, members);
        if (files.size() > 1 && !files.front().upcoming()) files.erase(files.begin());
        if (files.size() > 1 && !files.back().upcoming()) files.pop_back();
    }

    void addOdometry(const std::string& name, LineSource lines) {
        odometry.emplace(name, std::move(lines), false, believers);
        if (!odometry->upcoming()) odometry.reset();
    }
    /// The world changed: moments may lack robots or people.
    void letGo(double last) {
        end = last;
        for (MomentFile& file : files) file.letGo();
        if (odometry) odometry->letGo();
    }
    [[nodiscard]] bool readOdometry();
    /// Returns the time of the next moment; empty at the end.
    [[nodiscard]] std::optional<double> upcoming();

    std::string name;
    std::vector<RunMember> members;
    std::vector<MomentFile> files;
    std::optional<EventFile> events;
    // The odometry rows of `files`, with a separate list of members.
    std::vector<RunMember> believers;
    std::optional<MomentFile> odometry;
    std::vector<RunState> beliefs;
    std::vector<RunState> states;
    std::vector<RunCollision> collisions;
    std::vector<RunUnreached> unreached;
    std::optional<BumperFile> bumper_file;
    std::vector<RunBumpers> bumpers;
    double time = 0;
    /// In a changed world, the last moment that all files hold.
    std::optional<double> end;
    bool is_cut = false;
};

std::optional<double> RunReader::Data::upcoming() {
    std::optional<double> next;
    bool is_over = false;
    for (const MomentFile& file : files) {
        const auto start = file.upcoming();
        is_over = is_over || !start;
        if (start && (!next || *start < *next)) next = start;
    }
    // A killed run may leave one file behind the other.
    for (const MomentFile& file : files)
        is_cut = is_cut || file.isCut() || (!end && is_over && file.upcoming());
    if (!end) return is_over ? std::nullopt : files.front().upcoming();
    if (next && *next > *end + 0.5 * kTimeTolerance) is_cut = true;
    return next && *next <= *end + 0.5 * kTimeTolerance ? next : std::nullopt;
}

RunReader::RunReader(const std::string& folder) : data_(std::make_unique<Data>()) {
    const RecordedFiles files(folder);
    data_->name = files.robots;
    data_->add(files.robots, tableOf(files.robots), false);
    if (exists(files.people)) data_->add(files.people, tableOf(files.people), true);
    if (exists(files.odometry)) data_->addOdometry(files.odometry, tableOf(files.odometry));
    if (exists(files.bumpers)) data_->bumper_file.emplace(files.bumpers, tableOf(files.bumpers));
    if (!exists(files.events)) return;
    data_->events.emplace(files.events, tableOf(files.events), kReadEvents);
    if (!recordedChange(folder)) return;
    const auto info = recordedInfo(folder);
    data_->letGo(info && info->steps > 0 ? info->step * static_cast<double>(info->steps)
                                         : std::numeric_limits<double>::infinity());
}

RunReader::RunReader(std::string robots, std::string people, std::string events,
                     std::string odometry, std::string bumpers)
    : data_(std::make_unique<Data>()) {
    data_->name = "robots.csv";
    data_->add("robots.csv", LineSource({}, std::move(robots)), false);
    if (!people.empty()) data_->add("people.csv", LineSource({}, std::move(people)), true);
    if (!odometry.empty()) data_->addOdometry("odometry.csv", LineSource({}, std::move(odometry)));
    if (!bumpers.empty())
        data_->bumper_file.emplace("bumpers.csv", LineSource({}, std::move(bumpers)));
    if (events.find(",change,") != std::string::npos)
        data_->letGo(std::numeric_limits<double>::infinity());
    if (!events.empty())
        data_->events.emplace("events.csv", LineSource({}, std::move(events)), kReadEvents);
}

/// Stores the recorded odometry of the moment in its robots; false if its rows are incomplete.
bool RunReader::Data::readOdometry() {
    const bool has_robots =
        std::any_of(states.begin(), states.end(),
                    [this](const RunState& state) { return !members[state.member].is_person; });
    if (!has_robots) return true;
    if (!odometry->upcoming()) return false;
    if (*odometry->upcoming() != time)
        odometry->fail("the moment t=" + formatDouble(*odometry->upcoming()) + " is none of " +
                       name + ", which goes on at t=" + formatDouble(time));
    beliefs.clear();
    if (!odometry->read(beliefs)) return false;
    // The same robots in the same order.
    auto belief = beliefs.begin();
    for (RunState& state : states) {
        if (members[state.member].is_person) continue;
        if (belief == beliefs.end() || believers[belief->member].id != members[state.member].id)
            odometry->fail("the robots at t=" + formatDouble(time) + " are not those of " + name);
        const RunState& believed = *belief++;
        state.odometry = believed.odometry.value_or(EstimatedPose{believed.pose});
    }
    return true;
}

RunReader::~RunReader() = default;
RunReader::RunReader(RunReader&&) noexcept = default;
RunReader& RunReader::operator=(RunReader&&) noexcept = default;

bool RunReader::next() {
    Data& data = *data_;
    const auto next = data.upcoming();
    if (!next) return false;
    const double time = *next;
    std::vector<RunState> states;
    for (MomentFile& file : data.files) {
        if (data.end && file.upcoming() != time) continue;
        if (*file.upcoming() != time)
            file.fail("the moment t=" + formatDouble(*file.upcoming()) + " is none of " +
                      data.name + ", which goes on at t=" + formatDouble(time));
        if (!file.read(states)) {
            data.is_cut = true;
            return false;
        }
    }
    data.states = std::move(states);
    data.time = time;
    if (data.odometry && !data.readOdometry()) {
        data.is_cut = true;
        return false;
    }
    data.collisions.clear();
    data.unreached.clear();
    if (data.events)
        data.events->read(time, [&data](EventFile::Row row) {
            if (row.kind == "collision")
                data.collisions.push_back({std::move(row.id), std::move(row.other)});
            else
                data.unreached.push_back(
                    {std::move(row.id), std::move(row.other), row.at, std::move(row.text)});
        });
    data.bumpers.clear();
    if (data.bumper_file) data.bumper_file->read(time, data.bumpers);
    return true;
}

double RunReader::time() const { return data_->time; }
std::span<const RunState> RunReader::states() const { return data_->states; }
std::optional<std::span<const RunCollision>> RunReader::collisions() const {
    return data_->events ? std::optional<std::span<const RunCollision>>(data_->collisions)
                         : std::nullopt;
}
std::span<const RunUnreached> RunReader::unreached() const { return data_->unreached; }
std::span<const RunBumpers> RunReader::bumpers() const { return data_->bumpers; }
const std::vector<RunMember>& RunReader::members() const { return data_->members; }
bool RunReader::isCut() const { return data_->is_cut; }
bool RunReader::hasOdometry() const { return data_->odometry.has_value(); }
const std::string& RunReader::name() const { return data_->name; }

std::optional<double> recordedChange(const std::string& folder) {
    const std::string name = RecordedFiles(folder).events;
    if (!exists(name)) return std::nullopt;
    return EventFile(name, tableOf(name), {"change"}).upcoming();
}

}  // namespace ispace
