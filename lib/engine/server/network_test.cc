// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/network.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/error.h"

namespace ispace {
namespace network_test {

bool holds(const std::string& network, const std::string& address) {
    const std::vector<Network> allowed{parseNetwork(network)};
    return isAllowed(allowed, address);
}

TEST(Network, HoldsItsAddresses) {
    EXPECT_TRUE(holds("192.168.1.0/24", "192.168.1.0"));
    EXPECT_TRUE(holds("192.168.1.0/24", "192.168.1.255"));
    EXPECT_FALSE(holds("192.168.1.0/24", "192.168.2.0"));
    EXPECT_TRUE(holds("192.168.1.20", "192.168.1.20"));
    EXPECT_FALSE(holds("192.168.1.20", "192.168.1.21"));
    EXPECT_TRUE(holds("10.0.0.0/7", "11.255.0.1"));
    EXPECT_FALSE(holds("10.0.0.0/7", "12.0.0.1"));
    EXPECT_TRUE(holds("0.0.0.0/0", "8.8.8.8"));
    EXPECT_FALSE(holds("0.0.0.0/0", "2001:db8::1"));
    EXPECT_TRUE(holds("fd00::/8", "fd12::1"));
    EXPECT_FALSE(holds("fd00::/8", "fe80::1"));
}

TEST(Network, AddressesOfVersion4AreTheSameWithinVersion6) {
    EXPECT_TRUE(holds("192.168.1.0/24", "::ffff:192.168.1.7"));
    EXPECT_FALSE(holds("192.168.1.0/24", "::ffff:192.168.2.7"));
}

TEST(Network, ThisMachineIsAlwaysAllowed) {
    for (const char* address : {"127.0.0.1", "127.0.0.2", "::1", "::ffff:127.0.0.1"})
        EXPECT_TRUE(isAllowed({}, address)) << address;
    EXPECT_FALSE(isAllowed({}, "192.168.1.1"));
    EXPECT_FALSE(isAllowed({}, "no address"));
}

TEST(Network, RefusesWhatIsNone) {
    for (const char* text : {"", "a", "192.168.1", "192.168.1.0/33", "192.168.1.0/", "fd00::/129",
                             "192.168.1.0/-1", "192.168.1.0/+8", "192.168.1.0/2x", "localhost"})
        EXPECT_THROW(static_cast<void>(parseNetwork(text)), UsageError) << text;
    try {
        static_cast<void>(parseNetwork("192.168.1.7/24"));
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 192.168.1.0/24?"), std::string::npos)
            << error.what();
    }
}

}  // namespace network_test
}  // namespace ispace
