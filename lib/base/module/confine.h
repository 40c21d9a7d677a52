// SPDX-License-Identifier: GPL-3.0-or-later
// Of the programs that read untrusted bytes; what starts them is base/confined.h.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "base/confined.h"

namespace ispace {

/// main() of a confined program, whose last arguments are the number of the process that started
/// it, the size of the file on standard input, and its limits: memory and seconds.
///
/// First restricts this process to what reading untrusted bytes needs: no memory or time beyond the
/// limits, no files but open ones, no programs, network or core dumps; it ends with its parent.
/// Where the system has no seccomp, or refuses it, the limits hold all the same. Under sanitizers,
/// which need more, only time is limited.
/// Answers for each file that the parent hands over after that, too, until the first error.
/// \param most what the parent may raise the limits to; lower: the limits stay
/// \param answer makes the result of a file of this size; what it throws is the error of the file
int runConfined(int argc, char** argv, const ConfinedLimits& most,
                const std::function<std::string(std::size_t size)>& answer);

/// A file that the parent hands over.
struct HandedOver {
    int fd = -1;  ///< -1: there is none
    std::size_t size = 0;
};
/// Waits for the parent's reply, or for the next file; exits if the parent is gone.
HandedOver receiveFile();

/// Sends a whole message to the program that started this one; exits if that is gone.
void tell(ConfinedAnswer kind, std::string_view bytes);

/// The bytes on standard input.
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
