// SPDX-License-Identifier: GPL-3.0-or-later
// A client of MQTT 3.1.1 (OASIS, 2014) by libmosquitto, which runs in a thread. One message is
// under way at a time: QoS 1 repeats messages after a reconnection, and a second one under way
// could overtake the first. For a broker that is away 100 000 messages are kept, then the oldest
// are dropped.
#include "extensions/mqtt/mqtt_client.h"

#include <dlfcn.h>
#include <mosquitto.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <new>
#include <system_error>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace::mqtt {

namespace {

constexpr int kKeepAlive = 30;  // s
constexpr int kAtLeastOnce = 1;
constexpr auto kPatience = std::chrono::seconds(5);
constexpr auto kLastMessages = std::chrono::milliseconds(500);
/// Messages kept for a broker that is away; then the oldest are dropped.
constexpr std::size_t kMaxKept = 100'000;
/// Messages that have arrived between two calls of take(), and bytes of each; further are dropped.
constexpr std::size_t kMaxIncoming = 10'000, kMaxPayload = 2048;

[[noreturn]] void fail(const std::string& message) {
    throw FormatError(Diagnostic{"", 0, 0, message});
}

/// The functions of libmosquitto that are used.
struct Library {
    Library();

    decltype(&mosquitto_lib_init) lib_init;
    decltype(&mosquitto_new) create;
    decltype(&mosquitto_destroy) destroy;
    decltype(&mosquitto_username_pw_set) set_login;
    decltype(&mosquitto_will_set) set_will;
    decltype(&mosquitto_reconnect_delay_set) set_delay;
    decltype(&mosquitto_connect) connect;
    decltype(&mosquitto_disconnect) disconnect;
    decltype(&mosquitto_socket) socket;
    decltype(&mosquitto_loop_start) start;
    decltype(&mosquitto_loop_stop) stop;
    decltype(&mosquitto_publish) publish;
    decltype(&mosquitto_subscribe) subscribe;
    decltype(&mosquitto_unsubscribe) unsubscribe;
    decltype(&mosquitto_connect_callback_set) on_connect;
    decltype(&mosquitto_disconnect_callback_set) on_disconnect;
    decltype(&mosquitto_publish_callback_set) on_publish;
    decltype(&mosquitto_message_callback_set) on_message;
    decltype(&mosquitto_strerror) error_text;
    decltype(&mosquitto_connack_string) refusal_text;
};

Library::Library() {
    constexpr const char* kName = "libmosquitto.so.1";
    void* const opened = ::dlopen(kName, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (opened == nullptr)
        fail(std::string("MQTT requires ") + kName +
             ", in Debian's package libmosquitto1: " + ::dlerror());
    const auto find = [opened](auto& function, const char* name) {
        function = reinterpret_cast<std::decay_t<decltype(function)>>(::dlsym(opened, name));
        if (function == nullptr) fail(std::string(kName) + " has no function " + name);
    };
    find(lib_init, "mosquitto_lib_init");
    find(create, "mosquitto_new");
    find(destroy, "mosquitto_destroy");
    find(set_login, "mosquitto_username_pw_set");
    find(set_will, "mosquitto_will_set");
    find(set_delay, "mosquitto_reconnect_delay_set");
    find(connect, "mosquitto_connect");
    find(disconnect, "mosquitto_disconnect");
    find(socket, "mosquitto_socket");
    find(start, "mosquitto_loop_start");
    find(stop, "mosquitto_loop_stop");
    find(publish, "mosquitto_publish");
    find(subscribe, "mosquitto_subscribe");
    find(unsubscribe, "mosquitto_unsubscribe");
    find(on_connect, "mosquitto_connect_callback_set");
    find(on_disconnect, "mosquitto_disconnect_callback_set");
    find(on_publish, "mosquitto_publish_callback_set");
    find(on_message, "mosquitto_message_callback_set");
    find(error_text, "mosquitto_strerror");
    find(refusal_text, "mosquitto_connack_string");
    lib_init();
}

/// Has one message under way at a time, so that their order survives reconnections.
class MosquittoClient final : public MqttClient {
  public:
    MosquittoClient(const MqttOptions& options, std::function<void()> wake);
    ~MosquittoClient() override;
    MosquittoClient(const MosquittoClient&) = delete;
    MosquittoClient& operator=(const MosquittoClient&) = delete;

    void publish(MqttMessage message) override;
    void subscribe(const std::string& topic) override;
    void unsubscribe(const std::string& topic) override;
    std::vector<MqttMessage> take() override;
    [[nodiscard]] int connections() const override;
    void close() override;

  private:
    static MosquittoClient& self(void* object) { return *static_cast<MosquittoClient*>(object); }
    void connected(int refusal);
    void acknowledgeAtOnce() const;
    void arrived();
    void received(const mosquitto_message& message);
    void pump();

    Library library_;
    mosquitto* mosquitto_ = nullptr;
    std::function<void()> wake_;
    mutable std::mutex mutex_;  // guards all below; never locked while the library is called
    std::condition_variable changed_;
    std::deque<MqttMessage> outgoing_;
    bool is_under_way_ = false;  // a message that has not arrived yet
    std::vector<MqttMessage> incoming_;
    std::vector<std::string> subscriptions_;
    bool is_connected_ = false;
    int connections_ = 0, refusal_ = 0;
};

MosquittoClient::MosquittoClient(const MqttOptions& options, std::function<void()> wake)
    : wake_(std::move(wake)) {
    mosquitto_ = library_.create(nullptr, true, this);
    if (mosquitto_ == nullptr) throw std::bad_alloc();
    const std::string status = statusTopic(options.prefix);
    const std::string offline = "offline";
    library_.set_will(mosquitto_, status.c_str(), static_cast<int>(offline.size()), offline.data(),
                      kAtLeastOnce, true);
    if (!options.user.empty())
        library_.set_login(mosquitto_, options.user.c_str(), options.password.c_str());
    library_.set_delay(mosquitto_, 1, 8, true);
    library_.on_connect(
        mosquitto_, [](mosquitto*, void* object, int refusal) { self(object).connected(refusal); });
    library_.on_disconnect(mosquitto_, [](mosquitto*, void* object, int /*reason*/) {
        {
            const std::lock_guard lock(self(object).mutex_);
            self(object).is_connected_ = false;
        }
        self(object).changed_.notify_all();
    });
    library_.on_publish(mosquitto_, [](mosquitto*, void* object, int /*id*/) {
        self(object).acknowledgeAtOnce();
        self(object).arrived();
    });
    library_.on_message(mosquitto_, [](mosquitto*, void* object, const mosquitto_message* message) {
        self(object).received(*message);
    });
    const std::string broker = options.host + ':' + std::to_string(options.port);
    const int error = library_.connect(mosquitto_, options.host.c_str(), options.port, kKeepAlive);
    if (error != MOSQ_ERR_SUCCESS) {
        const std::string reason = error == MOSQ_ERR_ERRNO ? std::generic_category().message(errno)
                                                           : library_.error_text(error);
        library_.destroy(mosquitto_);
        fail("cannot connect to the broker " + broker + ": " + reason);
    }
    library_.start(mosquitto_);
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPatience, [this] { return connections_ > 0 || refusal_ != 0; });
    if (connections_ > 0) return;
    const std::string reason =
        refusal_ != 0 ? library_.refusal_text(refusal_) : "it does not answer";
    lock.unlock();
    library_.disconnect(mosquitto_);
    library_.stop(mosquitto_, true);
    library_.destroy(mosquitto_);
    fail("the broker " + broker + " accepts no connection: " + reason);
}

MosquittoClient::~MosquittoClient() {
    library_.disconnect(mosquitto_);
    {
        // Else the broker hears no farewell, and publishes the will.
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kLastMessages, [this] { return !is_connected_; });
    }
    library_.stop(mosquitto_, true);
    library_.destroy(mosquitto_);
}

void MosquittoClient::publish(MqttMessage message) {
    {
        const std::lock_guard lock(mutex_);
        outgoing_.push_back(std::move(message));
        if (outgoing_.size() > kMaxKept) outgoing_.pop_front();
    }
    pump();
}

/// Sends the next message unless one is under way.
void MosquittoClient::pump() {
    MqttMessage next;
    {
        const std::lock_guard lock(mutex_);
        if (!is_connected_ || is_under_way_ || outgoing_.empty()) return;
        next = std::move(outgoing_.front());
        outgoing_.pop_front();
        is_under_way_ = true;
    }
    const int error = library_.publish(mosquitto_, nullptr, next.topic.c_str(),
                                       static_cast<int>(next.payload.size()), next.payload.data(),
                                       kAtLeastOnce, next.retain);
    // Without a connection the library keeps the message, and sends it first after the next one.
    if (error == MOSQ_ERR_SUCCESS || error == MOSQ_ERR_NO_CONN || error == MOSQ_ERR_CONN_LOST)
        return;
    arrived();
}

/// Acknowledges the bytes just read. Without an answer to them the system would wait 40 ms, and a
/// broker with Nagle's algorithm would hold back the next command so long.
void MosquittoClient::acknowledgeAtOnce() const {
    const int yes = 1;
    ::setsockopt(library_.socket(mosquitto_), IPPROTO_TCP, TCP_QUICKACK, &yes, sizeof yes);
}

void MosquittoClient::arrived() {
    {
        const std::lock_guard lock(mutex_);
        is_under_way_ = false;
    }
    changed_.notify_all();
    pump();
}

void MosquittoClient::connected(int refusal) {
    std::vector<std::string> topics;
    {
        const std::lock_guard lock(mutex_);
        refusal_ = refusal;
        if (refusal == 0) {
            is_connected_ = true;
            ++connections_;
            topics = subscriptions_;
        }
    }
    changed_.notify_all();
    for (const std::string& topic : topics)
        library_.subscribe(mosquitto_, nullptr, topic.c_str(), kAtLeastOnce);
    pump();
    wake_();
}

void MosquittoClient::subscribe(const std::string& topic) {
    bool is_connected = false;
    {
        const std::lock_guard lock(mutex_);
        if (std::find(subscriptions_.begin(), subscriptions_.end(), topic) != subscriptions_.end())
            return;
        subscriptions_.push_back(topic);
        is_connected = is_connected_;
    }
    if (is_connected) library_.subscribe(mosquitto_, nullptr, topic.c_str(), kAtLeastOnce);
}

void MosquittoClient::unsubscribe(const std::string& topic) {
    bool is_connected = false;
    {
        const std::lock_guard lock(mutex_);
        std::erase(subscriptions_, topic);
        is_connected = is_connected_;
    }
    if (is_connected) library_.unsubscribe(mosquitto_, nullptr, topic.c_str());
}

void MosquittoClient::received(const mosquitto_message& message) {
    {
        const std::lock_guard lock(mutex_);
        if (incoming_.size() >= kMaxIncoming) return;
        const std::size_t size =
            std::min(static_cast<std::size_t>(message.payloadlen), kMaxPayload);
        incoming_.push_back(
            {message.topic, {static_cast<const char*>(message.payload), size}, message.retain});
    }
    wake_();
}

std::vector<MqttMessage> MosquittoClient::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(incoming_, {});
}

int MosquittoClient::connections() const {
    const std::lock_guard lock(mutex_);
    return connections_;
}

void MosquittoClient::close() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kLastMessages,
                      [this] { return !is_connected_ || (outgoing_.empty() && !is_under_way_); });
    lock.unlock();
    library_.disconnect(mosquitto_);
}

}  // namespace

MqttOptions parseBroker(const std::string& text) {
    MqttOptions options;
    const bool is_bracketed = text.starts_with('[');  // an address of IPv6
    const std::size_t end = is_bracketed ? text.find(']') : 0;
    const std::size_t colon = end == std::string::npos ? end : text.find(':', end);
    options.host = is_bracketed ? text.substr(1, end - 1) : text.substr(0, colon);
    const bool has_rest = is_bracketed && end + 1 != std::min(colon, text.size());
    const std::string port = colon == std::string::npos ? "1883" : text.substr(colon + 1);
    const auto number = parseInteger(port);
    constexpr int kMaxPort = 65535;
    if (options.host.empty() || has_rest || !number || *number < 1 || *number > kMaxPort)
        throw UsageError(excerpt(text) + " is no broker, wanted HOST:PORT, like 127.0.0.1:1883");
    options.port = static_cast<std::uint16_t>(*number);
    return options;
}

void readLogin(const std::string& file, MqttOptions& options) {
    std::string line = readAll(file);
    line.resize(std::min(line.find_first_of("\r\n"), line.size()));
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || colon == 0)
        throw UsageError(file + " holds no line USER:PASSWORD");
    options.user = line.substr(0, colon);
    options.password = line.substr(colon + 1);
}

std::string statusTopic(const std::string& prefix) { return prefix + "/status"; }

std::unique_ptr<MqttClient> connectMqtt(const MqttOptions& options, std::function<void()> wake) {
    return std::make_unique<MosquittoClient>(options, std::move(wake));
}

}  // namespace ispace::mqtt
