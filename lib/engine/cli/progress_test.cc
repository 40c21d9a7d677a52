// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress_bar.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

namespace ispace {

namespace progress_test {

TEST(SearchWatch, EndsAtItsLimitAndNotBefore) {
    using std::chrono::steady_clock;
    {
        const SearchWatch none(std::make_unique<SilentProgress>(), std::nullopt);
        EXPECT_FALSE(none.stopped());
    }
    const auto start = steady_clock::now();
    const SearchWatch watch(std::make_unique<SilentProgress>(), 0.05);
    while (!watch.stopped()) std::this_thread::yield();
    EXPECT_GE(steady_clock::now() - start, std::chrono::milliseconds(50));
}

TEST(SearchWatch, NotesTellTheLimit) {
    class Listener final : public Progress {
      public:
        explicit Listener(std::string& heard) : heard_(&heard) {}
        void begin(std::string_view /*phase*/, std::int64_t /*total*/) override {}
        void advance(std::int64_t /*count*/) override {}
        void note(std::string_view text) override { *heard_ = text; }
        void end() override {}

      private:
        std::string* heard_;
    };
    std::string heard;
    SearchWatch(std::make_unique<Listener>(heard), std::nullopt).note("best 1 %");
    EXPECT_EQ(heard, "best 1 %");
    SearchWatch(std::make_unique<Listener>(heard), 0).note("best 2 %");
    EXPECT_EQ(heard, "best 2 %, limit in 0 s");
}

TEST(SearchWatch, NoTimeIsNoTime) {
    const SearchWatch watch(std::make_unique<SilentProgress>(), 0);
    EXPECT_TRUE(watch.stopped());
    EXPECT_EQ(watch.signal(), 0);
}

TEST(SearchWatch, LongLimitsDoNotOverflow) {
    const SearchWatch watch(std::make_unique<SilentProgress>(), 1e300);
    EXPECT_FALSE(watch.stopped());
}

TEST(SearchWatch, ASignalStopsItAndTheProcessCanEndByIt) {
    const pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGTERM, SIG_DFL);  // watches of other tests leave it ignored
        int signal = 0;
        {
            const SearchWatch watch(std::make_unique<SilentProgress>(), std::nullopt);
            std::raise(SIGTERM);
            while (!watch.stopped()) std::this_thread::yield();
            signal = watch.signal();
        }
        if (signal != SIGTERM) ::_exit(1);
        endBySignal(signal);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << status;
    EXPECT_EQ(WTERMSIG(status), SIGTERM);
}

}  // namespace progress_test

}  // namespace ispace
