// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/web/web_files.h"

#include <gtest/gtest.h>

namespace ispace::web {
namespace web_origin_test {

TEST(WebOrigin, KnowsItsOwnNames) {
    const WebOrigin origin("127.0.0.1", 8080);
    for (const char* host : {"127.0.0.1:8080", "localhost:8080", "LocalHost:8080"})
        EXPECT_TRUE(origin.isHost(host)) << host;
    for (const char* host : {"", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:80801",
                             "evil.example:8080", "localhost", "localhost.evil.example:8080",
                             "127.0.0.1:8080.evil.example", "[::1]:8080", " localhost:8080"})
        EXPECT_FALSE(origin.isHost(host)) << host;
}

TEST(WebOrigin, NeedsNoPortIfItIsThatOfHttp) {
    const WebOrigin origin("127.0.0.1", 80);
    EXPECT_TRUE(origin.isHost("127.0.0.1"));
    EXPECT_TRUE(origin.isHost("localhost:80"));
    EXPECT_FALSE(origin.isHost("localhost:8080"));
}

TEST(WebOrigin, HasAnIpv6Address) {
    const WebOrigin origin("[::1]", 8080);
    EXPECT_TRUE(origin.isHost("[::1]:8080"));
    EXPECT_TRUE(origin.isHost("localhost:8080"));
    EXPECT_FALSE(origin.isHost("127.0.0.1:8080"));
    EXPECT_TRUE(origin.mayConnect("http://[::1]:8080"));
}

TEST(WebOrigin, LetsItsOwnPageConnect) {
    const WebOrigin origin("127.0.0.1", 8080);
    EXPECT_TRUE(origin.mayConnect("http://127.0.0.1:8080"));
    EXPECT_TRUE(origin.mayConnect("http://localhost:8080"));
    EXPECT_TRUE(origin.mayConnect("")) << "no browser";
    for (const char* other :
         {"null", "https://127.0.0.1:8080", "http://127.0.0.1:8081", "http://127.0.0.1",
          "http://evil.example", "http://evil.example:8080", "http://127.0.0.1:8080@evil.example",
          "file://", "http://127.0.0.1:8080/"})
        EXPECT_FALSE(origin.mayConnect(other)) << other;
}

TEST(WebOrigin, PolicyNamesTheSocket) {
    const std::string policy = contentPolicy("localhost:8080");
    EXPECT_TRUE(policy.starts_with("default-src 'none';")) << policy;
    EXPECT_NE(policy.find("connect-src 'self' ws://localhost:8080;"), std::string::npos) << policy;
    EXPECT_NE(policy.find("frame-ancestors 'none'"), std::string::npos) << policy;
    EXPECT_EQ(policy.find("unsafe"), std::string::npos) << policy;
}

}  // namespace web_origin_test
}  // namespace ispace::web
