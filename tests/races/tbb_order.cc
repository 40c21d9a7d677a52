// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the order of TBB's scheduler to ThreadSanitizer.
//
// Debian's libtbb.so is not instrumented: ThreadSanitizer cannot see that a thread takes a task
// after another one has spawned it, and that the scheduler reuses memory of tasks, and would report
// races. (It sees the join of a loop, which counts in TBB's headers.) This source wraps the
// library's entry points: they order events exactly as far as the scheduler does, so that tasks are
// not ordered among each other, and a race between them is found. It handles loops and task groups,
// tbb_pipelines.cc pipelines; code that uses the queues of arenas would seem to race.
#include <oneapi/tbb/detail/_task.h>
#include <oneapi/tbb/partitioner.h>
#include <sanitizer/tsan_interface.h>

#include <new>

#include "tbb_original.h"

namespace tbb::detail {

// Programs take the first copy of a template that they are linked with. Those of libraries without
// instrumentation would hide the join of a loop.
template void d1::fold_tree<d1::tree_node>(d1::node*, const d1::execution_data&);

namespace {

/// Stands for a task on its way to the thread that runs it.
class Envelope final : public d1::task {
  public:
    explicit Envelope(d1::task& task) : task_(&task) { __tsan_release(this); }
    d1::task* execute(d1::execution_data& data) override { return opened().execute(data); }
    d1::task* cancel(d1::execution_data& data) override { return opened().cancel(data); }

  private:
    d1::task& opened() {
        __tsan_acquire(this);
        d1::task& task = *task_;
        delete this;
        return task;
    }
    d1::task* task_;
};

/// Tasks count down as they end, in the headers; the library reads a count of zero.
void acquireEnd(d1::wait_context& wait) {
    constexpr std::size_t kVersion = sizeof(std::uint64_t);
    __tsan_acquire(reinterpret_cast<char*>(&wait) + kVersion);
}

}  // namespace

namespace r1 {

void spawn(d1::task& task, d1::task_group_context& context) {
    using Spawn = void(d1::task&, d1::task_group_context&);
    static auto* const real =
        original<Spawn>("_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextE");
    real(*new Envelope(task), context);
}

void spawn(d1::task& task, d1::task_group_context& context, d1::slot_id slot) {
    using Spawn = void(d1::task&, d1::task_group_context&, d1::slot_id);
    static auto* const real =
        original<Spawn>("_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextEt");
    real(*new Envelope(task), context, slot);
}

void execute_and_wait(d1::task& task, d1::task_group_context& context, d1::wait_context& wait,
                      d1::task_group_context& wait_group) {
    using Execute =
        void(d1::task&, d1::task_group_context&, d1::wait_context&, d1::task_group_context&);
    static auto* const real = original<Execute>(
        "_ZN3tbb6detail2r116execute_and_waitERNS0_2d14taskERNS2_18task_group_contextERNS2_12wait_"
        "contextES6_");
    real(task, context, wait, wait_group);
    acquireEnd(wait);
}

void wait(d1::wait_context& wait, d1::task_group_context& context) {
    using Wait = void(d1::wait_context&, d1::task_group_context&);
    static auto* const real =
        original<Wait>("_ZN3tbb6detail2r14waitERNS0_2d112wait_contextERNS2_18task_group_contextE");
    real(wait, context);
    acquireEnd(wait);
}

// Memory of tasks: malloc is known to the sanitizer, the library's own lists are not.

void* allocate(d1::small_object_pool*& pool, std::size_t bytes) {
    static char none;
    pool = reinterpret_cast<d1::small_object_pool*>(&none);
    return ::operator new(bytes, std::align_val_t(d1::task_alignment));
}

void* allocate(d1::small_object_pool*& pool, std::size_t bytes, const d1::execution_data&) {
    return allocate(pool, bytes);
}

void deallocate(d1::small_object_pool&, void* memory, std::size_t) {
    ::operator delete(memory, std::align_val_t(d1::task_alignment));
}

void deallocate(d1::small_object_pool& pool, void* memory, std::size_t bytes,
                const d1::execution_data&) {
    deallocate(pool, memory, bytes);
}

}  // namespace r1

}  // namespace tbb::detail
