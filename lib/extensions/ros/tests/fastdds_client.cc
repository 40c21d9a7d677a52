// SPDX-License-Identifier: GPL-3.0-or-later
// fastdds_client DOMAIN [+]TYPE:TOPIC…: reads topics over Fast DDS as a node of ROS 2 does and
// prints each message as a line of JSON, decoded by Fast CDR. Lines on stdin: `twist TOPIC FORWARD
// TURN`, `stamped TOPIC FORWARD TURN`, `pose TOPIC X Y HEADING`, `raw TYPE TOPIC HEX` (any bytes),
// `flood TYPE TOPIC HEX COUNT`, `call TYPE SERVICE HEX` (calls a service as rmw_fastrtps does: the
// request names the caller's reader, and the answer that reader and the request's number; both are
// printed). Ends with stdin.
// The address in FASTDDS_PEER is that of a machine to be found.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

/// A type whose messages are their bytes, with the head of CDR.
class Bytes final : public dds::TopicDataType {
  public:
    explicit Bytes(const std::string& name) {
        setName(name.c_str());
        m_typeSize = 1U << 16U;
        m_isGetKeyDefined = false;
        auto_fill_type_information(false);
        auto_fill_type_object(false);
    }
    bool serialize(void* data, SerializedPayload_t* payload) override {
        const auto& bytes = *static_cast<std::string*>(data);
        payload->encapsulation = CDR_LE;
        payload->length = static_cast<std::uint32_t>(bytes.size());
        std::memcpy(payload->data, bytes.data(), bytes.size());
        return true;
    }
    bool deserialize(SerializedPayload_t* payload, void* data) override {
        static_cast<std::string*>(data)->assign(reinterpret_cast<char*>(payload->data),
                                                payload->length);
        return true;
    }
    std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
        return
            [data] { return static_cast<std::uint32_t>(static_cast<std::string*>(data)->size()); };
    }
    void* createData() override { return new std::string; }
    void deleteData(void* data) override { delete static_cast<std::string*>(data); }
    bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

std::string numbers(const std::vector<double>& values) {
    std::string out = "[";
    for (const double value : values) {
        std::array<char, 32> text{};
        const char* const form = std::isfinite(value) ? "%.17g" : value > 0 ? "Infinity" : "NaN";
        std::snprintf(text.data(), text.size(), form, value);
        out.append(out.size() > 1 ? "," : "").append(text.data());
    }
    return out + "]";
}

/// Decodes the fields of a message in their order.
class Decoder {
  public:
    explicit Decoder(std::string& bytes)
        : buffer_(bytes.data(), bytes.size()), cdr_(buffer_, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR) {
        cdr_.read_encapsulation();
    }
    template <typename Value>
    Value one() {
        Value value{};
        cdr_ >> value;
        return value;
    }
    std::vector<double> doubles(std::size_t count) {
        std::vector<double> out;
        for (std::size_t i = 0; i < count; ++i) out.push_back(one<double>());
        return out;
    }
    template <typename Value>
    std::vector<double> sequence() {
        std::vector<Value> values;
        cdr_ >> values;
        return {values.begin(), values.end()};
    }
    std::string stamp() {
        const auto seconds = one<std::int32_t>();
        const auto nanoseconds = one<std::uint32_t>();
        return "\"t\":" + std::to_string(std::int64_t{seconds} * 1'000'000'000 + nanoseconds);
    }
    std::string header() {
        const std::string time = stamp();
        return time + ",\"frame\":\"" + one<std::string>() + "\"";
    }

  private:
    FastBuffer buffer_;
    Cdr cdr_;
};

std::string scan(Decoder& in) {
    const std::string head = in.header();
    std::vector<double> limits(7);
    for (double& limit : limits) limit = in.one<float>();
    const auto ranges = in.sequence<float>(), intensities = in.sequence<float>();
    return head + ",\"limits\":" + numbers(limits) + ",\"ranges\":" + numbers(ranges) +
           ",\"intensities\":" + std::to_string(intensities.size());
}

std::string transforms(Decoder& in) {
    std::string out = "\"transforms\":[";
    const auto count = in.one<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string head = in.header();
        const auto child = in.one<std::string>();
        out.append(i > 0 ? "," : "").append("{").append(head);
        out.append(",\"child\":\"").append(child).append("\",\"pose\":");
        out.append(numbers(in.doubles(7))).append("}");
    }
    return out + "]";
}

std::string grid(Decoder& in) {
    std::string out = in.header();
    in.stamp();
    out += ",\"resolution\":" + numbers({in.one<float>()});
    const auto width = in.one<std::uint32_t>(), height = in.one<std::uint32_t>();
    out += ",\"width\":" + std::to_string(width) + ",\"height\":" + std::to_string(height);
    out += ",\"origin\":" + numbers(in.doubles(7));
    return out + ",\"cells\":" + numbers(in.sequence<std::int8_t>());
}

std::string odometry(Decoder& in) {
    std::string out = in.header() + ",\"child\":\"";
    out += in.one<std::string>() + "\",\"pose\":";
    out += numbers(in.doubles(7));
    in.doubles(36);
    return out + ",\"twist\":" + numbers(in.doubles(6));
}

void print(const std::string& topic, const std::string& members) {
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    std::cout << "{\"topic\":\"" << topic << "\"," << members << "}" << std::endl;
}

std::string hexMember(const std::string& bytes) {
    std::string out = "\"bytes\":\"";
    for (const char c : bytes) {
        std::array<char, 3> digits{};
        std::snprintf(digits.data(), digits.size(), "%02x", static_cast<unsigned char>(c));
        out += digits.data();
    }
    return out + "\"";
}

/// Returns the members of a message; those of services and actions are its bytes.
std::string json(const std::string& type, std::string& bytes) {
    for (const char* name :
         {"std_srvs::srv", "ParticipantEntitiesInfo", "::action::", "action_msgs"})
        if (type.find(name) != std::string::npos) return hexMember(bytes);
    Decoder in(bytes);
    if (type == "sensor_msgs::msg::dds_::LaserScan_") return scan(in);
    if (type == "tf2_msgs::msg::dds_::TFMessage_") return transforms(in);
    if (type == "nav_msgs::msg::dds_::OccupancyGrid_") return grid(in);
    if (type == "nav_msgs::msg::dds_::Odometry_") return odometry(in);
    if (type == "rosgraph_msgs::msg::dds_::Clock_") return in.stamp();
    throw std::runtime_error("no decoder of " + type);
}

class Printer final : public dds::DataReaderListener {
  public:
    Printer(std::string topic, std::string type)
        : topic_(std::move(topic)), type_(std::move(type)) {}
    void on_data_available(dds::DataReader* reader) override {
        std::string bytes;
        dds::SampleInfo info;
        while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
            if (!info.valid_data) continue;
            print(topic_, json(type_, bytes));
        }
    }

  private:
    std::string topic_, type_;
};

/// Prints the answers to requests that named its reader, with the numbers of the requests.
class Answers final : public dds::DataReaderListener {
  public:
    explicit Answers(std::string topic) : topic_(std::move(topic)) {}
    void on_data_available(dds::DataReader* reader) override {
        std::string bytes;
        dds::SampleInfo info;
        while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
            const auto& request = info.related_sample_identity;
            if (!info.valid_data || request.writer_guid() != reader->guid()) continue;
            print(topic_, "\"answered\":" + std::to_string(request.sequence_number().to64long()) +
                              "," + hexMember(bytes));
        }
    }

  private:
    std::string topic_;
};

/// Encodes a message of doubles after an optional header.
std::string message(bool has_header, const std::vector<double>& values) {
    std::array<char, 1024> memory{};
    FastBuffer buffer(memory.data(), memory.size());
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    if (has_header) cdr << std::int32_t{0} << std::uint32_t{0} << std::string("map");
    for (const double value : values) cdr << value;
    return {memory.data(), cdr.getSerializedDataLength()};
}

std::string fromHex(const std::string& hex) {
    std::string out;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
        out += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return out;
}

class Client {
  public:
    explicit Client(std::uint32_t domain) {
        dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
        const std::string enclave = "enclave=/;";
        qos.user_data().data_vec({enclave.begin(), enclave.end()});
        // Another machine does not hear the announcements of one that keeps to itself: it knows the
        // ports.
        const char* const peer = std::getenv("FASTDDS_PEER");
        constexpr std::uint32_t kFirstPort = 7410, kOfDomain = 250;
        eprosima::fastrtps::rtps::Locator_t port(kFirstPort + kOfDomain * domain);
        if (peer != nullptr && eprosima::fastrtps::rtps::IPLocator::setIPv4(port, peer)) {
            qos.wire_protocol().builtin.initialPeersList.push_back(port);
            qos.wire_protocol().builtin.discovery_config.leaseDuration_announcementperiod = {
                0, 200'000'000};
        }
        participant_ =
            dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
        if (participant_ == nullptr) throw std::runtime_error("no participant");
        publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
        subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    }
    ~Client() {
        participant_->delete_contained_entities();
        dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }

    /// Sensor data is read by best effort unless it is to be reliable, /map and /tf_static by
    /// transient local.
    void read(const std::string& type, const std::string& name, bool is_reliable) {
        dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
        const bool is_late = name == "rt/map" || name == "rt/tf_static";
        const bool is_scan = type.find("sensor_msgs") == 0;
        qos.reliability().kind = is_scan && !is_reliable ? dds::BEST_EFFORT_RELIABILITY_QOS
                                                         : dds::RELIABLE_RELIABILITY_QOS;
        if (is_late || name == "ros_discovery_info")
            qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
        constexpr int kDepth = 100;
        qos.history().depth = kDepth;
        qos.endpoint().history_memory_policy =
            eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
        printers_.push_back(std::make_unique<Printer>(name, type));
        if (subscriber_->create_datareader(topic(type, name), qos, printers_.back().get()) ==
            nullptr)
            throw std::runtime_error("no reader of " + name);
    }

    dds::DataWriter& writer(const std::string& type, const std::string& name) {
        dds::DataWriter*& writer = writers_[type + name];
        if (writer == nullptr) {
            dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
            qos.endpoint().history_memory_policy =
                eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
            writer = publisher_->create_datawriter(topic(type, name), qos);
            if (writer == nullptr) throw std::runtime_error("no writer to " + name);
            dds::PublicationMatchedStatus matched;
            for (int i = 0; i < 1000 && matched.current_count == 0; ++i) {
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
                writer->get_publication_matched_status(matched);
            }
            if (matched.current_count == 0) throw std::runtime_error("no reader of " + name);
        }
        return *writer;
    }

    /// Sends a request once the service's reader and writer are known.
    void call(const std::string& type, const std::string& name, std::string request) {
        dds::DataReader*& answers = answers_[name];
        if (answers == nullptr) {
            const std::string topic_name = "rr/" + name + "Reply";
            printers_.push_back(std::make_unique<Answers>(topic_name));
            dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
            qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
            qos.endpoint().history_memory_policy =
                eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
            answers = subscriber_->create_datareader(topic(type + "_Response_", topic_name), qos,
                                                     printers_.back().get());
            if (answers == nullptr) throw std::runtime_error("no reader of " + topic_name);
            dds::SubscriptionMatchedStatus matched;
            for (int i = 0; i < 1000 && matched.current_count == 0; ++i) {
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
                answers->get_subscription_matched_status(matched);
            }
            if (matched.current_count == 0) throw std::runtime_error("no answers of " + name);
        }
        eprosima::fastrtps::rtps::WriteParams parameters;
        parameters.related_sample_identity().writer_guid() = answers->guid();
        const std::string topic_name = "rq/" + name + "Request";
        writer(type + "_Request_", topic_name).write(&request, parameters);
        print(topic_name,
              "\"sent\":" +
                  std::to_string(parameters.sample_identity().sequence_number().to64long()));
    }

    void obey(const std::string& line) {
        std::istringstream words(line);
        std::string verb, type, name, hex;
        double a = 0, b = 0, c = 0;
        long count = 1;
        words >> verb;
        if (verb == "raw" || verb == "flood") {
            words >> type >> name >> hex >> count;
            std::string bytes = fromHex(hex);
            for (long i = 0; i < count; ++i) writer(type, name).write(&bytes);
            return;
        }
        if (verb == "call") {
            words >> type >> name >> hex;
            return call(type, name, fromHex(hex));
        }
        words >> name >> a >> b >> c;
        std::string bytes;
        if (verb == "twist" || verb == "stamped") {
            type = verb == "twist" ? "Twist_" : "TwistStamped_";
            bytes = message(verb == "stamped", {a, 0, 0, 0, 0, b});
        } else if (verb == "pose") {
            type = "PoseWithCovarianceStamped_";
            std::vector<double> values{a, b, 0, 0, 0, std::sin(c / 2), std::cos(c / 2)};
            values.resize(7 + 36);
            bytes = message(true, values);
        } else {
            throw std::runtime_error("no such line: " + line);
        }
        writer("geometry_msgs::msg::dds_::" + type, name).write(&bytes);
    }

  private:
    dds::Topic* topic(const std::string& type, const std::string& name) {
        // A participant of Fast DDS has one type of a name.
        dds::TopicDescription* const known = participant_->lookup_topicdescription(name);
        if (known != nullptr) return dynamic_cast<dds::Topic*>(known);
        dds::TypeSupport(new Bytes(type)).register_type(participant_);
        return participant_->create_topic(name, type, dds::TOPIC_QOS_DEFAULT);
    }

    dds::DomainParticipant* participant_ = nullptr;
    dds::Publisher* publisher_ = nullptr;
    dds::Subscriber* subscriber_ = nullptr;
    std::vector<std::unique_ptr<dds::DataReaderListener>> printers_;
    std::map<std::string, dds::DataReader*> answers_;  // by service
    std::map<std::string, dds::DataWriter*> writers_;
};

}  // namespace

int main(int argc, char** argv) try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    Client client(static_cast<std::uint32_t>(std::stoul(arguments.at(0))));
    for (std::size_t i = 1; i < arguments.size(); ++i) {
        const bool is_reliable = arguments[i].front() == '+';
        const std::string type_and_topic = arguments[i].substr(is_reliable ? 1 : 0);
        const std::size_t at = type_and_topic.rfind("_:") + 1;
        client.read(type_and_topic.substr(0, at), type_and_topic.substr(at + 1), is_reliable);
    }
    for (std::string line; std::getline(std::cin, line);) client.obey(line);
} catch (const std::exception& error) {
    std::cerr << "fastdds_client: " << error.what() << '\n';
    return 1;
}
