// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/module/call_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace ispace {
namespace call_filter_test {

/// Interprets a filter as the kernel does: only the instructions that ours consist of.
std::uint32_t resultOf(const std::vector<sock_filter>& program, const seccomp_data& call) {
    std::uint32_t value = 0;
    for (std::size_t at = 0; at < program.size(); ++at) {
        const sock_filter& step = program[at];
        switch (step.code) {
            case BPF_LD | BPF_W | BPF_ABS:
                if (step.k % 4 != 0 || step.k + 4 > sizeof call)
                    throw std::logic_error("a load outside of the call");
                std::memcpy(&value, reinterpret_cast<const char*>(&call) + step.k, sizeof value);
                break;
            case BPF_JMP | BPF_JEQ | BPF_K:
                at += value == step.k ? step.jt : step.jf;
                break;
            case BPF_RET | BPF_K:
                return step.k;
            default:
                throw std::logic_error("another instruction");
        }
    }
    throw std::logic_error("a filter without end");
}

seccomp_data callOf(std::uint32_t machine, int number) {
    seccomp_data call{};
    call.nr = number;
    call.arch = machine;
    return call;
}

/// Calls of each machine that open files, start programs or reach others.
struct Forbidden {
    const MachineCalls& calls;
    std::vector<int> numbers;
};

TEST(CallFilter, AllowsItsCallsAloneOnEachMachine) {
    for (const MachineCalls* calls : {&kX86Calls, &kArmCalls}) {
        const auto program = callFilter(*calls);
        int allowed = 0;
        for (int number = 0; number < 1024; ++number) {
            const std::uint32_t result = resultOf(program, callOf(calls->machine, number));
            const bool is_listed =
                std::count(calls->allowed.begin(), calls->allowed.end(), number) == 1;
            EXPECT_EQ(result, is_listed ? SECCOMP_RET_ALLOW : (SECCOMP_RET_ERRNO | EPERM))
                << number;
            allowed += is_listed ? 1 : 0;
        }
        EXPECT_EQ(allowed, 22);
        // x32 has the numbers of x86-64 with another bit.
        EXPECT_EQ(resultOf(program, callOf(calls->machine, 0x40000000)), SECCOMP_RET_ERRNO | EPERM);
        const MachineCalls& other = calls == &kX86Calls ? kArmCalls : kX86Calls;
        for (int number = 0; number < 1024; ++number)
            EXPECT_EQ(resultOf(program, callOf(other.machine, number)), SECCOMP_RET_KILL_PROCESS);
    }
}

TEST(CallFilter, RefusesFilesProgramsAndSockets) {
    // open or openat, openat2, clone, clone3, execve, execveat, socket, connect, bind, kill,
    // ptrace, ioctl, write, prctl, seccomp, memfd_create, io_uring_setup.
    const Forbidden machines[] = {
        {kX86Calls,
         {2, 257, 437, 56, 57, 58, 435, 59, 322, 41, 42, 49, 62, 101, 16, 1, 157, 317, 319, 425}},
        {kArmCalls,
         {56, 437, 220, 435, 221, 281, 198, 203, 200, 129, 117, 29, 64, 167, 277, 279, 425}},
    };
    for (const auto& [calls, numbers] : machines) {
        const auto program = callFilter(calls);
        for (const int number : numbers)
            EXPECT_EQ(resultOf(program, callOf(calls.machine, number)), SECCOMP_RET_ERRNO | EPERM)
                << number;
    }
    // The same number is close(2) on one, fork(2) on the other.
    EXPECT_EQ(resultOf(callFilter(kArmCalls), callOf(kArmCalls.machine, 57)), SECCOMP_RET_ALLOW);
}

TEST(CallFilter, TheseMachinesHaveOne) {
#if defined(__x86_64__)
    EXPECT_EQ(nativeCalls().value().machine, kX86Calls.machine);
#elif defined(__aarch64__)
    EXPECT_EQ(nativeCalls().value().machine, kArmCalls.machine);
#endif
}

}  // namespace call_filter_test
}  // namespace ispace
