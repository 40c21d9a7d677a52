// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pthread.h>

#include <memory>
#include <new>
#include <system_error>

namespace ispace {

/// Returns the T of the calling thread, one for each Tag, created at the first call and destroyed
/// with the thread: scratch memory that is reused. Use it in place of a thread_local object with a
/// destructor, for which glibc ends the process if memory is out when the thread registers it.
/// \throws std::bad_alloc
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
