// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/module/read_mesh.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <vector>

#if defined(__SANITIZE_ADDRESS__)
#define ISPACE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ISPACE_SANITIZED 1
#endif
#endif

#ifdef ISPACE_SANITIZED
// In place of the limit on memory. What assimp leaves behind is nobody's business.
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

/// Deep enough for trees of nodes that are refused with a message.
constexpr rlim_t kStack = 64U << 20U;
constexpr rlim_t kDescriptors = 64;

/// \param most what the limit may be raised to by the parent, where a mesh has side files
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

/// Memory, what is open, and the end; all else fails with EPERM.
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

}  // namespace

void confine(const MeshLimits& limits, int parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // it ended before
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    ::prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);  // a core may also go to a program, whatever its limit
    const MeshLimits most = meshLimits(SIZE_MAX, true);
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_FSIZE, 0, 0);
    limit(RLIMIT_CPU, limits.seconds, most.seconds);
    if (kSanitized) return;
    limit(RLIMIT_NOFILE, kDescriptors, kDescriptors);
    limit(RLIMIT_STACK, kStack, kStack);
    limit(RLIMIT_AS, limits.memory, most.memory);
    filterCalls();
}

}  // namespace ispace
