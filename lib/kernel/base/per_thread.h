// SPDX-License-Identifier: GPL-3.0-or-later
// Scratch memory of functions that several threads call very often.
//
//     struct Scratch;  // the tag
//     std::vector<double>& ranges = perThread<std::vector<double>, Scratch>();
//     ranges.clear();
#pragma once

#include <pthread.h>

#include <memory>
#include <new>
#include <system_error>

namespace ispace {

/// Returns the T of the calling thread, one for each Tag, created at the first call and destroyed
/// with the thread: scratch memory that is reused. Use it in place of a thread_local object with a
/// destructor, for which glibc ends the process if memory is out when the thread registers it. The
/// value keeps its contents from the last use; callers clear it. A call inside of another with the
/// same T and Tag gets the same object. Costs one look-up, some nanoseconds; the system allows some
/// 1000 keys (PTHREAD_KEYS_MAX), one for each T and Tag.
///
/// \throws std::bad_alloc, std::system_error if there are no more keys
template <typename T, typename Tag>
T& perThread() {
    static const pthread_key_t key = [] {
        pthread_key_t made{};
        const int error = pthread_key_create(&made, [](void* own) { delete static_cast<T*>(own); });
        if (error != 0) throw std::system_error(error, std::generic_category(), "thread data");
        return made;
    }();
    if (void* const known = pthread_getspecific(key)) return *static_cast<T*>(known);
    auto own = std::make_unique<T>();
    if (pthread_setspecific(key, own.get()) != 0) throw std::bad_alloc();
    return *own.release();
}

}  // namespace ispace
