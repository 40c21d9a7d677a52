// SPDX-License-Identifier: GPL-3.0-or-later
// simrun: simulates the robots and sensors of a scene and serves them over TCP.
#include <sys/resource.h>

#include <filesystem>
#include <iostream>

#include "base/error.h"
#include "base/file.h"
#include "base/json_writer.h"
#include "base/number.h"
#include "cli/operands.h"
#include "cli/progress_bar.h"
#include "cli/run_tool.h"
#include "net/server.h"
#include "simrun/options.h"

namespace {

using namespace ispace;

/// Says on stderr what robots run into, up to a number of lines that nobody reads beyond.
class CollisionLog {
  public:
    CollisionLog(const World& world, bool quiet) : world_(&world), quiet_(quiet) {}

    void takeNew() {
        for (const Collision& collision : world_->collisions()) {
            if (!quiet_ && ++count_ <= kMost) say(collision);
            if (!quiet_ && count_ == kMost) std::cerr << "simrun: warning: no more of these\n";
        }
    }

  private:
    static constexpr int kMost = 100;

    void say(const Collision& collision) const {
        const auto& robots = world_->robots();
        const Point2 place = world_->status(collision.robot).pose.position;
        std::cerr << "simrun: warning: t=" << formatMilliseconds(collision.time) << ' '
                  << robots[collision.robot].id << " at " << formatFixed(place.x, 3) << ','
                  << formatFixed(place.y, 3) << " ran into "
                  << (collision.other ? robots[*collision.other].id : "what stands there") << '\n';
    }

    const World* world_;
    bool quiet_;
    int count_ = 0;
};

/// The first line of output, and the port file: clients can connect now.
void announce(const Server& server, const std::string& port_file) {
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-simrun/1");
    json.key("listen").value(server.address());
    json.key("p2os").beginObject().endObject();
    json.key("scip").beginObject().endObject().endObject();
    writeAll("-", json.take() + '\n');
    if (!port_file.empty()) writeAll(port_file, std::to_string(server.port()) + '\n');
}

/// One file descriptor a client: as many as this process may have.
void raiseFileLimit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

std::vector<TimedCommand> scriptOf(const SimrunOptions& options, const SceneInput& input,
                                   const World& world) {
    if (options.script.empty()) return {};
    if (options.script == "-") {
        if (input.environment_operand == "-" || input.layout_operand == "-")
            throw UsageError("stdin cannot be read twice: give the script or the scene as a file");
        return readScript(readStdin(), displayName("-"), world);
    }
    return readScript(readAll(options.script), options.script, world);
}

void simrun(const SimrunCommand& command) {
    const SimrunOptions& options = command.options();
    const ThreadLimit threads(options.common.threads);
    // A port file of an earlier run must not lead anyone to a server that is gone.
    std::error_code ignored;
    if (!options.port_file.empty()) std::filesystem::remove(options.port_file, ignored);

    const SceneInput input = readScene({options.operands, options.any_environment, false});
    World world(input.scene, options.step);
    std::vector<TimedCommand> script = scriptOf(options, input, world);
    History history = input.layout ? input.layout->history : History();
    history.push_back(command.historyLine(input.named));
    std::optional<Recorder> recorder;
    if (!options.record.empty())
        recorder.emplace(options.record, world, history, options.common.seed);

    Simulation simulation(world, std::move(script), recorder ? &*recorder : nullptr, options.clock,
                          options.until);
    CollisionLog collisions(world, options.common.quiet);
    simulation.onStep([&collisions] { collisions.takeNew(); });
    const auto progress =
        makeProgress("simrun", options.until ? options.common.progress : std::optional(false),
                     options.common.quiet);
    if (options.until) {
        progress->begin("steps", (*options.until + options.step - SimTime(1)) / options.step);
        simulation.onStep([&progress] { progress->advance(1); });
    }

    raiseFileLimit();
    Server server(simulation, options.listen, options.limits);
    announce(server, options.port_file);
    server.run();
    progress->end();
    if (recorder) recorder->flush(world);
    talk(options.common, "simrun",
         std::to_string(world.steps()) + " steps, t=" + formatSimTime(world.time()));
}

}  // namespace

int main(int argc, char** argv) {
    return ispace::runTool("simrun", [&] { simrun(ispace::SimrunCommand(argc, argv)); });
}
