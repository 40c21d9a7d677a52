// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/module/packet_filter.h"

#include <ifaddrs.h>
#include <linux/filter.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace ispace::ros {

namespace {

[[noreturn]] void refuse(const char* what) {
    throw std::system_error(errno, std::system_category(), what);
}

std::vector<unsigned> loopbackInterfaces() {
    ifaddrs* all = nullptr;
    if (::getifaddrs(&all) != 0) refuse("cannot list the network interfaces");
    std::vector<unsigned> out;
    for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next)
        if ((one->ifa_flags & IFF_LOOPBACK) != 0) out.push_back(::if_nametoindex(one->ifa_name));
    ::freeifaddrs(all);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

constexpr std::size_t kIpv4At = 12;  // of an address that IPv6 maps

/// True for IPv4, which alone Cyclone speaks here.
bool isIpv4(const Network& network) {
    constexpr std::size_t kOnes = 10;
    const auto ends = network.address.begin() + kOnes;
    return network.bits >= static_cast<int>(8 * kIpv4At) &&
           std::all_of(network.address.begin(), ends, [](std::uint8_t b) { return b == 0; }) &&
           ends[0] == 0xff && ends[1] == 0xff;
}

/// Returns classic BPF, which sees UDP headers; the link and the IP header have offsets of their
/// own.
std::vector<sock_filter> filterOf(std::span<const Network> allowed) {
    constexpr std::uint32_t kAll = 0xffffffff, kSource = 12;  // in the IP header
    constexpr auto kLoad = static_cast<std::uint16_t>(BPF_LD | BPF_W | BPF_ABS),
                   kMask = static_cast<std::uint16_t>(BPF_ALU | BPF_AND | BPF_K),
                   kEquals = static_cast<std::uint16_t>(BPF_JMP | BPF_JEQ | BPF_K),
                   kReturn = static_cast<std::uint16_t>(BPF_RET | BPF_K);
    const auto offset = [](int value) { return static_cast<std::uint32_t>(value); };
    std::vector<sock_filter> out{{kLoad, 0, 0, offset(SKF_AD_OFF + SKF_AD_IFINDEX)}};
    const auto admit_if = [&out](std::uint32_t value) {
        out.push_back({kEquals, 0, 1, value});
        out.push_back({kReturn, 0, 0, kAll});
    };
    for (const unsigned interface : loopbackInterfaces()) admit_if(interface);
    for (const Network& network : allowed) {
        if (!isIpv4(network)) continue;
        const int bits = network.bits - static_cast<int>(8 * kIpv4At);
        const std::uint32_t mask = bits == 0 ? 0 : kAll << static_cast<unsigned>(32 - bits);
        std::uint32_t address = 0;
        for (std::size_t i = kIpv4At; i < network.address.size(); ++i)
            address = address << 8U | network.address[i];
        out.push_back({kLoad, 0, 0, offset(SKF_NET_OFF) + kSource});
        out.push_back({kMask, 0, 0, mask});
        admit_if(address & mask);
    }
    out.push_back({kReturn, 0, 0, 0});
    return out;
}

bool isUdp(int descriptor) {
    int type = 0, family = 0;
    socklen_t length = sizeof type;
    return ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &length) == 0 &&
           ::getsockopt(descriptor, SOL_SOCKET, SO_DOMAIN, &family, &length) == 0 &&
           type == SOCK_DGRAM && (family == AF_INET || family == AF_INET6);
}

}  // namespace

void admitOnly(std::span<const Network> allowed) {
    std::vector<sock_filter> filter = filterOf(allowed);
    const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        const std::string name = entry.path().filename().string();
        int descriptor = -1;
        std::from_chars(name.data(), name.data() + name.size(), descriptor);
        if (!isUdp(descriptor)) continue;
        if (::setsockopt(descriptor, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) != 0)
            refuse("cannot filter packets of other machines");
    }
}

}  // namespace ispace::ros
