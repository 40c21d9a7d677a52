// SPDX-License-Identifier: GPL-3.0-or-later
// The system calls of confined programs, by machine.
//
// A program that has started, with its libraries loaded and its files open, needs memory, reads, a
// socket to its parent, locks, the clock, random bytes and exit, and gets no more: no open, execve,
// socket, ioctl or clone. Calls that are not allowed fail with EPERM instead of killing, so that a
// library that tries a faster way falls back.
#pragma once

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/syscall.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace ispace {

/// The calls that a reader requires, by their numbers on one machine: memory, open files and exit.
struct MachineCalls {
    std::uint32_t machine;  ///< AUDIT_ARCH_…
    std::array<std::uint32_t, 22> allowed;
};

// In each: read, pread64, lseek, close, sendto, sendmsg, recvfrom, recvmsg, brk, mmap, munmap,
// mremap, mprotect, madvise, futex, clock_gettime, getrandom, exit, exit_group, rt_sigreturn,
// rt_sigprocmask, restart_syscall.
constexpr MachineCalls kX86Calls{
    AUDIT_ARCH_X86_64,
    {0, 17, 8, 3, 44, 46, 45, 47, 12, 9, 11, 25, 10, 28, 202, 228, 318, 60, 231, 15, 14, 219}};
constexpr MachineCalls kArmCalls{AUDIT_ARCH_AARCH64,
                                 {63,  67,  62,  57, 206, 211, 207, 212, 214, 222, 215,
                                  216, 226, 233, 98, 113, 278, 93,  94,  139, 135, 128}};

/// Returns those of the machine that this is compiled for, if they are known.
constexpr std::optional<MachineCalls> nativeCalls() {
#if defined(__x86_64__) || defined(__aarch64__)
#if defined(__x86_64__)
    constexpr MachineCalls kNative = kX86Calls;
#else
    constexpr MachineCalls kNative = kArmCalls;
#endif
    constexpr std::array<std::uint32_t, 22> kNumbers{
        __NR_read,
        __NR_pread64,
        __NR_lseek,
        __NR_close,
        __NR_sendto,
        __NR_sendmsg,
        __NR_recvfrom,
        __NR_recvmsg,
        __NR_brk,
        __NR_mmap,
        __NR_munmap,
        __NR_mremap,
        __NR_mprotect,
        __NR_madvise,
        __NR_futex,
        __NR_clock_gettime,
        __NR_getrandom,
        __NR_exit,
        __NR_exit_group,
        __NR_rt_sigreturn,
        __NR_rt_sigprocmask,
        __NR_restart_syscall,
    };
    static_assert(kNumbers == kNative.allowed);
    return kNative;
#else
    return std::nullopt;
#endif
}

/// Builds the filter: the calls are allowed, all others fail with EPERM, those by the numbers of
/// another machine kill the process: 32-bit calls on a 64-bit kernel have other numbers. A classic
/// BPF program (seccomp(2)) of 5 + 2 * 22 instructions; it reads the call's number alone, so
/// arguments are not restricted: mmap may map no file that is not open. Installed once, it cannot
/// be removed.
inline std::vector<sock_filter> callFilter(const MachineCalls& calls) {
    constexpr auto kNumberAt = static_cast<std::uint32_t>(offsetof(seccomp_data, nr));
    constexpr auto kMachineAt = static_cast<std::uint32_t>(offsetof(seccomp_data, arch));
    std::vector<sock_filter> program{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kMachineAt),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, calls.machine, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kNumberAt),
    };
    for (const std::uint32_t call : calls.allowed) {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    }
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
    return program;
}

}  // namespace ispace
