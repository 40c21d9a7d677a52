// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/film.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace ispace {
namespace encode_ahead_test {

Image imageOf(std::uint32_t number) { return {1, 1, {number}}; }

/// The first takes longest, so that others are encoded before it.
std::string encode(const Image& image) {
    const std::uint32_t number = image.pixels.front();
    if (number == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return std::to_string(number);
}

TEST(EncodeAhead, WritesInOrderOnAnyNumberOfCores) {
    for (const std::size_t cores : {1U, 2U, 8U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, cores);
        const std::thread::id here = std::this_thread::get_id();
        std::vector<std::string> written;
        EncodeAhead ahead(encode, [&](const std::string& file, const std::string& bytes) {
            EXPECT_EQ(std::this_thread::get_id(), here);
            written.push_back(file + bytes);
        });
        for (std::uint32_t i = 0; i < 30; ++i) ahead.add("f", imageOf(i));
        ahead.finish();
        ASSERT_EQ(written.size(), 30U);
        for (std::size_t i = 0; i < written.size(); ++i)
            EXPECT_EQ(written[i], "f" + std::to_string(i));
    }
}

TEST(EncodeAhead, HoldsFewPixels) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 8);
    std::size_t written = 0;
    EncodeAhead ahead(
        [](const Image& /*image*/) { return std::string(); },
        [&](const std::string& /*file*/, const std::string& /*bytes*/) { ++written; });
    Image large{7000, 5000, std::vector<std::uint32_t>(35'000'000)};
    ahead.add("a", large);
    EXPECT_EQ(written, 0U);
    ahead.add("b", std::move(large));
    EXPECT_EQ(written, 1U);
    ahead.finish();
    EXPECT_EQ(written, 2U);
}

TEST(EncodeAhead, ErrorsComeOutAndWhatWasAddedIsWritten) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
    std::vector<std::string> written;
    const auto write = [&](const std::string& file, const std::string& /*bytes*/) {
        if (file == "full") throw std::runtime_error("no space");
        written.push_back(file);
    };
    const auto fail = [](const Image& image) -> std::string {
        if (image.pixels.front() == 7) throw std::invalid_argument("seven");
        return "";
    };
    {
        EncodeAhead ahead(fail, write);
        ahead.add("a", imageOf(7));
        ahead.add("b", imageOf(1));
        EXPECT_THROW(ahead.finish(), std::invalid_argument);
    }
    EXPECT_EQ(written, std::vector<std::string>{"b"});
    EncodeAhead ahead(fail, write);
    ahead.add("full", imageOf(1));
    EXPECT_THROW(ahead.finish(), std::runtime_error);
}

}  // namespace encode_ahead_test
}  // namespace ispace
