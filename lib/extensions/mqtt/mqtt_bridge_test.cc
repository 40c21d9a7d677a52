// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/mqtt/mqtt_bridge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "extensions/mqtt/mqtt_survey.h"
#include "extensions/mqtt/mqtt_topics.h"
#include "extensions/mqtt/tests/memory_broker.h"
#include "support/test_source.h"
#include "support/test_talk.h"

namespace ispace::mqtt {
namespace mqtt_bridge_test {

using testing::MemoryBroker;
using testing::MemoryClient;

TEST(MqttTopics, PayloadsConvertBothWays) {
    const struct {
        const char *key, *value, *payload;
    } cases[] = {{"on", "1", "ON"},
                 {"open", "0", "OFF"},
                 {"level", "0.4", "40"},
                 {"level", "1", "100"},
                 {"color", "1,0.2,0", "255,51,0"},
                 {"pan", "0", "0"},
                 {"volume", "1", "1"},
                 {"tags", "a,b", "a,b"}};
    for (const auto& [key, value, payload] : cases) EXPECT_EQ(payloadOf(key, value, true), payload);
    EXPECT_EQ(payloadOf("level", "61.5", false), "61.5") << "of a microphone";
    EXPECT_EQ(valueOfPayload("on", "ON"), "on");
    EXPECT_EQ(valueOfPayload("level", "40"), "40%");
    EXPECT_EQ(valueOfPayload("color", "255,51,0"), "1,0.2,0");
    EXPECT_EQ(valueOfPayload("color", "255,,0"), "");
}

TEST(MqttTopics, DiscoveryKeepsToTheLettersOfTopics) {
    const KeySpec flag{.name = "on", .type = KeyType::Flag, .help = ""};
    const MqttMessage lamp =
        discoveryOf({"hall/l 1", "lamp", {{"on", "ispace/hall/l 1/on", &flag}}}, "ispace").front();
    EXPECT_EQ(lamp.topic, "homeassistant/light/ispace_hall__2fl__201/config");
    EXPECT_TRUE(lamp.retain);
    EXPECT_NE(lamp.payload.find("\"command_topic\":\"ispace/hall/l 1/on/set\""), std::string::npos);
}

TEST(MqttTopics, DiscoveryDescribesEachKey) {
    const KeySpec flag{.name = "on", .type = KeyType::Flag, .help = ""};
    const KeySpec share{.name = "level", .unit = Unit::Share, .help = "", .lower = 0, .upper = 1};
    const KeySpec pan{.name = "pan", .unit = Unit::Angle, .help = "", .lower = -180, .upper = 180};
    const auto projector =
        discoveryOf({"p1",
                     "projector",
                     {{"on", "t/on", &flag}, {"level", "t/level", &share}, {"pan", "t/pan", &pan}}},
                    "home");
    ASSERT_EQ(projector.size(), 2U);
    EXPECT_EQ(projector[0].topic, "homeassistant/light/home_p1/config");
    EXPECT_NE(projector[0].payload.find("\"brightness_command_topic\":\"t/level/set\""),
              std::string::npos);
    EXPECT_EQ(projector[1].topic, "homeassistant/number/home_p1___pan/config");
    EXPECT_NE(projector[1].payload.find("\"command_topic\":\"t/pan/set\",\"min\":-180,\"max\":180"),
              std::string::npos);
    const auto heater =
        discoveryOf({"h", "heater", {{"on", "t/on", &flag}, {"level", "t/level", &share}}}, "home");
    EXPECT_EQ(heater.at(0).topic, "homeassistant/switch/home_h/config");
    EXPECT_NE(heater.at(1).payload.find("\"max\":100"), std::string::npos);
    const auto window = discoveryOf(
        {"w", "window", {{"open", "t/open", &flag}, {"blind", "t/blind", &flag}}}, "home");
    EXPECT_EQ(window.at(1).topic, "homeassistant/cover/home_w___blind/config");
    EXPECT_NE(window.at(1).payload.find("\"device_class\":\"blind\""), std::string::npos);
    EXPECT_NE(window.at(1).payload.find("\"payload_close\":\"ON\""), std::string::npos);
    const auto mat = discoveryOf({"m", "mat", {{"n", "t/n"}, {"on", "t/on"}}}, "home");
    EXPECT_EQ(mat.at(0).topic, "homeassistant/binary_sensor/home_m/config");
    EXPECT_NE(mat.at(0).payload.find("\"device_class\":\"occupancy\""), std::string::npos);
    EXPECT_NE(mat.at(0).payload.find("value_template"), std::string::npos);
    EXPECT_EQ(mat.at(1).topic, "homeassistant/sensor/home_m___on/config");
    const auto gate = discoveryOf(
        {"g", "gate", {{"in", "t/in"}, {"out", "t/out"}, {"broken", "t/broken"}}}, "home");
    EXPECT_NE(gate.at(0).payload.find("\"state_class\":\"total_increasing\""), std::string::npos);
    EXPECT_NE(gate.at(1).payload.find("\"state_class\":\"total_increasing\""), std::string::npos);
    EXPECT_EQ(gate.at(2).topic, "homeassistant/binary_sensor/home_g___broken/config");
    const auto weather = discoveryOf({"w", "weather", {{"sun", "t/sun", &pan}}}, "home");
    ASSERT_EQ(weather.size(), 1U);
    EXPECT_EQ(weather[0].topic, "homeassistant/number/home_w___sun/config");
    // Sensors take no commands.
    const auto mote = discoveryOf({"m", "mote", {{"lux", "t/lux"}, {"neighbours", "t/n"}}}, "home");
    ASSERT_EQ(mote.size(), 2U);
    EXPECT_EQ(mote[1].topic, "homeassistant/sensor/home_m___neighbours/config");
    EXPECT_EQ(mote[1].payload.find("command_topic"), std::string::npos);
    const auto warm = discoveryOf({"t", "thermometer", {{"celsius", "t/celsius"}}}, "home");
    EXPECT_NE(warm.at(0).payload.find("\"unit_of_measurement\":\"°C\""), std::string::npos);
}

TEST(MqttTopics, DiscoveryDescribesChoicesAndPower) {
    const KeySpec flag{.name = "on", .type = KeyType::Flag, .help = ""};
    const KeySpec state{
        .name = "state", .type = KeyType::Choice, .help = "", .choices = {"off", "hold"}};
    const auto kettle = discoveryOf(
        {"k", "thing", {{"state", "t/state", &state}, {"power", "t/power"}, {"energy", "t/e"}}},
        "home");
    ASSERT_EQ(kettle.size(), 3U);
    EXPECT_NE(kettle[1].payload.find("\"device_class\":\"power\",\"unit_of_measurement\":\"W\""),
              std::string::npos);
    EXPECT_NE(kettle[2].payload.find("\"state_class\":\"total_increasing\""), std::string::npos);
    // Keywords of extensions, as of any actuator without a component.
    const auto known =
        discoveryOf({"b", "lamp", {{"on", "t/on", &flag}, {"state", "t/s", &state}}}, "home");
    EXPECT_EQ(known.at(1).topic, "homeassistant/select/home_b___state/config");
    EXPECT_NE(known.at(1).payload.find("\"options\":[\"off\",\"hold\"]"), std::string::npos);
    EXPECT_EQ(wantedPayload("state", &state, "hold"), "");
    EXPECT_EQ(wantedPayload("state", &state, "boil"), "one of off, hold");
}

using Keys = std::set<std::string>;

/// Keys that Home Assistant's schemas of MQTT entities take (homeassistant/components/mqtt, 2026);
/// it drops others without a word. Those of devices and origins are the last two.
const std::map<std::string, Keys>& knownKeys() {
    static const std::map<std::string, Keys> known{
        {"",
         {"name", "unique_id", "default_entity_id", "qos", "encoding", "availability",
          "availability_mode", "availability_template", "availability_topic", "payload_available",
          "payload_not_available", "device", "origin", "enabled_by_default", "entity_category",
          "entity_picture", "icon", "json_attributes_topic", "json_attributes_template"}},
        {"light",
         {"command_topic",
          "state_topic",
          "state_value_template",
          "optimistic",
          "retain",
          "schema",
          "payload_on",
          "payload_off",
          "on_command_type",
          "brightness_command_topic",
          "brightness_command_template",
          "brightness_state_topic",
          "brightness_value_template",
          "brightness_scale",
          "rgb_command_topic",
          "rgb_command_template",
          "rgb_state_topic",
          "rgb_value_template",
          "white_command_topic",
          "white_scale"}},
        {"switch",
         {"command_topic", "command_template", "state_topic", "value_template", "optimistic",
          "retain", "device_class", "payload_on", "payload_off", "state_on", "state_off"}},
        {"cover",
         {"command_topic", "state_topic",     "value_template",     "optimistic",
          "retain",        "device_class",    "payload_open",       "payload_close",
          "payload_stop",  "state_open",      "state_opening",      "state_closed",
          "state_closing", "state_stopped",   "position_topic",     "position_template",
          "position_open", "position_closed", "set_position_topic", "set_position_template"}},
        {"binary_sensor",
         {"state_topic", "value_template", "device_class", "expire_after", "force_update",
          "off_delay", "payload_on", "payload_off"}},
        {"sensor",
         {"state_topic", "value_template", "device_class", "expire_after", "force_update",
          "last_reset_value_template", "options", "suggested_display_precision", "state_class",
          "unit_of_measurement"}},
        {"number",
         {"command_topic", "command_template", "state_topic", "value_template", "optimistic",
          "retain", "device_class", "min", "max", "mode", "step", "payload_reset",
          "unit_of_measurement"}},
        {"select",
         {"command_topic", "command_template", "state_topic", "value_template", "optimistic",
          "retain", "options"}},
        {"text",
         {"command_topic", "command_template", "state_topic", "value_template", "retain", "min",
          "max", "mode", "pattern"}},
        {"vacuum",
         {"command_topic", "state_topic", "retain", "fan_speed_list", "payload_clean_spot",
          "payload_locate", "payload_return_to_base", "payload_start", "payload_pause",
          "payload_stop", "send_command_topic", "set_fan_speed_topic", "supported_features"}},
        {"device_tracker",
         {"state_topic", "value_template", "payload_home", "payload_not_home", "payload_reset",
          "source_type"}},
        {"camera", {"topic", "image_encoding"}},
        {"/device",
         {"identifiers", "connections", "manufacturer", "model", "model_id", "name", "hw_version",
          "serial_number", "sw_version", "via_device", "suggested_area", "configuration_url"}},
        {"/origin", {"name", "sw_version", "support_url"}}};
    return known;
}

void expectKnown(const nlohmann::json& object, const std::string& of) {
    for (const auto& [key, value] : object.items())
        EXPECT_TRUE(knownKeys().at(of).contains(key) ||
                    (!of.starts_with('/') && knownKeys().at("").contains(key)))
            << of << ' ' << key;
}

/// What the schemas ask of the values.
void expectValid(const nlohmann::json& entity, const std::string& component) {
    static const std::map<std::string, Keys> required{
        {"light", {"command_topic"}},       {"switch", {"command_topic"}},
        {"number", {"command_topic"}},      {"select", {"command_topic", "options"}},
        {"text", {"command_topic"}},        {"sensor", {"state_topic"}},
        {"binary_sensor", {"state_topic"}}, {"camera", {"topic"}}};
    if (const auto keys = required.find(component); keys != required.end()) {
        for (const std::string& key : keys->second) EXPECT_TRUE(entity.contains(key)) << component;
    }
    EXPECT_FALSE(entity["device"]["identifiers"].empty());
    EXPECT_TRUE(entity["origin"].contains("name"));
    if (component == "number") {
        EXPECT_LT(entity["min"], entity["max"]);
        EXPECT_GE(entity["step"], 1e-3);
    }
    if (entity.contains("set_position_topic")) {
        EXPECT_TRUE(entity.contains("position_topic"));
    }
    const Keys features{"start",   "pause",  "stop",         "return_home", "fan_speed",
                        "battery", "status", "send_command", "locate",      "clean_spot"};
    if (component == "vacuum") {
        for (const auto& feature : entity["supported_features"])
            EXPECT_TRUE(features.contains(feature)) << feature;
    }
    // Energy that is only measured has no statistics.
    if (entity.value("device_class", "") == "energy") {
        EXPECT_EQ(entity["state_class"], "total_increasing");
    }
}

TEST(MqttTopics, DiscoveryHasKnownKeys) {
    const KeySpec flag{.name = "on", .type = KeyType::Flag, .help = ""};
    const KeySpec share{.name = "level", .unit = Unit::Share, .help = "", .lower = 0, .upper = 1};
    const KeySpec word{.name = "state", .type = KeyType::Choice, .help = "", .choices = {"a"}};
    const KeySpec text{.name = "text", .type = KeyType::Word, .help = ""};
    Keys seen;
    for (const char* keyword :
         {"lamp", "projector", "switch", "speaker", "heater", "door", "window", "pir", "contact",
          "lux", "mote", "microphone", "thermometer", "mat", "gate", "rfid", kRobotThing,
          kPersonThing, kPictureThing}) {
        // No command sets what a sensor reports.
        const auto set = [is_actuator = isActuator(keyword)](const KeySpec& spec) {
            return is_actuator ? &spec : nullptr;
        };
        for (const MqttMessage& message : discoveryOf({"x",
                                                       keyword,
                                                       {{"on", "t/on", set(flag)},
                                                        {"level", "t/level", set(share)},
                                                        {"color", "t/color", set(text)},
                                                        {"blind", "t/blind", set(flag)},
                                                        {"state", "t/state", set(word)},
                                                        {"power", "t/power"},
                                                        {"energy", "t/energy"},
                                                        {"broken", "t/broken"}}},
                                                      "home")) {
            const std::string component =
                message.topic.substr(14, message.topic.find('/', 14) - 14);
            seen.insert(component);
            ASSERT_TRUE(knownKeys().contains(component)) << component;
            const auto entity = nlohmann::json::parse(message.payload);
            expectKnown(entity, component);
            expectKnown(entity["device"], "/device");
            expectKnown(entity["origin"], "/origin");
            expectValid(entity, component);
            EXPECT_EQ(entity["device"]["manufacturer"], "ispace");
        }
    }
    constexpr std::size_t kOthers = 3;  // common keys, devices, origins
    EXPECT_EQ(seen.size() + kOthers, knownKeys().size()) << "each component is checked";
}

TEST(MqttTopics, DistinctIdsStayDistinct) {
    EXPECT_EQ(topicId("hall/l.1"), "hall/l.1");
    EXPECT_EQ(topicId("front_door"), "front_door");
    std::set<std::string> topics, descriptions;
    const std::vector<std::string> ids{"a+b", "a#b", "a_b",    "a__b", "a_+b",    "a_5f_b",
                                       "a.b", "a/b", "a__2eb", "a_",   "a___2eb", "a_.b"};
    for (const std::string& id : ids) {
        topics.insert(topicId(id));
        descriptions.insert(discoveryOf({id, "lamp", {{"on", "t"}}}, "ispace").front().topic);
    }
    EXPECT_EQ(topics.size(), ids.size());
    EXPECT_EQ(descriptions.size(), ids.size());
}

TEST(MqttOptions, AreParsed) {
    EXPECT_EQ(parseBroker("broker.local:1884").host, "broker.local");
    EXPECT_EQ(parseBroker("broker.local:1884").port, 1884);
    EXPECT_EQ(parseBroker("127.0.0.1").port, 1883);
    EXPECT_EQ(parseBroker("[::1]:1884").host, "::1");
    EXPECT_EQ(parseBroker("[::1]:1884").port, 1884);
    EXPECT_EQ(parseBroker("[::1]").port, 1883);
    for (const char* bad : {"", ":1883", "host:", "host:0", "host:70000", "host:x", "::1", "[::1",
                            "[]:1", "[::1]x:1", "[::1]1883"})
        EXPECT_THROW(parseBroker(bad), UsageError) << bad;
}

/// A room with a lamp and a door, whose states a broker in memory has.
class BridgeTest : public ::testing::Test {
  protected:
    BridgeTest() {
        ask("ADD lamp id=lp at=1,1");
        ask("ADD gate id=s1 at=2,2");
        bridge.emplace(talk.state, std::make_unique<MemoryClient>(broker), "home");
    }
    void ask(const std::string& request) {
        std::string answer = testing::Talk::ask(world, request);
        while (world.waiting()) {
            std::this_thread::yield();
            world.proceed();
            answer += world.take();
        }
        EXPECT_EQ(answer.substr(0, 3), "OK ") << request << ": " << answer;
    }
    void step() {
        talk.step(1);
        bridge->stepped();
        bridge->serve(false);
    }
    void publish(const std::string& topic, const std::string& payload, bool retained = false) {
        broker.incoming.push_back({topic, payload, retained});
        bridge->serve(false);
        // A change has half of the time; the next waits for its turn.
        for (int i = 0; i < 200; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            bridge->serve(false);
        }
        step();
    }
    static ServerLimits limits() {
        ServerLimits limits;
        limits.source = std::make_shared<testing::TextSource>();
        return limits;
    }

    MemoryBroker broker;
    testing::Talk talk{{Clock::Kind::Step, 1}, {}, "", limits()};
    Session& world = talk.client("WORLD");
    std::optional<MqttBridge> bridge;
};

TEST_F(BridgeTest, PublishesStatesAndSubscribesToCommands) {
    EXPECT_EQ(broker.last("home/lp/on"), "OFF");
    EXPECT_EQ(broker.last("home/lp/level"), "100");
    EXPECT_EQ(broker.last("home/s1/broken"), "OFF");
    EXPECT_EQ(broker.last("home/status"), "online");
    EXPECT_NE(broker.last("homeassistant/light/home_lp/config"), "");
    EXPECT_EQ(broker.subscriptions,
              (std::vector<std::string>{"home/run", "home/+/+/set", "home/+/+/+/set"}));
    EXPECT_TRUE(std::all_of(
        broker.published.begin(), broker.published.end(),
        [](const MqttMessage& message) { return message.retain || message.topic == "home/run"; }));
    bridge->end();
    EXPECT_EQ(broker.last("home/status"), "offline");
    EXPECT_TRUE(broker.is_closed);
}

TEST_F(BridgeTest, CarriesOutCommands) {
    publish("home/lp/on/set", "ON");
    EXPECT_EQ(broker.last("home/lp/on"), "ON");
    publish("home/lp/level/set", "25");
    EXPECT_EQ(broker.last("home/lp/level"), "25");
    publish("home/lp/color/set", "255,0,51");
    EXPECT_EQ(broker.last("home/lp/color"), "255,0,51");
    publish("home/lp/on/set", "OFF", true);
    EXPECT_EQ(broker.last("home/lp/on"), "ON") << "a retained command is old";
}

TEST_F(BridgeTest, RefusesBadCommands) {
    publish("home/lp/level/set", "500");
    EXPECT_EQ(broker.last("home/error").substr(0, 8), "ERR 400 ");
    broker.published.clear();
    for (const char* payload : {"", "O N", "\n", "1 level=1"}) {
        publish("home/lp/on/set", payload);
        EXPECT_NE(broker.last("home/error"), "") << payload;
        broker.published.clear();
    }
    publish("elsewhere/lp/on/set", "ON");
    EXPECT_TRUE(broker.published.empty());
}

TEST_F(BridgeTest, SaysInWordsOfTopicsWhatIsWanted) {
    const struct {
        const char *topic, *payload, *reason;
    } cases[] = {
        {"lp/level", "101", "`101` is given, wanted a number from 0 to 100"},
        {"lp/level", "95%", "`95%` is given, wanted a number from 0 to 100"},
        {"lp/on", "DIM", "`DIM` is given, wanted ON or OFF"},
        {"lp/color", "300,0,0", "`300,0,0` is given, wanted three numbers R,G,B from 0 to 255"},
        {"lp/color", "1,2", "`1,2` is given, wanted three numbers R,G,B from 0 to 255"},
        {"s1/broken", "ON", "a sensor reports this state, and no command sets it"},
        {"l2/on", "ON", "no thing of the room has this state, see home/+/+"}};
    for (const auto& [topic, payload, reason] : cases) {
        broker.published.clear();
        publish("home/" + std::string(topic) + "/set", payload);
        EXPECT_EQ(broker.last("home/error"),
                  "ERR 400 home/" + std::string(topic) + "/set: " + reason);
    }
}

TEST(MqttTopics, SharesComeBackAsTheyWereGiven) {
    for (int level = 0; level <= 100; ++level)
        EXPECT_EQ(payloadOf("level", formatDouble(level / 100.0), true), std::to_string(level));
    EXPECT_EQ(payloadOf("level", "0.3333", true), "33.33");
}

/// A broker with what an earlier run left, among it a thing that this room lacks.
TEST(MqttSurvey, RemovesWhatAnEarlierRunLeft) {
    MemoryBroker broker;
    const std::string device = R"("device":{"name":"home","manufacturer":"ispace"}})";
    broker.incoming = {
        {"home/status", "online", true},
        {"homeassistant/light/home_old/config",
         R"({"state_topic":"home/old/on","brightness_state_topic":"home/old/level",)" + device,
         true},
        {"homeassistant/light/other/config",
         R"({"state_topic":"their/on","device":{"name":"home","manufacturer":"them"}})", true},
        {"homeassistant/sensor/odd/config", R"({"device":{"manufacturer":null,"name":7}})", true},
        {"homeassistant/light/cut/config", R"({"state_topic":"home/cut/on",)", true}};
    MemoryClient client(broker);
    const MqttSurvey survey(client, "home");
    EXPECT_EQ(survey.leftovers(), (std::set<std::string>{"homeassistant/light/home_old/config",
                                                         "home/old/on", "home/old/level"}));
    EXPECT_EQ(broker.subscriptions, std::vector<std::string>{"home/run"});
}

TEST(MqttSurvey, ARunThatAnswersKeepsItsPrefix) {
    MemoryBroker broker;
    broker.incoming = {{"home/status", "online", true}, {"home/run", "here 7", false}};
    MemoryClient client(broker);
    EXPECT_THROW(MqttSurvey(client, "home"), FormatError);
}

TEST_F(BridgeTest, AnswersOtherRuns) {
    broker.published.clear();
    broker.incoming.push_back({"home/run", "ask another", false});
    bridge->serve(false);
    EXPECT_TRUE(broker.last("home/run").starts_with("here "));
}

TEST_F(BridgeTest, TellsAllAgainAfterAReconnection) {
    publish("home/lp/on/set", "ON");
    broker.published.clear();
    bridge->serve(false);
    EXPECT_TRUE(broker.published.empty());
    ++broker.connections;
    bridge->serve(false);
    EXPECT_EQ(broker.last("home/lp/on"), "ON");
    EXPECT_EQ(broker.published.back(), (MqttMessage{"home/status", "online", true}));
}

TEST_F(BridgeTest, IntroducesNewThings) {
    ask("ADD switch id=b1 at=1,0");
    step();
    EXPECT_EQ(broker.last("home/b1/on"), "OFF");
    EXPECT_NE(broker.last("homeassistant/switch/home_b1/config"), "");
    publish("home/b1/on/set", "ON");
    EXPECT_EQ(broker.last("home/b1/on"), "ON");
}

TEST_F(BridgeTest, AStateIsNoNews) {
    broker.published.clear();
    publish("home/lp/level/set", "25");
    EXPECT_EQ(broker.published, (std::vector<MqttMessage>{{"home/lp/level", "25", true}}));
}

TEST_F(BridgeTest, DescribesAThingOfAnotherKeyword) {
    ask("ADD window id=w at=0,-3");
    step();
    const std::string topic = "homeassistant/cover/home_w/config";
    EXPECT_NE(broker.last(topic).find("\"device_class\":\"window\""), std::string::npos);
    ask("DELETE w");
    ask("ADD door id=w at=0,-3");
    step();
    EXPECT_NE(broker.last(topic).find("\"device_class\":\"door\""), std::string::npos);
    EXPECT_EQ(broker.last("homeassistant/cover/home_w___blind/config"), "");
    EXPECT_EQ(broker.last("home/w/blind"), "");
}

TEST_F(BridgeTest, RemovesThingsThatAreGone) {
    ask("DELETE lp");
    step();
    for (const char* topic :
         {"home/lp/on", "home/lp/level", "home/lp/color", "homeassistant/light/home_lp/config"})
        EXPECT_NE(std::find(broker.published.begin(), broker.published.end(),
                            MqttMessage{topic, "", true}),
                  broker.published.end())
            << topic;
    EXPECT_EQ(broker.last("home/s1/broken"), "OFF");
    ask("ADD switch id=lp at=1,1");
    step();
    EXPECT_EQ(broker.last("home/lp/on"), "OFF");
    EXPECT_NE(broker.last("homeassistant/switch/home_lp/config"), "");
}

TEST_F(BridgeTest, RobotsAreVacuumCleaners) {
    const std::string description = broker.last("homeassistant/vacuum/home_r2/config");
    for (const char* part :
         {R"("state_topic":"home/r2/vacuum")", R"("command_topic":"home/r2/vacuum/set")",
          R"("supported_features":["stop","return_home"])"})
        EXPECT_NE(description.find(part), std::string::npos) << description;
    EXPECT_EQ(broker.last("home/r2/vacuum"), R"({"state":"idle"})");
    Session& robot = talk.client("ROBOT r2");
    testing::Talk::ask(robot, "SPEED 0.3");
    for (int i = 0; i < 20; ++i) step();
    EXPECT_EQ(broker.last("home/r2/vacuum"), R"({"state":"cleaning"})");
    publish("home/r2/vacuum/set", "stop");
    EXPECT_NE(broker.last("home/error"), "") << "another client drives it";
    testing::Talk::ask(robot, "QUIT");
    publish("home/r2/vacuum/set", "dance");
    EXPECT_NE(broker.last("home/error").find("wanted stop or return_to_base"), std::string::npos);
}

TEST_F(BridgeTest, PeopleArePresent) {
    ask("ADD human id=ann at=1,0");
    step();
    for (int i = 0; i < 6; ++i) step();
    EXPECT_NE(broker.last("homeassistant/device_tracker/home_ann/config")
                  .find(R"("state_topic":"home/ann/presence")"),
              std::string::npos);
    EXPECT_EQ(broker.last("home/ann/presence"), "home");
    ask("DELETE ann");
    step();
    EXPECT_EQ(broker.last("home/ann/presence"), "");
}

TEST_F(BridgeTest, CamerasHavePictures) {
    ask("ADD camera id=c1 at=0,-2,2 pixels=4,3");
    step();
    EXPECT_NE(broker.last("homeassistant/camera/home_c1/config").find(R"("topic":"home/c1/image")"),
              std::string::npos);
    for (int i = 0; i < 210; ++i) step();
    EXPECT_TRUE(broker.last("home/c1/image").starts_with("\x89PNG"));
}

}  // namespace mqtt_bridge_test
}  // namespace ispace::mqtt
