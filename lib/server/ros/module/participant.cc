// SPDX-License-Identifier: GPL-3.0-or-later
// The module that links Cyclone DDS, opened by `simrun --ros2`.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsrt/log.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "server/ros/module/dds_participant.h"
#include "server/ros/module/opaque_type.h"
#include "server/ros/module/packet_filter.h"

namespace ispace {

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
/// heard it. With other machines, discovery is by multicast, too. At the end, writers do not wait
/// for readers that are behind: they would do so one after another.
std::string configuration(bool is_local) {
    return std::string("<CycloneDDS><Domain Id=\"any\"><General><AllowMulticast>") +
           (is_local ? "false" : "spdp") +
           "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
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

    bool changed() override { return changes_.is_noted.exchange(false); }

    [[nodiscard]] bool isRead(int writer) const override { return ends_.at(writer).is_read; }

    void write(int writer, std::string_view message) override {
        const End& end = ends_.at(writer);
        // Takes the message over, even if it fails.
        dds_writecdr(end.entity, newOpaqueMessage(end.type, message));
    }

    std::vector<std::string> take(int reader) override {
        End& end = ends_.at(reader);
        std::vector<std::string> out;
        if (!end.has_data.exchange(false)) return out;
        std::vector<ddsi_serdata*> taken(end.depth);
        std::vector<dds_sample_info_t> infos(end.depth);
        const dds_return_t count =
            dds_takecdr(end.entity, taken.data(), static_cast<std::uint32_t>(end.depth),
                        infos.data(), DDS_ANY_STATE);
        for (int i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (infos[at].valid_data) out.emplace_back(bytesOf(taken[at]));
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
    dds_entity_t domain_ = 0, participant_ = 0;
    std::map<int, End> ends_;  // which never move: threads of DDS know their addresses
    int next_ = 1;
};

}  // namespace

}  // namespace ispace

extern "C" __attribute__((visibility("default"))) void ispaceOpenDds(
    const ispace::DdsSettings& settings, std::unique_ptr<ispace::DdsParticipant>& out) {
    out = std::make_unique<ispace::Participant>(settings);
}
