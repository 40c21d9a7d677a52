// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_options.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/run_files.h"
#include "cli/storey_operands.h"
#include "extensions/ros/ros_bridge.h"
#include "io/exporters.h"
#include "io/glb/glb_write.h"
#include "sense/formats/mcap_writer.h"

namespace ispace::ros {

namespace {

namespace fs = std::filesystem;

/// Draws the map of --to ros, coarser for large rooms, since clients get it in one message.
RosGrid mapOf(const Scene& scene) {
    constexpr double kFinest = 0.05, kMaxCells = 4e6;
    const Box2 box = bounds(scene.environment.indoor());
    double resolution = kFinest;
    while (box.width() * box.depth() > kMaxCells * resolution * resolution) resolution *= 2;
    const Grid grid = rosMapCells(box, resolution);
    const std::string picture = writeRosMap(scene, kScanHeight, resolution, "map.pgm").beside;
    constexpr char kFree = static_cast<char>(254), kOccupied = 0;
    constexpr std::int8_t kFreeCell = 0, kOccupiedCell = 100, kUnknownCell = -1;
    RosGrid map;
    map.origin = grid.limits.low;
    map.resolution = resolution;
    map.columns = static_cast<std::size_t>(grid.columns);
    map.cells.reserve(grid.size());
    // The pixels are at the end, the lowest row last.
    for (std::size_t row = 0; row < static_cast<std::size_t>(grid.rows); ++row) {
        const char* const pixels = picture.data() + picture.size() - (row + 1) * map.columns;
        for (std::size_t i = 0; i < map.columns; ++i)
            map.cells.push_back(pixels[i] == kFree       ? kFreeCell
                                : pixels[i] == kOccupied ? kOccupiedCell
                                                         : kUnknownCell);
    }
    return map;
}

/// The file of --mcap. It ends the run once it is larger than --record-limit.
class TopicLog {
  public:
    /// \param name FILE, or DIR/ of a bag, which is made. Call before the run.
    /// \throws std::system_error
    TopicLog(const std::string& name, RosBridge& ros, Simulation& simulation, std::uint64_t most);

    /// Returns the name of its file: for a folder, `run/`, that of a bag in it, `run/run_0.mcap`.
    static std::string fileOf(const std::string& name);
    /// Returns that of the bag's metadata; "" without a folder.
    static std::string metadataOf(const std::string& name);

    /// Completes the file after the run; warns of topics left out. \throws FormatError if the limit
    /// ended the run
    void commit(const CommonOptions& common);

  private:
    RosBridge* ros_;
    std::string metadata_, name_;
    std::uint64_t most_;
    OutputFile file_;
    std::uint64_t bytes_ = 0;
    SimTime end_ = kMaxTime;  // at which the file was full
};

std::string TopicLog::fileOf(const std::string& name) {
    if (!name.ends_with('/')) return name;
    const fs::path folder = fs::absolute(name).lexically_normal().parent_path();
    return (folder / (folder.filename().string() + "_0.mcap")).string();
}

std::string TopicLog::metadataOf(const std::string& name) {
    return name.ends_with('/') ? name + "metadata.yaml" : "";
}

/// Makes the folder of a bag. \returns the name of the file in it
std::string prepared(const std::string& name) {
    if (name.ends_with('/')) fs::create_directories(name);
    return TopicLog::fileOf(name);
}

TopicLog::TopicLog(const std::string& name, RosBridge& ros, Simulation& simulation,
                   std::uint64_t most)
    : ros_(&ros), metadata_(metadataOf(name)), name_(prepared(name)), most_(most), file_(name_) {
    ros.log([this](std::string_view bytes) {
        file_.write(bytes);
        bytes_ += bytes.size();
    });
    simulation.onStep([this, &simulation] {
        if (bytes_ <= most_ || end_ < kMaxTime) return;
        end_ = simulation.world().time();
        simulation.finish();
    });
}

void TopicLog::commit(const CommonOptions& common) {
    file_.commit();
    if (!metadata_.empty())
        writeAll(metadata_, ros_->bagMetadata(fs::path(name_).filename().string()));
    if (const std::size_t left_out = ros_->topicsLeftOut(); left_out > 0)
        warn(common, "simrun",
             name_ + ": " + std::to_string(left_out) +
                 " topics are left out, as an MCAP file has at most " +
                 std::to_string(McapWriter::kMaxChannels) + " channels");
    if (end_ == kMaxTime) return;
    throw FormatError({name_, 0, 0,
                       "ended at t=" + formatSimTime(end_) + ", as it has " +
                           std::to_string(bytes_) + " bytes, wanted at most " +
                           std::to_string(most_) + " (--record-limit)"});
}

class RosOptions final : public BridgeGroup {
  public:
    void declare(CommandLine& line) override;
    void take(BridgeRules& rules) override;
    [[nodiscard]] std::size_t connections() const override;
    void claim() const override;
    void open(Server& server, Simulation& simulation, const BridgeRun& run) override;
    void begin(Simulation& simulation, const BridgeRun& run) override;
    void announce(JsonWriter& json) const override;
    void commit(const CommonOptions& common) override;

  private:
    struct Port {
        const char* option;
        const char* key;  ///< in the first line of output
        RosLanguage language;
        std::optional<Endpoint> endpoint = {};
        std::string address = {};
    };
    Port ports_[2] = {{"--foxglove", "foxglove", RosLanguage::Foxglove},
                      {"--rosbridge", "rosbridge", RosLanguage::Rosbridge}};
    std::optional<int> domain_;
    std::string robot_;  // "": the only one
    bool has_rmf_ = false;
    std::string mcap_;             // "" without
    RosBridge* bridge_ = nullptr;  // null unless it is asked for
    std::optional<TopicLog> log_;
};

void RosOptions::declare(CommandLine& line) {
    line.group("Topics of ROS");
    line.parsed(
        ports_[0].option, "[ADDR:]PORT",
        [this](const std::string& text) { ports_[0].endpoint = parsePort(text); },
        "serve topics of ROS 2 to Foxglove and Lichtblick there (by custom 8765); port 0 takes any "
        "free one",
        Enters::Nothing);
    line.parsed(
        ports_[1].option, "[ADDR:]PORT",
        [this](const std::string& text) { ports_[1].endpoint = parsePort(text); },
        "serve topics of ROS 2 to clients of rosbridge there (by custom 9090)", Enters::Nothing);
    constexpr int kLastDomain = 232;
    line.countOr("--ros2", domain_, 0, 0, kLastDomain,
                 "be a node of ROS 2 in this domain, over DDS, for programs of this machine",
                 Enters::Nothing);
    line.text("--ros-robot", "ROBOT", robot_,
              "give topics of ROS 2 of this robot names without its own, too, such as /odom and "
              "/scan (default: the only robot)",
              Enters::Nothing);
    line.flag("--rmf", has_rmf_,
              "add the topics by which Open-RMF runs lifts, doors and fleets: lift_states, "
              "lift_requests, door_states, door_requests, fleet_states",
              Enters::Nothing);
    line.file("--mcap", "FILE", mcap_,
              "write all topics of ROS 2 to an MCAP file, or as a bag to a folder (DIR/), for "
              "Foxglove and ros2 bag",
              Enters::Nothing);
    line.essential({"--foxglove", "--rosbridge", "--ros2", "--mcap"});
}

void RosOptions::take(BridgeRules& rules) {
    const bool is_live = ports_[0].endpoint || ports_[1].endpoint || domain_;
    if (rules.line.given("--ros-robot") && !is_live)
        throw UsageError(
            "--ros-robot is about topics of ROS 2: give --ros2, --rosbridge PORT or --foxglove "
            "PORT");
    if (has_rmf_ && !is_live && mcap_.empty())
        throw UsageError(
            "--rmf is about topics of ROS 2: give --ros2, --rosbridge PORT, --foxglove PORT or "
            "--mcap FILE");
    if (mcap_ == "-")
        throw UsageError("--mcap writes to a file: standard output has the addresses of the run");
    mustBeOneFile("--mcap", mcap_);
    for (const Port& port : ports_)
        if (port.endpoint && !port.endpoint->is_loopback && !rules.has_token)
            throw UsageError(std::string(port.option) + ": `" + port.endpoint->address +
                             "`: other machines are served only with --token-file; or use "
                             "127.0.0.1");
    rules.heeds_networks = rules.heeds_networks || domain_;
}

std::size_t RosOptions::connections() const {
    constexpr std::size_t kOfPort = 64;
    std::size_t count = 0;
    for (const Port& port : ports_) count += port.endpoint ? kOfPort : 0;
    return count;
}

void RosOptions::claim() const {
    claimOutput(TopicLog::fileOf(mcap_), "--mcap");
    claimOutput(TopicLog::metadataOf(mcap_), "the metadata of --mcap");
}

void RosOptions::open(Server& server, Simulation& /*simulation*/, const BridgeRun& run) {
    if (!ports_[0].endpoint && !ports_[1].endpoint && !domain_ && mcap_.empty()) return;
    RosScenery scenery{.map = mapOf,
                       .room = [](const Scene& scene) { return writeRoomGlb(scene); },
                       .robot_model = writeRobotUrdf,
                       .robot = robot_};
    if (has_rmf_) scenery.sources.push_back(rmfTopics());
    RosBridge& ros = *ofOption("--ros-robot", [&] {
        return &server.add(std::make_unique<RosBridge>(server.host(), std::move(scenery)));
    });
    bridge_ = &ros;
    for (Port& port : ports_)
        if (port.endpoint)
            port.address = ros.open(port.language, *port.endpoint, "simrun " + run.title);
    if (domain_) {
        ros.join(static_cast<std::uint32_t>(*domain_));
        if (const std::size_t left_out = ros.nodeTopicsLeftOut(); left_out > 0)
            warn(run.common, "simrun",
                 "--ros2: nodes do not see " + std::to_string(left_out) +
                     " topics, as there are too many; Foxglove and rosbridge have all");
    }
}

void RosOptions::begin(Simulation& simulation, const BridgeRun& run) {
    if (bridge_ != nullptr && !mcap_.empty())
        log_.emplace(mcap_, *bridge_, simulation, run.max_recorded);
}

void RosOptions::announce(JsonWriter& json) const {
    for (const Port& port : ports_)
        if (!port.address.empty()) json.key(port.key).value(port.address);
    if (domain_) json.key("ros2").value(*domain_);
}

void RosOptions::commit(const CommonOptions& common) {
    if (log_) log_->commit(common);
}

}  // namespace

std::unique_ptr<BridgeGroup> makeRosOptions() { return std::make_unique<RosOptions>(); }

}  // namespace ispace::ros
