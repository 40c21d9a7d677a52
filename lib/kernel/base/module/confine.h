// SPDX-License-Identifier: GPL-3.0-or-later
// Restricts programs that read untrusted bytes; base/confined.h starts them.
//
// Rights are given up before the first byte of the file is read, and never come back. A reader that
// is taken over can compute, read what it was handed, and answer its parent.
//
//     int main(int argc, char** argv) {
//         return runConfined(argc, argv, kMost, [](std::size_t size, Budget& work) {
//             const MappedInput input(size);
//             return packed(parse(input.bytes(), work));
//         });
//     }
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/budget.h"
#include "base/confined.h"

namespace ispace {

/// Reports work beyond the budget, by its cause: "nodes that repeat meshes".
class TooMuchWork : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// main() of a confined program, whose last arguments are its parent's process number, the size of
/// the file on standard input, its limits (memory, seconds and units of work), and 1 if it may read
/// without being confined, else 0.
///
/// First restricts this process to the system calls that a reader requires: no memory or time
/// beyond the limits, no files but open ones, no programs, network or core dumps; it ends with its
/// parent. If the system lacks or refuses any of that, as without seccomp, it reads nothing unless
/// it may. Under sanitizers, which require more system calls, only time is limited. Then computes
/// one answer for each file that the parent hands over, until the first error. \param most bound up
/// to which the parent may raise the limits; if lower, the limits stay \param answer computes the
/// result of a file of this size, and takes its work; its exceptions are the errors of the file
int runConfined(int argc, char** argv, const ConfinedLimits& most,
                const std::function<std::string(std::size_t size, Budget& work)>& answer);

/// A file that the parent hands over.
struct HandedOver {
    int fd = -1;  ///< -1 if missing
    std::size_t size = 0;
};
/// Waits for the parent's reply, or for the next file; exits if the parent is gone.
HandedOver receiveFile();

/// Sends a whole message to the parent; exits if the parent is gone.
void report(ConfinedAnswer kind, std::string_view bytes);

/// Reads all bytes on standard input.
class MappedInput {
  public:
    explicit MappedInput(std::size_t size);
    ~MappedInput();
    MappedInput(const MappedInput&) = delete;
    MappedInput& operator=(const MappedInput&) = delete;

    [[nodiscard]] std::string_view bytes() const {
        return {static_cast<const char*>(start_), size_};
    }

  private:
    void* start_ = nullptr;
    std::size_t size_;
};

}  // namespace ispace
