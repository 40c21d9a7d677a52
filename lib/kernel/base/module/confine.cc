// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/module/confine.h"

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <vector>

#include "base/module/call_filter.h"
#include "base/unconfined.h"

#if defined(__SANITIZE_ADDRESS__)
#define ISPACE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ISPACE_SANITIZED 1
#endif
#endif

#ifdef ISPACE_SANITIZED
// Replaces the limit on memory. Leaks of libraries are ignored.
extern "C" const char* __asan_default_options() {  // NOLINT
    return "detect_leaks=0:symbolize=0:hard_rss_limit_mb=1200:max_allocation_size_mb=1024";
}
#endif

namespace ispace {

namespace {

#ifdef ISPACE_SANITIZED
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// Deep enough for trees of nodes that are rejected with a message.
constexpr rlim_t kStack = 64U << 20U;
constexpr rlim_t kDescriptors = 64;

/// \param most bound up to which the parent may raise the limit
/// \return false if it is refused
bool limit(__rlimit_resource resource, rlim_t now, rlim_t most) {
    rlimit limits{};
    if (::getrlimit(resource, &limits) != 0) return false;
    limits.rlim_max = std::min(limits.rlim_max, most);
    limits.rlim_cur = std::min(limits.rlim_max, now);
    return ::setrlimit(resource, &limits) == 0;
}

/// \return false if the system has no such filters or refuses them
bool filterCalls() {
    const auto calls = nativeCalls();
    if (!calls) return false;
    std::vector<sock_filter> program = callFilter(*calls);
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    return ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

/// \return false if the process has rights left
bool confine(const ConfinedLimits& limits, const ConfinedLimits& most, int parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent ended before
    bool is_confined = ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0;
    ::prctl(PR_SET_DUMPABLE, 0, 0, 0,
            0);  // cores piped to a program have no limit
    const auto bound = [&](__rlimit_resource resource, rlim_t now, rlim_t largest) {
        is_confined = limit(resource, now, largest) && is_confined;
    };
    bound(RLIMIT_CORE, 0, 0);
    bound(RLIMIT_FSIZE, 0, 0);
    // The system kills at the second limit and reports the reason at the first.
    bound(RLIMIT_CPU, limits.seconds, std::max(limits.seconds + 1, most.seconds));
    if (kSanitized) return true;
    bound(RLIMIT_NOFILE, kDescriptors, kDescriptors);
    bound(RLIMIT_STACK, kStack, kStack);
    bound(RLIMIT_AS, limits.memory, std::max(limits.memory, most.memory));
    return filterCalls() && is_confined;
}

void send(const char* bytes, std::size_t size) {
    while (size > 0) {
        const ssize_t sent = ::send(STDOUT_FILENO, bytes, size, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0) ::_exit(1);
        bytes += sent;
        size -= static_cast<std::size_t>(sent);
    }
}

/// Assimp reports an error after a failed allocation; other libraries end the program.
[[noreturn]] void outOfMemory() {
    report(ConfinedAnswer::OutOfMemory, {});
    ::_exit(0);
}

std::size_t number(const char* text) { return std::strtoull(text, nullptr, 10); }

void reportWork(const Budget& work) {
    const std::uint64_t spent = work.limit() - work.left();
    std::array<char, sizeof spent> bytes{};
    std::memcpy(bytes.data(), &spent, sizeof spent);
    report(ConfinedAnswer::Work, {bytes.data(), bytes.size()});
}

}  // namespace

void report(ConfinedAnswer kind, std::string_view bytes) {
    std::array<char, kConfinedHead> head{};
    head[0] = static_cast<char>(kind);
    const std::uint64_t size = bytes.size();
    std::memcpy(&head[1], &size, sizeof size);
    send(head.data(), head.size());
    send(bytes.data(), bytes.size());
}

HandedOver receiveFile() {
    std::array<char, 1 + sizeof(std::uint64_t)> bytes{};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    iovec part{bytes.data(), bytes.size()};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    ssize_t got = 0;
    do got = ::recvmsg(STDOUT_FILENO, &message, MSG_WAITALL | MSG_CMSG_CLOEXEC);
    while (got < 0 && errno == EINTR);
    if (got != static_cast<ssize_t>(bytes.size())) ::_exit(1);
    const cmsghdr* const head = CMSG_FIRSTHDR(&message);
    if (static_cast<ConfinedReply>(bytes[0]) != ConfinedReply::Handed || head == nullptr) return {};
    HandedOver file;
    std::memcpy(&file.fd, CMSG_DATA(head), sizeof file.fd);
    std::uint64_t size = 0;
    std::memcpy(&size, &bytes[1], sizeof size);
    file.size = size;
    return file;
}

MappedInput::MappedInput(std::size_t size) : size_(size) {
    if (size > 0) start_ = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
    if (start_ == MAP_FAILED) throw std::bad_alloc();
}

MappedInput::~MappedInput() {
    if (start_ != nullptr) ::munmap(start_, size_);
}

int runConfined(int argc, char** argv, const ConfinedLimits& most,
                const std::function<std::string(std::size_t size, Budget& work)>& answer) {
    constexpr int kWords = 6;
    if (argc <= kWords) return 2;
    const char* const* const words = argv + argc - kWords;
    std::set_new_handler(outOfMemory);
    const bool may_be_unconfined = number(words[5]) != 0;
    if (!confine({number(words[2]), number(words[3])}, most, std::atoi(words[0])) &&
        !may_be_unconfined)
        ::_exit(kNotConfined);
    HandedOver file{STDIN_FILENO, number(words[1])};
    Budget work(0, {number(words[4])});
    try {
        while (file.fd == STDIN_FILENO) {
            work = Budget(0, {number(words[4])});
            const std::string result = answer(file.size, work);
            reportWork(work);
            report(ConfinedAnswer::Result, result);
            ::close(STDIN_FILENO);  // frees the number for the next file
            file = receiveFile();
        }
    } catch (const std::bad_alloc&) {
        outOfMemory();
    } catch (const TooMuchWork& error) {
        report(ConfinedAnswer::TooMuchWork, error.what());
    } catch (const std::exception& error) {
        reportWork(work);
        report(ConfinedAnswer::Error, error.what());
    }
    ::_exit(0);  // without destructors, which would only take time
}

}  // namespace ispace
