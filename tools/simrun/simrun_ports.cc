// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/simrun_ports.h"

#include <algorithm>
#include <cctype>
#include <csignal>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "cli/common_options.h"
#include "extensions.h"
#include "io/exporters.h"
#include "io/glb/glb_write.h"
#include "sense/formats/mcap_writer.h"
#include "server/device/device_bridge.h"
#include "server/mqtt/mqtt_bridge.h"
#include "server/ros/ros_bridge.h"
#include "server/web/web_page.h"
#include "simrun/simrun_run.h"

namespace ispace {

namespace fs = std::filesystem;

namespace {

std::string optionOf(const WireProtocol& protocol) { return "--" + std::string(protocol.name); }

/// Parses "l1=10940" or "l1=127.0.0.2:10940".
DevicePortOption parseDevicePort(const WireProtocol& protocol, const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw UsageError(excerpt(text) + ": wanted " + std::string(protocol.device) +
                         "=[ADDR:]PORT with its id, like " +
                         static_cast<char>(std::tolower(protocol.device.front())) +
                         "1=" + std::to_string(protocol.port));
    return {&protocol, text.substr(0, equals), parsePort(text.substr(equals + 1))};
}

}  // namespace

Endpoint parsePort(const std::string& text) {
    return parseEndpoint(text.find(':') == std::string::npos ? "127.0.0.1:" + text : text);
}

void DevicePortOptions::declare(CommandLine& line) {
    for (const WireProtocol* const protocol : wireProtocols())
        line.texts(optionOf(*protocol), std::string(protocol->device) + "=[ADDR:]PORT",
                   texts_[protocol], std::string(protocol->help), Enters::Nothing);
    if (texts_.empty()) return;
    line.texts("--allow", "CIDR", allowed_,
               "machines that may use such ports and --ros2 besides this one, e.g. 192.168.1.0/24",
               Enters::Nothing);
    line.choice("--device-clock", clock_, {"simulated", "wall"},
                "what time stamps of such ports count (default simulated)", Enters::Nothing);
}

void DevicePortOptions::take(const CommandLine& line, bool has_others, ServerLimits& limits) {
    for (const WireProtocol* const protocol : wireProtocols()) {
        for (const std::string& text : texts_[protocol]) {
            DevicePortOption port =
                ofOption(optionOf(*protocol), [&] { return parseDevicePort(*protocol, text); });
            const bool known = std::any_of(ports_.begin(), ports_.end(), [&](const auto& other) {
                return other.protocol == protocol && other.id == port.id;
            });
            if (known)
                throw UsageError(optionOf(*protocol) + ": " + excerpt(port.id) + " is given twice");
            if (!port.endpoint.is_loopback && allowed_.empty())
                throw UsageError(optionOf(*protocol) + ": `" + port.endpoint.address +
                                 "`: programs for real devices know no token, so say with --allow "
                                 "which machines may connect, like --allow 192.168.1.0/24; or use "
                                 "127.0.0.1");
            ports_.push_back(std::move(port));
        }
    }
    for (const char* option : {"--allow", "--device-clock"}) {
        const bool is_heeded = has_others && std::string_view(option) == "--allow";
        if (ports_.empty() && !texts_.empty() && !is_heeded && line.given(option))
            throw UsageError(std::string(option) +
                             " is about ports of devices, and none is asked for");
    }
    for (const std::string& text : allowed_)
        limits.allowed.push_back(ofOption("--allow", [&text] { return parseNetwork(text); }));
    limits.wall_clock = clock_ == "wall";
}

std::size_t DevicePortOptions::connections() const {
    std::size_t count = 0;
    for (const DevicePortOption& port : ports_) count += port.protocol->clients + 1;
    return count;
}

DeviceAddresses serveDevices(Server& server, const DevicePortOptions& options) {
    DeviceAddresses out;
    if (options.ports().empty()) return out;
    DeviceBridge& devices = server.add(std::make_unique<DeviceBridge>(server.host()));
    for (const auto& [protocol, id, endpoint] : options.ports())
        out[protocol][id] =
            ofOption(optionOf(*protocol), [&, where = &endpoint, which = protocol, whose = &id] {
                return devices.open(*which, *whose, *where);
            });
    return out;
}

namespace {

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

/// Writes the room without sensors, robots and people, which have topics.
std::string meshOf(const Scene& scene) {
    Scene room = scene;
    room.sensors.clear();
    room.robots.clear();
    room.people.clear();
    room.placed.clear();
    return writeGlb(room, Document());
}

/// Returns writers of the room's map, mesh and robots for clients of topics, and further topics.
RosScenery rosScenery(const SimrunOptions& options) {
    RosScenery scenery{
        .map = mapOf, .room = meshOf, .robot_model = writeRobotUrdf, .robot = options.ros_robot};
    if (options.rmf) scenery.sources.push_back(rmfTopics());
    return scenery;
}

}  // namespace

void tellLosses(const Server& server, const SimrunOptions& options) {
    const ReaderLosses losses = server.readerLosses();
    std::string what;
    if (losses.readings > 0) what = std::to_string(losses.readings) + " readings of streams";
    if (losses.messages > 0)
        what +=
            (what.empty() ? "" : " and ") + std::to_string(losses.messages) + " messages of topics";
    if (what.empty()) return;
    const bool may_wait =
        options.clock.kind != Clock::Kind::Real && !options.limits.waits_for_readers;
    tell(options.common, "simrun",
         "slow readers lost " + what + (may_wait ? " (--wait-for-readers keeps them)" : ""));
}

ServedAddresses servePorts(Server& server, const SimrunOptions& options, const std::string& title,
                           const std::vector<std::string>& replayed) {
    for (const std::string& note : server.serveRoles(roleServices()))
        tell(options.common, "simrun", note);
    ServedAddresses out;
    if (options.web)
        out.web = serveWeb(
            server, *options.web, title,
            {.edits = options.web_edits, .marks = recordedMarks(replayed), .mesh = meshOf});
    if (options.foxglove || options.rosbridge || options.ros_domain || !options.mcap.empty()) {
        out.ros = ofOption("--ros-robot", [&] {
            return &server.add(std::make_unique<RosBridge>(server.host(), rosScenery(options)));
        });
        const auto open = [&](RosLanguage language, const std::optional<Endpoint>& endpoint) {
            return endpoint ? out.ros->open(language, *endpoint, "simrun " + title) : std::string();
        };
        out.foxglove = open(RosLanguage::Foxglove, options.foxglove);
        out.rosbridge = open(RosLanguage::Rosbridge, options.rosbridge);
    }
    if (options.ros_domain) {
        out.ros->join(static_cast<std::uint32_t>(*options.ros_domain));
        out.ros_domain = options.ros_domain;
        if (const std::size_t left_out = out.ros->nodeTopicsLeftOut(); left_out > 0)
            warn(options.common, "simrun",
                 "--ros2: nodes do not see " + std::to_string(left_out) +
                     " topics, as there are too many; Foxglove and rosbridge have all");
    }
    if (options.mqtt) {
        MqttOptions mqtt = *options.mqtt;
        if (!options.mqtt_login.empty()) readLogin(options.mqtt_login, mqtt);
        serveMqtt(server, mqtt);
    }
    out.devices = serveDevices(server, options.devices);
    return out;
}

std::string mcapFile(const SimrunOptions& options) {
    if (!options.mcap.ends_with('/')) return options.mcap;
    const fs::path folder = fs::absolute(options.mcap).lexically_normal().parent_path();
    return (folder / (folder.filename().string() + "_0.mcap")).string();
}

std::string bagMetadataFile(const SimrunOptions& options) {
    return options.mcap.ends_with('/') ? options.mcap + "metadata.yaml" : "";
}

namespace {

/// Makes the folder of a bag. \return the name of the file in it
std::string preparedMcap(const SimrunOptions& options) {
    if (options.mcap.ends_with('/')) fs::create_directories(options.mcap);
    return mcapFile(options);
}

}  // namespace

TopicLog::TopicLog(RosBridge& ros, Simulation& simulation, const SimrunOptions& options)
    : ros_(&ros), options_(&options), name_(preparedMcap(options)), file_(name_) {
    ros.log([this](std::string_view bytes) {
        file_.write(bytes);
        bytes_ += bytes.size();
    });
    simulation.onStep([this, &simulation] {
        if (bytes_ <= options_->max_recorded || end_ < kMaxTime) return;
        end_ = simulation.world().time();
        simulation.finish();
    });
}

void TopicLog::commit() {
    file_.commit();
    if (const std::string metadata = bagMetadataFile(*options_); !metadata.empty())
        writeAll(metadata, ros_->bagMetadata(fs::path(name_).filename().string()));
    if (const std::size_t left_out = ros_->topicsLeftOut(); left_out > 0)
        warn(options_->common, "simrun",
             name_ + ": " + std::to_string(left_out) +
                 " topics are left out, as an MCAP file has at most " +
                 std::to_string(McapWriter::kMaxChannels) + " channels");
    if (end_ == kMaxTime) return;
    throw FormatError({name_, 0, 0,
                       "ended at t=" + formatSimTime(end_) + ", as it has " +
                           std::to_string(bytes_) + " bytes, wanted at most " +
                           std::to_string(options_->max_recorded) + " (--record-limit)"});
}

void announce(const Server& server, const ServedAddresses& addresses) {
    const DeviceAddresses& devices = addresses.devices;
    JsonWriter json;
    json.beginObject().key("schema").value("ispace-simrun/1");
    json.key("listen").value(server.address());
    for (const WireProtocol* const protocol : wireProtocols()) {
        const auto found = devices.find(protocol);
        const bool is_used = found != devices.end();
        // The first two are always listed; later ones would surprise old readers.
        if (!is_used && protocol->name != "p2os" && protocol->name != "scip") continue;
        json.key(std::string(protocol->name)).beginObject();
        if (is_used)
            for (const auto& [id, address] : found->second) json.key(id).value(address);
        json.endObject();
    }
    for (const auto& [name, address] : {std::pair("web", &addresses.web),
                                        {"foxglove", &addresses.foxglove},
                                        {"rosbridge", &addresses.rosbridge}})
        if (!address->empty()) json.key(name).value(*address);
    if (addresses.ros_domain) json.key("ros2").value(*addresses.ros_domain);
    json.endObject();
    writeAll("-", json.take() + '\n');
    // Clients stay connected when the reader of the warnings has gone.
    std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace ispace
