// SPDX-License-Identifier: GPL-3.0-or-later
// Records of runs: robots.csv, people.csv, events.csv, odometry.csv, bumpers.csv and info.csv, with
// lines `---` between; an empty file is a missing one. Replays those that it can
// read, also as that of one of several worlds.
#include <array>
#include <filesystem>

#include "fuzz.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/run/run_changes.h"
#include "scene/run/run_reader.h"
#include "sim/replay.h"

namespace {

using namespace ispace;

constexpr std::array kNames = {"robots.csv",   "people.csv",  "events.csv",
                               "odometry.csv", "bumpers.csv", "info.csv"};

void writeRecord(std::string_view bytes) {
    const std::vector<std::string_view> files = fuzz::filesOf(bytes);
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        const std::string path = fuzz::scratchFolder() + '/' + kNames[i];
        if (i < files.size() && !files[i].empty())
            fuzz::writeFile(path, std::string(files[i]) + '\n');
        else
            std::filesystem::remove(path);
    }
}

void checkMoment(const RunReader& reader, double before) {
    fuzz::require(reader.time() >= before, "time runs backwards");
    for (const RunState& state : reader.states())
        fuzz::require(state.member < reader.members().size(), "a state of an unknown member");
    for (const RunBumpers& bumpers : reader.bumpers())
        fuzz::require(!bumpers.hit.empty(), "bumpers without one");
}

/// The first steps of a replay, in a separate room.
void replay(Replay replay) {
    static const Document room = readRecordText(
        "#env 1\nispace size=8,6\nrobot id=r1 at=0,0\nrobot id=r2 at=1,0\nhuman id=h1 at=2,2\n",
        "room.env", sceneSchemas());
    static const Scene start = makeScene(room, nullptr, DeviceCatalogue());
    Scene scene = start;
    replay.placeAtStart(scene);
    World world(scene, replay.stepLength());
    constexpr int kSteps = 4;
    for (int i = 0; i < kSteps && replay.step(world); ++i)
        fuzz::require(world.time() == (i + 1) * replay.stepLength(), "a step of another length");
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    writeRecord(bytes);
    double time = 0;
    for (const RunChange& change : recordedChanges(scratchFolder()))
        require(change.line > 1, "a change without its line");
    if (const auto info = recordedInfo(scratchFolder()))
        require(info->step > 0 && info->steps >= 0, "a run with negative steps");
    if (!std::filesystem::exists(RecordedFiles(scratchFolder()).robots)) return;
    RunReader reader(scratchFolder());
    while (reader.next()) {
        checkMoment(reader, time);
        time = reader.time();
    }
    try {
        replay(Replay(scratchFolder()));
    } catch (const FormatError&) {
        // As one of several worlds it may lack moments.
    }
    replay(Replay(scratchFolder(), SimTime(std::chrono::milliseconds(5))));
}
