// SPDX-License-Identifier: GPL-3.0-or-later
// cyclone_client DOMAIN TOPIC: a program over Cyclone DDS as it is without a configuration. Exit
// status 0 once a writer of TOPIC is known, 1 after ten seconds without one.
#include <dds/dds.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const auto domain = static_cast<dds_domainid_t>(std::strtoul(argv[1], nullptr, 10));
    const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
    const dds_entity_t reader =
        dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
    if (reader < 0) return 2;
    constexpr std::size_t kAtOnce = 64;
    for (int i = 0; i < 200; ++i) {
        std::array<void*, kAtOnce> samples{};
        std::array<dds_sample_info_t, kAtOnce> infos{};
        const dds_return_t count = dds_take(reader, samples.data(), infos.data(), kAtOnce, kAtOnce);
        for (std::size_t k = 0; count > 0 && k < static_cast<std::size_t>(count); ++k) {
            const auto* const end = static_cast<const dds_builtintopic_endpoint_t*>(samples[k]);
            if (!infos[k].valid_data || std::strcmp(end->topic_name, argv[2]) != 0) continue;
            std::printf("%s\n", end->type_name);
            return 0;
        }
        if (count > 0) dds_return_loan(reader, samples.data(), count);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return 1;
}
