// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/error.h"
#include "net/server.h"

namespace ispace {
namespace {

std::string parsed(const std::string& text) {
    const Endpoint endpoint = parseEndpoint(text);
    return endpoint.address + " " + std::to_string(endpoint.port);
}

std::string usage(const std::string& text) {
    try {
        parseEndpoint(text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(ParseEndpoint, ReadsLoopback) {
    EXPECT_EQ(parsed("127.0.0.1:0"), "127.0.0.1 0");
    EXPECT_EQ(parsed("127.1.2.3:65535"), "127.1.2.3 65535");
    EXPECT_EQ(parsed("localhost:8000"), "127.0.0.1 8000");
    EXPECT_EQ(parsed("[::1]:80"), "::1 80");
}

TEST(ParseEndpoint, HintsAtWhatIsMissing) {
    EXPECT_EQ(usage("8000"), "`8000` is no ADDR:PORT, did you mean 127.0.0.1:8000?");
    EXPECT_EQ(usage(":0"), "`:0` has no address, did you mean 127.0.0.1:0?");
    EXPECT_EQ(usage("localhost"), "`localhost` is no ADDR:PORT");
    EXPECT_EQ(usage(""), "`` is no ADDR:PORT");
    for (const std::string port :
         {"", "65536", "-1", "+1", "x", "80x", " 80", "1e3", "99999999999999999999"})
        EXPECT_EQ(usage("127.0.0.1:" + port),
                  "`127.0.0.1:" + port + "` has no port from 0 to 65535 behind the last colon");
}

TEST(ParseEndpoint, WantsANumericAddress) {
    for (const std::string host : {"example.com", "127.1", "::1", "[127.0.0.1]", "[localhost]",
                                   "1.2.3", "LOCALHOST", "[", "[]", "0x7f.0.0.1"})
        EXPECT_EQ(usage(host + ":80"),
                  "`" + host +
                      ":80`: wanted a numeric address or localhost before the port, like "
                      "127.0.0.1:8000 or [::1]:8000");
}

TEST(ParseEndpoint, RefusesOtherMachines) {
    for (const std::string host : {"0.0.0.0", "192.168.0.1", "126.255.255.255", "128.0.0.1", "[::]",
                                   "[fe80::1]", "[::ffff:127.0.0.1]"})
        EXPECT_EQ(usage(host + ":80"),
                  "`" + host +
                      ":80`: other machines can only be served with a token, which this version "
                      "does not have; listen on 127.0.0.1");
}

}  // namespace
}  // namespace ispace
