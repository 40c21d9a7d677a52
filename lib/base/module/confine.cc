// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/module/confine.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
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
void limit(__rlimit_resource resource, rlim_t now, rlim_t most) {
    rlimit limits{};
    if (::getrlimit(resource, &limits) != 0) return;
    limits.rlim_max = std::min(limits.rlim_max, most);
    limits.rlim_cur = std::min(limits.rlim_max, now);
    ::setrlimit(resource, &limits);
}

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;
#endif

/// Allows memory, open files and exit; all other calls fail with EPERM.
constexpr std::array kAllowed{
    __NR_read,           __NR_pread64,         __NR_lseek,    __NR_close,      __NR_sendto,
    __NR_sendmsg,        __NR_recvfrom,        __NR_recvmsg,  __NR_brk,        __NR_mmap,
    __NR_munmap,         __NR_mremap,          __NR_mprotect, __NR_madvise,    __NR_futex,
    __NR_clock_gettime,  __NR_getrandom,       __NR_exit,     __NR_exit_group, __NR_rt_sigreturn,
    __NR_rt_sigprocmask, __NR_restart_syscall,
};

void filterCalls() {
    if (kMachine == 0) return;
    constexpr auto kNumberAt = static_cast<std::uint32_t>(offsetof(seccomp_data, nr));
    constexpr auto kMachineAt = static_cast<std::uint32_t>(offsetof(seccomp_data, arch));
    std::vector<sock_filter> program{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kMachineAt),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kNumberAt),
    };
    for (const auto call : kAllowed) {
        program.push_back(
            BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    }
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
    const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
    ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter);
}

void confine(const ConfinedLimits& limits, const ConfinedLimits& most, int parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent ended before
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    ::prctl(PR_SET_DUMPABLE, 0, 0, 0,
            0);  // cores piped to a program have no limit
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_FSIZE, 0, 0);
    // The system kills at the second limit and reports the reason at the first.
    limit(RLIMIT_CPU, limits.seconds, std::max(limits.seconds + 1, most.seconds));
    if (kSanitized) return;
    limit(RLIMIT_NOFILE, kDescriptors, kDescriptors);
    limit(RLIMIT_STACK, kStack, kStack);
    limit(RLIMIT_AS, limits.memory, std::max(limits.memory, most.memory));
    filterCalls();
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
    tell(ConfinedAnswer::OutOfMemory, {});
    ::_exit(0);
}

std::size_t number(const char* text) { return std::strtoull(text, nullptr, 10); }

void tellWork(const Budget& work) {
    const std::uint64_t spent = work.limit() - work.left();
    std::array<char, sizeof spent> bytes{};
    std::memcpy(bytes.data(), &spent, sizeof spent);
    tell(ConfinedAnswer::Work, {bytes.data(), bytes.size()});
}

}  // namespace

void tell(ConfinedAnswer kind, std::string_view bytes) {
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
    constexpr int kWords = 5;
    if (argc <= kWords) return 2;
    const char* const* const words = argv + argc - kWords;
    std::set_new_handler(outOfMemory);
    confine({number(words[2]), number(words[3])}, most, std::atoi(words[0]));
    HandedOver file{STDIN_FILENO, number(words[1])};
    Budget work(0, {number(words[4])});
    try {
        while (file.fd == STDIN_FILENO) {
            work = Budget(0, {number(words[4])});
            const std::string result = answer(file.size, work);
            tellWork(work);
            tell(ConfinedAnswer::Result, result);
            ::close(STDIN_FILENO);  // frees the number for the next file
            file = receiveFile();
        }
    } catch (const std::bad_alloc&) {
        outOfMemory();
    } catch (const TooMuchWork& error) {
        tell(ConfinedAnswer::TooMuchWork, error.what());
    } catch (const std::exception& error) {
        tellWork(work);
        tell(ConfinedAnswer::Error, error.what());
    }
    ::_exit(0);  // without destructors, which would only take time
}

}  // namespace ispace
