// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of a running world, in two parts.
//
// The scene after the edits is made from the records before them; positions of movers that an edit
// sets only in part come from the world, and are taken again when the change is made, in case they
// moved meanwhile. Edits that are set apart may be made in any order, so their loads count as if
// all records were there twice.
#include "sim/world_editor.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "scene/scene.h"
#include "scene/thing_kind.h"
#include "sim/pace.h"
#include "sim/run_limits.h"

namespace ispace {

namespace {

using Preparer = std::function<NextScene(Scene scene)>;
using Check = std::function<void(const Scene& scene)>;
using SceneWriter = std::function<std::string(const Scene& scene)>;

/// Above this number each one would be looked up among all.
constexpr std::size_t kFewMovers = 100;

/// Finds the pose of a robot or a person.
std::optional<Pose2> placeIn(const World& world, const std::string& id) {
    const auto mover = world.moverNamed(id);
    return mover ? std::optional(world.status(*mover).pose) : std::nullopt;
}

/// Returns the readings after a change for each one before.
double timesAsOften(const Scene& before, const Scene& after) {
    const double all = readingRate(before);
    return all > 0 ? readingRate(after) / all : 1;
}

struct Loads {
    RunLoad before, after;
};

/// Returns the loads to check before a change from one scene to another. While some of its edits
/// are carried out, set apart, the load is at most the sum of both: each record has one of them.
Loads loadsOf(const Scene& before, const Scene& after, SimTime step, const RecordOptions* record,
              bool apart) {
    const Loads loads = {loadOf(before, step, record), loadOf(after, step, record)};
    return apart ? Loads{{}, loads.before + loads.after} : loads;
}

/// Returns the most readings that a change adds, for each one before. \param apart see loadsOf()
double moreReadings(const Scene& before, const Scene& after, bool apart) {
    return std::max(0.0, timesAsOften(before, after) - (apart ? 0 : 1));
}

/// Applies edits to a scene.
class Editing {
  public:
    /// Fast: names are looked up in prepare().
    /// \param pace of a world by the clock Real, else null
    Editing(World& world, Pace* pace, std::shared_ptr<const SceneSource> source,
            std::vector<Edit> edits, Check check, SceneWriter write)
        : world_(&world),
          pace_(pace),
          source_(std::move(source)),
          edits_(std::move(edits)),
          before_(world.sharedScene()),
          prepare_(world.preparer()),
          check_(std::move(check)),
          write_(std::move(write)) {
        for (std::size_t i = 0; i < world.movers().size(); ++i)
            poses_.push_back(world.status(i).pose);
    }

    void prepare() {
        findAll();
        Scene scene = makeScene(goodRecords(), *before_, source_->devices());
        checkPeople(scene);
        check_(scene);
        // Built here, for the checks of new positions; edits of things share it.
        static_cast<void>(scene.environment.indoorIndex());
        next_ = prepare_(std::move(scene));
        if (!write_ || !touchFiles(edits_, *next_.scene)) write_ = nullptr;
        if (write_) news_->scene_text = write_(*next_.scene);
        if (edits_.front().kind == Edit::Kind::Set) news_->movers = moversOf(edits_.front());
    }

    std::shared_ptr<const void> adopt() {
        follow();
        auto before = world_->change(next_, placed_);
        if (pace_ == nullptr) return before;
        if (edits_.front().kind == Edit::Kind::Add) readAdded();
        if (edits_.front().kind == Edit::Kind::Set)
            pace_->rescaled(timesAsOften(*before_, world_->scene()));
        return before;
    }
    [[nodiscard]] std::shared_ptr<const ChangeNews> news() const { return news_; }

  private:
    void findAll();
    void checkPeople(const Scene& after) const;
    [[nodiscard]] std::vector<std::string> moversOf(const Edit& edit) const;
    [[nodiscard]] std::vector<Record> records() const;
    [[nodiscard]] std::vector<Record> goodRecords() const;
    void follow();
    void readAdded();

    World* world_;
    Pace* pace_;
    std::shared_ptr<const SceneSource> source_;
    std::vector<Edit> edits_;
    std::shared_ptr<const Scene> before_;
    Preparer prepare_;
    Check check_;
    SceneWriter write_;         // null if the change needs no text of its scene
    std::vector<Pose2> poses_;  // of robots and people before, in the order of the scene
    std::vector<std::string> placed_;
    std::unordered_map<std::string, Pose2> places_;  // of movers among them
    NextScene next_;
    std::shared_ptr<ChangeNews> news_ = std::make_shared<ChangeNews>();
};

/// Finds the records that the edits change. \throws UnknownRecord
void Editing::findAll() {
    const std::vector<std::string>& ids = before_->ids;
    for (const Edit& edit : edits_) {
        const auto is_meant = [&](const std::string& id) { return isAbout(edit, id); };
        if (edit.kind != Edit::Kind::Add && std::none_of(ids.begin(), ids.end(), is_meant))
            throw UnknownRecord(edit);
    }
    placed_ = placedBy(edits_, *before_);
    std::unordered_map<std::string_view, Pose2> poses;
    for (std::size_t i = 0; i < before_->robots.size(); ++i)
        poses.emplace(before_->robots[i].id, poses_[i]);
    for (std::size_t i = 0; i < before_->people.size(); ++i)
        poses.emplace(before_->people[i].id, poses_[before_->robots.size() + i]);
    for (const std::string& id : placed_)
        if (const auto pose = poses.find(id); pose != poses.end())
            places_.emplace(id, pose->second);
}

/// Asks the kind of people whether they change like this. \throws FormatError
void Editing::checkPeople(const Scene& after) const {
    const ThingKind* const kind = thingKind("human");
    if (kind == nullptr || kind->refusal == nullptr || edits_.front().kind != Edit::Kind::Set)
        return;
    // Records keep their order.
    for (const PlacedRecord& placed : before_->placed) {
        const Record& record = before_->records[placed.record];
        if (record.keyword() != "human") continue;
        const std::string& id = before_->ids[placed.record];
        if (std::none_of(edits_.begin(), edits_.end(),
                         [&](const Edit& edit) { return isAbout(edit, id); }))
            continue;
        const Record& changed = after.records[placed.record];
        const bool is_placed = std::find(placed_.begin(), placed_.end(), id) != placed_.end();
        const Pose2 at = is_placed ? after.people[placed.index].pose
                                   : poses_[before_->robots.size() + placed.index];
        if (const std::string reason = kind->refusal(record, changed, at, after); !reason.empty())
            throw FormatError(changed.finding(reason));
    }
}

std::vector<std::string> Editing::moversOf(const Edit& edit) const {
    std::vector<std::string> ids;
    const auto look = [&](const auto& movers) {
        for (const auto& mover : movers)
            if (ids.size() <= kFewMovers && isAbout(edit, mover.id)) ids.push_back(mover.id);
    };
    look(next_.scene->robots);
    look(next_.scene->people);
    return ids.size() > kFewMovers ? std::vector<std::string>{""} : ids;
}

std::vector<Record> Editing::records() const {
    std::vector<Record> records = editedRecords(*before_, edits_, [this](const std::string& id) {
        const auto place = places_.find(id);
        return place == places_.end() ? std::nullopt : std::optional(place->second);
    });
    const auto has_file = [](const Record& record) { return fileKeyOf(record) != nullptr; };
    if (std::none_of(records.begin(), records.end(), has_file)) return records;
    std::unordered_map<std::string, Record> with_files;
    for (std::size_t i = 0; i < before_->records.size(); ++i)
        if (fileKeyOf(before_->records[i]) != nullptr)
            with_files.emplace(before_->ids[i], before_->records[i]);
    const std::vector<std::string> ids = assignIds(records);
    for (std::size_t i = 0; i < records.size(); ++i) {
        if (fileKeyOf(records[i]) == nullptr) continue;
        const auto before = with_files.find(ids[i]);
        if (before == with_files.end() || !(before->second == records[i]))
            source_->loadFilesOf(records[i]);
    }
    return records;
}

std::vector<Record> Editing::goodRecords() const {
    try {
        return records();
    } catch (const FormatError& error) {
        throw BadEdit(error);
    }
}

/// Edited movers may have moved meanwhile.
void Editing::follow() {
    const bool moved = std::any_of(places_.begin(), places_.end(), [this](const auto& place) {
        return placeIn(*world_, place.first) != place.second;
    });
    if (!moved) return;
    Scene& scene = *next_.scene;
    std::vector<Record> records = scene.records;
    placeAgain(records, scene.ids, edits_,
               [this](const std::string& id) { return placeIn(*world_, id); });
    scene = makeScene(std::move(records), scene, source_->devices());
    if (write_) news_->scene_text = write_(scene);
}

/// Measures the first readings of the new sensors.
void Editing::readAdded() {
    const std::chrono::nanoseconds begun = threadTime();
    world_->readSome(WallTime::max());
    const std::chrono::nanoseconds work = threadTime() - begun;
    std::vector<const Sensor*> added;
    for (const std::size_t i : world_->latestReadings()) added.push_back(&world_->sensors()[i]);
    pace_->added(added, work, world_);
}

}  // namespace

WorldEditor::WorldEditor(Simulation& simulation, std::shared_ptr<const SceneSource> source)
    : simulation_(&simulation), source_(std::move(source)) {}

/// Returns a check for another thread.
WorldEditor::Check WorldEditor::loadCheck(bool apart) const {
    const World& world = simulation_->world();
    std::optional<RecordOptions> record;
    if (const Recorder* const recorder = simulation_->recorder()) record = recorder->options();
    return [apart, before = world.sharedScene(), step = world.stepLength(),
            record = std::move(record)](const Scene& scene) {
        const RecordOptions* const options = record ? &*record : nullptr;
        const Loads loads = loadsOf(*before, scene, step, options, apart);
        checkLoad(loads.before, loads.after);
    };
}

SceneWriter WorldEditor::sceneWriter() const {
    const Recorder* const recorder = simulation_->recorder();
    return recorder == nullptr ? nullptr : recorder->options().scene_text;
}

WorldChange WorldEditor::edit(std::vector<Edit> edits, bool apart) const {
    const bool is_live = simulation_->pacingClock().kind == Clock::Kind::Real;
    Pace* const pace = is_live ? &simulation_->pace() : nullptr;
    Check check = loadCheck(apart);
    if (pace != nullptr) {
        const World& world = simulation_->world();
        const auto exists = [&world](const std::string& id) {
            return world.sensorNamed(id).has_value();
        };
        // At real time: a faster clock is no fault of the client that adds, and a slower one
        // may be set to real time afterwards.
        const auto [all, reading] = pace->load(exists, &world);
        const bool may_rescale = edits.front().kind == Edit::Kind::Set;
        check = [check = std::move(check), before = world.sharedScene(), step = world.stepLength(),
                 may_rescale, apart, work = all, reads = reading](const Scene& scene) {
            check(scene);
            const Loads loads = loadsOf(*before, scene, step, nullptr, apart);
            const double more = may_rescale ? moreReadings(*before, scene, apart) * reads : 0;
            checkPace(loads.before, loads.after, work + more);
        };
    }
    const auto editing = std::make_shared<Editing>(
        simulation_->world(), pace, source_, std::move(edits), std::move(check), sceneWriter());
    return {[editing] { editing->prepare(); }, [editing] { return editing->adopt(); },
            editing->news()};
}

std::shared_ptr<const void> WorldEditor::restart(const NextScene& next) const {
    simulation_->pace().restarted();
    return simulation_->world().restart(next);
}

WorldChange WorldEditor::load(std::string environment, std::string layout) const {
    const auto next = std::make_shared<NextScene>();
    const auto news = std::make_shared<ChangeNews>(ChangeNews{{""}, ""});
    return {[next, news, source = source_, prepare = simulation_->world().preparer(),
             environment = std::move(environment), layout = std::move(layout), check = loadCheck(),
             write = sceneWriter()] {
                Scene scene = source->load(environment, layout);
                check(scene);
                static_cast<void>(scene.environment.indoorIndex());
                *next = prepare(std::move(scene));
                if (write) news->scene_text = write(*next->scene);
            },
            [this, next] { return restart(*next); }, news};
}

WorldChange WorldEditor::reset() const {
    const auto next = std::make_shared<NextScene>();
    return {[next, start = simulation_->world().sharedStart(),
             prepare = simulation_->world().preparer()] { *next = prepare(Scene(*start)); },
            [this, next] { return restart(*next); }, std::make_shared<const ChangeNews>()};
}

}  // namespace ispace
