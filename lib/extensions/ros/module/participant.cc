// SPDX-License-Identifier: GPL-3.0-or-later
// The module that links Cyclone DDS, opened by `simrun --ros2`. Uses internals of it, see
// opaque_type.cc.
#include <arpa/inet.h>
#include <dds/dds.h>
#include <dds/ddsi/ddsi_guid.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_thread.h>
#include <dds/ddsrt/log.h>
#include <dds/ddsrt/time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "extensions/ros/module/dds_participant.h"
#include "extensions/ros/module/opaque_type.h"
#include "extensions/ros/module/packet_filter.h"
#include "extensions/ros/module/sample_identity.h"

/// Of dds/ddsi/ddsi_proxy_participant.h of version 0.10, which is no C++.
// NOLINTNEXTLINE(readability-identifier-naming): a name of Cyclone's
extern "C" int ddsi_delete_proxy_participant_by_guid(ddsi_domaingv* domain, const ddsi_guid* guid,
                                                     ddsrt_wctime_t timestamp, int is_implicit);

namespace ispace::ros {

namespace {

/// Messages of Cyclone about its own state: the last one explains a failure.
class CycloneLog {
  public:
    CycloneLog() { dds_set_log_sink(keep, this); }
    ~CycloneLog() { dds_set_log_sink(drop, nullptr); }
    CycloneLog(const CycloneLog&) = delete;
    CycloneLog& operator=(const CycloneLog&) = delete;

    [[nodiscard]] std::string last() {
        const std::lock_guard lock(mutex_);
        return last_;
    }

  private:
    static void keep(void* log, const dds_log_data_t* data) {
        CycloneLog& own = *static_cast<CycloneLog*>(log);
        const std::lock_guard lock(own.mutex_);
        own.last_.assign(data->message, data->size);
        while (own.last_.ends_with('\n')) own.last_.pop_back();
    }
    static void drop(void* /*log*/, const dds_log_data_t* /*data*/) {}

    std::mutex mutex_;
    std::string last_;
};

/// Finds participants of this machine by unicast to the ports of the first 32, and announces this
/// one each second: nodes of ROS that are set to their whole subnet do not listen before they have
/// heard it. Programs whose ports are any, as those over Cyclone without a configuration, are found
/// by multicast; with a time to live of 0 it never leaves the machine, see ip(7). Fragments are
/// nearly as long as packets may be (14720 bytes), so that answers are whole, see withRequest(). At
/// the end, writers do not wait for readers that are behind: they would do so one after another.
std::string configuration(bool is_local) {
    return std::string(
               "<CycloneDDS><Domain Id=\"any\"><General><AllowMulticast>spdp"
               "</AllowMulticast>") +
           (is_local ? "<MulticastTimeToLive>0</MulticastTimeToLive>" : "") + "<FragmentSize>" +
           std::to_string(kMaxWithRequest) +
           "B</FragmentSize></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
           "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
           "<Peers><Peer address=\"localhost\"/></Peers><SPDPInterval>1s</SPDPInterval>"
           "</Discovery><Internal><WriterLingerDuration>0s</WriterLingerDuration></Internal>"
           "</Domain></CycloneDDS>";
}

dds_entity_t checked(dds_entity_t entity, CycloneLog& log, const std::string& what) {
    if (entity >= 0) return entity;
    std::string why = log.last();
    if (why.empty()) why = dds_strretcode(-entity);
    throw std::runtime_error(what + ": " + why);
}

struct FreeQos {
    void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
struct FreeListener {
    void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

std::unique_ptr<dds_qos_t, FreeQos> qosOf(const DdsTopic& topic) {
    std::unique_ptr<dds_qos_t, FreeQos> qos(dds_create_qos());
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, static_cast<std::int32_t>(topic.depth));
    // A writer waits for no slow reader.
    dds_qset_reliability(
        qos.get(), topic.is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_durability(
        qos.get(), topic.is_latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    if (topic.is_latched)
        dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST,
                                    static_cast<std::int32_t>(topic.depth), DDS_LENGTH_UNLIMITED,
                                    DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    constexpr dds_data_representation_id_t kRepresentation = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos.get(), 1, &kRepresentation);
    if (!topic.user_data.empty())
        dds_qset_userdata(qos.get(), topic.user_data.data(), topic.user_data.size());
    return qos;
}

/// A flag that threads of DDS set.
struct Changes {
    explicit Changes(std::function<void()> the_wake) : wake(std::move(the_wake)) {}
    void note() {
        if (!is_noted.exchange(true) && wake) wake();
    }
    std::function<void()> wake;
    std::atomic<bool> is_noted = false;
};

/// A writer or a reader.
struct End {
    Changes* changes = nullptr;
    dds_entity_t topic = 0, entity = 0;
    const ddsi_sertype* type = nullptr;
    std::size_t depth = 1;
    std::atomic<bool> is_read = false;   // a writer
    std::atomic<bool> has_data = false;  // a reader
};

void matched(dds_entity_t /*writer*/, dds_publication_matched_status_t status, void* end) {
    End& own = *static_cast<End*>(end);
    own.is_read = status.current_count > 0;
    own.changes->note();
}

void arrived(dds_entity_t /*reader*/, void* end) {
    End& own = *static_cast<End*>(end);
    own.has_data = true;
    own.changes->note();
}

void peersChanged(dds_entity_t /*reader*/, void* flag) {
    auto& [has_changed, changes] = *static_cast<std::pair<std::atomic<bool>, Changes*>*>(flag);
    has_changed = true;
    changes->note();
}

/// \param type registered
ddsi_domaingv* domainOf(const ddsi_sertype* type) {
    return static_cast<ddsi_domaingv*>(
        ddsrt_atomic_ldvoidp(const_cast<ddsrt_atomic_voidp_t*>(&type->gv)));
}

using GuidPrefix = std::array<std::uint8_t, 12>;

GuidPrefix prefixOf(const dds_guid_t& guid) {
    GuidPrefix prefix{};
    std::copy_n(guid.v, prefix.size(), prefix.begin());
    return prefix;
}

/// Makes DDS forget a participant of others, as if its lease had ended: its next announcement makes
/// it known again.
void forget(ddsi_domaingv* domain, const dds_guid_t& guid) {
    ddsi_guid own{};
    std::array<std::uint32_t, 4> words{};
    std::memcpy(words.data(), guid.v, sizeof guid.v);
    for (std::size_t i = 0; i < 3; ++i) own.prefix.u[i] = ntohl(words[i]);
    own.entityid.u = ntohl(words[3]);
    thread_state* const thread = lookup_thread_state();
    thread_state_awake(thread, domain);
    ddsi_delete_proxy_participant_by_guid(domain, &own, ddsrt_time_wallclock(), 0);
    thread_state_asleep(thread);
}

/// Anyone may announce any number of participants, each of which costs memory, announcements in
/// return, and time at the end: at most kMost stay. Those without an end that an end of ours meets
/// go first, oldest first, then the newest of the others.
class Peers {
  public:
    explicit Peers(Changes& changes) : flag_(false, &changes) {}

    /// \throws std::runtime_error
    void watch(dds_entity_t participant, CycloneLog& log) {
        const std::unique_ptr<dds_listener_t, FreeListener> listener(dds_create_listener(&flag_));
        dds_lset_data_available(listener.get(), peersChanged);
        reader_ = checked(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr,
                                            listener.get()),
                          log, "cannot watch the participants");
        dds_get_guid(participant, &own_);
    }

    /// \param ends entities of writers and readers \param type registered; null without a topic
    void bound(const std::vector<dds_entity_t>& ends, const ddsi_sertype* type) {
        constexpr std::size_t kSpare = 32;
        if (!flag_.first.exchange(false)) return;
        update();
        if (known_.size() <= kMost + kSpare || type == nullptr) return;
        ddsi_domaingv* const domain = domainOf(type);
        if (domain == nullptr) return;
        const std::set<GuidPrefix> met = metBy(ends);
        // The first to go last.
        std::vector<std::tuple<bool, std::int64_t, GuidPrefix>> order;
        for (const auto& [prefix, peer] : known_) {
            const bool is_met = met.contains(prefix);
            order.emplace_back(!is_met, is_met ? peer.second : -peer.second, prefix);
        }
        std::sort(order.begin(), order.end());
        for (; order.size() > kMost; order.pop_back()) {
            const auto peer = known_.find(std::get<2>(order.back()));
            forget(domain, peer->second.first);
            known_.erase(peer);
        }
    }

  private:
    static constexpr std::size_t kMost = 256;

    /// Takes the news about participants.
    void update() {
        constexpr std::size_t kAtOnce = 64;
        std::array<void*, kAtOnce> samples{};
        std::array<dds_sample_info_t, kAtOnce> infos{};
        dds_return_t count = 0;
        do {
            samples.fill(nullptr);
            count = dds_take(reader_, samples.data(), infos.data(), kAtOnce, kAtOnce);
            for (std::size_t i = 0; count > 0 && i < static_cast<std::size_t>(count); ++i) {
                const auto& guid =
                    static_cast<const dds_builtintopic_participant_t*>(samples[i])->key;
                const GuidPrefix prefix = prefixOf(guid);
                if (infos[i].instance_state != DDS_ALIVE_INSTANCE_STATE)
                    known_.erase(prefix);
                else if (prefix != prefixOf(own_))
                    known_.try_emplace(prefix, guid, next_++);
            }
            if (count > 0) dds_return_loan(reader_, samples.data(), count);
        } while (count == static_cast<dds_return_t>(kAtOnce));
    }

    static std::set<GuidPrefix> metBy(const std::vector<dds_entity_t>& ends) {
        std::set<GuidPrefix> met;
        std::vector<dds_instance_handle_t> others(1024);
        for (const dds_entity_t end : ends) {
            const bool is_reader = dds_get_matched_publications(end, nullptr, 0) >= 0;
            const dds_return_t count =
                is_reader ? dds_get_matched_publications(end, others.data(), others.size())
                          : dds_get_matched_subscriptions(end, others.data(), others.size());
            for (std::size_t i = 0;
                 count > 0 && i < std::min(others.size(), static_cast<std::size_t>(count)); ++i) {
                dds_builtintopic_endpoint_t* const other =
                    is_reader ? dds_get_matched_publication_data(end, others[i])
                              : dds_get_matched_subscription_data(end, others[i]);
                if (other == nullptr) continue;
                met.insert(prefixOf(other->participant_key));
                dds_builtintopic_free_endpoint(other);
            }
        }
        return met;
    }

    std::pair<std::atomic<bool>, Changes*> flag_;
    dds_entity_t reader_ = 0;
    dds_guid_t own_{};
    std::map<GuidPrefix, std::pair<dds_guid_t, std::int64_t>> known_;  // and a number, by age
    std::int64_t next_ = 0;
};

class Participant final : public DdsParticipant {
  public:
    explicit Participant(const DdsSettings& settings) : changes_(settings.wake) {
        domain_ = checked(
            dds_create_domain(settings.domain, configuration(settings.allowed.empty()).c_str()),
            log_, "cannot open domain " + std::to_string(settings.domain));
        try {
            admitOnly(settings.allowed);
            std::unique_ptr<dds_qos_t, FreeQos> qos(dds_create_qos());
            constexpr std::string_view kEnclave = "enclave=/;";
            dds_qset_userdata(qos.get(), kEnclave.data(), kEnclave.size());
            participant_ =
                checked(dds_create_participant(settings.domain, qos.get(), nullptr), log_,
                        "cannot take part in domain " + std::to_string(settings.domain));
            peers_.watch(participant_, log_);
        } catch (...) {
            dds_delete(domain_);
            throw;
        }
    }
    ~Participant() override { dds_delete(domain_); }

    int addWriter(const DdsTopic& topic) override { return add(topic, true); }
    int addReader(const DdsTopic& topic) override { return add(topic, false); }

    void remove(int end) override {
        const auto found = ends_.find(end);
        if (found == ends_.end()) return;
        dds_delete(found->second.entity);  // returns after its last callback
        dds_delete(found->second.topic);
        ends_.erase(found);
    }

    [[nodiscard]] DdsGuid guid() const override { return guidOf(participant_); }
    [[nodiscard]] DdsGuid guid(int end) const override { return guidOf(ends_.at(end).entity); }

    bool changed() override {
        const bool has_changed = changes_.is_noted.exchange(false);
        if (has_changed) {
            std::vector<dds_entity_t> entities;
            for (const auto& [number, end] : ends_) entities.push_back(end.entity);
            peers_.bound(entities, ends_.empty() ? nullptr : ends_.begin()->second.type);
        }
        return has_changed;
    }

    [[nodiscard]] bool isRead(int writer) const override { return ends_.at(writer).is_read; }

    void write(int writer, std::string_view message) override {
        const End& end = ends_.at(writer);
        // Takes the message over, even if it fails.
        dds_writecdr(end.entity, newOpaqueMessage(end.type, message));
    }

    void answer(int writer, const DdsRequest& request, std::string_view message) override {
        const std::string bytes = withRequest(request, message);
        if (bytes.size() <= kMaxWithRequest) write(writer, bytes);
    }

    std::vector<DdsMessage> take(int reader) override {
        End& end = ends_.at(reader);
        std::vector<DdsMessage> out;
        if (!end.has_data.exchange(false)) return out;
        std::vector<ddsi_serdata*> taken(end.depth);
        std::vector<dds_sample_info_t> infos(end.depth);
        const dds_return_t count =
            dds_takecdr(end.entity, taken.data(), static_cast<std::uint32_t>(end.depth),
                        infos.data(), DDS_ANY_STATE);
        for (int i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (infos[at].valid_data) out.push_back(messageOf(taken[at]));
            ddsi_serdata_unref(taken[at]);
        }
        return out;
    }

  private:
    static DdsGuid guidOf(dds_entity_t entity) {
        dds_guid_t guid{};
        dds_get_guid(entity, &guid);
        DdsGuid out{};
        std::copy(std::begin(guid.v), std::end(guid.v), out.begin());
        return out;
    }

    int add(const DdsTopic& topic, bool is_writer) {
        const int number = next_++;
        End& end = ends_[number];
        end.changes = &changes_;
        end.depth = topic.depth;
        try {
            ddsi_sertype* type = newOpaqueType(topic.type);
            end.topic = dds_create_topic_sertype(participant_, topic.name.c_str(), &type, nullptr,
                                                 nullptr, nullptr);
            if (end.topic < 0) ddsi_sertype_unref(type);
            checked(end.topic, log_, topic.name);
            end.type = type;
            if (!std::exchange(declares_, true)) declareRequests(domainOf(type));
            const auto qos = qosOf(topic);
            const std::unique_ptr<dds_listener_t, FreeListener> listener(dds_create_listener(&end));
            if (is_writer)
                dds_lset_publication_matched(listener.get(), matched);
            else
                dds_lset_data_available(listener.get(), arrived);
            end.entity = checked(
                is_writer ? dds_create_writer(participant_, end.topic, qos.get(), listener.get())
                          : dds_create_reader(participant_, end.topic, qos.get(), listener.get()),
                log_, topic.name);
        } catch (...) {
            if (end.topic > 0) dds_delete(end.topic);
            ends_.erase(number);
            throw;
        }
        return number;
    }

    CycloneLog log_;
    Changes changes_;
    Peers peers_{changes_};
    dds_entity_t domain_ = 0, participant_ = 0;
    std::map<int, End> ends_;  // which never move: threads of DDS know their addresses
    int next_ = 1;
    bool declares_ = false;  // see declareRequests()
};

}  // namespace

}  // namespace ispace::ros

extern "C" __attribute__((visibility("default"))) void ispaceOpenDds(
    const ispace::ros::DdsSettings& settings, std::unique_ptr<ispace::ros::DdsParticipant>& out) {
    out = std::make_unique<ispace::ros::Participant>(settings);
}
